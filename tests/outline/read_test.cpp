#include "outline/read.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fmt/core.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.hpp"
#include "core/files.hpp"

namespace rejoin::outline {
namespace {

class Read : public ::testing::Test {
 protected:
  Read() {
    folder_ = std::filesystem::temp_directory_path() / ("rejoin-read-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~Read() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    const std::string path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }

  void expect_refusal(const std::string& name, const std::string& text, const std::string& reason) const {
    const std::string path = write(name, text);
    try {
      read_pieces(path);
      FAIL() << name;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find(path), 0U) << error.what();
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  }

  std::filesystem::path folder_;
};

double only_area(const PieceSet& set) {
  EXPECT_EQ(set.pieces.size(), 1U);
  return set.pieces.empty() ? 0.0 : signed_area(set.pieces[0].outline.points);
}

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

TEST_F(Read, SvgShapesWithTransformsAndHoles) {
  const std::string svg =
      "<?xml version='1.0'?><svg xmlns='http://www.w3.org/2000/svg'><g transform='translate(100 50) "
      "scale(2)'>"
      "<path d='M0 0h10v10h-10z m2,2 0 4 4 0 0-4z'/></g><polygon points='0,0 5,0 5,5 0,5'/><defs><rect "
      "width='9' "
      "height='9'/></defs></svg>";
  const PieceSet set = read_pieces(write("a.svg", svg));
  ASSERT_EQ(set.pieces.size(), 2U);
  EXPECT_DOUBLE_EQ(signed_area(set.pieces[0].outline.points), 400.0);
  ASSERT_EQ(set.pieces[0].outline.holes.size(), 1U);
  EXPECT_DOUBLE_EQ(signed_area(set.pieces[0].outline.holes[0]), -64.0);
  EXPECT_DOUBLE_EQ(signed_area(set.pieces[1].outline.points), 25.0);
  EXPECT_EQ(set.pieces[1].name, "a.svg#2");
}

// A circle from two half arcs and one from four cubic quarters.
TEST_F(Read, SvgCurvesAreFlattened) {
  const double circle = M_PI * 100.0;
  EXPECT_NEAR(only_area(read_pieces(
                  write("arc.svg", "<svg><path d='M-10 0A10 10 0 0110 0 10 10 0 01-10 0Z'/></svg>"))),
              circle, 0.01 * circle);
  EXPECT_NEAR(only_area(read_pieces(
                  write("cubic.svg",
                        "<svg><path d='M10,0 C10,5.523 5.523,10 0,10 S-10,5.523 -10,0 -5.523,-10 0,-10 "
                        "10-5.523 10 0'/></svg>"))),
              circle, 0.01 * circle);
  EXPECT_NEAR(only_area(read_pieces(write("quad.svg", "<svg><path d='M0 0Q10 20 20 0Z'/></svg>"))),
              400.0 / 3.0, 1.0);
}

TEST_F(Read, SvgShapesThatAreNotSeenAreLeftOut) {
  const std::string shape = "<polygon points='0,0 5,0 5,5 0,5'/>";
  const std::string big = "<rect x='10' width='20' height='20'/>";
  const auto expect_shape = [&](const std::string& name, const std::string& content,
                                const std::string& note) {
    SCOPED_TRACE(name);
    const PieceSet set = read_pieces(write(name + ".svg", "<svg viewBox='0 0 60 60'>" + content + "</svg>"));
    EXPECT_DOUBLE_EQ(only_area(set), 25.0);
    EXPECT_TRUE(set.pieces[0].outline.holes.empty());
    ASSERT_EQ(set.notes.size(), note.empty() ? 0U : 1U);
    if (!note.empty()) {
      EXPECT_NE(set.notes[0].find(note), std::string::npos) << set.notes[0];
    }
  };
  expect_shape("layer", shape + "<g style='fill:none; display: none'><g display='inline'>" + big + "</g></g>",
               "1 shape left out as hidden");
  expect_shape("invisible", "<g visibility='hidden'>" + big + "<g visibility='visible'>" + shape + "</g></g>",
               "1 shape left out as hidden");
  for (const char* kind : {"defs", "symbol", "clipPath", "mask", "marker", "pattern"})
    expect_shape(kind, shape + "<" + kind + ">" + big + "</" + kind + ">", "");
  expect_shape("page", "<rect width='60' height='60'/>" + shape, "covers the page");
  expect_shape("percent", "<rect width='100%' height='100%'/>" + shape, "covers the page");
  expect_shape("beyond", "<path d='M-5-5H99V99H-5z'/>" + shape, "covers the page");
  expect_shape("twice", shape + shape, "1 shape drawn twice");
}

TEST_F(Read, SvgDrawingOfARectangleTheSizeOfItsPageIsKept) {
  EXPECT_DOUBLE_EQ(
      only_area(read_pieces(write("a.svg", "<svg viewBox='0 0 6 6'><rect width='6' height='6'/></svg>"))),
      36.0);
}

TEST_F(Read, SvgLengthsHaveUnitsAndCornersMayBeRound) {
  const auto area = [&](const std::string& content) {
    return only_area(read_pieces(write("a.svg", "<svg viewBox='0 0 200 400'>" + content + "</svg>")));
  };
  EXPECT_NEAR(area("<rect width='1in' height='25.4mm'/>"), 96.0 * 96.0, 1e-6);
  EXPECT_NEAR(area("<rect width='50%' height='10%'/>"), 100.0 * 40.0, 1e-6);
  EXPECT_NEAR(area("<circle cx='9' cy='9' r='10'/>"), M_PI * 100.0, 1.0);
  EXPECT_NEAR(area("<ellipse cx='9' cy='9' rx='10' ry='20'/>"), M_PI * 200.0, 2.0);
  EXPECT_NEAR(area("<rect width='100' height='50' rx='10'/>"), 5000.0 - (4.0 - M_PI) * 100.0, 2.0);
  EXPECT_NEAR(area("<rect width='100' height='50' rx='900' ry='900'/>"), M_PI * 50.0 * 25.0, 8.0);
  expect_refusal("b.svg", "<svg><rect width='3em' height='4'/></svg>", "width=\"3em\" is no length");
}

TEST_F(Read, SvgDrawingsInDrawingsAndTransformsOfStylesAreApplied) {
  const std::string shape = "<polygon points='0,0 5,0 5,5 0,5'/>";
  const auto first = [&](const std::string& content) {
    const PieceSet set = read_pieces(write("a.svg", "<svg viewBox='0 0 60 60'>" + content + "</svg>"));
    EXPECT_TRUE(set.notes.empty());
    return std::pair(set.pieces[0].outline.points[0], signed_area(set.pieces[0].outline.points));
  };
  EXPECT_EQ(first("<svg x='3' y='4'>" + shape + "</svg>"), std::pair(glm::dvec2(3, 4), 25.0));
  // Twice as large, and 10 units beside it because the place is wider than the box.
  EXPECT_EQ(first("<svg x='1' width='40' height='20' viewBox='0 0 10 10'>" + shape + "</svg>"),
            std::pair(glm::dvec2(11, 0), 100.0));
  EXPECT_EQ(
      first("<g transform='scale(9)' style='transform: translate(2px, 3px) scale(2)'>" + shape + "</g>"),
      std::pair(glm::dvec2(2, 3), 100.0));
}

/// "low x, low y, width, height" of each piece's box, largest area first.
std::vector<std::string> boxes_of(const PieceSet& set) {
  std::vector<std::string> boxes;
  for (const Piece& piece : set.pieces) {
    glm::dvec2 low = piece.outline.points[0];
    glm::dvec2 high = low;
    for (const glm::dvec2& p : piece.outline.points) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    boxes.push_back(fmt::format("{:.6g},{:.6g},{:.6g},{:.6g}", low.x, low.y, high.x - low.x, high.y - low.y));
  }
  return boxes;
}

TEST_F(Read, SvgCopiesStandWhereTheyAreShown) {
  using Boxes = std::vector<std::string>;
  const auto boxes = [&](const std::string& content) {
    return boxes_of(read_pieces(
        write("a.svg",
              "<svg xmlns:xlink='x' viewBox='0 0 1000 1000'><defs><rect id='r' x='1' width='6' height='4'/>"
              "<g id='g'><rect width='5' height='3'/><circle cx='50' r='1'/></g></defs>" +
                  content + "</svg>")));
  };
  EXPECT_EQ(boxes("<use href='#r'/>"), Boxes{"1,0,6,4"});
  EXPECT_EQ(boxes("<use xlink:href='#r' x='10' y='20' transform='scale(2)'/>"), Boxes{"22,40,12,8"});
  EXPECT_EQ(boxes("<g transform='translate(100)'><use href='#g' y='7'/></g>"),
            (Boxes{"100,7,5,3", "149,6,2,2"}));
  EXPECT_EQ(boxes("<use id='u' href='#r' x='10'/><use href='#u' y='9'/>"), (Boxes{"11,0,6,4", "11,9,6,4"}));
  EXPECT_EQ(boxes("<use href='#r'/><g display='none'><use href='#r' x='50'/></g>"), Boxes{"1,0,6,4"});
  const std::string symbol = "<symbol id='s' viewBox='0 0 10 10'><rect width='10' height='5'/></symbol>";
  EXPECT_EQ(boxes(symbol + "<use href='#s' x='30' y='40' width='20' height='20'/>"), Boxes{"30,40,20,10"});
  EXPECT_EQ(boxes("<symbol id='s'><rect width='10' height='5'/></symbol><use href='#s' x='30'/>"),
            Boxes{"30,0,10,5"});
}

TEST_F(Read, SvgStyleSheetsHideAndMove) {
  using Boxes = std::vector<std::string>;
  const auto boxes = [&](const std::string& sheet, const std::string& content) {
    return boxes_of(read_pieces(write("a.svg", "<svg viewBox='0 0 1000 1000'>" + content +
                                                   "<rect id='other' width='2' height='1'/><style>" + sheet +
                                                   "</style></svg>")));
  };
  const std::string shape = "<rect class='a b' id='c' x='10' width='5' height='5'/>";
  const Boxes both{"10,0,5,5", "0,0,2,1"};
  const Boxes other{"0,0,2,1"};
  EXPECT_EQ(boxes(".d { display: none } #cc{display:none} circle{display:none}", shape), both);
  EXPECT_EQ(boxes("/* .x { */ .b\n{ fill: none; display :none; }", shape), other);
  EXPECT_EQ(boxes("<![CDATA[#c,#d{visibility:hidden}]]>", shape), other);
  EXPECT_EQ(boxes("rect.a.b#c { display: none }", shape), other);
  EXPECT_EQ(boxes(".a { transform: translate(7px, 1px) }", shape), (Boxes{"17,1,5,5", "0,0,2,1"}));
  // The more special selector counts, then the later one, then what is important; the element's own style is before the sheet.
  EXPECT_EQ(boxes("#c { display: inline } .a { display: none }", shape), both);
  EXPECT_EQ(boxes(".b { display: none } .a { display: inline }", shape), both);
  EXPECT_EQ(boxes(".a { display: none !important } #c { display: inline }", shape), other);
  const std::string styled = "<rect class='a' style='display:inline' x='10' width='5' height='5'/>";
  EXPECT_EQ(boxes(".a { display: none }", styled), both);
  const std::string attribute = "<rect class='a' display='inline' x='10' width='5' height='5'/>";
  EXPECT_EQ(boxes("@import url(x); .a { display: none }", attribute), other);
  EXPECT_EQ(boxes(".hidden * { fill: red } .a { display: none }", "<g class='a'>" + shape + "</g>"), other);
}

TEST_F(Read, SvgShapesThatShareABorderLieSideBySide) {
  // The second begins on the border that it has in common with the first.
  const PieceSet set = read_pieces(
      write("a.svg", "<svg><path d='M0 0H10V10H0z'/><polygon points='0,5 0,10 -8,10 -8,0 0,0'/></svg>"));
  EXPECT_EQ(boxes_of(set), (std::vector<std::string>{"0,0,10,10", "-8,0,8,10"}));
  EXPECT_TRUE(set.pieces[0].outline.holes.empty());
}

TEST_F(Read, SvgHoleAndTheShapeThatFillsItAreBothRead) {
  const std::string holed = "<path d='M0 0H100V100H0z M40 40V60H60V40z'/>";
  for (const char* filling : {"40,40 40,60 60,60 60,40", "60,40 60,60 40,60 40,40"}) {
    const std::string plug = fmt::format("<polygon points='{}'/>", filling);
    for (const std::string& content : {holed + plug, plug + holed, holed + plug + holed + plug}) {
      const PieceSet set = read_pieces(write("a.svg", "<svg>" + content + "</svg>"));
      ASSERT_EQ(boxes_of(set), (std::vector<std::string>{"0,0,100,100", "40,40,20,20"})) << content;
      ASSERT_EQ(set.pieces[0].outline.holes.size(), 1U);
      EXPECT_DOUBLE_EQ(signed_area(set.pieces[0].outline.holes[0]), -400.0);
    }
  }
}

TEST_F(Read, SvgShapesTakenForHolesOfOthersAreTold) {
  const std::string notes = "<rect width='9' height='9'/><rect x='2' y='2' width='4' height='4'/>";
  const PieceSet set = read_pieces(write("a.svg", "<svg>" + notes + "</svg>"));
  ASSERT_EQ(set.pieces.size(), 1U);
  EXPECT_EQ(set.pieces[0].outline.holes.size(), 1U);
  ASSERT_EQ(set.notes.size(), 1U);
  EXPECT_NE(set.notes[0].find("1 shape drawn inside another is taken for a hole in it"), std::string::npos);
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

TEST_F(Read, SvgTellsWhatItDoesNotRead) {
  const std::string shape = "<polygon points='0,0 5,0 5,5 0,5'/>";
  const auto note = [&](const std::string& content) {
    const PieceSet set = read_pieces(write("a.svg", "<svg>" + shape + content + "</svg>"));
    return set.notes.size() == 1 ? set.notes[0] : std::to_string(set.notes.size());
  };
  EXPECT_NE(note("<use href='#b'/><use href='other.svg#a'/>").find("(<use>)"), std::string::npos);
  EXPECT_NE(note("<style>g > .a { display: none }</style>").find("style sheet"), std::string::npos);
  EXPECT_NE(note("<style>@media print { .a { display: none } }</style>").find("style sheet"),
            std::string::npos);
  EXPECT_EQ(note("<style>g > .a { fill: none }</style>"), "0");
  EXPECT_NE(note("<g clip-path='url(#a)'/>").find("clip path"), std::string::npos);
  EXPECT_NE(note("<g transform-origin='center'/>").find("transform-origin"), std::string::npos);
  EXPECT_EQ(note("<style>.a { fill: none }</style>"), "0");
}

TEST_F(Read, SvgDrawingsOfDifferentUnitsAreDoubted) {
  const auto write_drawing = [&](const char* name, const char* size, int corner) {
    write(name, fmt::format("<svg {}><polygon points='0,0 5,0 5,{} 0,5'/></svg>", size, corner));
  };
  write_drawing("a.svg", "width='50mm' viewBox='0 0 50 50'", 5);
  write_drawing("b.svg", "width='2in' viewBox='0 0 50.8 50'", 6);
  write_drawing("c.svg", "width='70' viewBox='0 0 500 500'", 7);
  EXPECT_TRUE(read_folder(folder_.string()).notes.empty());
  write_drawing("d.svg", "width='50mm'", 8);
  ASSERT_EQ(read_folder(folder_.string()).notes.size(), 1U);
  EXPECT_NE(read_folder(folder_.string()).notes[0].find("d.svg says that it has 96 dots or units an inch, "),
            std::string::npos);
}

TEST_F(Read, BrokenSvgIsRefused) {
  expect_refusal("a.svg", "<svg><path d='M0 0 L", "no SVG");
  expect_refusal("b.svg", "<svg><path d='M0 0 L 1 x'/></svg>", "path data");
  expect_refusal("c.svg", "<svg></svg>", "no closed shape");
  expect_refusal("d.svg", "<svg><defs><rect id='a' width='4' height='4'/></defs><use href='#b'/></svg>",
                 "holds no closed shape; a copy (<use>)");
  expect_refusal("f.svg", "<svg><g id='a'><rect width='4' height='4'/><use href='#a' x='9'/></g></svg>",
                 "too deep");
  expect_refusal("e.svg", "<svg><rect style='display:none' width='4' height='4'/></svg>",
                 "that is not hidden");
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
