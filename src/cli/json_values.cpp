#include "cli/json_values.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/json_depth.hpp"

namespace rejoin::cli {

using nlohmann::ordered_json;

namespace {

constexpr double kLargestShift = 1e13;  // of scans, whose coordinates end at 1e12, one onto another
/// Rounding to three decimals leaves 2 sqrt(3) 0.0005 and a little.
constexpr double kLargestRounding = 0.002;

bool is_matrix(const ordered_json& rows) {
  if (!rows.is_array() || rows.size() != 4) return false;
  for (const ordered_json& row : rows) {
    if (!row.is_array() || row.size() != 4) return false;
    for (const ordered_json& value : row) {
      if (!value.is_number() || !std::isfinite(value.get<double>())) return false;
    }
  }
  return rows[3] == ordered_json({0.0, 0.0, 0.0, 1.0});
}

/// How far the products of columns are from those of unit vectors at right angles, at most.
double off_rotation(const glm::dmat3& matrix) {
  const glm::dmat3 difference = glm::transpose(matrix) * matrix - glm::dmat3(1.0);
  double most = 0;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) most = std::max(most, std::abs(difference[column][row]));
  }
  return most;
}

/// The matrix as it stands.  \pre is_matrix()
Rigid unchecked(const ordered_json& rows) {
  Rigid pose;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) pose.rotation[column][row] = rows[row][column].get<double>();
    pose.translation[row] = rows[row][3].get<double>();
  }
  return pose;
}

bool turns(const glm::dmat3& matrix) {
  return off_rotation(matrix) <= kLargestRounding && glm::determinant(matrix) > 0;
}

bool is_far(const Rigid& pose) {
  const glm::dvec3 shift = glm::abs(pose.translation);
  return std::max({shift.x, shift.y, shift.z}) > kLargestShift;
}

/// Gram-Schmidt.
glm::dmat3 orthonormal(const glm::dmat3& matrix) {
  const glm::dvec3 x = glm::normalize(matrix[0]);
  const glm::dvec3 y = glm::normalize(matrix[1] - glm::dot(matrix[1], x) * x);
  return {x, y, glm::cross(x, y)};
}

}  // namespace

ordered_json to_json(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

ordered_json to_json(const Rigid& pose) {
  ordered_json rows = ordered_json::array();
  for (int row = 0; row < 3; ++row) {
    rows.push_back(
        {pose.rotation[0][row], pose.rotation[1][row], pose.rotation[2][row], pose.translation[row]});
  }
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return rows;
}

std::optional<Rigid> rigid_from_json(const ordered_json& rows) {
  if (!is_matrix(rows)) return std::nullopt;
  Rigid pose = unchecked(rows);
  if (!turns(pose.rotation) || is_far(pose)) return std::nullopt;
  pose.rotation = orthonormal(pose.rotation);
  return pose;
}

std::string why_no_rigid(const ordered_json& rows) {
  if (!is_matrix(rows)) return "is no 4 x 4 matrix of numbers whose last row is 0, 0, 0, 1";
  const Rigid pose = unchecked(rows);
  if (is_far(pose)) return "shifts by more than 1e13";
  const double off = off_rotation(pose.rotation);
  if (off <= kLargestRounding) return "is no rotation, as it mirrors";
  return fmt::format(
      "is no rotation: products of its columns are {:.2g} off, and {} is what rounding may leave", off,
      kLargestRounding);
}

bool is_no_rotation(const ordered_json& rows) {
  return is_matrix(rows) && !is_far(unchecked(rows)) && !turns(unchecked(rows).rotation);
}

std::string read_json_text(const std::string& path, const std::string& mend) {
  std::string text = read_file(path);
  if (json_depth(text) > kDeepestJson)
    throw InputError(path, fmt::format("its JSON is nested deeper than {}", kDeepestJson), mend);
  return text;
}

std::string json_fault(const std::string& text) {
  try {
    [[maybe_unused]] const ordered_json none = ordered_json::parse(text);
  } catch (const ordered_json::parse_error& error) {
    const std::string_view before =
        std::string_view(text).substr(0, std::max<std::size_t>(1, error.byte) - 1);
    const std::string_view line =
        before.substr(before.rfind('\n') + 1);  // all of it where there is no line end
    const auto is_letter = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; };
    return fmt::format("line {}, column {}", 1 + std::ranges::count(before, '\n'),
                       1 + std::ranges::count_if(line, is_letter));
  } catch (const ordered_json::exception&) {
  }
  return "a number is beyond what one holds";
}

std::string text_of(const ordered_json& json) {
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace rejoin::cli
