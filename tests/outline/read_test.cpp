#include "outline/read.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <fmt/core.h>

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

TEST_F(Read, FeaturesOfGeoJsonKeepTheirNames) {
  const auto feature = [](const std::string& head, double side) {
    return fmt::format(
        R"({{"type":"Feature",{0}"geometry":{{"type":"Polygon","coordinates":[[[0,0],[{1},0],[{1},{1}],[0,{1}]]]}}}})",
        head, side);
  };
  const std::string text = fmt::format(R"({{"type":"FeatureCollection","features":[{},{},{}]}})",
                                       feature(R"("id":7,"properties":{"NAME":"Small"},)", 1.0),
                                       feature(R"("id":7,"properties":null,)", 2.0),
                                       R"({"type":"Polygon","coordinates":[[[0,0],[3,0],[3,3],[0,3]]]})");
  const PieceSet set = read_pieces(write("a.geojson", text));
  ASSERT_EQ(set.pieces.size(), 3U);
  EXPECT_EQ(set.pieces[0].outline.label, "") << "it is not the one before it";
  EXPECT_EQ(set.pieces[1].outline.label, "7");
  EXPECT_EQ(set.pieces[2].outline.label, "Small");
}

TEST_F(Read, PicturesOfOtherKindsAreToldAsSuch) {
  expect_refusal("a.webp", "RIFF", "kind that is not read");
  expect_refusal("a.bmp", "BM", "save it as png");
  expect_refusal("a.xyz", "1 2 3", "neither a picture");
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

TEST_F(Read, AsksWhetherGeoJsonWithoutACrsIsInDegreesWherePiecesAreSmall) {
  const auto notes = [&](const char* polygons, const char* crs = "") {
    return read_pieces(write("a.geojson", std::string("{") + crs +
                                              R"("type":"MultiPolygon","coordinates":[)" + polygons + "]}"))
        .notes;
  };
  const char* field = "[[[9.1,60.2],[9.2,60.2],[9.2,60.3],[9.1,60.25]]]";
  ASSERT_EQ(notes(field).size(), 1U);
  EXPECT_NE(
      notes(field)[0].find("a.geojson: if its coordinates are degrees, as without a \"crs\", they are no "
                           "lengths (at a latitude of 60 one of longitude is 0.50 times"),
      std::string::npos)
      << notes(field)[0];
  EXPECT_EQ(notes("[[[9.1,60.2],[9.2,60.2],[9.2,60.3],[9.1,60.25]]],[[[29.1,60.2],[29.2,60.2],[29.2,60.3],["
                  "29.1,60.25]]]")
                .size(),
            1U)
      << "far apart";
  EXPECT_TRUE(notes(field, R"("crs":{"type":"name","properties":{"name":"EPSG:3857"}},)").empty());
  EXPECT_TRUE(notes("[[[9.1,60.2],[49.2,60.2],[49.2,85.3],[9.1,85.25]]]").empty()) << "as of millimetres";
  EXPECT_TRUE(notes("[[[9.1,0.2],[9.2,0.2],[9.2,0.3],[9.1,0.25]]]").empty()) << "at the equator";
  EXPECT_TRUE(notes("[[[9.1,95.2],[9.2,95.2],[9.2,95.3],[9.1,95.25]]]").empty()) << "no latitude";
  EXPECT_TRUE(notes("[[[190.1,60.2],[190.2,60.2],[190.2,60.3],[190.1,60.25]]]").empty()) << "no longitude";
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

TEST_F(Read, CsvBetweenSemicolonsMayHaveCommasInQuotedWords) {
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write("a.csv",
                                               "note;x;y\n\"corner, 1\";0,5;0\n\"corner, 2\";10,5;0\n"
                                               "\"corner, 3\";10,5;8\n\"corner, 4\";0,5;8\n"))),
                   80.0);
}

TEST_F(Read, CsvOfRowsAndColumnsIsThatOfAPicture) {
  const PieceSet set = read_pieces(write("a.csv", "row,col\n0,0\n0,4\n1,4\n3,0\n"));
  const auto& points = set.pieces.at(0).outline.points;
  EXPECT_FALSE(set.pieces[0].y_up);
  EXPECT_NE(std::ranges::find(points, glm::dvec2(4, 1)), points.end()) << "columns go right, rows down";
}

TEST_F(Read, CsvWithBlanksOrTabsMayHaveDecimalCommas) {
  EXPECT_DOUBLE_EQ(
      only_area(read_pieces(write("a.txt", "0,5\t0,5\r\n10,5\t0,5\r\n10,5\t10,5\r\n0,5\t10,5\r\n"))), 100.0);
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write("b.txt", "0 0\n2,5 0\n2,5 2,5\n0 2,5\n"))), 6.25);
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write(
                       "id.txt", "id\tx\ty\n1\t0,5\t0,5\n2\t10,5\t0,5\n3\t10,5\t10,5\n4\t0,5\t10,5\n"))),
                   100.0);
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write(
                       "z.txt", "x\ty\tz\n0,5\t0,5\t1,5\n10,5\t0,5\t1,5\n10,5\t8,5\t1,5\n0,5\t8,5\t1,5\n"))),
                   80.0);
  EXPECT_DOUBLE_EQ(only_area(read_pieces(write("told.csv", "# 1,5 2,5\n0,0\n4,0\n4,2\n0,2\n"))), 8.0);
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

TEST_F(Read, WktInACsvIsNamed) {
  expect_refusal("a.csv", "id;wkt\n1;\"POLYGON ((0 0, 1 0, 1 1, 0 0))\"\n", "line 2 holds WKT");
  expect_refusal("b.csv", "WKT\n\"POLYGON ((0 0, 1 0, 1 1, 0 0))\"\n", "line 2 holds WKT");
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

TEST_F(Read, CsvMayNameThePieceOfEachPoint) {
  const PieceSet set = read_pieces(write("sheet.csv",
                                         "piece,x,y\nrim,0,0\nrim,9,0\nrim,9,7\nrim,0,7\nrim,0,0\n"
                                         "foot,20,0\nfoot,26,0\nfoot,26,5\nfoot,20,5\nfoot,20,0\n"));
  ASSERT_EQ(set.pieces.size(), 2U);
  EXPECT_NEAR(signed_area(set.pieces[0].outline.points), 63.0, 1e-9);
  EXPECT_NEAR(signed_area(set.pieces[1].outline.points), 30.0, 1e-9);
  EXPECT_EQ(set.pieces[0].outline.label, "rim");
  EXPECT_EQ(set.pieces[1].outline.label, "foot");
  ASSERT_EQ(set.notes.size(), 1U);
  EXPECT_NE(set.notes[0].find("a column of names parts 2 outlines"), std::string::npos) << set.notes[0];
}

TEST_F(Read, ColumnThatNamesEveryPointPartsNothing) {
  const PieceSet set = read_pieces(write("a.csv", "id,x,y\n1,0,0\n2,9,0\n3,9,7\n4,0,8\n"));
  EXPECT_EQ(set.pieces.at(0).outline.points.size(), 4U);
  EXPECT_EQ(set.pieces[0].outline.label, "");
}

TEST_F(Read, BlankLinesPartOutlinesOfFewPointsThatEndWhereTheyBegin) {
  const std::string square = "0,0\n4,0\n4,4\n0,4\n0,0\n";
  const std::string other = "10,0\n19,0\n19,9\n10,9\n10,0\n";
  const PieceSet set = read_pieces(write("a.csv", "x,y\n" + square + "\n" + other));
  ASSERT_EQ(set.pieces.size(), 2U);
  EXPECT_EQ(signed_area(set.pieces[0].outline.points), 81.0);
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

}  // namespace
}  // namespace rejoin::outline
