/// SVG drawings, read as pieces.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "read_files.hpp"

namespace rejoin::outline {
namespace {

using testing::only_area;

class Svg : public testing::ReadFiles {};

TEST_F(Svg, ShapesWithTransformsAndHoles) {
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
TEST_F(Svg, CurvesAreFlattened) {
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

TEST_F(Svg, ShapesThatAreNotSeenAreLeftOut) {
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
  expect_shape("inherited", "<g visibility='inherit'>" + shape + "</g>", "");
  expect_shape("important", shape + "<g style='display: none !important'>" + big + "</g>",
               "1 shape left out as hidden");
  expect_shape("invisible", "<g visibility='hidden'>" + big + "<g visibility='visible'>" + shape + "</g></g>",
               "1 shape left out as hidden");
  expect_shape("transparent", shape + "<g opacity='0'>" + big + "</g><g style='opacity: 0%'>" + big + "</g>",
               "2 shapes left out as hidden");
  expect_shape("faint", "<g opacity='.01'>" + shape + "</g>", "");
  for (const char* kind : {"defs", "symbol", "clipPath", "mask", "marker", "pattern"})
    expect_shape(kind, shape + "<" + kind + ">" + big + "</" + kind + ">", "");
  expect_shape("page", "<rect width='60' height='60'/>" + shape, "covers the page");
  expect_shape("percent", "<rect width='100%' height='100%'/>" + shape, "covers the page");
  expect_shape("beyond", "<path d='M-5-5H99V99H-5z'/>" + shape, "covers the page");
  expect_shape("twice", shape + shape, "1 shape drawn twice");
}

TEST_F(Svg, DrawingOfARectangleTheSizeOfItsPageIsKept) {
  EXPECT_DOUBLE_EQ(
      only_area(read_pieces(write("a.svg", "<svg viewBox='0 0 6 6'><rect width='6' height='6'/></svg>"))),
      36.0);
}

TEST_F(Svg, LengthsHaveUnitsAndCornersMayBeRound) {
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

TEST_F(Svg, DrawingsInDrawingsAndTransformsOfStylesAreApplied) {
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

TEST_F(Svg, CopiesStandWhereTheyAreShown) {
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

/// A drawing that defines a group of 10 by 10 squares, 10 apart.
std::string with_hundred_squares(const std::string& content) {
  std::string squares;
  for (int k = 0; k < 100; ++k)
    squares += fmt::format("<rect x='{}' y='{}' width='5' height='5'/>", 10 * (k % 10), 10 * (k / 10));
  return "<svg viewBox='0 0 100000 100000'><defs><g id='g'>" + squares + "</g></defs>" + content + "</svg>";
}

TEST_F(Svg, CopiesAreCountedByWhatTheyDraw) {
  std::string copies;
  for (int k = 0; k < 2000; ++k)
    copies += fmt::format("<use href='#g' x='{}' y='{}'/>", 100 * (k % 50), k / 50 * 100);
  expect_refusal("a.svg", with_hundred_squares(copies), "has more than 20000 copies of elements");
}

TEST_F(Svg, ShapesThatAreDrawnTwiceButForRoundingCountOnce) {
  std::string copies;
  for (int k = 0; k < 18; ++k)
    copies += fmt::format("<use href='#g' x='{0}' y='7000'/><use href='#g' x='{0}.0000000001' y='7000'/>",
                          100 * k / 2);
  const PieceSet set = read_pieces(write("a.svg", with_hundred_squares(copies)));
  EXPECT_EQ(set.pieces.size(), 950U);
  ASSERT_EQ(set.notes.size(), 1U);
  EXPECT_NE(set.notes[0].find("2650 shapes drawn twice; each counts once"), std::string::npos)
      << set.notes[0];
}

TEST_F(Svg, StyleSheetsHideAndMove) {
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

TEST_F(Svg, ShapesThatShareABorderLieSideBySide) {
  // The second begins on the border that it has in common with the first.
  const PieceSet set = read_pieces(
      write("a.svg", "<svg><path d='M0 0H10V10H0z'/><polygon points='0,5 0,10 -8,10 -8,0 0,0'/></svg>"));
  EXPECT_EQ(boxes_of(set), (std::vector<std::string>{"0,0,10,10", "-8,0,8,10"}));
  EXPECT_TRUE(set.pieces[0].outline.holes.empty());
}

TEST_F(Svg, HoleAndTheShapeThatFillsItAreBothRead) {
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

TEST_F(Svg, ShapesTakenForHolesOfOthersAreTold) {
  const std::string notes = "<rect width='9' height='9'/><rect x='2' y='2' width='4' height='4'/>";
  const PieceSet set = read_pieces(write("a.svg", "<svg>" + notes + "</svg>"));
  ASSERT_EQ(set.pieces.size(), 1U);
  EXPECT_EQ(set.pieces[0].outline.holes.size(), 1U);
  ASSERT_EQ(set.notes.size(), 1U);
  EXPECT_NE(set.notes[0].find("1 shape drawn inside another is taken for a hole in it"), std::string::npos);
}

TEST_F(Svg, TellsWhatItDoesNotRead) {
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

TEST_F(Svg, DrawingsOfDifferentUnitsAreDoubted) {
  const auto write_drawing = [&](const char* name, const char* size, int corner) {
    write(name, fmt::format("<svg {}><polygon points='0,0 5,0 5,{} 0,5'/></svg>", size, corner));
  };
  write_drawing("a.svg", "width='50mm' viewBox='0 0 50 50'", 5);
  write_drawing("b.svg", "width='2in' viewBox='0 0 50.8 50'", 6);
  write_drawing("c.svg", "width='70' viewBox='0 0 500 500'", 7);
  EXPECT_TRUE(read_folder(folder_.string()).notes.empty());
  write_drawing("e.svg", "width='100vw' viewBox='0 0 50 50'", 9);
  EXPECT_EQ(read_folder(folder_.string()).pieces.size(), 4U);
  write_drawing("d.svg", "width='50mm'", 8);
  ASSERT_EQ(read_folder(folder_.string()).notes.size(), 1U);
  EXPECT_NE(read_folder(folder_.string()).notes[0].find("d.svg says that it has 96 dots or units an inch, "),
            std::string::npos);
}

TEST_F(Svg, BrokenFileIsRefused) {
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

}  // namespace
}  // namespace rejoin::outline
