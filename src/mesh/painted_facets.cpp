#include "mesh/painted_facets.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "mesh/detail/facet_table.hpp"
#include "mesh/point_index.hpp"

namespace rejoin::mesh {
namespace {

constexpr int kGrey = 24;         // channels of a grey differ by at most this
constexpr int kDark = 100;        // a grey below this is no original surface
constexpr double kCovered = 0.9;  // of the fragment lies on the painted surface, at least
constexpr double kNear = 1.5;  // sample spacings between a sample and the painted surface's nearest, at most
constexpr double kDenser = 4.0;  // samples of the painted surface for one of the fragment

/// What a sample belongs to: a colour's facet, or an original facet.
struct Paint {
  bool known = false;  // false: nothing painted is near
  bool facet = true;   // false: in no facet
  bool fracture = true;
  int number = 0;  // the colour, or the facet that it was

  auto key() const { return std::tuple(!fracture, number); }
};

glm::u8vec3 colour_of(const Mesh& mesh, std::uint32_t face) {
  const glm::uvec3 corners = mesh.faces[face];
  const glm::u8vec3 a = mesh.colours[corners.x];
  const glm::u8vec3 b = mesh.colours[corners.y];
  const glm::u8vec3 c = mesh.colours[corners.z];
  return b == c ? b : a;
}

Paint paint_of(glm::u8vec3 colour, int found, Surface surface) {
  const auto [low, high] =
      std::minmax({static_cast<int>(colour.x), static_cast<int>(colour.y), static_cast<int>(colour.z)});
  if (high - low > kGrey) return {true, true, true, (colour.x << 16) | (colour.y << 8) | colour.z};
  if (high < kDark) return {true, false, surface == Surface::Fracture, 0};
  return {true, true, false, found};
}

std::vector<Paint> paint_samples(const Segmentation& s, const glm::dvec3& origin, const Mesh& painted) {
  const auto count = static_cast<std::size_t>(kDenser * static_cast<double>(s.samples.size()));
  const Samples dense = sample_surface(painted, count);
  const PointIndex index(dense.points);
  const glm::vec3 shift(origin - painted.origin);
  const auto reach = static_cast<float>(kNear * s.samples.spacing);
  std::vector<Paint> paints(s.samples.size());
  std::vector<std::uint32_t> near;
  for (std::size_t i = 0; i < s.samples.size(); ++i) {
    const glm::vec3 point = s.samples.points[i] + shift;
    index.nearest(point, 8, near);
    for (const auto k : near) {
      if (glm::distance(point, dense.points[k]) > reach) break;
      if (glm::dot(s.normals[i], dense.normals[k]) < 0.0F) continue;  // the other wall of a thin piece
      paints[i] = paint_of(colour_of(painted, dense.faces[k]), s.facet_of_sample[i], s.surface[i]);
      break;
    }
  }
  return paints;
}

}  // namespace

std::optional<PaintedFacets> painted_facets(const Segmentation& segmentation, const glm::dvec3& origin,
                                            const Mesh& painted) {
  const std::vector<Paint> paints = paint_samples(segmentation, origin, painted);
  const auto known = std::count_if(paints.begin(), paints.end(), [](const Paint& p) { return p.known; });
  if (static_cast<double>(known) < kCovered * static_cast<double>(paints.size())) return std::nullopt;

  PaintedFacets painted_ones{segmentation, 0};
  Segmentation& result = painted_ones.segmentation;
  std::map<std::tuple<bool, int>, std::vector<std::uint32_t>> groups;
  for (std::uint32_t i = 0; i < paints.size(); ++i) {
    if (!paints[i].known) continue;
    result.surface[i] = paints[i].fracture ? Surface::Fracture : Surface::Original;
    if (paints[i].facet) groups[paints[i].key()].push_back(i);
  }
  std::vector<std::vector<std::uint32_t>> members;
  for (auto& [key, samples] : groups) {
    if (2 * samples.size() >= detail::smallest_facet(result)) {
      members.push_back(std::move(samples));
    } else if (result.surface[samples.front()] == Surface::Fracture) {
      ++painted_ones.left_out;
    }
  }
  static_cast<Cut&>(result) = detail::cut_into(result, std::move(members));
  result.creased = {};
  result.backed.assign(result.backed.size(), true);  // what is painted as broken is no wall
  return painted_ones;
}

}  // namespace rejoin::mesh
