#include "mesh/detail/writers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <iterator>

namespace rejoin::mesh::detail {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PLY is written little-endian");

template <class T>
void append(std::string& bytes, const T& value) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  bytes.append(raw.data(), raw.size());
}

std::string ply_header(const Soup& soup, bool doubles) {
  const char* real = doubles ? "double" : "float";
  std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment rejoin\nelement vertex {0}\n"
      "property {1} x\nproperty {1} y\nproperty {1} z\n",
      soup.points.size(), real);
  if (!soup.normals.empty()) header += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!soup.colours.empty()) header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  if (!soup.sizes.empty()) {
    header += fmt::format("element face {}\nproperty list uchar int vertex_indices\n", soup.sizes.size());
  }
  return header + "end_header\n";
}

/// Shortest text that reads back as the same number.
void append_triple(std::string& text, const glm::dvec3& value, bool doubles) {
  if (doubles) {
    fmt::format_to(std::back_inserter(text), " {} {} {}", value.x, value.y, value.z);
  } else {
    const glm::vec3 rounded(value);
    fmt::format_to(std::back_inserter(text), " {} {} {}", rounded.x, rounded.y, rounded.z);
  }
}

}  // namespace

bool is_far(const Soup& soup) {
  if (soup.points.empty()) return false;
  glm::dvec3 low = soup.points.front();
  glm::dvec3 high = low;
  for (const glm::dvec3& point : soup.points) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  const glm::dvec3 furthest = glm::max(glm::abs(low), glm::abs(high));
  return std::max({furthest.x, furthest.y, furthest.z}) > 8 * glm::length(high - low);
}

std::string write_ply(const Soup& soup) {
  const bool doubles = is_far(soup);
  std::string bytes = ply_header(soup, doubles);
  bytes.reserve(bytes.size() + 40 * soup.points.size() + 13 * soup.sizes.size());
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    if (doubles) {
      append(bytes, soup.points[i]);
    } else {
      append(bytes, glm::vec3(soup.points[i]));
    }
    if (!soup.normals.empty()) append(bytes, soup.normals[i]);
    if (!soup.colours.empty()) append(bytes, soup.colours[i]);
  }
  for (std::size_t i = 0; i + 2 < soup.corners.size(); i += 3) {
    append(bytes, std::uint8_t{3});
    for (std::size_t k = 0; k < 3; ++k) append(bytes, static_cast<std::int32_t>(soup.corners[i + k]));
  }
  return bytes;
}

std::string write_obj(const Soup& soup) {
  const bool doubles = is_far(soup);
  std::string text = "# rejoin\n";
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    text += 'v';
    append_triple(text, soup.points[i], doubles);
    // Four decimals tell all 256 levels apart.
    if (!soup.colours.empty()) {
      const glm::dvec3 colour = glm::dvec3(soup.colours[i]) / 255.0;
      fmt::format_to(std::back_inserter(text), " {:.4f} {:.4f} {:.4f}", colour.x, colour.y, colour.z);
    }
    text += '\n';
  }
  for (const glm::vec3& normal : soup.normals) {
    text += "vn";
    append_triple(text, glm::dvec3(normal), false);
    text += '\n';
  }
  for (std::size_t i = 0; i + 2 < soup.corners.size(); i += 3) {
    text += 'f';
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t corner = soup.corners[i + k] + 1;
      if (soup.normals.empty()) {
        fmt::format_to(std::back_inserter(text), " {}", corner);
      } else {
        fmt::format_to(std::back_inserter(text), " {}//{}", corner, corner);
      }
    }
    text += '\n';
  }
  return text;
}

}  // namespace rejoin::mesh::detail
