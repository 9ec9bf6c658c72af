#include "outline/read.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.hpp"
#include "core/files.hpp"
#include "read_files.hpp"

namespace rejoin::outline {
namespace {

using testing::only_area;

class Read : public testing::ReadFiles {};

TEST_F(Read, CsvWithAnySeparatorAndLineEnd) {
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write("a.csv", "x,y\n0,0\n0,2\n2,2\n2,0\n"))), 4.0);
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write("b.txt", "0;0\r\n2;0\r\n2;2\r\n0;2\r\n0;0\r\n"))), 4.0);
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write("c.csv", "# km\n0 0\n2e0 0\n\n2 2\n0\t2"))), 4.0);
}

TEST_F(Read, BrokenCsvNamesTheLine) {
  expect_refusal("a.csv", "x,y\n0,0\n1;abc\n1,1\n0,1\n", "line 3");
  expect_refusal("b.csv", "x,y\n", "no points");
  expect_refusal("c.csv", "0,0\n1,0\n1,nan\n0,1\n", "point 3");
  expect_refusal("d.csv", "0,0\n1,0\n0,1\n", "3 points");
  expect_refusal("e.csv", "", "empty");
}

TEST_F(Read, HolesAcrossTheBorderAreToldAndLeftOut) {
  const PieceSet set = read_pieces(
      write("a.geojson",
            R"({"type":"Polygon","coordinates":[[[0,0],[10,0],[10,10],[0,10]],[[5,5],[15,5],[15,8],[5,8]],
                                                [[1,1],[2,1],[2,2],[1,2]]]})"));
  EXPECT_EQ(set.pieces[0].outline.holes.size(), 1U);
  ASSERT_EQ(set.notes.size(), 1U);
  EXPECT_NE(set.notes[0].find("hole 1: lies outside the border, or across it"), std::string::npos)
      << set.notes[0];
}

TEST_F(Read, GeoJsonPolygonsWithHoles) {
  const std::string text =
      R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":
    {"type":"Polygon","coordinates":[[[0,0],[10,0],[10,10],[0,10],[0,0]],[[2,2],[4,2],[4,4],[2,4],[2,2]]]}},
    {"type":"Feature","geometry":{"type":"MultiPolygon","coordinates":[[[[20,0,5],[21,0,5],[21,1,5],[20,1,5]]]]}}]})";
  const PieceSet set = read_pieces(write("a.geojson", text));
  ASSERT_EQ(set.pieces.size(), 2U);
  EXPECT_DOUBLE_EQ(signed_area(set.pieces[0].outline.points), 100.0);
  ASSERT_EQ(set.pieces[0].outline.holes.size(), 1U);
  EXPECT_DOUBLE_EQ(signed_area(set.pieces[0].outline.holes[0]), -4.0);
  EXPECT_DOUBLE_EQ(signed_area(set.pieces[1].outline.points), 1.0);
}

TEST_F(Read, MapsAndTablesHaveYUpAndDrawingsDown) {
  EXPECT_TRUE(read_pieces(write("a.csv", "0,0\n1,0\n1,1\n0,1\n")).pieces[0].y_up);
  EXPECT_TRUE(read_pieces(write("b.csv", "x,y\n0,0\n1,0\n1,1\n0,1\n")).pieces[0].y_up);
  EXPECT_FALSE(read_pieces(write("c.csv", "x,y_down\n0,0\n1,0\n1,1\n0,1\n")).pieces[0].y_up);
  EXPECT_FALSE(
      read_pieces(write("d.csv", "n;X [px];Y_down [px]\n7;0;0\n7;1;0\n7;1;1\n7;0;1\n")).pieces[0].y_up);
  EXPECT_TRUE(
      read_pieces(write("a.geojson", R"({"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1],[0,1]]]})"))
          .pieces[0]
          .y_up);
  EXPECT_FALSE(read_pieces(write("a.svg", "<svg><rect width='2' height='2'/></svg>")).pieces[0].y_up);
}

TEST_F(Read, BrokenGeoJsonIsRefused) {
  expect_refusal("a.geojson", "{\"type\":", "no JSON");
  expect_refusal("b.geojson", R"({"type":"Point","coordinates":[1,2]})", "no polygon");
  expect_refusal("c.geojson", R"({"type":"Polygon","coordinates":[[[0,0],[1,"a"]]]})", "polygon 1: point 2");
  expect_refusal("d.geojson", R"({"type":7,"coordinates":3})", "no polygon");
}

TEST_F(Read, TellsGeoJsonThatSaysItsCoordinatesAreDegrees) {
  const auto notes = [&](const std::string& crs) {
    const std::string head =
        crs.empty() ? "" : R"("crs":{"type":"name","properties":{"name":")" + crs + R"("}},)";
    return read_pieces(
               write("a.geojson",
                     "{" + head + R"("type":"Polygon","coordinates":[[[0,50],[9,50],[9,59],[0,59]]]})"))
        .notes;
  };
  for (const char* degrees : {"urn:ogc:def:crs:OGC:1.3:CRS84", "EPSG:4326", "urn:ogc:def:crs:EPSG::4326"}) {
    ASSERT_EQ(notes(degrees).size(), 1U) << degrees;
    EXPECT_NE(notes(degrees)[0].find("a.geojson: degrees are no lengths"), std::string::npos)
        << notes(degrees)[0];
  }
  for (const char* metres : {"", "urn:ogc:def:crs:EPSG::32650", "EPSG:3857"})
    EXPECT_TRUE(notes(metres).empty()) << metres;
}

TEST_F(Read, ARingThatIsNoOutlineIsToldAndLeftOutWhereOthersAreLeft) {
  const std::string good = "[[0,0],[9,0],[9,9],[0,9]]";
  const std::string three = "[[20,0],[21,0],[20,1]]";
  const std::string crossing = "[[2,2],[4,4],[4,2],[2,4]]";
  const auto polygons = [](const std::string& list) {
    return R"({"type":"MultiPolygon","coordinates":[)" + list + "]}";
  };
  const PieceSet map =
      read_pieces(write("a.geojson", polygons("[" + three + "],[],[" + good + "," + crossing + "]")));
  EXPECT_DOUBLE_EQ(only_area(map), 81.0);
  EXPECT_TRUE(map.pieces[0].outline.holes.empty());
  ASSERT_EQ(map.notes.size(), 2U);
  EXPECT_NE(map.notes[0].find("a.geojson, polygon 1: an outline of 3 points"), std::string::npos)
      << map.notes[0];
  EXPECT_NE(map.notes[1].find("hole 1: the outline crosses itself"), std::string::npos) << map.notes[1];
  EXPECT_EQ(read_pieces(write("b.svg", "<svg><path d='M0 0H9V9H0z M20 0H21L20 1'/></svg>")).notes.size(), 1U);
  expect_refusal("c.geojson", polygons("[" + three + "]"), "polygon 1: an outline of 3 points");
}

TEST_F(Read, CoordinatesWhoseAreasOverflowAreRefused) {
  expect_refusal("a.csv", "-1e308,0\n1e308,0\n1e308,1\n0,1\n", "point 1 (-1e+308, 0) is not within 1e+12");
  expect_refusal("b.geojson", R"({"type":"Polygon","coordinates":[[[0,0],[1,0],[1,2e12],[0,1]]]})",
                 "point 3 (1, 2e+12)");
  expect_refusal("c.svg", "<svg><path d='M0 0 h1 v1 h-1 z M0 0 H1e300 V1e300 z'/></svg>", "shape 2: point 2");
}

TEST_F(Read, GeoJsonNestedWithoutEndIsRefused) {
  std::string text = R"({"type":"Polygon","coordinates":[]})";
  std::string head;
  std::string foot;
  for (int k = 0; k < 100000; ++k) {
    head += R"({"type":"GeometryCollection","geometries":[)";
    foot += "]}";
  }
  EXPECT_THROW(read_pieces(write("deep.geojson", head + text + foot)), InputError);
  const std::string brackets(1000000, '[');
  text = R"({"type":)" + brackets + std::string(1000000, ']') + "}";
  EXPECT_THROW(read_pieces(write("type.geojson", text)), InputError);
}

TEST_F(Read, CsvWithSemicolonsMayHaveDecimalCommas) {
  const PieceSet set = read_pieces(write("a.csv", "x;y\r\n0,5;0,5\r\n10,5;0,5\r\n10,5;-1e1\r\n0,5;-10\r\n"));
  ASSERT_EQ(set.pieces.size(), 1U);
  EXPECT_DOUBLE_EQ(signed_area(set.pieces[0].outline.points), 10.0 * 10.5);
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write("b.csv", "0;0\n10;0\n10;10\n0;10\n"))), 100.0);
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write("c.csv", "0,0\n1,0\n1,1\n0,1\n"))), 1.0);
}

TEST_F(Read, CsvWithBlanksOrTabsMayHaveDecimalCommas) {
  EXPECT_DOUBLE_EQ(
      only_area(read_pieces(write("a.txt", "0,5\t0,5\r\n10,5\t0,5\r\n10,5\t10,5\r\n0,5\t10,5\r\n"))), 100.0);
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write("b.txt", "0 0\n2,5 0\n2,5 2,5\n0 2,5\n"))), 6.25);
  expect_refusal("c.txt", "0,5 0,5\n3,5 0,5\n3,5,2\n", "line 3 has commas");
  expect_refusal("d.txt", "0,5 0,5\n3,5\n3,5 2,5\n", "line 2 is no point");
}

TEST_F(Read, CsvWhoseCommasPartColumnsMayHaveBlanksAroundThem) {
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write("a.csv", "  0, 0\n1, 0 \n1 ,1\n  0,1 \n"))), 1.0);
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write("b.csv", "0,\t0\n3,\t0\n3,\t1\n0,\t1\t\n"))), 3.0);
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write("c.csv", "0,0 1\n50,0 2\n50,2 3\n0,2 4\n"))), 100.0)
      << "a number each";
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write("d.csv", "0,0;\n4,0;\n4,2;\n0,2;\n"))), 8.0);
}

TEST_F(Read, CsvFieldsMayStandInQuotesWithDecimalCommas) {
  EXPECT_DOUBLE_EQ(
      only_area(read_pieces(
          write("a.csv", "x,y\n\"0,5\",\"0,5\"\n\"10,5\",\"0,5\"\n\"10,5\",\"8,5\"\n\"0,5\",\"8,5\"\n"))),
      80.0);
  EXPECT_DOUBLE_EQ(
      only_area(read_pieces(
          write("b.csv", "\"x\",\"y\"\n\"0.5\",\"0\"\n\"10.5\",\"0\"\n\"10.5\",\"8\"\n\"0.5\",\"8\"\n"))),
      80.0);
  EXPECT_DOUBLE_EQ(only_area(read_pieces(
                       write("c.csv", "\"0,5\";\"0\"\n\"10,5\";\"0\"\n\"10,5\";\"8\"\n\"0,5\";\"8\"\n"))),
                   80.0);
  expect_refusal("d.csv", "0,0\n\"1,234.5\",1\n", "line 2 is no point");
}

TEST_F(Read, CsvWithTwiceAsManyFieldsAsNamesIsRefused) {
  expect_refusal("a.csv", "x,y\n80,69,191,42\n80,61,190,43\n80,53,189,43\n80,45,188,43\n",
                 "line 2 has 4 fields under 2 names; if its commas are decimal ones");
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write("b.csv", "x,y\n0,0,\n4,0,\n4,2,\n0,2,a corner\n"))), 8.0);
}

/// Points along a circle, or a part of it.
std::string circle_csv(double centre, double radius, double share = 1.0) {
  std::string text;
  for (int i = 0; i < 40; ++i) {
    const double angle = 2.0 * M_PI * share * i / 40.0;
    text += std::to_string(centre + radius * std::cos(angle)) + "," +
            std::to_string(radius * std::sin(angle)) + "\n";
  }
  return text;
}

TEST_F(Read, CsvMayHoldSeveralOutlinesPartedByBlankLines) {
  const PieceSet set =
      read_pieces(write("a.csv", "x,y\n" + circle_csv(0.0, 5.0) + "\n" + circle_csv(30.0, 9.0)));
  ASSERT_EQ(set.pieces.size(), 2U);
  EXPECT_EQ(set.pieces[1].name, "a.csv#2");
  EXPECT_NEAR(signed_area(set.pieces[1].outline.points), M_PI * 25.0, 0.5);  // of its 40 corners
  ASSERT_EQ(set.notes.size(), 1U);
  EXPECT_NE(set.notes[0].find("blank lines part 2 outlines"), std::string::npos) << set.notes[0];
}

TEST_F(Read, OutlinesThatEndFarFromTheirBeginningAreDoubted) {
  const auto doubted = [&](const char* name, const std::string& text) {
    const PieceSet set = read_pieces(write(name, text));
    return set.notes.size() == 1 &&
           set.notes[0].find("the outline is open, and its ends, ") != std::string::npos;
  };
  const std::string part = circle_csv(0.0, 5.0, 0.6);
  EXPECT_TRUE(doubted("a.csv", part));
  EXPECT_FALSE(doubted("b.csv", circle_csv(0.0, 5.0)));
  EXPECT_FALSE(doubted("c.csv", part + part.substr(0, part.find('\n'))));  // closed by its last point
  std::string points = part;
  std::ranges::replace(points, '\n', ' ');
  EXPECT_TRUE(doubted("a.svg", "<svg><polyline points='" + points + "'/></svg>"));
  EXPECT_FALSE(doubted("b.svg", "<svg><polygon points='" + points + "'/></svg>"));
  EXPECT_TRUE(doubted("c.svg", "<svg><path d='M" + points + "'/></svg>"));
  EXPECT_FALSE(doubted("d.svg", "<svg><path d='M" + points + "z'/></svg>"));
}

TEST_F(Read, DegreesAreDoubtedAwayFromTheEquator) {
  const auto notes = [&](const char* name, const char* text) { return read_pieces(write(name, text)).notes; };
  const auto far = notes("a.csv", "lat;lon\n60;10\n60;11\n61;11\n61;10\n");
  ASSERT_EQ(far.size(), 1U);
  EXPECT_NE(far[0].find("at a latitude of 60 one of longitude is 0.49 times"), std::string::npos) << far[0];
  EXPECT_TRUE(notes("b.csv", "lat;lon\n0;10\n0;11\n1;11\n1;10\n").empty());
  EXPECT_TRUE(notes("c.csv", "northing;easting\n60;10\n60;11\n61;11\n61;10\n").empty());
}

TEST_F(Read, CsvWithAByteOrderMarkLosesNoPoint) {
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write("a.csv",
                                               "\xEF\xBB\xBF"
                                               "0,0\n4,0\n4,2\n0,2\n2,1\n"))),
                   6.0);
}

TEST_F(Read, CsvLosesNoFirstLineThatIsNoPoint) {
  expect_refusal("a.csv", "0,one\n4,0\n4,2\n0,2\n", "line 1 is no point");
}

TEST_F(Read, CsvTakesTheColumnsThatAreNamedXAndY) {
  const std::vector<glm::dvec2> expected = {{0, 5}, {7, 5}, {7, 8}, {0, 8}};
  const auto points = [&](const char* name, const char* text) {
    const PieceSet set = read_pieces(write(name, text));
    EXPECT_TRUE(set.notes.empty()) << name;
    return set.pieces.at(0).outline.points;
  };
  EXPECT_EQ(points("a.csv", "id,x,y\np1,0,5\n,7,5\n3,7,8\n4,0,8\n"), expected);
  EXPECT_EQ(points("b.csv", "\"Y [mm]\";\"X [mm]\"\n5,0;0\n5,0;7,0\n8,0;7,0\n8,0;0\n"), expected);
  EXPECT_EQ(points("c.txt", "n  lon  lat\n1  0  5\n2  7  5\n3  7  8\n4  0  8\n"), expected);
  EXPECT_EQ(points("h.csv", "\"\",\"x\",\"y\"\n\"1\",0,5\n\"2\",7,5\n\"3\",7,8\n\"4\",0,8\n"), expected)
      << "as R writes it";
  EXPECT_EQ(points("i.csv", ",x,y\n0,0,5\n2,7,5\n4,7,8\n6,0,8\n"), expected) << "as pandas does";
  EXPECT_EQ(points("d.txt", "a\tb\n0\t5\n7\t5\n7\t8\n0\t8\n"), expected);
  expect_refusal("e.csv", "id,x,y\n1,0,5\n2,7\n", "line 3 is no point");
  expect_refusal("f.csv", "1,0,5\n2,7,5\n3,7,8\n4,0,8\n", "its first column counts the points");
  EXPECT_EQ(read_pieces(write("g.csv", "a,b,c\n0,5,1\n7,5,2\n7,8,2\n0,8,3\n")).notes.size(), 1U);
}

TEST_F(Read, CsvMayBeginWithBlankLinesAndCommentsAndHaveSigns) {
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write("a.csv", "\n# km\nx,y\n+0,-0\n+4,0\n4,+2\n0,2\n"))), 8.0);
  expect_refusal("b.csv", "0,0\n+-4,0\n", "line 2 is no point");
  expect_refusal("c.csv", "\nx,y\nx,y\n", "line 3 is no point");
}

TEST_F(Read, CsvLinesMayEndWithCarriageReturnsAlone) {
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write("a.csv", "x,y\r0,0\r4,0\r4,2\r0,2\r"))), 8.0);
  expect_refusal("b.csv", "0,0\r\n1,0\r\n\r\n1,one\r\n", "line 4 is no point");
}

TEST_F(Read, Utf16IsRefusedAsSuch) {
  using namespace std::string_literals;
  expect_refusal("a.csv",
                 "\xFF\xFE"
                 "0\0,\0000\0\n\0"s,
                 "is UTF-16");
  expect_refusal("b.geojson", "\xFE\xFF\0{\0}"s, "is UTF-16");
}

TEST_F(Read, CsvWhoseCommasMayMeanTwoThingsIsRefusedWithTheLine) {
  expect_refusal("a.csv", "0,5;0,5\n1,2,3;4\n", "line 2 has commas that may be decimal ones");
  expect_refusal("b.csv", "0;0\n1, 2;3\n", "line 2 has commas that may be decimal ones");
}

/// A blot with a bump that shows where it is turned to; `bump` in degrees.
cv::Mat blot(double bump) {
  cv::Mat image(200, 220, CV_8UC3, cv::Scalar(240, 240, 240));
  cv::circle(image, {110, 100}, 60, cv::Scalar(40, 60, 120), cv::FILLED, cv::LINE_AA);
  const cv::Point at(110 + static_cast<int>(60 * std::cos(bump * M_PI / 180)),
                     100 + static_cast<int>(60 * std::sin(bump * M_PI / 180)));
  cv::circle(image, at, 15, cv::Scalar(40, 60, 120), cv::FILLED, cv::LINE_AA);
  return image;
}

TEST_F(Read, OnePictureInSeveralFormatsIsOnePiece) {
  cv::Mat deep;
  blot(30).convertTo(deep, CV_16U, 257);
  cv::imwrite((folder_ / "a.png").string(), blot(30));
  cv::imwrite((folder_ / "a copy.tif").string(), deep);
  cv::imwrite((folder_ / "a copy.jpg").string(), blot(30));
  cv::imwrite((folder_ / "b.png").string(), blot(60));
  const PieceSet set = read_folder(folder_.string());
  ASSERT_EQ(set.pieces.size(), 2U);
  EXPECT_EQ(set.pieces[0].name, "a.png");
  EXPECT_EQ(set.pieces[1].name, "b.png");
  EXPECT_EQ(set.repeated.size(), 2U);
}

// Noise moves the places at which a contour crosses pixels, and how many there are.
TEST_F(Read, ANoisyPictureSavedAsJpegIsOnePieceWithIt) {
  cv::Mat noise(200, 220, CV_16SC3);
  cv::RNG random(7);
  random.fill(noise, cv::RNG::NORMAL, 0.0, 6.0);
  cv::Mat picture;
  cv::add(blot(30), noise, picture, cv::noArray(), CV_8U);
  cv::imwrite((folder_ / "a.png").string(), picture);
  cv::imwrite((folder_ / "a copy.jpg").string(), picture, {cv::IMWRITE_JPEG_QUALITY, 90});
  const PieceSet set = read_folder(folder_.string());
  ASSERT_EQ(set.pieces.size(), 1U);
  EXPECT_EQ(set.pieces[0].name, "a.png");
  EXPECT_EQ(set.repeated.size(), 1U);
}

TEST_F(Read, FolderTellsHowFarItIs) {
  for (const char* name : {"a.csv", "b.csv", "c.csv"}) write(name, "0,0\n9,0\n9,7\n0,8\n");
  std::vector<double> told;
  const Context context([&](std::string_view stage, double fraction) {
    EXPECT_EQ(stage, "reading pieces");
    told.push_back(fraction);
  });
  EXPECT_FALSE(read_folder(folder_.string(), {}, context).pieces.empty());
  EXPECT_EQ(told, std::vector<double>({0.0, 1.0 / 3.0, 2.0 / 3.0}));
}

TEST_F(Read, CardsOfOneSizeWithOtherTextAreNoCopies) {
  const auto card = [&](const char* name, const char* text) {
    cv::Mat image(200, 300, CV_8UC3, cv::Scalar(90, 60, 40));
    cv::rectangle(image, {30, 30, 240, 140}, cv::Scalar(215, 230, 236), cv::FILLED);
    cv::putText(image, text, {100, 110}, cv::FONT_HERSHEY_SIMPLEX, 0.5, cv::Scalar(30, 30, 30), 1,
                cv::LINE_AA);
    cv::imwrite((folder_ / name).string(), image);
  };
  card("a.png", "No. 17");
  card("b.png", "No. 18");
  card("b copy.jpg", "No. 18");
  const PieceSet set = read_folder(folder_.string());
  ASSERT_EQ(set.pieces.size(), 2U);
  ASSERT_EQ(set.repeated.size(), 1U);
  EXPECT_EQ(set.repeated[0].name, "b copy.jpg");
}

TEST_F(Read, PicturesThatTellDifferentResolutionsAreDoubted) {
  const auto tiff = [&](const char* name, double bump, int dots) {
    cv::imwrite((folder_ / name).string(), blot(bump),
                {cv::IMWRITE_TIFF_RESUNIT, 2, cv::IMWRITE_TIFF_XDPI, dots, cv::IMWRITE_TIFF_YDPI, dots});
  };
  tiff("a.tif", 10, 300);
  tiff("b.tif", 50, 300);
  EXPECT_TRUE(read_folder(folder_.string()).notes.empty());
  // A JPEG of the same 300 dots an inch, told as 118 a centimetre, and then of 200 dots an inch.
  const std::string jpeg = (folder_ / "c.jpg").string();
  for (const auto& [unit, dots, notes] : {std::tuple(2, 118, 0U), std::tuple(1, 200, 1U)}) {
    cv::imwrite(jpeg, blot(90));
    std::fstream file(jpeg, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(13);
    const char bytes[] = {static_cast<char>(unit), 0, static_cast<char>(dots), 0, static_cast<char>(dots)};
    file.write(bytes, sizeof bytes);
    file.close();
    EXPECT_EQ(read_folder(folder_.string()).notes.size(), notes) << unit;
  }
}

TEST_F(Read, ResolutionOfAJpegMayStandInItsExif) {
  cv::imwrite((folder_ / "a.tif").string(), blot(10),
              {cv::IMWRITE_TIFF_RESUNIT, 2, cv::IMWRITE_TIFF_XDPI, 300, cv::IMWRITE_TIFF_YDPI, 300});
  const std::string path = (folder_ / "b.jpg").string();
  for (const char dots : {75, 60}) {
    cv::imwrite(path, blot(50));
    std::string bytes = read_file(path);
    // In the place of the JFIF segment; one entry: tag 0x11A, a ratio that stands behind, `dots` over a quarter.
    std::string exif(
        "\xFF\xE1\0\x2A"
        "Exif\0\0"
        "II*\0\x8\0\0\0"
        "\1\0"
        "\x1A\1\5\0\1\0\0\0\x1A\0\0\0"
        "\0\0\0\0"
        "\0\0\0\0\x1\0\0\0",
        44);
    exif[37] = dots;  // times 256
    exif[40] = 64;
    bytes.replace(2, 18, exif);
    std::ofstream(path, std::ios::binary) << bytes;
    EXPECT_EQ(read_folder(folder_.string()).notes.size(), dots == 75 ? 0U : 1U) << static_cast<int>(dots);
  }
}

TEST_F(Read, ResultsAndHiddenFilesOfAFolderAreNoPieces) {
  for (const char* name : {"a.png", "object_12.png", "similarity.png"})
    cv::imwrite((folder_ / name).string(), blot(30));
  write("._a.png", "what macOS keeps beside a.png");
  const PieceSet set = read_folder(folder_.string());
  ASSERT_EQ(set.pieces.size(), 1U);
  EXPECT_TRUE(set.unusable.empty());
  ASSERT_EQ(set.notes.size(), 1U);
  EXPECT_NE(set.notes[0].find("2 pictures that rejoin writes"), std::string::npos) << set.notes[0];
}

TEST_F(Read, PipesAndFoldersWithNamesOfPicturesAreToldAndLeftOut) {
  cv::imwrite((folder_ / "a.png").string(), blot(30));
  std::filesystem::create_directory(folder_ / "folder.png");
  ASSERT_EQ(mkfifo((folder_ / "pipe.png").c_str(), 0600), 0);
  const PieceSet set = read_folder(folder_.string());
  EXPECT_EQ(set.pieces.size(), 1U);
  ASSERT_EQ(set.unusable.size(), 2U);
  EXPECT_EQ(set.unusable[0].name, "folder.png");
  EXPECT_EQ(set.unusable[1].name, "pipe.png");
  EXPECT_NE(set.unusable[1].reason.find("pipe.png: is a pipe or device; "), std::string::npos);
}

TEST_F(Read, FoldersOfPiecesAndRawPicturesAreTold) {
  cv::imwrite((folder_ / "a.png").string(), blot(30));
  write("b.NEF", "raw");
  std::filesystem::create_directory(folder_ / "more");
  std::filesystem::create_directory(folder_ / "notes");
  cv::imwrite((folder_ / "more" / "c.png").string(), blot(20));
  cv::imwrite((folder_ / "more" / "pieces.png").string(), blot(20));
  const PieceSet set = read_folder(folder_.string());
  EXPECT_EQ(set.pieces.size(), 1U);
  ASSERT_EQ(set.unusable.size(), 1U);
  EXPECT_EQ(set.unusable[0].name, "b.NEF");
  ASSERT_EQ(set.notes.size(), 1U);
  EXPECT_NE(set.notes[0].find("more: is a folder with 1 file"), std::string::npos) << set.notes[0];
}

/// A torn piece beside a ruler with rounded corners, a little askew, on black.
cv::Mat with_ruler() {
  cv::Mat picture(900, 1200, CV_8UC3, cv::Scalar(20, 20, 20));
  const cv::RotatedRect ruler(cv::Point2f(600, 750), cv::Size2f(900, 120), 2.0F);
  std::array<cv::Point2f, 4> corners;
  ruler.points(corners.data());
  std::vector<cv::Point> polygon(corners.begin(), corners.end());
  cv::fillConvexPoly(picture, polygon, cv::Scalar(240, 240, 240), cv::LINE_AA);
  std::vector<cv::Point> piece;  // nearly a rectangle, but torn
  for (int k = 0; k < 120; ++k) {
    const double at = k / 30.0;
    const int side = static_cast<int>(at);
    const double along = 400.0 * (at - side);
    const double rough = 6.0 * std::sin(9.7 * k) + 300.0;
    const std::array<cv::Point2d, 4> places{{{along, 300.0 - rough},
                                             {400.0 + rough - 300.0, along},
                                             {400.0 - along, rough + 100.0},
                                             {300.0 - rough, 400.0 - along}}};
    piece.emplace_back(300 + static_cast<int>(places[static_cast<std::size_t>(side)].x),
                       120 + static_cast<int>(places[static_cast<std::size_t>(side)].y));
  }
  cv::fillPoly(picture, std::vector<std::vector<cv::Point>>{piece}, cv::Scalar(120, 180, 210), cv::LINE_AA);
  return picture;
}

TEST_F(Read, RulersBesidePiecesAreLeftOutButNotAlone) {
  const cv::Mat picture = with_ruler();
  cv::imwrite((folder_ / "alone.png").string(), blot(60));
  cv::imwrite((folder_ / "both.png").string(), picture);
  const PieceSet set = read_folder(folder_.string());
  ASSERT_EQ(set.pieces.size(), 2U);
  EXPECT_EQ(set.pieces[1].name, "both.png");  // the larger
  ASSERT_EQ(set.left_out.size(), 1U);
  EXPECT_EQ(set.left_out[0].name, "both.png#2");
  ExtractOptions keeping;
  keeping.keep_rectangles = true;
  EXPECT_EQ(read_folder(folder_.string(), keeping).pieces.size(), 3U);
  cv::imwrite((folder_ / "both.png").string(), picture(cv::Rect(0, 600, 1200, 300)));
  EXPECT_EQ(read_folder(folder_.string()).pieces.size(), 2U);
}

// Two sides of every quarter were torn, by a few pixels, and two are the page's.
TEST_F(Read, TornQuartersOfAPageAreNoRulers) {
  cv::Mat page(1100, 1500, CV_8UC3, cv::Scalar(20, 20, 20));
  cv::rectangle(page, cv::Rect(60, 60, 1380, 980), cv::Scalar(240, 240, 240), cv::FILLED);
  for (int k = 0; k < 1500; ++k) {
    const int y = 550 + static_cast<int>(3.0 * std::sin(0.05 * k) + 2.0 * std::sin(0.31 * k));
    cv::line(page, {k, y - 8}, {k, y + 8}, cv::Scalar(20, 20, 20));
    const int x = 750 + static_cast<int>(3.0 * std::cos(0.06 * k) + 2.0 * std::cos(0.37 * k));
    if (k < 1100) cv::line(page, {x - 8, k}, {x + 8, k}, cv::Scalar(20, 20, 20));
  }
  cv::GaussianBlur(page, page, cv::Size(), 0.7);
  cv::imwrite((folder_ / "page.png").string(), page);
  cv::imwrite((folder_ / "another.png").string(), blot(60));
  cv::imwrite((folder_ / "third.png").string(), blot(50));
  EXPECT_EQ(read_folder(folder_.string()).pieces.size(), 6U);
}

TEST_F(Read, WhatWasCutOutOfAPieceStays) {
  cv::Mat picture(900, 1200, CV_8UC3, cv::Scalar(20, 20, 20));
  cv::circle(picture, {400, 450}, 350, cv::Scalar(240, 240, 240), cv::FILLED, cv::LINE_AA);
  cv::rectangle(picture, cv::Rect(300, 400, 200, 120), cv::Scalar(20, 20, 20), cv::FILLED);
  cv::rectangle(picture, cv::Rect(900, 400, 200, 120), cv::Scalar(240, 240, 240), cv::FILLED);
  cv::imwrite((folder_ / "page.png").string(), picture);
  EXPECT_EQ(read_folder(folder_.string()).pieces.size(), 2U);
}

TEST_F(Read, NamesThatAreNoUtf8AreToldAndLeftOut) {
  write("\xC3\xBC.csv", "0,0\n1,0\n1,1\n0,1\n");
  write("p\xFE.csv", "0,0\n2,0\n2,2\n0,2\n");
  write("p\xFF.csv", "0,0\n3,0\n3,3\n0,3\n");
  const PieceSet set = read_folder(folder_.string());
  ASSERT_EQ(set.pieces.size(), 1U);
  EXPECT_EQ(set.pieces[0].name, "\xC3\xBC.csv");
  ASSERT_EQ(set.unusable.size(), 2U);
  EXPECT_NE(set.unusable[0].reason.find("p\uFFFD.csv: has a name that is no UTF-8"), std::string::npos);
}

TEST_F(Read, FolderIsReadInTheOrderOfNames) {
  write("b.csv", "0,0\n1,0\n1,1\n0,1\n");
  write("a.csv", "0,0\n2,0\n2,2\n0,2\n");
  write("truth.json", "{}");
  write("notes.md", "nothing");
  const PieceSet set = read_folder(folder_.string());
  ASSERT_EQ(set.pieces.size(), 2U);
  EXPECT_EQ(set.pieces[0].name, "a.csv");
  EXPECT_EQ(set.pieces[1].name, "b.csv");
  EXPECT_THROW(read_folder((folder_ / "missing").string()), IoError);
  std::filesystem::create_directories(folder_ / "empty");
  EXPECT_THROW(read_folder((folder_ / "empty").string()), InputError);
  EXPECT_THROW(read_pieces((folder_ / "notes.md").string()), InputError);
}

}  // namespace
}  // namespace rejoin::outline
