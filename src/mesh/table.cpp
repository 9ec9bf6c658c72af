#include "mesh/table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "core/random.hpp"
#include "core/rigid.hpp"
#include "mesh/detail/local_fit.hpp"
#include "mesh/detail/parts.hpp"

namespace rejoin::mesh {
namespace {

constexpr double kPlane = 0.2;    // of the whole, at least
constexpr double kBehind = 0.08;  // of the whole, at most, lies behind it
constexpr double kLayer =
    0.01;  // of the diagonal: thickness at most, and by how much it reaches beyond the rest
constexpr double kFlat = 0.995;  // of a part's area that is left of it when looked at from the front: a sheet
constexpr double kUneven =
    0.3;  // of the plane's share, at most, lies up to as far again above it: else it is bent, and taken thicker
constexpr std::array kThicknesses{1.0, 2.0, 4.0};  // spacings
constexpr double kOutmost = 0.02;  // of the rest, by which sides are not judged: bits of noise

/// Points spread over the surface by area, each with the normal of its face.
struct Spread {
  std::vector<glm::vec3> points;
  std::vector<glm::vec3> normals;  ///< 0: may face either way

  std::size_t size() const { return points.size(); }
};

/// Which faces belong to flat parts, whose backs may have been taken for their fronts.
std::vector<bool> faces_of_sheets(const Mesh& mesh) {
  const std::vector<std::uint32_t> part_of_face = detail::part_of_faces(mesh);
  const std::vector<detail::Part> parts = detail::measured_parts(mesh, part_of_face);
  std::vector<bool> result(mesh.faces.size());
  for (std::size_t f = 0; f < result.size(); ++f) {
    const detail::Part& part = parts[part_of_face[f]];
    result[f] = glm::length(part.facing) > kFlat * part.weight;
  }
  return result;
}

glm::vec3 point_of_face(const Mesh& mesh, const glm::uvec3& face, Random& random) {
  const auto root = static_cast<float>(std::sqrt(random.uniform()));
  const auto along = static_cast<float>(random.uniform());
  const glm::vec3 side = glm::mix(mesh.vertices[face.y], mesh.vertices[face.z], along);
  return glm::mix(mesh.vertices[face.x], side, root);
}

Spread spread_over(const Mesh& scan, const std::vector<bool>& of_sheet) {
  constexpr std::size_t kSamples = 5000;
  Random random(1);
  Spread spread;
  if (scan.is_cloud()) {
    const std::size_t step = 1 + scan.vertices.size() / kSamples;
    for (std::size_t i = 0; i < scan.vertices.size(); i += step) spread.points.push_back(scan.vertices[i]);
    spread.normals.resize(spread.size(), glm::vec3(0.0F));
    return spread;
  }
  const std::vector<glm::vec3> normals = face_normals(scan);
  const double step = surface_area(scan) / static_cast<double>(kSamples);
  double due = random.uniform() * step;
  for (std::size_t f = 0; f < scan.faces.size(); ++f) {
    const glm::uvec3& face = scan.faces[f];
    const glm::dvec3 a(scan.vertices[face.x]);
    const double area = 0.5 * glm::length(glm::cross(glm::dvec3(scan.vertices[face.y]) - a,
                                                     glm::dvec3(scan.vertices[face.z]) - a));
    for (due -= area; due < 0; due += step) {
      spread.points.push_back(point_of_face(scan, face, random));
      spread.normals.push_back(of_sheet[f] ? glm::vec3(0.0F) : normals[f]);
    }
  }
  return spread;
}

bool faces_up(const glm::vec3& normal, const glm::vec3& up) {
  return normal == glm::vec3(0.0F) || glm::dot(normal, up) > static_cast<float>(kFacesUp);
}

/// What of a scan lies where, as shares of it.
struct Sides {
  double plane = 0;
  double front = 0;
  double above = 0;  ///< of the front: what faces up within two thicknesses
  double behind = 0;
};

Sides sides_of(const Spread& spread, const Table& table) {
  const glm::vec3 up(table.up);
  Sides sides;
  for (std::size_t i = 0; i < spread.size(); ++i) {
    const double height = static_cast<double>(glm::dot(spread.points[i], up)) - table.height;
    if (height < -table.thickness) {
      sides.behind += 1;
    } else if (height > table.thickness) {
      sides.front += 1;
      if (height < 2 * table.thickness && faces_up(spread.normals[i], up)) sides.above += 1;
    } else if (faces_up(spread.normals[i], up)) {
      sides.plane += 1;
    }
  }
  const auto all = static_cast<double>(spread.size());
  return {sides.plane / all, sides.front / all, sides.above / all, sides.behind / all};
}

/// Looks for the plane of one thickness.
class PlaneSearch {
 public:
  PlaneSearch(const Spread& spread, double thickness, double least_front)
      : spread_(spread), thickness_(thickness), least_front_(least_front) {}

  /// Planes through three points at a time (RANSAC), the one with most of the surface, fitted to it.
  std::optional<Table> search(double diagonal) const {
    constexpr int kDraws = 2000;  // 16 of them lie in a plane that has a fifth
    Random random(2);
    std::optional<Table> best;
    for (int draw = 0; draw < kDraws; ++draw) {
      const glm::dvec3 a = drawn(random);
      const glm::dvec3 across = glm::cross(drawn(random) - a, drawn(random) - a);
      const double length = glm::length(across);
      if (length < kLayer * diagonal * diagonal) continue;  // three that are near each other say little
      const glm::dvec3 normal = across / length;
      if (!is_promising(normal, glm::dot(normal, a))) continue;
      for (const glm::dvec3& up : {normal, -normal}) keep_better({up, glm::dot(up, a), thickness_, 0}, best);
    }
    return best ? fitted(*best) : std::nullopt;
  }

 private:
  glm::dvec3 drawn(Random& random) const {
    return glm::dvec3(spread_.points[random.below(static_cast<std::uint32_t>(spread_.size()))]);
  }

  /// By a few of the points, whether the plane may have enough of them.
  bool is_promising(const glm::dvec3& normal, double height) const {
    constexpr std::size_t kFew = 200;
    const glm::vec3 up(normal);
    const std::size_t step = 1 + spread_.size() / kFew;
    std::size_t near = 0;
    std::size_t all = 0;
    for (std::size_t i = 0; i < spread_.size(); i += step, ++all)
      near += std::abs(static_cast<double>(glm::dot(spread_.points[i], up)) - height) <= thickness_ ? 1 : 0;
    return static_cast<double>(near) > 0.5 * kPlane * static_cast<double>(all);
  }

  bool is_table(const Sides& sides) const {
    return sides.plane >= kPlane && sides.behind <= kBehind && sides.behind < sides.front &&
           sides.front >= least_front_;
  }

  void keep_better(Table table, std::optional<Table>& best) const {
    const Sides sides = sides_of(spread_, table);
    table.share = sides.plane;
    if (is_table(sides) && (!best || sides.plane > best->share)) best = table;
  }

  std::optional<Table> fitted(Table table) const {
    constexpr int kRounds = 8;
    for (int round = 0; round < kRounds; ++round) {
      std::vector<std::uint32_t> chosen;
      glm::dvec3 sum(0.0);
      for (std::uint32_t i = 0; i < spread_.size(); ++i) {
        const glm::dvec3 point(spread_.points[i]);
        if (std::abs(glm::dot(point, table.up) - table.height) > table.thickness ||
            !faces_up(spread_.normals[i], glm::vec3(table.up)))
          continue;
        chosen.push_back(i);
        sum += point;
      }
      if (chosen.size() < 3) return std::nullopt;
      const glm::dvec3 normal(detail::plane_normal(spread_.points, chosen));
      table.up = glm::dot(normal, table.up) < 0 ? -normal : normal;
      table.height = glm::dot(sum / static_cast<double>(chosen.size()), table.up);
    }
    const Sides sides = sides_of(spread_, table);
    table.share = sides.plane;
    return is_table(sides) ? std::optional(table) : std::nullopt;
  }

  const Spread& spread_;
  double thickness_;
  double least_front_;
};

constexpr std::size_t kAround = 16;

std::array<glm::dvec3, kAround> directions_about(const glm::dvec3& up) {
  const glm::dmat3 frame = frame_of(up);
  std::array<glm::dvec3, kAround> directions{};
  for (std::size_t k = 0; k < kAround; ++k) {
    const double turn = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(kAround);
    directions[k] = frame[0] * std::cos(turn) + frame[1] * std::sin(turn);
  }
  return directions;
}

/// How far the plane itself reaches along a direction.
double reach_of_plane(const Mesh& scan, const Table& table, const glm::dvec3& direction) {
  double reach = -std::numeric_limits<double>::infinity();
  for (const glm::vec3& vertex : scan.vertices) {
    const glm::dvec3 point(vertex);
    if (std::abs(glm::dot(point, table.up) - table.height) <= table.thickness)
      reach = std::max(reach, glm::dot(point, direction));
  }
  return reach;
}

/// The same of what lies clearly off it, but for the outmost bits.
double reach_of_rest(const Spread& spread, const Table& table, const glm::dvec3& direction) {
  std::vector<double> along;
  for (const glm::vec3& sample : spread.points) {
    const glm::dvec3 point(sample);
    if (std::abs(glm::dot(point, table.up) - table.height) > 2 * table.thickness)
      along.push_back(glm::dot(point, direction));
  }
  if (along.empty()) return -std::numeric_limits<double>::infinity();
  const auto at = along.end() - 1 - static_cast<std::ptrdiff_t>(kOutmost * static_cast<double>(along.size()));
  std::nth_element(along.begin(), at, along.end());
  return *at;
}

bool reaches_beyond(const Mesh& scan, const Spread& spread, const Table& table, double room) {
  return std::ranges::all_of(directions_about(table.up), [&](const glm::dvec3& direction) {
    return reach_of_plane(scan, table, direction) > reach_of_rest(spread, table, direction) + room;
  });
}

}  // namespace

std::optional<Table> find_table(const Mesh& scan, const TableOptions& options) {
  const Box box = bounds(scan);
  const double diagonal = glm::distance(glm::dvec3(box.low), glm::dvec3(box.high));
  const double spacing = resolution(scan);
  const Spread spread = spread_over(scan, scan.is_cloud() ? std::vector<bool>() : faces_of_sheets(scan));
  std::optional<Table> first;
  for (const double times : kThicknesses) {
    const double thickness = times * spacing;
    if (times > kThicknesses.front() && thickness > kLayer * diagonal) break;
    std::optional<Table> table = PlaneSearch(spread, thickness, options.least_front).search(diagonal);
    if (!table || (options.beyond && !reaches_beyond(scan, spread, *table, kLayer * diagonal))) continue;
    if (sides_of(spread, *table).above <= kUneven * table->share) return table;
    if (!first) first = table;
  }
  return first;
}

}  // namespace rejoin::mesh
