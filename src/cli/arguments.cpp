#include "cli/arguments.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <optional>

#include "batch/inputs.hpp"
#include "cli/command.hpp"

namespace rejoin::cli {
namespace {

std::optional<double> parse_number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Digits after at most a sign, without a nought before them: CLI11 would take 010 for 8.
bool is_whole(const std::string& text) {
  const std::size_t digits = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  if (text.size() > digits + 1 && text[digits] == '0') return false;
  return text.find_first_not_of("0123456789", digits) == std::string::npos;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

}  // namespace

Choices<zbuffer::Backend> backend_choices() {
  Choices<zbuffer::Backend> choices;
  for (const zbuffer::Backend backend :
       {zbuffer::Backend::Auto, zbuffer::Backend::Gpu, zbuffer::Backend::OsMesa, zbuffer::Backend::Raster,
        zbuffer::Backend::RayCast}) {
    choices.emplace_back(zbuffer::name_of(backend), backend);
  }
  return choices;
}

CLI::Validator in_range(double low, double high) {
  return {[low, high](std::string& text) {
            const std::optional<double> value = parse_number(text);
            if (value && *value >= low && *value <= high) return std::string();
            return fmt::format("'{}' is no number from {} to {}", text, low, high);
          },
          ""};
}

CLI::Validator whole_in_range(double low, double high) {
  return {[low, high](std::string& text) {
            const std::optional<double> value = is_whole(text) ? parse_number(text) : std::nullopt;
            if (value && *value >= low && *value <= high) return std::string();
            return fmt::format("'{}' is no whole number from {} to {}", text, low, high);
          },
          ""};
}

std::vector<double> whole_numbers(const std::string& option, const std::string& text,
                                  const NumberRange& range) {
  std::vector<double> numbers;
  for (const std::string& part : split(text)) {
    const std::optional<double> value = is_whole(part) ? parse_number(part) : std::nullopt;
    if (!value || *value < range.low || *value > range.high) {
      throw CLI::ValidationError(
          option, fmt::format("'{}' is no list of whole numbers from {} to {}, such as {},{}", text,
                              range.low, range.high, range.low, range.low + 1));
    }
    numbers.push_back(*value);
  }
  return numbers;
}

CLI::Option* add_seed(CLI::App& app, std::uint64_t& seed, const std::string& description) {
  const auto check = [](std::string& text) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::int64_t>::max();  // in a run's database
    std::uint64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [stopped, problem] = std::from_chars(text.data(), end, value);
    if (problem == std::errc() && stopped == end && is_whole(text) && value <= kMost) return std::string();
    return fmt::format("'{}' is no whole number from 0 to {}", text, kMost);
  };
  return app.add_option("--seed", seed, description + ", below 2^63 (1)")
      ->type_name("S")
      ->check(CLI::Validator(check, ""));
}

glm::dvec3 parse_direction(const std::string& option, const std::string& text) {
  const std::vector<std::string> parts = split(text);
  glm::dvec3 direction(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    const auto value = parts.size() == 3 ? parse_number(parts[axis]) : std::nullopt;
    if (!value)
      throw UsageError(option, fmt::format("'{}' is no direction", text), "give x,y,z, such as 0,0,1");
    direction[axis] = *value;
  }
  const double largest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
  if (largest == 0.0) {
    throw UsageError(option, fmt::format("'{}' has length 0", text), "give x,y,z, such as 0,0,1");
  }
  return glm::normalize(direction / largest);  // first the scale: squares of extreme numbers overflow
}

std::vector<glm::dvec3> parse_directions(const std::string& option, const std::vector<std::string>& texts) {
  std::vector<glm::dvec3> directions;
  directions.reserve(texts.size());
  for (const std::string& text : texts) directions.push_back(parse_direction(option, text));
  return directions;
}

void require_two_files(const std::string& a, const std::string& b) {
  std::error_code unreadable;  // load() tells that better
  if (a == b || std::filesystem::equivalent(a, b, unreadable)) {
    throw UsageError(b, "is the same file as " + a, "give two different fragments");
  }
  const auto size = std::filesystem::file_size(a, unreadable);
  if (unreadable || std::filesystem::file_size(b, unreadable) != size || unreadable) return;
  if (batch::content_hash(a) == batch::content_hash(b))
    throw UsageError(b, "is a copy of " + a, "give two different fragments");
}

}  // namespace rejoin::cli
