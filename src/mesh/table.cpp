#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/rigid.hpp"
#include "mesh/bodies.hpp"
#include "mesh/detail/parts.hpp"

namespace rejoin::mesh {
namespace {

constexpr double kLayer = 0.01;   // thickness of what is taken for the plane, of the diagonal
constexpr double kPlane = 0.2;    // of the whole area, at least
constexpr double kPiece = 0.05;   // of the whole area, at least, stands on it
constexpr double kBehind = 0.08;  // of the whole area, at most, lies behind it

/// A face and its area vector.
struct Plate {
  std::array<glm::dvec3, 3> corners;
  glm::dvec3 facing;

  double area() const { return glm::length(facing); }
  glm::dvec3 middle() const { return (corners[0] + corners[1] + corners[2]) / 3.0; }
};

std::vector<Plate> plates_of(const Mesh& mesh) {
  std::vector<Plate> plates;
  plates.reserve(mesh.faces.size());
  for (const glm::uvec3& face : mesh.faces) {
    const glm::dvec3 a(mesh.vertices[face.x]);
    const glm::dvec3 b(mesh.vertices[face.y]);
    const glm::dvec3 c(mesh.vertices[face.z]);
    plates.push_back({{a, b, c}, 0.5 * glm::cross(b - a, c - a)});
  }
  return plates;
}

/// The cell of a cube about the origin through which a direction passes.
std::size_t cell_of(const glm::dvec3& v, std::size_t cells) {
  const glm::dvec3 size = glm::abs(v);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto step = [&](double value) {
    const double at = (value / size[axis] + 1.0) / 2.0 * static_cast<double>(cells);
    return std::min(static_cast<std::size_t>(at), cells - 1);
  };
  const std::size_t side = 2 * static_cast<std::size_t>(axis) + (v[axis] < 0 ? 1 : 0);
  return (side * cells + step(v[(axis + 1) % 3])) * cells + step(v[(axis + 2) % 3]);
}

/// The direction in which most of the surface faces.
glm::dvec3 fullest_direction(const std::vector<Plate>& plates) {
  constexpr std::size_t kCells = 8;
  std::vector<glm::dvec3> cells(6 * kCells * kCells, glm::dvec3(0.0));
  for (const Plate& plate : plates) {
    if (plate.area() > 0) cells[cell_of(plate.facing, kCells)] += plate.facing;
  }
  glm::dvec3 mean =
      *std::ranges::max_element(cells, {}, [](const glm::dvec3& cell) { return glm::length(cell); });
  for (const double cosine :
       {0.9, 0.97, 0.99}) {  // nearer and nearer, as what is tilted a little is not of the plane
    const glm::dvec3 up = glm::normalize(mean);
    mean = glm::dvec3(0.0);
    for (const Plate& plate : plates) {
      if (glm::dot(plate.facing, up) > cosine * plate.area()) mean += plate.facing;
    }
    if (glm::length(mean) == 0) return up;
  }
  return glm::normalize(mean);
}

/// The height along `up` at which a table lies if there is one: little lies below it, and it takes up more than the rest of this share.
double height_of_table(const std::vector<Plate>& plates, const glm::dvec3& up) {
  constexpr double kLowest = 0.5 * (kBehind + kPlane);
  std::vector<std::pair<double, double>> heights;  // and areas
  double all = 0;
  for (const Plate& plate : plates) {
    heights.emplace_back(glm::dot(plate.middle(), up), plate.area());
    all += plate.area();
  }
  std::ranges::sort(heights);
  double below = 0;
  for (const auto& [height, area] : heights) {
    below += area;
    if (below >= kLowest * all) return height;
  }
  return heights.back().first;
}

constexpr std::size_t kAround = 16;
/// How far something reaches in directions all round.
using Reach = std::array<double, kAround>;

Reach of_nothing() {
  Reach reach{};
  reach.fill(-std::numeric_limits<double>::infinity());
  return reach;
}

std::array<glm::dvec3, kAround> directions_about(const glm::dvec3& up) {
  const glm::dmat3 frame = frame_of(up);
  std::array<glm::dvec3, kAround> directions{};
  for (std::size_t k = 0; k < kAround; ++k) {
    const double turn = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(kAround);
    directions[k] = frame[0] * std::cos(turn) + frame[1] * std::sin(turn);
  }
  return directions;
}

/// The share of a part that is a plane and takes up much of the whole, beside others, whichever way it faces; 0: there is none.
double flat_part(const Mesh& mesh) {
  constexpr double kMuch = 0.3;
  constexpr double kOthers = 0.01;
  constexpr double kFlat = 0.995;  // of a part's area that is left of it when looked at from the front
  const std::vector<detail::Part> parts = detail::measured_parts(mesh, detail::part_of_faces(mesh));
  double all = 0;
  for (const detail::Part& part : parts) all += part.weight;
  for (const detail::Part& part : parts) {
    if (part.weight > kMuch * all && part.weight < (1.0 - kOthers) * all &&
        glm::length(part.facing) > kFlat * part.weight)
      return part.weight / all;
  }
  return 0;
}

}  // namespace

double table(const Mesh& mesh) {
  if (const double share = flat_part(mesh); share > 0) return share;
  const std::vector<Plate> plates = plates_of(mesh);
  const glm::dvec3 up = fullest_direction(plates);
  const Box box = bounds(mesh);
  const double layer = kLayer * glm::distance(glm::dvec3(box.low), glm::dvec3(box.high));
  const double height = height_of_table(plates, up);
  const std::array<glm::dvec3, kAround> directions = directions_about(up);
  Reach of_plane = of_nothing();
  Reach of_rest = of_nothing();
  double plane = 0;
  double front = 0;
  double behind = 0;
  for (const Plate& plate : plates) {
    const double above = glm::dot(plate.middle(), up) - height;
    const bool in_plane = std::abs(above) <= layer;
    (in_plane ? plane : above > 0 ? front : behind) += plate.area();
    Reach& reach = in_plane ? of_plane : of_rest;
    for (std::size_t k = 0; k < kAround; ++k) {
      for (const glm::dvec3& corner : plate.corners)
        reach[k] = std::max(reach[k], glm::dot(corner, directions[k]));
    }
  }
  const double all = plane + front + behind;
  if (plane < kPlane * all || front < kPiece * all || behind > kBehind * all) return 0;
  const bool beyond = std::ranges::equal(
      of_plane, of_rest, [layer](double of_plane, double of_rest) { return of_plane > of_rest + layer; });
  return beyond ? plane / all : 0;
}

}  // namespace rejoin::mesh
