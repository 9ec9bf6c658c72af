#include "mesh/flaps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/median.hpp"
#include "core/parallel.hpp"
#include "mesh/detail/inside.hpp"
#include "mesh/detail/local_fit.hpp"
#include "mesh/detail/thin_parts.hpp"
#include "mesh/neighbours.hpp"
#include "mesh/point_index.hpp"
#include "mesh/samples.hpp"

namespace rejoin::mesh {
namespace {

using detail::Inside;
using detail::kNoBody;
using detail::ThinPart;

constexpr std::size_t kLeafPlaces = 6000;
constexpr double kMostOpen = 0.5;  // of a piece that has a body, at most, has nothing behind it
constexpr double kLeast = 0.01;    // of the area: less keeps no pieces apart
/// Of the piece's thickness, at most: sheets that are open, then leaves, thin ones first, as thicker parts go on into edges that run out.
constexpr std::array kThin{0.0, 0.05, 0.1, 0.2};
constexpr double kFree = 0.5;       // of an open flap's border, at least, is where the scan ends
constexpr double kMost = 0.8;       // of a leaf beside its seam is no thicker than it counts
constexpr double kLeafWidth = 6.0;  // thicknesses, at least, from where a leaf hangs to its end
constexpr double kFine = 3.0;  // edges, at most, is a leaf thick whose own border has no shape to be known by
constexpr float kStep = 3.0F;  // thicknesses of the leaf, at least, beside it ...
constexpr double kAtStep = 0.9;      // ... nearly everywhere
constexpr double kOtherSide = 0.08;  // of the piece, at most, lies on the other side of a leaf
constexpr double kTilt = 0.15;       // slope by which the plane of a leaf is not sure
constexpr double kWall = 0.1;  // of the rays that would leave the body through it, were it a wall, at most
constexpr float kEnclosed = 0.7F;  // of the directions end in the body, at least, beside what was cut off ...
constexpr double kClosed = 0.9;    // ... nearly everywhere
constexpr double kNear = 1.0;      // spacings of places from a seam ...
constexpr double kFar = 3.0;       // ... between which is beside it
constexpr double kReach = 2.0;     // spacings: faces of thin parts have a thin place so near
constexpr float kThick = std::numeric_limits<float>::max();

Mesh without(const Mesh& mesh, const std::vector<bool>& faces) {
  std::vector<std::uint32_t> kept;
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    if (!faces[f]) kept.push_back(f);
  }
  return submesh(mesh, kept);
}

enum class Kind { None, Flap, Doubtful };

struct Found {
  std::vector<bool> faces;  ///< of flaps
  bool any = false;
  double doubtful = 0;  ///< area of others
};

/// Looks at the thin parts of one scan.
class FlapSearch {
 public:
  explicit FlapSearch(const Mesh& mesh)
      : mesh_(mesh), inside_(mesh), places_(sample_surface(mesh, kLeafPlaces)), area_(surface_area(mesh)) {
    thickness_.resize(places_.size());
    parallel_for(places_.size(), 64, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i)
        thickness_[i] = thickness_at(places_.points[i], places_.normals[i]);
    });
    std::vector<float> known;
    std::ranges::copy_if(thickness_, std::back_inserter(known), [](float t) { return t < kNoBody; });
    has_body_ = static_cast<double>(known.size()) >= (1.0 - kMostOpen) * static_cast<double>(places_.size());
    body_ = median(known);
  }

  /// Whether enough is thin for a flap.  Where both sides of a leaf share cells of the grid they have half of the places.
  bool is_worth_a_look() const {
    const auto thin = std::ranges::count_if(thickness_, [this](float t) { return is_thin(t, kThin.back()); });
    return has_body_ && static_cast<double>(thin) >= 0.5 * kLeast * static_cast<double>(places_.size());
  }

  /// What flaps there are among the parts up to a share of the piece's thickness.
  Found find(double share) {
    if (of_faces_.empty()) look_at_faces();
    std::vector<bool> thin;
    thin.reserve(of_faces_.size());
    for (const float t : of_faces_) thin.push_back(is_thin(t, share));
    Found found{std::vector<bool>(thin.size(), false), false, 0.0};
    for (const ThinPart& part : detail::thin_parts(mesh_, thin, kLeast * area_)) {
      const Kind kind = kind_of(part);
      if (kind == Kind::Doubtful) found.doubtful += part.area;
      if (kind != Kind::Flap) continue;
      found.any = true;
      for (const std::uint32_t f : part.faces) found.faces[f] = true;
    }
    return found;
  }

 private:
  /// Looks where a place nearby is thin, as of a part that counts most places are: a scan may have millions of faces.
  void look_at_faces() {
    std::vector<glm::vec3> thin;
    for (std::size_t i = 0; i < places_.size(); ++i)
      if (is_thin(thickness_[i], kThin.back())) thin.push_back(places_.points[i]);
    const Neighbours neighbours(thin, static_cast<float>(kReach * places_.spacing));
    const std::vector<glm::vec3> normals = evened_normals();
    const float limit = static_cast<float>(kThin.back()) * body_;
    of_faces_.assign(mesh_.faces.size(), kThick);
    parallel_for(of_faces_.size(), 64, [&](std::size_t first, std::size_t last) {
      for (std::size_t f = first; f < last; ++f) {
        const glm::uvec3& face = mesh_.faces[f];
        const glm::vec3 middle =
            (mesh_.vertices[face.x] + mesh_.vertices[face.y] + mesh_.vertices[face.z]) / 3.0F;
        if (!neighbours.any(middle, [](std::uint32_t) { return true; })) continue;
        if (normals[f] != glm::vec3(0.0F) && inside_.is_thicker(middle, normals[f], limit)) continue;
        of_faces_[f] = thickness_at(middle, normals[f]);
      }
    });
  }

  Kind kind_of(const ThinPart& part) const {
    const Part at = look_at(part);
    if (at.seam.empty() || is_wall(at)) return Kind::None;
    const bool open = open_share(at) > 0.5 && part.free >= kFree * (part.free + part.attached);
    const float thickness = open ? 0.0F : thickness_of_part(at);
    if (!(open || is_leaf(at, thickness)) || !closes_without(at)) return Kind::None;
    return static_cast<double>(thickness) <= kFine * resolution(mesh_) ? Kind::Flap : Kind::Doubtful;
  }

  /// A thin part among the places.
  struct Part {
    const ThinPart& part;
    std::vector<bool> has_face;
    std::vector<glm::vec3> seam;      ///< points along it
    std::vector<std::uint32_t> own;   ///< places on it
    std::vector<std::uint32_t> rest;  ///< all others
    std::vector<float> from_seam;     ///< distance of every place; infinity if far
  };

  bool is_thin(float thickness, double share) const {
    return thickness == kNoBody || thickness <= static_cast<float>(share) * body_;
  }

  float thickness_at(const glm::vec3& point, const glm::vec3& normal) const {
    return normal == glm::vec3(0.0F) ? kNoBody : inside_.thickness_at(point, normal);
  }

  /// Of every face, with what of its surroundings looks its way: noise turns single ones.
  std::vector<glm::vec3> evened_normals() const {
    constexpr float kSameWay = 0.5F;
    std::vector<glm::vec3> normals = face_normals(mesh_);
    Mesh around;
    around.vertices = mesh_.vertices;
    around.faces = mesh_.faces;
    compute_normals(around);
    for (std::size_t f = 0; f < normals.size(); ++f) {
      glm::vec3 sum = normals[f];
      for (int k = 0; k < 3; ++k) {
        const glm::vec3& normal = around.normals[mesh_.faces[f][k]];
        if (glm::dot(normal, normals[f]) > kSameWay) sum += normal;
      }
      if (normals[f] != glm::vec3(0.0F)) normals[f] = glm::normalize(sum);
    }
    return normals;
  }

  Part look_at(const ThinPart& part) const {
    Part at{part, std::vector<bool>(mesh_.faces.size(), false), {}, {}, {}, {}};
    for (const std::uint32_t f : part.faces) at.has_face[f] = true;
    for (std::uint32_t i = 0; i < places_.size(); ++i)
      (at.has_face[places_.faces[i]] ? at.own : at.rest).push_back(i);
    at.seam = part.seam.empty() ? touching(at) : along(part.seam);
    const PointIndex index(at.seam);
    for (const glm::vec3& place : places_.points) {
      const auto hit = index.nearest_within(place, static_cast<float>(kFar * places_.spacing));
      at.from_seam.push_back(hit ? hit->second : kNoBody);
    }
    return at;
  }

  std::vector<glm::vec3> along(const std::vector<glm::uvec2>& edges) const {
    std::vector<glm::vec3> points;
    for (const glm::uvec2& edge : edges) {
      const glm::vec3& a = mesh_.vertices[edge.x];
      const glm::vec3& b = mesh_.vertices[edge.y];
      const int parts = 1 + static_cast<int>(static_cast<double>(glm::distance(a, b)) / places_.spacing);
      for (int i = 0; i <= parts; ++i)
        points.push_back(glm::mix(a, b, static_cast<float>(i) / static_cast<float>(parts)));
    }
    return points;
  }

  /// Where a part that shares no edge with the rest lies at it.
  std::vector<glm::vec3> touching(const Part& at) const {
    const Mesh without_it = without(mesh_, at.has_face);
    const RayScene rest(without_it);
    const auto reach = static_cast<float>(2.0 * resolution(mesh_));
    std::vector<glm::vec3> points;
    for (const std::uint32_t f : at.part.faces) {
      for (int k = 0; k < 3; ++k) {
        const glm::vec3& corner = mesh_.vertices[mesh_.faces[f][k]];
        if (rest.nearest(corner, reach)) points.push_back(corner);
      }
    }
    return points;
  }

  double open_share(const Part& at) const {
    const auto open =
        std::ranges::count_if(at.own, [this](std::uint32_t i) { return thickness_[i] == kNoBody; });
    return static_cast<double>(open) / static_cast<double>(std::max<std::size_t>(1, at.own.size()));
  }

  /// Whether rays from the rest leave the body through it, as through any wall of its area.
  bool is_wall(const Part& at) const {
    std::size_t all = 0;
    std::size_t through = 0;
    for (const std::uint32_t i : at.rest) {
      for (const std::uint32_t face : inside_.exits_from(places_.points[i], places_.normals[i])) {
        ++all;
        through += at.has_face[face] ? 1 : 0;
      }
    }
    const double share = at.part.area / area_;
    return static_cast<double>(through) > kWall * share * static_cast<double>(all);
  }

  /// Of most of it beside the seam: edges that run out are thinner farther away.
  float thickness_of_part(const Part& at) const {
    std::vector<float> own;
    for (const std::uint32_t i : at.own) {
      if (thickness_[i] < kNoBody && at.from_seam[i] < kNoBody) own.push_back(thickness_[i]);
    }
    return quantile(own, kMost);
  }

  bool is_leaf(const Part& at, float thickness) const {
    if (at.part.area < kLeafWidth * static_cast<double>(thickness) * at.part.attached) return false;
    std::size_t all = 0;
    std::size_t thick = 0;
    for (const std::uint32_t i : at.rest) {
      if (at.from_seam[i] == kNoBody) continue;
      ++all;
      thick += thickness_[i] > kStep * thickness ? 1 : 0;
    }
    return static_cast<double>(thick) >= kAtStep * static_cast<double>(all) && is_at_one_side(at, thickness);
  }

  /// Whether the rest lies on one side of the plane in which a leaf begins.
  bool is_at_one_side(const Part& at, float thickness) const {
    std::vector<std::uint32_t> near;
    glm::vec3 middle(0.0F);
    for (const std::uint32_t i : at.own) {
      if (at.from_seam[i] == kNoBody) continue;
      near.push_back(i);
      middle += places_.points[i];
    }
    if (near.size() < 3) return false;
    middle /= static_cast<float>(near.size());
    const glm::vec3 up = detail::plane_normal(places_.points, near);
    const auto layer = static_cast<double>(thickness) + resolution(mesh_);
    double above = 0;
    double below = 0;
    for (const std::uint32_t i : at.rest) {
      const glm::vec3 step = places_.points[i] - middle;
      const auto height = static_cast<double>(glm::dot(step, up));
      if (std::abs(height) < layer + kTilt * static_cast<double>(glm::length(step))) continue;
      (height > 0 ? above : below) += static_cast<double>(places_.areas[i]);
    }
    return std::min(above, below) <= kOtherSide * (above + below);
  }

  /// Whether the body beside the seam is closed when the part is gone.
  bool closes_without(const Part& at) const {
    const Mesh rest = without(mesh_, at.has_face);
    const Inside inside(rest);
    std::size_t all = 0;
    std::size_t closed = 0;
    for (const std::uint32_t i : at.rest) {
      if (at.from_seam[i] == kNoBody || static_cast<double>(at.from_seam[i]) < kNear * places_.spacing)
        continue;
      ++all;
      closed += inside.enclosed_at(places_.points[i], places_.normals[i]) > kEnclosed ? 1 : 0;
    }
    return all > 0 && static_cast<double>(closed) >= kClosed * static_cast<double>(all);
  }

  const Mesh& mesh_;
  Inside inside_;
  Samples places_;
  double area_;
  std::vector<float> thickness_;  ///< at the places
  std::vector<float> of_faces_;   ///< thickness at their middles; kThick: more than the last of kThin
  bool has_body_ = false;
  float body_ = 0;  ///< median thickness
};

}  // namespace

Flaps cut_off_flaps(const Mesh& mesh) {
  Flaps flaps;
  std::optional<FlapSearch> search(mesh);
  if (!search->is_worth_a_look()) return flaps;
  for (const double share : kThin) {
    const Found found = search->find(share);
    flaps.doubtful = std::max(flaps.doubtful, found.doubtful / surface_area(mesh));
    if (!found.any) continue;
    Mesh rest = without(flaps.rest ? *flaps.rest : mesh, found.faces);
    search.reset();
    flaps.rest = std::move(rest);
    search.emplace(*flaps.rest);
  }
  if (flaps.rest) flaps.share = 1.0 - surface_area(*flaps.rest) / surface_area(mesh);
  return flaps;
}

}  // namespace rejoin::mesh
