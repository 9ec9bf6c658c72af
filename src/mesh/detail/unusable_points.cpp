#include "mesh/detail/unusable_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace rejoin::mesh::detail {
namespace {

// Coordinates end up as floats, of which fourth powers are taken: what overflows one then is as bad as an infinity.
constexpr double kLargest = 1e12;
// What may be lost: one in so many faces, or points of a cloud, for some scanners write a grid with NaN where they saw nothing.
constexpr std::size_t kOneFaceIn = 10;
constexpr std::size_t kOnePointIn = 2;

bool is_finite(const glm::dvec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

bool is_usable(const glm::dvec3& p) {
  return is_finite(p) && glm::all(glm::lessThan(glm::abs(p), glm::dvec3(kLargest)));
}

[[noreturn]] void refuse(const std::string& name, std::size_t vertex, const glm::dvec3& p) {
  throw InputError(name,
                   fmt::format("vertex {} is not a finite point{} ({}, {}, {})", vertex,
                               is_finite(p) ? fmt::format(" within {:g}", kLargest) : "", p.x, p.y, p.z),
                   "remove it in the scanning software");
}

/// \return how many faces went
std::size_t drop_faces(Soup& soup, const std::vector<bool>& usable) {
  std::size_t kept_faces = 0;
  std::size_t kept_corners = 0;
  std::size_t at = 0;
  for (const std::uint32_t size : soup.sizes) {
    const auto begin = soup.corners.begin() + static_cast<std::ptrdiff_t>(at);
    at += size;
    if (!std::all_of(begin, begin + size, [&](std::uint32_t corner) { return usable[corner]; })) continue;
    std::copy(begin, begin + size, soup.corners.begin() + static_cast<std::ptrdiff_t>(kept_corners));
    kept_corners += size;
    soup.sizes[kept_faces++] = size;
  }
  const std::size_t dropped = soup.sizes.size() - kept_faces;
  soup.sizes.resize(kept_faces);
  soup.corners.resize(kept_corners);
  return dropped;
}

template <class Value>
void keep(std::vector<Value>& values, const std::vector<bool>& usable) {
  if (values.empty()) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < usable.size(); ++i) {
    if (usable[i]) values[kept++] = values[i];
  }
  values.resize(kept);
}

/// \pre no face uses one of them
void drop_points(Soup& soup, const std::vector<bool>& usable) {
  std::vector<std::uint32_t> number(usable.size());
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < usable.size(); ++i) number[i] = usable[i] ? kept++ : 0;
  for (std::uint32_t& corner : soup.corners) corner = number[corner];
  keep(soup.points, usable);
  keep(soup.normals, usable);
  keep(soup.colours, usable);
  keep(soup.places, usable);
}

}  // namespace

void leave_out_unusable_points(Soup& soup, const std::string& name, std::vector<std::string>& warnings) {
  const auto first = std::ranges::find_if_not(soup.points, is_usable);
  if (first == soup.points.end()) return;
  const auto vertex = static_cast<std::size_t>(first - soup.points.begin());
  const glm::dvec3 point = *first;
  std::vector<bool> usable(soup.points.size());
  std::transform(soup.points.begin(), soup.points.end(), usable.begin(), is_usable);
  const auto bad = static_cast<std::size_t>(std::ranges::count(usable, false));
  const std::size_t points = soup.points.size();
  const std::size_t faces = soup.sizes.size();
  const std::size_t lost = drop_faces(soup, usable);
  if (faces > 0 ? kOneFaceIn * lost > faces : kOnePointIn * bad > points) refuse(name, vertex, point);
  drop_points(soup, usable);
  const char* what = faces > 0 ? "vertices" : "points";
  std::string text = fmt::format("{}: left out {} of {} {} that are not finite", name, bad, points, what);
  if (faces > 0)
    text += lost > 0 ? fmt::format(", with {} of {} faces", lost, faces) : ", which no face uses";
  warnings.push_back(text + " (remove them in the scanning software)");
}

}  // namespace rejoin::mesh::detail
