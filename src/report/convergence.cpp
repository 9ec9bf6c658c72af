#include "report/convergence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>

#include "core/utf8.hpp"
#include "report/canvas.hpp"

namespace rejoin::report {
namespace {

constexpr double kWidth = 900;
constexpr double kHeight = 520;
constexpr double kLeft = 86;
constexpr double kRight = 816;
constexpr double kTop = 64;
constexpr double kBottom = 450;
constexpr std::array<const char*, 8> kChainColours{"#4477aa", "#ee6677", "#228833", "#b89b1f", "#2f9fbf",
                                                   "#aa3377", "#777777", "#cc6600"};  // after Tol 2021

/// One axis: values to pixels, straight or logarithmic.
struct Axis {
  double low = 0, high = 1;  ///< values (of the logarithm, if logarithmic) at the ends
  double from = 0, to = 1;   ///< pixels at the ends
  bool logarithmic = false;

  double operator()(double value) const {
    const double at = logarithmic ? std::log10(value) : value;
    return from + (at - low) / (high - low) * (to - from);
  }

  std::vector<double> marks(int count) const {
    if (!logarithmic) return ticks(low, high, count);
    std::vector<double> result;
    const int step = std::max(1, static_cast<int>(std::ceil((high - low) / count)));
    for (int k = static_cast<int>(std::ceil(low - 1e-9)); k <= high + 1e-9; k += step)
      result.push_back(std::pow(10.0, k));
    return result;
  }
};

Axis make_axis(double low, double high, double from, double to, bool logarithmic) {
  if (logarithmic) {
    low = std::floor(std::log10(low));
    high = std::ceil(std::log10(high));
  }
  if (!(high > low)) high = low + 1;
  return {low, high, from, to, logarithmic};
}

/// Cut in the middle where it has more letters than a line of the title's font; wide ones count twice.
std::string fitted_title(std::string_view title) {
  constexpr std::size_t kMost = 82;
  std::vector<std::string_view> letters;
  std::size_t width = 0;
  const auto width_of = [](std::string_view letter) { return letter.size() > 2 ? 2U : 1U; };
  while (!title.empty()) {
    letters.push_back(title.substr(0, std::max<std::size_t>(1, utf8_length(title))));
    width += width_of(letters.back());
    title.remove_prefix(letters.back().size());
  }
  const std::size_t middle = letters.size() / 2;
  std::size_t first = middle;  // of those that are left out
  std::size_t end = middle;
  while (width > kMost - (first < end ? 3 : 0)) {
    width -= width_of(first > 0 && middle - first <= end - middle ? letters[--first] : letters[end++]);
  }
  std::string fitted;
  for (std::size_t k = 0; k < letters.size(); ++k) {
    if (k == first && first < end) fitted += "...";
    if (k < first || k >= end) fitted += letters[k];
  }
  return fitted;
}

std::string text(double x, double y, const char* anchor, const std::string& content, const char* more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, more,
                     escaped(content));
}

std::string line(double x1, double y1, double x2, double y2, const char* colour) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x1,
                     y1, x2, y2, colour);
}

std::string vertical_title(double x, const std::string& content) {
  const double y = (kTop + kBottom) / 2;
  return fmt::format(
      "<text x=\"{0:.1f}\" y=\"{1:.1f}\" text-anchor=\"middle\" transform=\"rotate(-90 {0:.1f} "
      "{1:.1f})\">{2}</text>\n",
      x, y, escaped(content));
}

std::string horizontal_axis(const Axis& axis, const std::string& title) {
  std::string svg = line(kLeft, kBottom, kRight, kBottom, "#333");
  for (const double value : axis.marks(8)) {
    svg += line(axis(value), kBottom, axis(value), kBottom + 5, "#333");
    svg += text(axis(value), kBottom + 20, "middle", short_number(value));
  }
  return svg + text((kLeft + kRight) / 2, kBottom + 44, "middle", title);
}

std::string left_axis(const Axis& axis, const std::string& title) {
  std::string svg;
  for (const double value : axis.marks(6)) {
    svg += line(kLeft, axis(value), kRight, axis(value), "#e4e4e8");
    svg += text(kLeft - 8, axis(value) + 4, "end", short_number(value));
  }
  return svg + line(kLeft, kTop, kLeft, kBottom, "#333") + vertical_title(22, title);
}

std::string right_axis(const Axis& axis, const std::string& title) {
  std::string svg = line(kRight, kTop, kRight, kBottom, "#333");
  for (const double value : axis.marks(6)) {
    svg += line(kRight, axis(value), kRight + 5, axis(value), "#333");
    svg += text(kRight + 9, axis(value) + 4, "start", short_number(value));
  }
  return svg + vertical_title(kWidth - 14, title);
}

/// Values that appear in the chart.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return low > high; }
};

struct Ranges {
  Range evaluations, best, temperature;
};

Ranges ranges_of(const std::vector<std::vector<match::Progress>>& chains) {
  Ranges result;
  for (const auto& chain : chains) {
    for (const match::Progress& step : chain) {
      result.evaluations.add(static_cast<double>(step.evaluations));
      result.best.add(step.best);
      if (step.temperature > 0) result.temperature.add(step.temperature);
    }
  }
  return result;
}

/// A chain's course as steps (`best` holds until the next improvement) or as straight lines.
template <class Value>
std::string course(const std::vector<match::Progress>& chain, const Axis& x, const Axis& y,
                   const std::string& style, bool steps, const Value& value_of) {
  std::string points;
  double before = 0;
  for (const match::Progress& step : chain) {
    const double value = value_of(step);
    if (!std::isfinite(value) || (y.logarithmic && value <= 0)) continue;
    const double at = x(static_cast<double>(step.evaluations));
    if (steps && !points.empty()) points += fmt::format("{:.1f},{:.1f} ", at, before);
    before = y(value);
    points += fmt::format("{:.1f},{:.1f} ", at, before);
  }
  return points.empty() ? "" : fmt::format("<polyline fill=\"none\" {} points=\"{}\"/>\n", style, points);
}

std::string chains_chart(const std::vector<std::vector<match::Progress>>& chains, const Ranges& ranges) {
  const Axis x = make_axis(0, ranges.evaluations.high, kLeft, kRight, false);
  const bool wide = ranges.best.low > 0 && ranges.best.high > 20 * ranges.best.low;
  const double pad = 0.05 * (ranges.best.high - ranges.best.low);
  const Axis y =
      wide ? make_axis(ranges.best.low, ranges.best.high, kBottom, kTop, true)
           : make_axis(std::min(0.0, ranges.best.low), ranges.best.high + pad, kBottom, kTop, false);
  std::string svg = left_axis(y, "best energy") + horizontal_axis(x, "evaluations");
  const bool warm = !ranges.temperature.empty();
  const Axis t =
      warm ? make_axis(ranges.temperature.low, ranges.temperature.high, kBottom, kTop, true) : Axis{};
  if (warm) svg += right_axis(t, "temperature (dashed)");
  for (std::size_t k = 0; k < chains.size(); ++k) {
    const char* colour = kChainColours[k % kChainColours.size()];
    if (warm) {
      svg += course(chains[k], x, t,
                    fmt::format("stroke=\"{}\" stroke-dasharray=\"4 4\" opacity=\"0.55\"", colour), false,
                    [](const match::Progress& step) { return step.temperature; });
    }
    svg += course(chains[k], x, y, fmt::format("stroke=\"{}\" stroke-width=\"2\"", colour), true,
                  [](const match::Progress& step) { return step.best; });
  }
  return svg;
}

std::string candidates_chart(const std::vector<match::Candidate>& candidates) {
  if (candidates.empty()) return text(kWidth / 2, kHeight / 2, "middle", "no candidate pose was found");
  const Axis y = make_axis(0, 1, kBottom, kTop, false);
  std::string svg = left_axis(y, "score");
  const double step = (kRight - kLeft) / static_cast<double>(candidates.size());
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const double middle = kLeft + (static_cast<double>(k) + 0.5) * step;
    const double score = std::clamp(candidates[k].score, 0.0, 1.0);
    svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
                       middle - 0.35 * step, y(score), 0.7 * step, kBottom - y(score),
                       k == 0 ? "#4477aa" : "#a9bcd0");
    svg += text(middle, y(score) - 6, "middle", short_number(candidates[k].score));
    svg += text(middle, kBottom + 20, "middle", std::to_string(k + 1));
  }
  svg += line(kLeft, kBottom, kRight, kBottom, "#333");
  return svg + text((kLeft + kRight) / 2, kBottom + 44, "middle", "candidate pose, best first");
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const auto first = static_cast<unsigned char>(text[0]);
    if (length == 0 || first < 32 || first == 127) {
      result += '?';
    } else if (text[0] == '&') {
      result += "&amp;";
    } else if (text[0] == '<') {
      result += "&lt;";
    } else if (text[0] == '>') {
      result += "&gt;";
    } else if (text[0] == '"') {
      result += "&quot;";
    } else if (text[0] == '\'') {
      result += "&apos;";
    } else {
      result += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return result;
}

std::string convergence_svg(const match::Result& result, const std::string& title) {
  const Ranges ranges = ranges_of(result.convergence);
  const bool chains = !ranges.evaluations.empty() && !ranges.best.empty();
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
      "{1:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"13\" fill=\"#222\">\n<rect width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" "
      "fill=\"#fafafa\"/>\n",
      kWidth, kHeight);
  svg += text(kLeft, 28, "start",
              fitted_title((chains ? "Course of the search: " : "Scores of the poses found: ") + title),
              " font-size=\"16\" font-weight=\"bold\"");
  svg += text(
      kLeft, 48, "start",
      fmt::format(
          "{} evaluations{}", result.evaluations,
          chains ? fmt::format(", {} chains, best energy so far of each", result.convergence.size()) : ""));
  svg += chains ? chains_chart(result.convergence, ranges) : candidates_chart(result.candidates);
  return svg + "</svg>\n";
}

}  // namespace rejoin::report
