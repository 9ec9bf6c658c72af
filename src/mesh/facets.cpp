#include "mesh/facets.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <queue>

#include "core/median.hpp"
#include "core/parallel.hpp"
#include "mesh/detail/creases.hpp"
#include "mesh/detail/facet_table.hpp"
#include "mesh/detail/flanks.hpp"
#include "mesh/detail/grow.hpp"
#include "mesh/detail/islands.hpp"
#include "mesh/detail/local_fit.hpp"
#include "mesh/detail/mean_normals.hpp"
#include "mesh/detail/open_walls.hpp"
#include "mesh/neighbours.hpp"
#include "mesh/point_index.hpp"
#include "mesh/thickness.hpp"

namespace rejoin::mesh {
namespace {

constexpr std::size_t kSamples = 12000;
constexpr double kQuadricRadius = 4.0;  // spacings: about 50 neighbours for 6 unknowns
constexpr float kWallLow = 0.5F;        // of the wall thickness
constexpr float kWallHigh = 1.8F;
constexpr float kWallSquare = 0.95F;   // the opposite wall may lean by 18 degrees
constexpr float kThickSquare = 0.75F;  // walls much thicker than the others may lean by 41 degrees,
constexpr float kThicker = 1.3F;       // have that of the wall thickness at least,
constexpr float kThickest = 6.0F;      // that at most,
constexpr double kWide =
    0.8;  // and are that much as wide as thick: more than a break, which has 1 / kThicker of it
constexpr double kVoteReach = 1.0;  // wall thicknesses within which samples vote on each other,
constexpr float kVoteLean = 0.95F;  // if their normals differ by at most 18 degrees
constexpr float kVoteLevel = 0.1F;  // and they lie within that of each other's plane
constexpr std::size_t kVoters = 6;  // every so many samples have a vote: some twenty-five are asked each time
constexpr int kVotes = 8;           // at most
constexpr double kStripRadius = 0.7;  // of the wall thickness
constexpr float kStripCone = 28.0F;   // the same: a strip ends where the break turns a corner
constexpr double kStripOfSize =
    0.125;  // of the piece: the break of a thicker wall is as wide as a solid's side
constexpr double kSamplesPerWall = 7.0;  // across a sherd's fracture strip
constexpr double kMostSamples = 240000.0;
constexpr std::size_t kFewest = 20;  // samples of a facet; more are
constexpr std::size_t kOfAll = 300;  // one of so many of all, or one
constexpr std::size_t kOfFracture =
    32;  // of so many of the broken ones where those are few, as on a large plate
constexpr double kOpen =
    0.05;  // share of the rays inwards that meet nothing, of an open scan; closed ones have 0.003
constexpr double kWideOfSize = 0.25;  // of the piece: breaks of an open scan are narrower
constexpr double kMostOfOpen = 0.2;   // of the piece: its breaks measure less across
constexpr double kWideWalls = 2.5;    // wall thicknesses: breaks are narrower
// Breaks of sherds go through the walls, with a cosine between them and the nearest wall of this at most
constexpr float kSidewards = 0.6F;
// on at least this share of the area of a round sherd's side, whose border is the shortest.
constexpr double kLeastSides = 0.29;
constexpr double kLeastAcross = 5.0;  // samples across the wall, to tell
constexpr double kVesselFlatness =
    3.0;  // wall thicknesses: a flake is flatter, unlike a vessel with hardly any break

using detail::Lists;

/// Fracture normals averaged across the whole strip, so that growing follows the strip's course and not its
/// bevels.
std::vector<glm::vec3> strip_normals(const Segmentation& s) {
  const Neighbours neighbours(s.samples.points, static_cast<float>(kStripRadius * s.wall_thickness));
  std::vector<glm::vec3> smooth = s.normals;
  parallel_for(smooth.size(), 256, [&](std::size_t first, std::size_t last) {
    std::vector<std::uint32_t> near;
    for (std::size_t i = first; i < last; ++i) {
      if (s.surface[i] != Surface::Fracture) continue;
      neighbours.of(s.samples.points[i], near);
      glm::vec3 sum(0.0F);
      for (const auto k : near) {
        if (s.surface[k] == Surface::Fracture && glm::dot(s.normals[k], s.normals[i]) > 0.0F)
          sum += s.normals[k];
      }
      if (glm::length(sum) > 0.0F) smooth[i] = glm::normalize(sum);
    }
  });
  return smooth;
}

/// rms distance of the neighbours from the quadric fitted to them, as a fraction of the radius.
/// \param local  room for them
float roughness_at(const Samples& samples, const std::vector<glm::vec3>& normals,
                   const std::vector<std::uint32_t>& near, std::size_t i, double radius,
                   std::vector<glm::dvec3>& local) {
  const glm::dmat3 frame = frame_of(glm::normalize(glm::dvec3(normals[i])));
  local.clear();
  for (const auto k : near) {
    if (glm::dot(normals[k], normals[i]) < 0.3F) continue;
    local.push_back(glm::dvec3(samples.points[k] - samples.points[i]) * frame / radius);
  }
  return static_cast<float>(detail::quadric_residual(local));
}

std::vector<float> roughness_of(const Samples& samples, const std::vector<glm::vec3>& normals) {
  const double radius = kQuadricRadius * samples.spacing;
  const Lists near = detail::neighbours_within(samples.points, radius);
  std::vector<float> rough(samples.size());
  parallel_for(samples.size(), 128, [&](std::size_t first, std::size_t last) {
    std::vector<glm::dvec3> local;
    for (std::size_t i = first; i < last; ++i)
      rough[i] = roughness_at(samples, normals, near[i], i, radius, local);
  });
  return rough;
}

std::vector<bool> meets_something(const InwardRays& rays) {
  std::vector<bool> meets;
  meets.reserve(rays.length.size());
  for (const float length : rays.length) meets.push_back(!std::isinf(length));
  return meets;
}

/// Every sample's voters: those near it that lie on the same side of every edge, about level with it.
Lists voters_of(const Segmentation& s) {
  const auto level = kVoteLevel * static_cast<float>(s.wall_thickness);
  std::vector<glm::vec3> points;
  for (std::size_t k = 0; k < s.samples.size(); k += kVoters) points.push_back(s.samples.points[k]);
  const Neighbours neighbours(points, static_cast<float>(kVoteReach * s.wall_thickness));
  Lists lists(s.samples.size());
  parallel_for(lists.size(), 256, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      neighbours.of(s.samples.points[i], lists[i]);
      for (std::uint32_t& k : lists[i]) k *= kVoters;
      std::erase_if(lists[i], [&](std::uint32_t k) {
        const float height = glm::dot(s.normals[i], s.samples.points[k] - s.samples.points[i]);
        return std::abs(height) > level || glm::dot(s.normals[k], s.normals[i]) < kVoteLean;
      });
    }
  });
  return lists;
}

/// A single normal of a noisy scan leans by ten degrees and more, their mean over a wall thickness hardly.
std::vector<glm::vec3> normals_over(const std::vector<glm::vec3>& normals, const Lists& voters) {
  std::vector<glm::vec3> means = normals;
  parallel_for(means.size(), 1024, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      glm::vec3 sum = normals[i];
      for (const auto k : voters[i]) sum += normals[k];
      means[i] = glm::normalize(sum);
    }
  });
  return means;
}

/// Distance across a facet: that of a strip's sides, or three quarters of a disc's diameter.
double width_of(const Segmentation& s, const std::vector<std::uint32_t>& facet) {
  std::vector<bool> inside(s.samples.size(), false);
  for (const auto i : facet) inside[i] = true;
  std::vector<glm::vec3> outside;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    if (!inside[i]) outside.push_back(s.samples.points[i]);
  }
  const PointIndex index(outside);
  std::vector<float> inwards;
  for (const auto i : facet) {
    if (const auto nearest = index.nearest(s.samples.points[i])) inwards.push_back(nearest->second);
  }
  constexpr double kInner = 0.9;
  return inwards.empty() ? 0.0 : 2.0 * quantile(inwards, kInner) / kInner;
}

/// Adds the walls of a vessel's foot and the like, much thicker than its others, and those that are much thinner than a foot: facets that
/// are about as wide as the piece is thick there, or wider.  The sides of a sherd's breaks are farther from each other than they are wide;
/// where a break runs askew, the piece thins out along it.
/// \return whether there are such
bool add_other_walls(Segmentation& s, const InwardRays& rays, const Lists& near) {
  const detail::Ground ground{s.samples.points, s.normals, s.surface, near, s.samples.spacing};
  bool some = false;
  for (const auto& facet : detail::grow_facets(ground, detail::kCone, detail::smallest_facet(s))) {
    if (s.surface[facet.front()] != Surface::Fracture) continue;
    std::vector<float> squares;
    std::vector<float> thickness;
    for (const auto i : facet) {
      squares.push_back(rays.square[i]);
      thickness.push_back(rays.length[i]);
    }
    const float middle = median(thickness) / static_cast<float>(s.wall_thickness);
    const float square = median(squares);
    const bool thicker = middle > kThicker && middle < kThickest && square > kThickSquare;
    const bool thinner = middle < kWallLow && square > kWallSquare;
    if (!thicker && !thinner) continue;
    if (width_of(s, facet) < kWide * static_cast<double>(middle) * s.wall_thickness) continue;
    for (const auto i : facet) s.surface[i] = Surface::Original;
    some = true;
  }
  return some;
}

/// Until none changes, every point takes the vote of its surroundings up to the next edge.
void vote(std::vector<Surface>& surface, const Lists& voters) {
  for (int round = 0; round < kVotes; ++round) {
    std::vector<Surface> voted = surface;
    parallel_for(voted.size(), 1024, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const auto fracture = static_cast<std::size_t>(std::ranges::count_if(
            voters[i], [&](std::uint32_t k) { return surface[k] == Surface::Fracture; }));
        if (2 * fracture != voters[i].size())
          voted[i] = 2 * fracture > voters[i].size() ? Surface::Fracture : Surface::Original;
      }
    });
    if (voted == surface) break;
    surface = std::move(voted);
  }
}

/// Wall points see the opposite wall, parallel to theirs, or lie on a wide facet of an open scan; then they vote.  Where a break runs askew,
/// the wall behind it counts as a break, too.
/// \param wide  of an open scan, per sample: on a facet too wide for a break; else empty
/// \param roughest  what is rougher than that, by most of its voters, is a break; 0: nothing is for that
void classify_thin(Segmentation& s, const InwardRays& rays, const Lists& near, const std::vector<bool>& wide,
                   float roughest) {
  const auto t = static_cast<float>(s.wall_thickness);
  const Lists voters = voters_of(s);
  const std::vector<glm::vec3> normals = normals_over(s.normals, voters);
  const PointIndex index(s.samples.points);
  const auto is_rough = [&](std::uint32_t i) { return s.roughness[i] > roughest; };
  const auto is_wall = [&](std::size_t i) {
    if (roughest > 0 &&
        2 * std::ranges::count_if(voters[i], is_rough) > static_cast<std::ptrdiff_t>(voters[i].size()))
      return false;
    if (!wide.empty() && wide[i]) return true;
    const float length = rays.length[i];
    if (!(length > kWallLow * t && length < kWallHigh * t)) return false;
    const auto opposite = index.nearest(s.samples.points[i] - length * s.normals[i]);
    return -glm::dot(normals[i], normals[opposite->first]) > kWallSquare;
  };
  parallel_for(s.samples.size(), 256, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      s.surface[i] = is_wall(i) ? Surface::Original : Surface::Fracture;
  });
  vote(s.surface, voters);
  if (add_other_walls(s, rays, near)) vote(s.surface, voters);
}

void measure(Facet& facet, const Segmentation& s) {
  glm::dvec3 normal(0.0);
  glm::dvec3 centre(0.0);
  double rough = 0.0;
  facet.area = 0.0;
  for (const auto i : facet.samples) {
    facet.area += static_cast<double>(s.samples.areas[i]);
    normal += glm::dvec3(s.normals[i]);
    centre += glm::dvec3(s.samples.points[i]);
    rough += static_cast<double>(s.roughness[i]);
  }
  const auto count = static_cast<double>(facet.samples.size());
  facet.normal = glm::length(normal) > 0 ? glm::normalize(normal) : glm::dvec3(0, 0, 1);
  facet.centre = centre / count;
  facet.roughness = rough / count;
  const glm::dmat3 frame = frame_of(facet.normal);
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const auto i : facet.samples) {
    const glm::dvec3 p = (glm::dvec3(s.samples.points[i]) - facet.centre) * frame;
    spread += Eigen::Vector2d(p.x, p.y) * Eigen::RowVector2d(p.x, p.y);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(spread);
  const Eigen::Vector2d axis = solver.eigenvectors().col(1);
  facet.along = frame * glm::dvec3(axis.x(), axis.y(), 0.0);
  const glm::dvec3 across = glm::cross(facet.normal, facet.along);
  glm::dvec2 low(1e300);
  glm::dvec2 high(-1e300);
  for (const auto i : facet.samples) {
    const glm::dvec3 p = glm::dvec3(s.samples.points[i]) - facet.centre;
    const glm::dvec2 q(glm::dot(p, facet.along), glm::dot(p, across));
    low = glm::min(low, q);
    high = glm::max(high, q);
  }
  facet.length = high.x - low.x;
  facet.width = high.y - low.y;
}

/// Neighbours of the samples and what lies inwards of them.
struct Look {
  Lists near;
  InwardRays rays;
};

/// Samples the surface; all of it counts as fracture at first.
Look look(const Mesh& mesh, std::size_t samples, Segmentation& s) {
  s.samples = sample_surface(mesh, samples);
  Lists near = detail::neighbours_within(s.samples.points, detail::kNormalRadius * s.samples.spacing);
  s.normals = detail::mean_normals(s.samples.normals, near, 0.0F);
  s.surface.assign(s.samples.size(), Surface::Fracture);
  s.roughness = roughness_of(s.samples, s.normals);
  InwardRays rays = cast_inwards(mesh, s.samples, s.normals);
  return {std::move(near), std::move(rays)};
}

detail::OpenWalls open_walls(const Mesh& mesh, const Segmentation& s, const Lists& near, double wide) {
  const detail::Ground all{s.samples.points, s.normals, s.surface, near, s.samples.spacing};
  return detail::open_walls(mesh, all, detail::smallest_facet(s), wide);
}

/// Whether what was taken for breaks hardly goes through what was taken for walls: the faces of a struck flake are parallel, too, but run out
/// into sharp edges.
bool is_flake(const Mesh& mesh, const Segmentation& s) {
  std::vector<glm::vec3> walls;
  std::vector<glm::vec3> normals;
  for (std::size_t i = 0; i < s.samples.size(); ++i) {
    if (s.surface[i] != Surface::Original) continue;
    walls.push_back(s.samples.points[i]);
    normals.push_back(s.normals[i]);
  }
  const bool told = s.samples.spacing < s.wall_thickness / kLeastAcross;
  if (walls.empty() || !told || least_extent(s.samples.points) > kVesselFlatness * s.wall_thickness)
    return false;
  const PointIndex index(walls);
  std::size_t sidewards = 0;
  for (std::size_t i = 0; i < s.samples.size(); ++i) {
    if (s.surface[i] != Surface::Fracture) continue;
    const auto nearest = index.nearest(s.samples.points[i]);
    if (std::abs(glm::dot(s.normals[i], normals[nearest->first])) < kSidewards) ++sidewards;
  }
  const double each = surface_area(mesh) / static_cast<double>(s.samples.size());
  const double face = 0.5 * static_cast<double>(walls.size()) * each;
  const double side = 2.0 * std::sqrt(std::numbers::pi * face) * s.wall_thickness;
  return static_cast<double>(sidewards) * each < kLeastSides * side;
}

/// Sets the samples, their normals and classes, and the wall thickness.
Look classify(const Mesh& mesh, double size, PieceKind kind, Segmentation& s) {
  Look seen = look(mesh, kSamples, s);
  s.backed = meets_something(seen.rays);
  if (kind == PieceKind::Solid) return seen;
  const Walls walls = find_walls(seen.rays, s.normals, s.roughness, size);
  s.wall_thickness = walls.thickness;
  const bool open = unbacked_share(s) > kOpen;
  if (open && s.wall_thickness == 0) {
    const double width = open_walls(mesh, s, seen.near, kWideOfSize * size).break_width;
    if (width < kMostOfOpen * size) s.wall_thickness = width;
  }
  if (s.wall_thickness == 0) return seen;
  if (s.samples.spacing > s.wall_thickness / kSamplesPerWall) {
    const double finer = s.samples.spacing * kSamplesPerWall / s.wall_thickness;
    const double count = static_cast<double>(s.samples.size()) * finer * finer;
    seen = look(mesh, static_cast<std::size_t>(std::min(count, kMostSamples)), s);
    s.backed = meets_something(seen.rays);
  }
  std::vector<bool> wide;
  if (open) wide = open_walls(mesh, s, seen.near, kWideWalls * s.wall_thickness).wall;
  classify_thin(s, seen.rays, seen.near, wide, walls.roughest);
  if (!open && is_flake(mesh, s)) {
    s.wall_thickness = 0;
    seen = look(mesh, kSamples, s);
    s.backed = meets_something(seen.rays);
  }
  return seen;
}

}  // namespace

namespace detail {

std::size_t smallest_facet(const Segmentation& s) {
  const auto fracture = static_cast<std::size_t>(std::ranges::count(s.surface, Surface::Fracture));
  return std::max(kFewest, std::min(s.samples.size() / kOfAll, fracture / kOfFracture));
}

Cut cut_into(const Segmentation& s, std::vector<std::vector<std::uint32_t>> members) {
  Cut cut;
  for (auto& samples : members) {
    Facet facet;
    facet.fracture = s.surface[samples.front()] == Surface::Fracture;
    facet.samples = std::move(samples);
    measure(facet, s);
    cut.facets.push_back(std::move(facet));
  }
  std::stable_sort(cut.facets.begin(), cut.facets.end(), [](const Facet& a, const Facet& b) {
    return a.fracture != b.fracture ? a.fracture : a.area > b.area;
  });
  cut.facet_of_sample.assign(s.samples.size(), -1);
  for (std::size_t f = 0; f < cut.facets.size(); ++f) {
    for (const auto i : cut.facets[f].samples) cut.facet_of_sample[i] = static_cast<int>(f);
  }
  return cut;
}

}  // namespace detail

double unbacked_share(const Segmentation& segmentation) {
  const auto lost = std::ranges::count(segmentation.backed, false);
  return static_cast<double>(lost) /
         static_cast<double>(std::max<std::size_t>(1, segmentation.backed.size()));
}

Segmentation segment(const Mesh& mesh) {
  return segment(mesh, diameter(mesh));
}

Segmentation segment(const Mesh& mesh, double size, PieceKind kind) {
  Segmentation s;
  const auto [near, rays] = classify(mesh, size, kind, s);
  const bool thin = s.wall_thickness > 0;
  s.sample_area = surface_area(mesh) / static_cast<double>(std::max<std::size_t>(1, s.samples.size()));
  const std::vector<glm::vec3> normals = thin ? strip_normals(s) : s.normals;
  const detail::Ground ground{s.samples.points, normals, s.surface, near, s.samples.spacing};
  const bool strips = thin && s.wall_thickness < kStripOfSize * size;
  const std::size_t smallest = detail::smallest_facet(s);
  auto members = detail::grow_facets(ground, strips ? kStripCone : detail::kCone, smallest);
  if (thin) {
    detail::take_flanks_for_walls(s, members, rays.length, near);
    detail::add_islands(ground, s.sample_area, smallest, members);
  }
  static_cast<Cut&>(s) = detail::cut_into(s, std::move(members));
  if (!thin) s.creased = detail::cut_into(s, detail::facets_between_creases(ground, smallest));
  return s;
}

std::vector<int> nearest_alike(const Segmentation& segmentation, const std::vector<glm::vec3>& points,
                               const std::vector<glm::vec3>& normals) {
  constexpr std::size_t kLooks = 4;
  const PointIndex index(segmentation.samples.points);
  std::vector<int> samples(points.size(), -1);
  parallel_for(points.size(), 512, [&](std::size_t first, std::size_t last) {
    std::vector<std::uint32_t> near;
    for (std::size_t k = first; k < last; ++k) {
      index.nearest(points[k], kLooks, near);
      for (const auto i : near) {
        if (glm::dot(segmentation.normals[i], normals[k]) < 0.0F) continue;
        samples[k] = static_cast<int>(i);
        break;
      }
    }
  });
  return samples;
}

std::vector<int> sample_of_faces(const Segmentation& segmentation, const Mesh& mesh) {
  std::vector<glm::vec3> middles;
  middles.reserve(mesh.faces.size());
  for (const glm::uvec3& face : mesh.faces)
    middles.push_back((mesh.vertices[face.x] + mesh.vertices[face.y] + mesh.vertices[face.z]) / 3.0F);
  return nearest_alike(segmentation, middles, face_normals(mesh));
}

std::vector<int> facet_of_faces(const Cut& cut, std::vector<int> sample_of_face) {
  for (int& i : sample_of_face) {
    if (i >= 0) i = cut.facet_of_sample[static_cast<std::size_t>(i)];
  }
  return sample_of_face;
}

}  // namespace rejoin::mesh
