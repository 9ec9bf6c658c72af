#include "outline/detail/svg_path.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

namespace rejoin::outline::detail {
namespace {

constexpr int kCurveSteps = 24;  ///< straight pieces of a curve

/// Takes numbers off a text, as SVG writes them: "1-2" and "1.5.5" are two numbers each.
class Numbers {
 public:
  explicit Numbers(std::string_view text) : rest_(text) {}

  void skip_blanks() {
    while (!rest_.empty() && (rest_[0] == ',' || std::isspace(static_cast<unsigned char>(rest_[0])) != 0))
      rest_.remove_prefix(1);
  }

  bool at_end() {
    skip_blanks();
    return rest_.empty();
  }

  bool at_letter() { return !at_end() && std::isalpha(static_cast<unsigned char>(rest_[0])) != 0; }

  char take_letter() {
    const char letter = rest_[0];
    rest_.remove_prefix(1);
    return letter;
  }

  std::optional<double> take() {
    skip_blanks();
    if (!rest_.empty() && rest_[0] == '+') rest_.remove_prefix(1);
    double value = 0.0;
    const auto [end, problem] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (problem != std::errc()) return std::nullopt;
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }

  /// An arc's flag: one digit, which may stand close to the next number.
  std::optional<bool> take_flag() {
    skip_blanks();
    if (rest_.empty() || (rest_[0] != '0' && rest_[0] != '1')) return std::nullopt;
    return take_letter() == '1';
  }

 private:
  std::string_view rest_;
};

double angle_of(const glm::dvec2& v) {
  return std::atan2(v.y, v.x);
}

class Path {
 public:
  explicit Path(std::string_view data) : numbers_(data) {}

  bool run() {
    char command = 'M';
    bool first = true;
    while (!numbers_.at_end()) {
      if (numbers_.at_letter()) {
        command = numbers_.take_letter();
        if (first && std::toupper(command) != 'M') return false;
      } else if (first || std::toupper(command) == 'Z') {
        return false;
      }
      first = false;
      if (!step(command)) return false;
      if (command == 'M') command = 'L';  // further pairs are lines
      if (command == 'm') command = 'l';
    }
    finish();
    return true;
  }

  std::vector<std::vector<glm::dvec2>> subpaths;

 private:
  bool step(char command) {
    relative_ = std::islower(static_cast<unsigned char>(command)) != 0;
    const char kind = static_cast<char>(std::toupper(static_cast<unsigned char>(command)));
    if (kind != 'C' && kind != 'S') cubic_control_ = std::nullopt;
    if (kind != 'Q' && kind != 'T') quadratic_control_ = std::nullopt;
    switch (kind) {
      case 'M':
        return move();
      case 'Z':
        return close();
      case 'L':
        return line();
      case 'H':
        return along(0);
      case 'V':
        return along(1);
      case 'C':
        return cubic(true);
      case 'S':
        return cubic(false);
      case 'Q':
        return quadratic(true);
      case 'T':
        return quadratic(false);
      case 'A':
        return arc();
      default:
        return false;
    }
  }

  std::optional<glm::dvec2> point() {
    const auto x = numbers_.take();
    const auto y = x ? numbers_.take() : std::nullopt;
    if (!y) return std::nullopt;
    return glm::dvec2(*x, *y) + (relative_ ? at_ : glm::dvec2(0.0));
  }

  bool move() {
    const auto to = point();
    if (!to) return false;
    finish();
    at_ = start_ = *to;
    current_.push_back(at_);
    return true;
  }

  bool close() {
    if (!current_.empty()) current_.push_back(start_);
    finish();
    at_ = start_;
    return true;
  }

  void add(const glm::dvec2& to) {
    if (current_.empty()) current_.push_back(at_);
    current_.push_back(to);
    at_ = to;
  }

  bool line() {
    const auto to = point();
    if (to) add(*to);
    return to.has_value();
  }

  bool along(int axis) {
    const auto value = numbers_.take();
    if (!value) return false;
    glm::dvec2 to = at_;
    to[axis] = *value + (relative_ ? at_[axis] : 0.0);
    add(to);
    return true;
  }

  void add_cubic(const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d) {
    const glm::dvec2 a = at_;
    for (int k = 1; k <= kCurveSteps; ++k) {
      const double t = static_cast<double>(k) / kCurveSteps;
      const double u = 1.0 - t;
      add(u * u * u * a + 3.0 * u * u * t * b + 3.0 * u * t * t * c + t * t * t * d);
    }
  }

  /// \param full  C: both control points are given; S: the first mirrors the last one's
  bool cubic(bool full) {
    const auto first = full ? point() : std::optional(cubic_control_ ? 2.0 * at_ - *cubic_control_ : at_);
    const auto second = first ? point() : std::nullopt;
    const auto to = second ? point() : std::nullopt;
    if (!to) return false;
    add_cubic(*first, *second, *to);
    cubic_control_ = second;
    return true;
  }

  bool quadratic(bool full) {
    const auto control =
        full ? point() : std::optional(quadratic_control_ ? 2.0 * at_ - *quadratic_control_ : at_);
    const auto to = control ? point() : std::nullopt;
    if (!to) return false;
    add_cubic(glm::mix(at_, *control, 2.0 / 3.0), glm::mix(*to, *control, 2.0 / 3.0), *to);
    quadratic_control_ = control;
    return true;
  }

  /// SVG 1.1, appendix F.6: from end points to centre.
  bool arc() {
    const auto rx = numbers_.take();
    const auto ry = rx ? numbers_.take() : std::nullopt;
    const auto tilt = ry ? numbers_.take() : std::nullopt;
    const auto large = tilt ? numbers_.take_flag() : std::nullopt;
    const auto sweep = large ? numbers_.take_flag() : std::nullopt;
    const auto to = sweep ? point() : std::nullopt;
    if (!to) return false;
    if (*rx == 0.0 || *ry == 0.0 || *to == at_) {
      add(*to);
      return true;
    }
    add_arc({std::abs(*rx), std::abs(*ry)}, *tilt * M_PI / 180.0, *large, *sweep, *to);
    return true;
  }

  void add_arc(glm::dvec2 radii, double tilt, bool large, bool sweep, const glm::dvec2& to) {
    const glm::dmat2 turn(std::cos(tilt), std::sin(tilt), -std::sin(tilt), std::cos(tilt));
    const glm::dvec2 from = at_;
    const glm::dvec2 half = glm::transpose(turn) * ((from - to) / 2.0);
    const glm::dvec2 unit = half / radii;
    const double excess = glm::dot(unit, unit);
    if (excess > 1.0) radii *= std::sqrt(excess);
    const glm::dvec2 on_circle = half / radii;
    const double square = glm::dot(on_circle, on_circle);
    const double factor = std::sqrt(std::max(0.0, 1.0 / square - 1.0)) * (large == sweep ? -1.0 : 1.0);
    const glm::dvec2 centre = factor * glm::dvec2(on_circle.y, -on_circle.x);
    const double begin = angle_of(on_circle - centre);
    double span = angle_of(-on_circle - centre) - begin;
    if (sweep && span < 0.0) span += 2.0 * M_PI;
    if (!sweep && span > 0.0) span -= 2.0 * M_PI;
    const glm::dvec2 middle = turn * (radii * centre) + (from + to) / 2.0;
    for (int k = 1; k < kCurveSteps; ++k) {
      const double angle = begin + span * k / kCurveSteps;
      add(middle + turn * (radii * glm::dvec2(std::cos(angle), std::sin(angle))));
    }
    add(to);
  }

  void finish() {
    if (current_.size() > 1) subpaths.push_back(current_);
    current_.clear();
  }

  Numbers numbers_;
  bool relative_ = false;
  glm::dvec2 at_{0.0};
  glm::dvec2 start_{0.0};
  std::optional<glm::dvec2> cubic_control_;
  std::optional<glm::dvec2> quadratic_control_;
  std::vector<glm::dvec2> current_;
};

}  // namespace

std::optional<std::vector<std::vector<glm::dvec2>>> flatten_path(std::string_view data,
                                                                 std::string& problem) {
  Path path(data);
  if (path.run()) return std::move(path.subpaths);
  problem = fmt::format("path data \"{}...\" is broken", data.substr(0, 24));
  return std::nullopt;
}

std::optional<std::vector<double>> parse_numbers(std::string_view text) {
  Numbers numbers(text);
  std::vector<double> result;
  while (!numbers.at_end()) {
    const auto value = numbers.take();
    if (!value) return std::nullopt;
    result.push_back(*value);
  }
  return result;
}

}  // namespace rejoin::outline::detail
