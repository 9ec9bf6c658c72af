#include "report/match_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/colour_scale.hpp"
#include "report/joint_panels.hpp"
#include "report/section.hpp"
#include "report/views.hpp"

namespace rejoin::report {
namespace {

constexpr int kWidth = 2000;
constexpr int kHeight = 1300;
constexpr int kMargin = 20;
constexpr int kGutter = 14;
constexpr int kUpper = 104;  ///< top of the first row
constexpr int kUpperHeight = 540;
constexpr int kLower = kUpper + kUpperHeight + kGutter;
constexpr int kLowerHeight = kHeight - kLower - kMargin;
constexpr int kCaption = 34;  ///< at the top of each panel

void frame(Image& sheet, const Area& area, const std::string& caption) {
  outline(sheet, area, {214, 216, 220});
  draw_text(sheet, area.x + 12, area.y + 23, caption, {13, kInk, Align::Left, true});
}

/// The area below a panel's caption.
Area inside(const Area& area) {
  return {area.x + 1, area.y + kCaption, area.width - 2, area.height - kCaption - 1};
}

void put(Image& sheet, const Area& area, const std::string& caption, const Image& picture) {
  const Area inner = inside(area);
  paste(sheet, picture, inner.x, inner.y);
  frame(sheet, area, caption);
}

void draw_upper_row(Image& sheet, const Joint& joint) {
  const std::vector<Body> joined = joined_bodies(joint);
  const Scene scene(joined);
  const JointViews views = choose_views(joint, scene);
  const Area apart{kMargin, kUpper, 680, kUpperHeight};
  put(sheet, apart, "Apart: A left, B right, broken faces turned to the eye",
      apart_panel(joint, views, {inside(apart).width, inside(apart).height}));
  struct View {
    const char* caption;
    glm::dvec3 back;
    Area area;
  };
  const int left = apart.x + apart.width + kGutter;
  const int right = left + 650 + kGutter;
  const int width = kWidth - kMargin - right;
  const int half = (kUpperHeight - kGutter) / 2;
  const std::array<View, 3> shown{
      {{"Joined", views.best, {left, kUpper, 650, kUpperHeight}},
       {"Joined: across the seam", views.across, {right, kUpper, width, half}},
       {"Joined: along the seam", views.along, {right, kUpper + half + kGutter, width, half}}}};
  for (const View& view : shown) {
    const Area inner = inside(view.area);
    put(sheet, view.area, view.caption,
        shaded_panel(scene, joined, {view.back, up_for(joint, view.back)}, {inner.width, inner.height}));
  }
}

/// Both broken faces face on, opened like a book: what touches lies mirrored about the fold.
void draw_gap_views(Image& sheet, const Joint& joint, const Area& area) {
  const Area inner = inside(area);
  const Book book = open_book(joint, inner.width, inner.height);
  put(sheet, area, "Broken faces by gap, opened like a book", book_panel(joint, book));
  for (const auto& [page, name] : {std::pair{book.a, "A"}, std::pair{book.b, "B"}}) {
    draw_text(sheet, inner.x + page.x + 12, inner.y + page.y + 22, name, {14, kInk, Align::Left, true});
  }
}

/// Share of the contact's vertices with the strongest colours, percent.
double darkest(const Joint& joint) {
  double beyond = 0;
  double total = 0;
  for (const auto* gaps : {&joint.gap_a, &joint.gap_b}) {
    for (const float gap : *gaps) {
      if (std::isnan(gap)) continue;
      total += 1;
      beyond += std::abs(gap) >= joint.scale ? 1 : 0;
    }
  }
  return 100.0 * beyond / std::max(1.0, total);
}

/// Share of the contact's vertices in each of `count` equal classes from -scale to scale; larger gaps count
/// in the last.
std::vector<double> histogram(const Joint& joint, int count) {
  std::vector<double> result(count, 0.0);
  double total = 0;
  for (const auto* gaps : {&joint.gap_a, &joint.gap_b}) {
    for (const float gap : *gaps) {
      if (std::isnan(gap)) continue;
      const auto at = static_cast<int>(std::floor((gap / joint.scale + 1) / 2 * count));
      result[std::clamp(at, 0, count - 1)] += 1;
      total += 1;
    }
  }
  for (double& share : result) share /= std::max(1.0, total);
  return result;
}

void draw_gap_legend(Image& sheet, const Joint& joint, double gap_median, const Area& area) {
  frame(sheet, area, "Gap [mesh units]");
  const int bar_x = area.x + 152;
  const Area bar{bar_x, area.y + 74, 30, area.height - 216};
  draw_text(sheet, area.x + 12, bar.y - 16, "apart", {12, {8, 45, 112}});
  draw_text(sheet, area.x + 12, bar.y + bar.height + 24, "overlapping", {12, {140, 10, 38}});
  const std::vector<double> shares = histogram(joint, bar.height / 3);
  const double most = std::max(1e-12, *std::max_element(shares.begin(), shares.end()));
  const auto count = static_cast<int>(shares.size());
  for (int k = 0; k < count; ++k) {
    const int length = static_cast<int>(std::lround(shares[k] / most * (bar_x - area.x - 24)));
    const int bottom = bar.y + bar.height - k * bar.height / count;
    const int top = bar.y + bar.height - (k + 1) * bar.height / count;
    fill(sheet, {bar_x - 4 - length, top, length, std::max(1, bottom - top - 1)}, {120, 126, 136});
  }
  draw_bar(sheet, bar, {gap_colour, -joint.scale, joint.scale, true, ""}, 12);
  const int y = area.y + area.height - 92;
  fill(sheet, {area.x + 14, y, 20, 14}, kNoContact);
  draw_text(sheet, area.x + 42, y + 13, "nothing within " + short_number(joint.reach), {12, kInk});
  draw_text(sheet, area.x + 14, y + 42, "median |gap|  " + short_number(gap_median), {12, kInk});
  if (joint.reach > joint.scale) {
    draw_text(sheet, area.x + 14, y + 66,
              fmt::format("darkest: from {} ({:.0f} %)", short_number(joint.scale), darkest(joint)),
              {12, kInk});
  }
}

void draw_lower_row(Image& sheet, const Joint& joint, double gap_median) {
  const Area faces{kMargin, kLower, 1090, kLowerHeight};
  draw_gap_views(sheet, joint, faces);
  const Area legend{faces.x + faces.width + kGutter, kLower, 290, kLowerHeight};
  draw_gap_legend(sheet, joint, gap_median, legend);
  const int left = legend.x + legend.width + kGutter;
  const Area cut{left, kLower, kWidth - kMargin - left, kLowerHeight};
  put(sheet, cut, "Cut through the joint", draw_section(joint, inside(cut).width, inside(cut).height));
}

struct VerdictLabel {
  const char* text;
  Colour colour;
};

VerdictLabel label_of(match::Verdict verdict) {
  switch (verdict) {
    case match::Verdict::Join:
      return {"JOIN", {36, 128, 74}};
    case match::Verdict::Unsure:
      return {"UNSURE", {176, 116, 16}};
    case match::Verdict::NoJoin:
      break;
  }
  return {"NO JOIN", {166, 48, 48}};
}

void draw_header(Image& sheet, const SheetLabels& labels) {
  const VerdictLabel verdict = label_of(labels.verdict);
  const TextStyle big{22, Colour(255), Align::Middle, true};
  const int chip = static_cast<int>(text_width(verdict.text, big)) + 40;
  fill(sheet, {kMargin, 20, chip, 44}, verdict.colour);
  draw_text(sheet, kMargin + chip / 2.0, 53, verdict.text, big);
  const TextStyle score{20, kInk, Align::Left, true};
  const std::string number = fmt::format("score {:.2f}", labels.candidate.score);
  draw_text(sheet, kMargin + chip + 22, 52, number, score);
  const double left = kMargin + chip + 22 + text_width(number, score) + 40;
  const TextStyle name{18, kInk};
  const double room = (kWidth - kMargin - left - 2 * 28 - 40 - text_width("A  B  ", name)) / 2;
  const std::string a = fitted(labels.name_a, name, room);
  fill(sheet, {static_cast<int>(left), 34, 18, 18}, kTintA);
  draw_text(sheet, left + 28, 52, "A  " + a, name);
  const double right = left + 28 + text_width("A  " + a, name) + 40;
  fill(sheet, {static_cast<int>(right), 34, 18, 18}, kTintB);
  draw_text(sheet, right + 28, 52, "B  " + fitted(labels.name_b, name, room), name);
  draw_text(sheet, kMargin, 90, figures_line(labels), {12.5, kFaint});
}

}  // namespace

std::string figures_line(const SheetLabels& labels) {
  const match::JointError& error = labels.candidate.error;
  return fmt::format(
      "gap median {}   penetration {}   contact area {}   whole fragments: slope difference {} (ray cast "
      "{}), "
      "depth error {}, map overlap {:.0f} %   backend {}",
      short_number(error.gap_median), short_number(error.penetration), short_number(error.contact_area),
      short_number(error.slope), short_number(error.raycast), short_number(error.depth), 100 * error.overlap,
      labels.backend);
}

Image draw_match_sheet(const Joint& joint, const SheetLabels& labels) {
  Image sheet(kWidth, kHeight, kPaper);
  draw_header(sheet, labels);
  draw_upper_row(sheet, joint);
  draw_lower_row(sheet, joint, labels.candidate.error.gap_median);
  return sheet;
}

}  // namespace rejoin::report
