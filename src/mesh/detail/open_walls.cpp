#include "mesh/detail/open_walls.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/components.hpp"
#include "core/median.hpp"
#include "mesh/detail/creases.hpp"
#include "mesh/point_index.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr double kInner = 0.9;    // share of a facet's samples that lie nearer to its edge than its middle
constexpr float kBehind = -0.5F;  // cosine of normals from which one sample lies behind the other
constexpr float kBent = 0.94F;    // cosine of normals beside each other across a crease, at most
constexpr double kHole = 0.1;     // of the longest border: shorter ones are holes
// A solid piece of which a side is missing must not become a sherd, for most of its breaks would be walls; a sherd that is taken
// as a solid piece still joins.
constexpr double kAround = 0.78;  // share of the end of the scan that lies at breaks, of a sherd
constexpr double kSheet = 0.52;   // flatness of a sherd
constexpr double kSharp =
    0.11;  // share of the creases beside its walls that have walls on both sides, of a sherd
constexpr int kMostParts = 1000;  // of an edge
constexpr double kEnded =
    0.25;  // share of a break's samples that are nearer to the end of the scan than to a crease

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Edges that have a face on one side only.
std::vector<Edge> open_edges(const Mesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.faces.size());
  for (const glm::uvec3& f : mesh.faces) {
    for (const Edge& e : {Edge(f.x, f.y), Edge(f.y, f.z), Edge(f.z, f.x)})
      edges.push_back(std::minmax(e.first, e.second));
  }
  std::sort(edges.begin(), edges.end());
  std::vector<Edge> open;
  for (std::size_t k = 0, next = 0; k < edges.size(); k = next) {
    next = k + 1;
    while (next < edges.size() && edges[next] == edges[k]) ++next;
    if (next - k == 1) open.push_back(edges[k]);
  }
  return open;
}

/// Points where the scan ends, no farther apart than `step`: along its long borders, not around holes.
std::vector<glm::vec3> ends_of_scan(const Mesh& mesh, double step) {
  const std::vector<Edge> open = open_edges(mesh);
  const auto length = [&](const Edge& e) {
    return static_cast<double>(glm::distance(mesh.vertices[e.first], mesh.vertices[e.second]));
  };
  Components borders(mesh.vertices.size());
  for (const Edge& e : open) borders.unite(e.first, e.second);
  std::vector<double> length_of(mesh.vertices.size(), 0.0);
  for (const Edge& e : open) length_of[borders.of(e.first)] += length(e);
  const double longest = length_of.empty() ? 0.0 : *std::ranges::max_element(length_of);
  std::vector<glm::vec3> points;
  for (const Edge& e : open) {
    if (length_of[borders.of(e.first)] < kHole * longest) continue;
    // Samples of a mesh of needles lie much closer than its edges are long.
    const int parts =
        length(e) < kMostParts * step ? static_cast<int>(std::ceil(length(e) / step)) : kMostParts;
    for (int i = 0; i < parts; ++i) {
      points.push_back(glm::mix(mesh.vertices[e.first], mesh.vertices[e.second],
                                static_cast<float>(i) / static_cast<float>(parts)));
    }
  }
  return points;
}

/// How far a facet's samples lie from its creases and from the end of the scan.
struct Span {
  double width = 0;  ///< of the facet, mesh units; infinity if it has neither
  double ended = 0;  ///< share of its samples that are nearer to the end of the scan than to a crease
};

std::vector<int> facets_of_samples(const Ground& ground,
                                   const std::vector<std::vector<std::uint32_t>>& facets) {
  std::vector<int> facet_of(ground.points.size(), -1);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    for (const auto i : facets[f]) facet_of[i] = static_cast<int>(f);
  }
  return facet_of;
}

/// Whether the surface bends sharply between two samples beside each other.
bool bends(const Ground& ground, std::uint32_t i, std::uint32_t k) {
  const float along = glm::dot(ground.normals[i], ground.normals[k]);
  return along > kBehind && along < kBent;
}

class Ruler {
 public:
  Ruler(const Ground& ground, const std::vector<std::vector<std::uint32_t>>& facets, const PointIndex& ends)
      : ground_(ground), ends_(ends), facet_of_(facets_of_samples(ground, facets)) {}

  Span span_of(const std::vector<std::uint32_t>& facet) const {
    const PointIndex creases(beyond_creases(facet));
    constexpr float kFar = std::numeric_limits<float>::infinity();
    std::vector<float> inwards;
    std::size_t ended = 0;
    for (const auto i : facet) {
      const auto crease = creases.nearest(ground_.points[i]);
      const auto end = ends_.nearest(ground_.points[i]);
      const float to_crease = crease ? crease->second : kFar;
      const float to_end = end ? end->second : kFar;
      ended += to_end < to_crease ? 1 : 0;
      inwards.push_back(std::min(to_crease, to_end));
    }
    const auto count = static_cast<double>(facet.size());
    return {2.0 * static_cast<double>(quantile(inwards, kInner)) / kInner,
            static_cast<double>(ended) / count};
  }

 private:
  /// Samples of other facets beside the facet's own, where the surface bends between them.
  std::vector<glm::vec3> beyond_creases(const std::vector<std::uint32_t>& facet) const {
    std::vector<glm::vec3> beyond;
    for (const auto i : facet) {
      for (const auto k : ground_.near[i]) {
        if (facet_of_[k] != facet_of_[i] && bends(ground_, i, k)) beyond.push_back(ground_.points[k]);
      }
    }
    return beyond;
  }

  const Ground& ground_;
  const PointIndex& ends_;
  std::vector<int> facet_of_;
};

/// A break.
struct Strip {
  double width;
  double length;
};

/// The width that half of the breaks' length does not reach; 0 if there are none.
double middle_width(std::vector<Strip> strips) {
  std::ranges::sort(strips, {}, &Strip::width);
  double all = 0.0;
  for (const Strip& strip : strips) all += strip.length;
  double narrower = 0.0;
  for (const Strip& strip : strips) {
    narrower += strip.length;
    if (2.0 * narrower >= all) return strip.width;
  }
  return 0.0;
}

/// How nearly the surface beside the breaks looks along one line, this way or that: the largest eigenvalue of its normals' second
/// moments.  1 for a flat wall, 1/3 for a half of a ball or for a solid piece of which a side is missing.
double flatness(const Ground& ground, const std::vector<bool>& ending) {
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double count = 0.0;
  for (std::size_t i = 0; i < ending.size(); ++i) {
    if (ending[i]) continue;
    const Eigen::Vector3d n =
        Eigen::Vector3f(ground.normals[i].x, ground.normals[i].y, ground.normals[i].z).cast<double>();
    moments += n * n.transpose();
    ++count;
  }
  if (count == 0) return 0.0;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments / count, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

/// Share of the end of the scan that lies at breaks.
double share_at_breaks(const Ground& ground, const std::vector<bool>& ending,
                       const std::vector<glm::vec3>& ends) {
  const PointIndex samples(ground.points);
  const auto at_breaks =
      std::ranges::count_if(ends, [&](const glm::vec3& end) { return ending[samples.nearest(end)->first]; });
  return static_cast<double>(at_breaks) / static_cast<double>(std::max<std::size_t>(1, ends.size()));
}

/// Share of the wall samples beside a crease that have a wall on the other side of it.
double share_between_walls(const Ground& ground, const std::vector<bool>& wall,
                           const std::vector<std::vector<std::uint32_t>>& facets) {
  const std::vector<int> facet_of = facets_of_samples(ground, facets);
  std::size_t between = 0;
  std::size_t all = 0;
  for (std::uint32_t i = 0; i < wall.size(); ++i) {
    if (!wall[i]) continue;
    bool meets_wall = false;
    bool meets_other = false;
    for (const auto k : ground.near[i]) {
      if (facet_of[k] != facet_of[i] && bends(ground, i, k)) (wall[k] ? meets_wall : meets_other) = true;
    }
    between += meets_wall ? 1 : 0;
    all += (meets_wall ? 1 : 0) + (meets_other ? 1 : 0);
  }
  return static_cast<double>(between) / static_cast<double>(std::max<std::size_t>(1, all));
}

}  // namespace

OpenWalls open_walls(const Mesh& mesh, const Ground& ground, std::size_t smallest, double wide) {
  const std::vector<glm::vec3> end_points = ends_of_scan(mesh, ground.spacing);
  const PointIndex ends(end_points);
  OpenWalls result{std::vector<bool>(ground.points.size(), true), 0.0};
  std::vector<bool> ending(ground.points.size(), false);  // on a narrow facet where the scan ends
  std::vector<Strip> strips;
  const auto by_cone = grow_facets(ground, kCone, smallest);
  const auto by_creases = facets_between_creases(ground, smallest);
  for (const auto* facets : {&by_cone, &by_creases}) {
    const Ruler ruler(ground, *facets, ends);
    for (const auto& facet : *facets) {
      const Span span = ruler.span_of(facet);
      if (span.width > wide) continue;
      const bool ends_here = span.ended >= kEnded;
      for (const auto i : facet) {
        result.wall[i] = false;
        ending[i] = ending[i] || ends_here;
      }
      if (ends_here) strips.push_back({span.width, static_cast<double>(facet.size()) / span.width});
    }
  }
  if (share_at_breaks(ground, ending, end_points) > kAround && flatness(ground, ending) > kSheet &&
      share_between_walls(ground, result.wall, by_creases) < kSharp) {
    result.break_width = middle_width(std::move(strips));
  }
  return result;
}

}  // namespace rejoin::mesh::detail
