#include "report/convergence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "report/canvas.hpp"

namespace rejoin::report {
namespace {

/// A small reader of XML without entities beyond the five: says what is wrong, or "".
std::string problem_in(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t k = 0; k < xml.size(); ++k) {
    if (xml[k] == '&') {
      const std::string name = xml.substr(k + 1, xml.find(';', k) - k - 1);
      if (name != "amp" && name != "lt" && name != "gt" && name != "quot" && name != "apos")
        return "entity &" + name;
    }
    if (xml[k] == '>') return "stray > at " + std::to_string(k);
    if (xml[k] != '<') continue;
    const std::size_t end = xml.find('>', k);
    if (end == std::string::npos) return "tag without end";
    const std::string tag = xml.substr(k + 1, end - k - 1);
    if (tag.find('<') != std::string::npos) return "stray < in " + tag;
    const std::string name = tag.substr(0, tag.find_first_of(" \n/", 1));
    if (tag[0] == '/') {
      if (open.empty() || "/" + open.back() != tag) return "closes " + tag;
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(name);
    }
    int quotes = 0;
    for (const char c : tag) quotes += c == '"' ? 1 : 0;
    if (quotes % 2 != 0) return "quotes in " + tag;
    k = end;
  }
  return open.empty() ? "" : "left open: " + open.back();
}

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

match::Result annealed(int chains) {
  match::Result result;
  result.evaluations = 900;
  for (int k = 0; k < chains; ++k) {
    result.convergence.push_back({{100, 0.5, 0.1}, {200, 0.3, 0.05}, {300, 0.3, 0.02}});
  }
  return result;
}

TEST(Convergence, TitleOfLongNamesStaysInThePicture) {
  const std::string name = std::string(100, 'n') + " and " + std::string(100, 'm') + ".ply";
  const std::string svg = convergence_svg(annealed(1), name);
  EXPECT_EQ(svg.find(name), std::string::npos);
  EXPECT_NE(svg.find(">Course of the search: nnnnnnnnnnnnnnn"), std::string::npos) << svg;
  EXPECT_NE(svg.find("nn...mm"), std::string::npos) << svg;
  EXPECT_NE(svg.find("mmmmmmmmmmmmmmmmmmmm.ply<"), std::string::npos) << svg;
  EXPECT_NE(convergence_svg(annealed(1), "a.ply and b.ply").find(": a.ply and b.ply<"), std::string::npos);
}

TEST(Convergence, DrawsEnergyAndTemperatureOfEachChain) {
  const std::string svg = convergence_svg(annealed(3), "a and b");
  EXPECT_EQ(problem_in(svg), "");
  EXPECT_EQ(count_of(svg, "<polyline"), 6U);
  EXPECT_NE(svg.find(">Course of the search: a and b<"), std::string::npos);
  EXPECT_EQ(count_of(svg, "stroke-dasharray"), 3U);
}

TEST(Convergence, WithoutChainsDrawsTheCandidatesScores) {
  match::Result result;
  result.candidates.resize(4);
  result.candidates[0].score = 0.9;
  const std::string svg = convergence_svg(result, "a and b");
  EXPECT_EQ(problem_in(svg), "");
  EXPECT_EQ(count_of(svg, "<rect"), 1U + 4U);
  EXPECT_EQ(count_of(svg, "<polyline"), 0U);
  EXPECT_NE(svg.find(">Scores of the poses found: a and b<"), std::string::npos);
}

TEST(Convergence, EmptyResultAndInfiniteEnergiesAreStillWellFormed) {
  EXPECT_EQ(problem_in(convergence_svg({}, "")), "");
  match::Result result = annealed(1);
  result.convergence[0][0].best = std::numeric_limits<double>::infinity();
  result.convergence.emplace_back();
  const std::string svg = convergence_svg(result, "x");
  EXPECT_EQ(problem_in(svg), "");
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Convergence, HostileNamesStayText) {
  const std::string name = "</text><script>alert(\"1\")</script>&'\x01\xFF\xC3\xA4";
  const std::string svg = convergence_svg(annealed(1), name);
  EXPECT_EQ(problem_in(svg), "");
  EXPECT_EQ(svg.find("<script"), std::string::npos);
  EXPECT_EQ(escaped("a<b>&\"'"), "a&lt;b&gt;&amp;&quot;&apos;");
  EXPECT_EQ(escaped("\x01\xFF\xC3\xA4\xC3"), "??\xC3\xA4?");
}

TEST(Canvas, TicksAreRoundAndInside) {
  EXPECT_EQ(ticks(-0.5, 0.5, 5), (std::vector<double>{-0.4, -0.2, 0, 0.2, 0.4}));
  EXPECT_DOUBLE_EQ(round_up(0.021), 0.05);
  EXPECT_DOUBLE_EQ(round_up(0.02), 0.02);
  EXPECT_EQ(short_number(0.0123456), "0.0123");
  EXPECT_EQ(short_number(1200), "1200");
  EXPECT_EQ(short_number(-2.5), "-2.5");
}

TEST(Canvas, LongNamesAreCutToFit) {
  const TextStyle style{16};
  const std::string name(400, 'w');
  const std::string shorter = fitted(name, style, 300);
  EXPECT_LE(text_width(shorter, style), 300);
  EXPECT_NE(shorter.find("..."), std::string::npos);
  EXPECT_EQ(fitted("short", style, 300), "short");
}

TEST(Canvas, AccentsAreLeftOutAndOtherScriptsMarked) {
  const auto shown = [](const std::string& text) { return fitted(text, {16}, 1e4); };
  EXPECT_EQ(shown("Schale Gr\xC3\xB6\xC3\x9F"
                  "e 1.ply"),
            "Schale Grosse 1.ply");
  EXPECT_EQ(shown("Gro\xCC\x88sse"), "Grosse");  // the letter and its accent, as one system writes file names
  EXPECT_EQ(shown("\xC3\x80\xC3\x86\xC3\xBF \xC4\x80\xC4\xB2\xC5\x81\xC5\xBE\xC5\xBF"), "AAEy AIJLzs");
  EXPECT_EQ(shown("\xE6\xBC\xA2\xC4"), "[6f22]?");
  EXPECT_EQ(shown("a\xFFz\x01"), "a?z?");
}

TEST(Canvas, TextLeavesInkWhereItIsAskedTo) {
  Image image(120, 40, Colour(255, 255, 255));
  draw_text(image, 10, 30, "H\xC3\xA4nde \xE6\xBC\xA2", {16, Colour(0, 0, 0)});
  int ink = 0;
  for (const Colour& pixel : image.pixels) ink += pixel.r < 128 ? 1 : 0;
  EXPECT_GT(ink, 60);
  EXPECT_EQ(image.at(119, 39), Colour(255, 255, 255));
}

}  // namespace
}  // namespace rejoin::report
