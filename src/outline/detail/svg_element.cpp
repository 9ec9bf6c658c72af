#include "outline/detail/svg_element.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/error.hpp"
#include "outline/detail/readers.hpp"
#include "outline/detail/svg_path.hpp"

namespace rejoin::outline::detail {
namespace {

using Polygon = std::vector<glm::dvec2>;

constexpr std::string_view kBlanks = " \t\r\n";

/// A property of a style attribute, "fill: none; display: none".
std::string_view style_property(std::string_view style, std::string_view name) {
  std::string_view value;
  while (!style.empty()) {
    const std::string_view one = style.substr(0, style.find(';'));
    style.remove_prefix(std::min(style.size(), one.size() + 1));
    const std::size_t colon = one.find(':');
    if (colon != std::string_view::npos && trimmed(one.substr(0, colon), kBlanks) == name)
      value = trimmed(one.substr(colon + 1, one.find('!', colon) - colon - 1), kBlanks);  // "none !important"
  }
  return value;
}

/// One function of a transform.
glm::dmat3 transform_function(const std::string& name, const std::vector<double>& v) {
  glm::dmat3 m(1.0);
  const auto number = [&](std::size_t i, double other) { return i < v.size() ? v[i] : other; };
  if (name == "matrix" && v.size() == 6) m = {{v[0], v[1], 0}, {v[2], v[3], 0}, {v[4], v[5], 1}};
  if (name == "translate") m[2] = {number(0, 0), number(1, 0), 1};
  if (name == "scale") m = {{number(0, 1), 0, 0}, {0, number(1, number(0, 1)), 0}, {0, 0, 1}};
  if (name == "skewX") m[1][0] = std::tan(number(0, 0) * M_PI / 180.0);
  if (name == "skewY") m[0][1] = std::tan(number(0, 0) * M_PI / 180.0);
  if (name == "rotate") {
    const double angle = number(0, 0) * M_PI / 180.0;
    const glm::dvec2 centre(number(1, 0), number(2, 0));
    const glm::dmat2 turn(std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle));
    m = {glm::dvec3(turn[0], 0), glm::dvec3(turn[1], 0), glm::dvec3(centre - turn * centre, 1)};
  }
  return m;
}

/// Style sheets' transforms have units, those of attributes none.
std::string without_usual_units(std::string text) {
  for (const std::string_view unit : {"px", "deg"}) {
    for (std::size_t at = text.find(unit); at != std::string::npos; at = text.find(unit, at))
      text.erase(at, unit.size());
  }
  return text;
}

std::vector<Polygon> path_polygons(const std::string& data, const std::string& path) {
  std::string problem;
  auto found = flatten_path(data, problem);
  if (!found) throw InputError(path, problem, kSvgMend);
  return std::move(*found);
}

Polygon listed_points(const pugi::xml_node& node, const std::string& path) {
  const auto numbers = parse_numbers(node.attribute("points").value());
  if (!numbers) throw InputError(path, "the points of a polygon are broken", kSvgMend);
  Polygon polygon;
  polygon.reserve(numbers->size() / 2);
  for (std::size_t i = 0; i + 1 < numbers->size(); i += 2)
    polygon.emplace_back((*numbers)[i], (*numbers)[i + 1]);
  return polygon;
}

/// Lengths of an element's attributes.
class Lengths {
 public:
  Lengths(const pugi::xml_node& node, const glm::dvec2& around, const std::string& path)
      : node_(node), around_(around), path_(path) {}

  std::optional<double> given(const char* name, double reference) const {
    const auto length = length_of(node_, name, reference, path_);
    return length ? std::optional(length->value) : std::nullopt;
  }
  glm::dvec2 both(const char* x, const char* y) const {
    return {given(x, around_.x).value_or(0.0), given(y, around_.y).value_or(0.0)};
  }
  /// rx and ry, of which one stands for both.
  glm::dvec2 radii() const {
    const auto rx = given("rx", around_.x);
    const auto ry = given("ry", around_.y);
    return {rx.value_or(ry.value_or(0.0)), ry.value_or(rx.value_or(0.0))};
  }

 private:
  const pugi::xml_node& node_;
  const glm::dvec2& around_;
  const std::string& path_;
};

std::vector<Polygon> rectangle(const Lengths& lengths, const std::string& path) {
  const glm::dvec2 at = lengths.both("x", "y");
  const glm::dvec2 size = lengths.both("width", "height");
  const glm::dvec2 r = glm::clamp(lengths.radii(), glm::dvec2(0.0), glm::max(0.5 * size, glm::dvec2(0.0)));
  if (r.x == 0.0 || r.y == 0.0) return {{at, {at.x + size.x, at.y}, at + size, {at.x, at.y + size.y}}};
  const glm::dvec2 straight = size - 2.0 * r;
  const std::string arc = fmt::format("a{} {} 0 0 1 ", r.x, r.y);
  return path_polygons(
      fmt::format("M{} {}h{}{}{} {}v{}{}{} {}h{}{}{} {}v{}{}{} {}z", at.x + r.x, at.y, straight.x, arc, r.x,
                  r.y, straight.y, arc, -r.x, r.y, -straight.x, arc, -r.x, -r.y, -straight.y, arc, r.x, -r.y),
      path);
}

std::vector<Polygon> ellipse(const glm::dvec2& centre, const glm::dvec2& r, const std::string& path) {
  if (r.x <= 0.0 || r.y <= 0.0) return {};
  std::string data = fmt::format("M{} {}", centre.x + r.x, centre.y);
  for (const glm::dvec2& to : {glm::dvec2(-r.x, r.y), {-r.x, -r.y}, {r.x, -r.y}, r})
    data += fmt::format("a{} {} 0 0 1 {} {}", r.x, r.y, to.x, to.y);
  return path_polygons(data + "z", path);
}

}  // namespace

std::string local_name(const pugi::xml_node& node) {
  const std::string name = node.name();
  return name.substr(name.find(':') == std::string::npos ? 0 : name.find(':') + 1);
}

std::string property(const pugi::xml_node& node, const char* name) {
  const std::string_view styled = style_property(node.attribute("style").value(), name);
  return std::string(styled.empty() ? trimmed(node.attribute(name).value(), kBlanks) : styled);
}

glm::dmat3 transform_of(const pugi::xml_node& node, const std::string& path) {
  const std::string all = without_usual_units(property(node, "transform"));
  std::string_view text = all;
  glm::dmat3 result(1.0);
  while (text.find('(') != std::string_view::npos) {
    const std::size_t open = text.find('(');
    const std::size_t shut = text.find(')', open);
    const auto numbers =
        parse_numbers(text.substr(open + 1, shut == std::string_view::npos ? shut : shut - open - 1));
    if (shut == std::string_view::npos || !numbers)
      throw InputError(path, "a transform is broken or has other units than px and deg", kSvgMend);
    std::string name;
    for (const char c : text.substr(0, open)) {
      if (std::isalpha(static_cast<unsigned char>(c)) != 0) name += c;
    }
    result = result * transform_function(name, *numbers);
    text.remove_prefix(shut + 1);
  }
  return result;
}

std::optional<Length> length_of(const pugi::xml_node& node, const char* name, double reference,
                                const std::string& path) {
  const std::string text = property(node, name);
  if (text.empty() || text == "auto") return std::nullopt;
  double number = 0.0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string unit(trimmed({end, static_cast<std::size_t>(text.data() + text.size() - end)}, kBlanks));
  if (problem == std::errc()) {
    if (unit.empty() || unit == "px") return Length{number, false};
    if (unit == "%") return Length{number / 100.0 * reference, false};
    static const std::array<std::pair<const char*, double>, 6> kInches{{{"in", 1.0},
                                                                        {"mm", 1.0 / 25.4},
                                                                        {"cm", 1.0 / 2.54},
                                                                        {"pt", 1.0 / 72.0},
                                                                        {"pc", 1.0 / 6.0},
                                                                        {"Q", 1.0 / 101.6}}};
    for (const auto& [known, inches] : kInches)
      if (unit == known) return Length{number * inches * kPixelsAnInch, true};
  }
  throw InputError(path, fmt::format("{}=\"{}\" is no length that is read", name, text),
                   "give it in px, mm, cm, in or pt");
}

ViewBox view_box(const pugi::xml_node& svg, const glm::dvec2& around, const std::string& path) {
  const auto numbers = parse_numbers(svg.attribute("viewBox").value());
  if (numbers && numbers->size() == 4) {
    const glm::dvec2 low((*numbers)[0], (*numbers)[1]);
    return {low, low + glm::dvec2((*numbers)[2], (*numbers)[3])};
  }
  return {{}, Lengths(svg, around, path).both("width", "height")};
}

std::vector<Polygon> polygons_of(const pugi::xml_node& node, const glm::dvec2& around,
                                 const std::string& path) {
  const std::string name = local_name(node);
  const Lengths lengths(node, around, path);
  if (name == "path") return path_polygons(node.attribute("d").value(), path);
  if (name == "polyline") return {listed_points(node, path)};
  if (name == "polygon") {
    Polygon points = listed_points(node, path);
    if (!points.empty()) points.push_back(points.front());
    return {std::move(points)};
  }
  if (name == "rect") return rectangle(lengths, path);
  if (name == "ellipse") return ellipse(lengths.both("cx", "cy"), lengths.radii(), path);
  if (name == "circle") {
    const double r = lengths.given("r", glm::length(around) / std::sqrt(2.0)).value_or(0.0);
    return ellipse(lengths.both("cx", "cy"), glm::dvec2(r), path);
  }
  return {};
}

}  // namespace rejoin::outline::detail
