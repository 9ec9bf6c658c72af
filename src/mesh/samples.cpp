#include "mesh/samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace rejoin::mesh {
namespace {

constexpr double kCellsOfPlane =
    1.5;  // of the grid that a plane cuts for every cell's face of area that it has, about

struct Cell {
  glm::dvec3 sum{0.0};
  int count = 0;
  float best = std::numeric_limits<float>::max();
  glm::vec3 point{0.0F};
  std::uint32_t face = 0;
};

struct Dart {
  std::uint64_t cell;
  glm::vec3 point;
  std::uint32_t face;
};

std::uint64_t cell_of(const glm::vec3& point, const glm::vec3& low, float spacing) {
  const glm::uvec3 cell((point - low) / spacing);
  return (static_cast<std::uint64_t>(cell.x) << 42U) | (static_cast<std::uint64_t>(cell.y) << 21U) | cell.z;
}

/// Of a number >= 0.
double fraction(double x) {
  return x - std::floor(x);
}

/// Twice a triangle's area: in floats, whose rounding all samples so far follow, but where a float's square would vanish.
double doubled_area(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  constexpr float kLeast = 1e-15F;
  const float length = glm::length(glm::cross(b - a, c - a));
  if (length > kLeast) return static_cast<double>(length);
  return glm::length(glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a)));
}

/// About `per_area` points a unit of area: every face gets its share (rounded by carrying the remainder on),
/// placed by a Kronecker sequence with the plastic number (Roberts 2018), which fills a triangle evenly.
std::vector<Dart> throw_darts(const Mesh& mesh, double per_area, const glm::vec3& low, float spacing) {
  std::vector<Dart> darts;
  double carried = 0.5;
  std::uint64_t index = 0;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    const glm::uvec3 face = mesh.faces[f];
    const glm::vec3 a = mesh.vertices[face.x];
    const glm::vec3 b = mesh.vertices[face.y];
    const glm::vec3 c = mesh.vertices[face.z];
    carried += 0.5 * doubled_area(a, b, c) * per_area;
    while (carried >= 1.0) {
      double u = fraction(0.5 + 0.7548776662466927 * static_cast<double>(index));
      double v = fraction(0.5 + 0.5698402909980532 * static_cast<double>(index));
      if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      const glm::vec3 point = a + static_cast<float>(u) * (b - a) + static_cast<float>(v) * (c - a);
      darts.push_back({cell_of(point, low, spacing), point, f});
      carried -= 1.0;
      ++index;
    }
  }
  return darts;
}

}  // namespace

Samples sample_surface(const Mesh& mesh, std::size_t count) {
  Samples samples;
  const double area = surface_area(mesh);
  const Box box = bounds(mesh);
  samples.spacing = std::sqrt(kCellsOfPlane * area / static_cast<double>(std::max<std::size_t>(count, 1)));
  const auto spacing = static_cast<float>(samples.spacing);
  const glm::vec3 low = box.low - glm::vec3(spacing);
  const auto darts = throw_darts(mesh, 6.0 / (samples.spacing * samples.spacing), low, spacing);

  std::unordered_map<std::uint64_t, std::uint32_t> slot_of;
  std::vector<Cell> cells;
  slot_of.reserve(count * 2);
  const auto cell_at = [&](std::uint64_t key) -> Cell& {
    const auto [place, fresh] = slot_of.try_emplace(key, static_cast<std::uint32_t>(cells.size()));
    if (fresh) cells.emplace_back();
    return cells[place->second];
  };
  for (const Dart& dart : darts) {
    Cell& cell = cell_at(dart.cell);
    cell.sum += glm::dvec3(dart.point);
    ++cell.count;
  }
  for (const Dart& dart : darts) {
    Cell& cell = cell_at(dart.cell);
    const float off = glm::distance(dart.point, glm::vec3(cell.sum / static_cast<double>(cell.count)));
    if (off >= cell.best) continue;
    cell.best = off;
    cell.point = dart.point;
    cell.face = dart.face;
  }
  const auto normals = face_normals(mesh);
  const double of_dart = area / static_cast<double>(std::max<std::size_t>(1, darts.size()));
  for (const Cell& cell : cells) {
    samples.areas.push_back(static_cast<float>(of_dart * cell.count));
    samples.points.push_back(cell.point);
    samples.normals.push_back(normals[cell.face]);
    samples.faces.push_back(cell.face);
  }
  return samples;
}

std::size_t count_at(const Mesh& mesh, double spacing) {
  return static_cast<std::size_t>(std::ceil(kCellsOfPlane * surface_area(mesh) / (spacing * spacing)));
}

}  // namespace rejoin::mesh
