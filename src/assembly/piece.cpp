#include "assembly/piece.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "match/evidence.hpp"

namespace rejoin::assembly {
namespace {

constexpr std::size_t kBodySamples = 2500;
constexpr double kFacing = -0.5;   // normals within 60 degrees of opposite
constexpr double kClearly = 0.25;  // wall thicknesses; less inside is worn edges and small errors of the pose
constexpr std::size_t kInsideSamples = 600;
constexpr double kMostOverlap = 0.03;      // of the smaller one's surface
constexpr double kMostCrossing = 0.0015;   // the same, of poses given by hand
constexpr double kLeastForbidden = 0.002;  // the same, of contact

std::size_t stride(std::size_t count, std::size_t most) {
  return most > 0 ? std::max<std::size_t>(1, count / most) : 1;
}

/// Faces with a corner on an edge that only one face has.
std::vector<bool> border_faces(const mesh::Mesh& mesh) {
  std::unordered_map<std::uint64_t, int> uses;
  uses.reserve(2 * mesh.faces.size());
  const auto key = [](std::uint32_t a, std::uint32_t b) {
    return (static_cast<std::uint64_t>(std::min(a, b)) << 32U) | std::max(a, b);
  };
  for (const glm::uvec3& face : mesh.faces) {
    for (int k = 0; k < 3; ++k) ++uses[key(face[k], face[(k + 1) % 3])];
  }
  std::vector<bool> corner(mesh.vertices.size(), false);
  for (const glm::uvec3& face : mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t next = face[(k + 1) % 3];
      if (uses[key(face[k], next)] != 1) continue;
      corner[face[k]] = true;
      corner[next] = true;
    }
  }
  std::vector<bool> result(mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const glm::uvec3& face = mesh.faces[f];
    result[f] = corner[face.x] || corner[face.y] || corner[face.z];
  }
  return result;
}

/// Adds up area until it is more than is allowed.
class Allowance {
 public:
  explicit Allowance(double area) : left_(area) {}
  void spend(double area) { left_ -= area; }
  bool is_spent() const { return left_ < 0.0; }

 private:
  double left_;
};

/// Spends what of b's body lies deeper than `limit` inside a.
void spend_inside(const Piece& a, const Piece& b, const Rigid& b_to_a, double limit, Allowance& allowance) {
  for (const glm::vec3& point : b.body().at) {
    if (allowance.is_spent()) return;
    if (a.holds(b_to_a(b.fragment().surface.origin + glm::dvec3(point)), limit))
      allowance.spend(b.body_area());
  }
}

/// Spends what of b's body has an inside under it, at twice the limit, that is clearly inside a too.  Surfaces that coincide lie nowhere
/// in each other, and all of their insides do: two scans of one sherd.
void spend_shared_inside(const Piece& a, const Piece& b, const Rigid& b_to_a, double limit,
                         Allowance& allowance) {
  const Points& body = b.body();
  const std::size_t step = stride(body.at.size(), kInsideSamples);
  for (std::size_t i = 0; i < body.at.size() && !allowance.is_spent(); i += step) {
    const glm::dvec3 in_b =
        b.fragment().surface.origin + glm::dvec3(body.at[i]) - 2.0 * limit * glm::dvec3(body.normals[i]);
    if (a.holds(b_to_a(in_b), limit) && b.holds(in_b, limit))
      allowance.spend(static_cast<double>(step) * b.body_area());
  }
}

bool overlap_more_than(double share, const Piece& a, const Piece& b, const Rigid& b_to_a) {
  if (!are_near(a, b, b_to_a, 0.0)) return false;
  const double thickness = match::thinner_wall(a.fragment(), b.fragment());
  const double scan = std::max(a.fragment().resolution, b.fragment().resolution);
  const double size = std::min(a.fragment().diameter, b.fragment().diameter);
  const double limit = std::max(thickness > 0 ? kClearly * thickness : 0.01 * size, 2.0 * scan);
  const Rigid a_to_b = inverse(b_to_a);
  const double allowed = share * std::min(a.area(), b.area());
  Allowance surface(allowed);
  spend_inside(a, b, b_to_a, limit, surface);
  spend_inside(b, a, a_to_b, limit, surface);
  if (surface.is_spent()) return true;
  // Half way into a wall is inside it, however coarse the scan.
  const double within = thickness > 0 ? kClearly * thickness : limit;
  Allowance inside(allowed);
  if (a.area() < b.area())
    spend_shared_inside(b, a, a_to_b, within, inside);
  else
    spend_shared_inside(a, b, b_to_a, within, inside);
  return inside.is_spent();
}

}  // namespace

Piece::Piece(const match::Fragment& fragment) : fragment_(&fragment) {
  const mesh::Segmentation& facets = fragment.facets;
  for (std::size_t i = 0; i < facets.samples.size(); ++i) {
    if (facets.surface[i] != mesh::Surface::Fracture) continue;
    broken_.at.push_back(facets.samples.points[i]);
    broken_.normals.push_back(facets.normals[i]);
    broken_.areas.push_back(facets.samples.areas[i]);
  }
  const std::size_t step = stride(facets.samples.size(), kBodySamples);
  for (std::size_t i = 0; i < facets.samples.size(); i += step) {
    body_.at.push_back(facets.samples.points[i]);
    body_.normals.push_back(facets.normals[i]);
  }
  body_area_ = facets.sample_area * static_cast<double>(step);
  broken_index_ = std::make_unique<mesh::PointIndex>(broken_.at);
  gap_ = std::make_unique<match::GapField>(fragment.surface);
  most_depth_ = std::make_unique<DepthBound>(*gap_);
  on_border_ = border_faces(fragment.surface);
  const mesh::Box box = mesh::bounds(fragment.surface);
  const glm::dvec3 middle = 0.5 * glm::dvec3(box.low + box.high);
  for (const glm::vec3& vertex : fragment.surface.vertices)
    radius_ = std::max(radius_, glm::distance(middle, glm::dvec3(vertex)));
  centre_ = fragment.surface.origin + middle;
}

bool Piece::holds(const glm::dvec3& point, double depth) const {
  const glm::vec3 own(point - fragment_->surface.origin);
  if (most_depth_->at(own) <= depth) return false;
  const auto nearest = gap_->at(own, static_cast<float>(radius_));
  return nearest && !on_border_[nearest->face] && -static_cast<double>(nearest->gap) > depth;
}

bool are_near(const Piece& a, const Piece& b, const Rigid& b_to_a, double distance) {
  return glm::distance(a.centre(), b_to_a(b.centre())) < a.radius() + b.radius() + distance;
}

std::vector<Facing> facing_points(const Piece& a, const Piece& b, const Rigid& b_to_a, double reach,
                                  std::size_t most) {
  std::vector<Facing> result;
  if (!are_near(a, b, b_to_a, reach)) return result;
  const glm::dvec3 origin_a = a.fragment().surface.origin;
  const glm::dvec3 origin_b = b.fragment().surface.origin;
  for (std::size_t i = 0; i < b.broken().at.size(); ++i) {
    const glm::dvec3 on_b = origin_b + glm::dvec3(b.broken().at[i]);
    const glm::dvec3 in_a = b_to_a(on_b);
    if (glm::distance(in_a, a.centre()) > a.radius() + reach) continue;
    const auto hit = a.broken_index().nearest_within(glm::vec3(in_a - origin_a), static_cast<float>(reach));
    if (!hit) continue;
    const glm::dvec3 normal(a.broken().normals[hit->first]);
    if (glm::dot(normal, b_to_a.rotation * glm::dvec3(b.broken().normals[i])) > kFacing) continue;
    result.push_back({origin_a + glm::dvec3(a.broken().at[hit->first]), normal, on_b,
                      static_cast<double>(b.broken().areas[i])});
  }
  const std::size_t step = stride(result.size(), most);
  if (step == 1) return result;
  std::vector<Facing> fewer;
  fewer.reserve(result.size() / step + 1);
  for (std::size_t i = 0; i < result.size(); i += step) {
    fewer.push_back(result[i]);
    fewer.back().area_of_b *= static_cast<double>(step);
  }
  return fewer;
}

Touch touch(const Piece& a, const Piece& b, const Rigid& b_to_a) {
  const double tolerance = match::contact_tolerance(a.fragment(), b.fragment(), match::Breaks::Worn);
  const double aside = std::max(a.spacing(), b.spacing());
  double area = 0.0;
  double touching = 0.0;
  std::vector<double> gaps;
  for (const Facing& facing : facing_points(a, b, b_to_a, std::hypot(aside, match::kOver * tolerance), 0)) {
    const glm::dvec3 offset = b_to_a(facing.on_b) - facing.on_a;
    const double gap = glm::dot(offset, facing.normal_a);
    if (std::abs(gap) > match::kOver * tolerance) continue;
    if (glm::length(offset - gap * facing.normal_a) > aside) continue;
    gaps.push_back(gap);
    area += facing.area_of_b;
    if (std::abs(gap) <= tolerance) touching += 1.0;
  }
  return {area * touching / static_cast<double>(std::max<std::size_t>(1, gaps.size())),
          match::median_gap(std::move(gaps))};
}

bool touch_forbidden(const Piece& a, const Piece& b, const Rigid& b_to_a) {
  return touch(a, b, b_to_a).area > kLeastForbidden * std::min(a.area(), b.area());
}

bool interpenetrate(const Piece& a, const Piece& b, const Rigid& b_to_a) {
  return overlap_more_than(kMostOverlap, a, b, b_to_a);
}

bool cross(const Piece& a, const Piece& b, const Rigid& b_to_a) {
  return overlap_more_than(kMostCrossing, a, b, b_to_a);
}

}  // namespace rejoin::assembly
