#include "match/gap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "mesh/area_normals.hpp"

namespace rejoin::match {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

const mesh::Mesh& with_faces(const mesh::Mesh& surface) {
  if (surface.faces.empty())
    throw InputError("gap", "the surface has no faces", "make a surface of the cloud first");
  return surface;
}

/// One thread builds: then the tree, and with it the order of equally near faces, never depends on the
/// machine.
mesh::RayScene make_scene(const mesh::Mesh& surface) {
  const ThreadLimit one(1);
  return mesh::RayScene(surface);
}

glm::vec3 unit_or_zero(const glm::vec3& v) {
  const float length = glm::length(v);
  return length > 0 ? v / length : glm::vec3(0.0F);
}

/// Normals of the faces; 0 for those so thin that the rounding of their corners decides where they look.
std::vector<glm::vec3> reliable_normals(const mesh::Mesh& mesh) {
  constexpr float kRounding = 1e-6F;  // of the coordinates: eight units in the last place
  const mesh::Box box = mesh::bounds(mesh);
  const glm::vec3 far = glm::max(glm::abs(box.low), glm::abs(box.high));
  const float least_height = kRounding * std::max({far.x, far.y, far.z});
  std::vector<glm::vec3> result(mesh.faces.size(), glm::vec3(0.0F));
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const glm::uvec3 face = mesh.faces[f];
    const glm::vec3 ab = mesh.vertices[face.y] - mesh.vertices[face.x];
    const glm::vec3 ac = mesh.vertices[face.z] - mesh.vertices[face.x];
    const float longest = std::max({glm::length(ab), glm::length(ac), glm::length(ac - ab)});
    const glm::vec3 normal = glm::cross(ab, ac);
    if (glm::length(normal) > least_height * longest) result[f] = glm::normalize(normal);
  }
  return result;
}

float angle_at(const glm::vec3& corner, const glm::vec3& p, const glm::vec3& q) {
  return std::acos(std::clamp(glm::dot(unit_or_zero(p - corner), unit_or_zero(q - corner)), -1.0F, 1.0F));
}

std::vector<glm::vec3> angle_weighted_normals(const mesh::Mesh& mesh,
                                              std::span<const glm::vec3> face_normals) {
  std::vector<glm::vec3> result(mesh.vertices.size(), glm::vec3(0.0F));
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const glm::uvec3 face = mesh.faces[f];
    for (int k = 0; k < 3; ++k) {
      const glm::vec3& corner = mesh.vertices[face[k]];
      result[face[k]] += face_normals[f] *
                         angle_at(corner, mesh.vertices[face[(k + 1) % 3]], mesh.vertices[face[(k + 2) % 3]]);
    }
  }
  for (glm::vec3& normal : result) normal = unit_or_zero(normal);
  return result;
}

/// Weights of the corners at a point of the triangle's plane; the whole weight on the first where it has no
/// area.
glm::vec3 barycentric(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::vec3 normal = glm::cross(b - a, c - a);
  const float square = glm::dot(normal, normal);
  if (square <= 0) return {1, 0, 0};
  const float wb = glm::dot(glm::cross(p - a, c - a), normal) / square;
  const float wc = glm::dot(glm::cross(b - a, p - a), normal) / square;
  return {1 - wb - wc, wb, wc};
}

/// The sum over the neighbours: calm on noisy scans, but wrong next to edges.
std::vector<glm::vec3> spread(const mesh::Mesh& mesh, const std::vector<glm::vec3>& normals) {
  std::vector<glm::vec3> result(normals.size(), glm::vec3(0.0F));
  for (const glm::uvec3& face : mesh.faces) {
    const glm::vec3 sum = normals[face.x] + normals[face.y] + normals[face.z];
    for (int k = 0; k < 3; ++k) result[face[k]] += sum;
  }
  return result;
}

void make_unit(std::vector<glm::vec3>& normals) {
  for (glm::vec3& normal : normals) normal = unit_or_zero(normal);
}

/// The box of a surface, grown by a distance: most vertices of a large partner lie outside it.
struct Reach {
  glm::vec3 low, high;

  Reach(const mesh::Mesh& mesh, float distance) {
    const mesh::Box box = mesh::bounds(mesh);
    low = box.low - distance;
    high = box.high + distance;
  }
  bool holds(const glm::vec3& p) const {
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z;
  }
};

/// Share of the area of the faces around each vertex; 1 each for a cloud.
std::vector<double> vertex_areas(const mesh::Mesh& mesh) {
  if (mesh.is_cloud()) return std::vector<double>(mesh.vertices.size(), 1.0);
  std::vector<double> result(mesh.vertices.size(), 0.0);
  for (const glm::uvec3& face : mesh.faces) {
    const glm::vec3& a = mesh.vertices[face.x];
    const double area = 0.5 * glm::length(glm::cross(mesh.vertices[face.y] - a, mesh.vertices[face.z] - a));
    for (int k = 0; k < 3; ++k) result[face[k]] += area / 3;
  }
  return result;
}

/// Smallest value that at least `share` of the weight does not exceed.  \pre not empty
double weighted_quantile(std::vector<std::pair<double, double>>& values, double share) {
  std::sort(values.begin(), values.end());
  double total = 0;
  for (const auto& [value, weight] : values) total += weight;
  double sum = 0;
  for (const auto& [value, weight] : values) {
    sum += weight;
    if (sum >= share * total) return value;
  }
  return values.back().first;
}

}  // namespace

FacingNormals facing_normals(const mesh::Mesh& mesh) {
  if (mesh.is_cloud()) return {mesh.normals, mesh.normals};
  FacingNormals result;
  result.near = mesh::area_normals(mesh);
  result.calm = spread(mesh, result.near);
  make_unit(result.near);
  make_unit(result.calm);
  return result;
}

GapField::GapField(const mesh::Mesh& surface)
    : surface_(&with_faces(surface)), scene_(make_scene(surface)), face_normals_(reliable_normals(surface)) {
  corner_normals_ = angle_weighted_normals(surface, face_normals_);
  facing_normals_ = facing_normals(surface);
}

std::optional<GapField::Sample> GapField::at(const glm::vec3& point, float max_distance) const {
  constexpr float kInside = 1e-4F;  // of the triangle; nearer to its border the neighbours have a say
  const auto hit = scene_.nearest(point, max_distance);
  if (!hit) return std::nullopt;
  const glm::uvec3 face = surface_->faces[hit->face];
  const glm::vec3 weight = barycentric(hit->point, surface_->vertices[face.x], surface_->vertices[face.y],
                                       surface_->vertices[face.z]);
  const auto blend = [&](const std::vector<glm::vec3>& normals) {
    return unit_or_zero(weight.x * normals[face.x] + weight.y * normals[face.y] + weight.z * normals[face.z]);
  };
  const glm::vec3 flat = face_normals_[hit->face];
  const bool within = std::min({weight.x, weight.y, weight.z}) > kInside && flat != glm::vec3(0.0F);
  const glm::vec3 away = point - hit->point;
  const glm::vec3 near = blend(facing_normals_.near);
  const glm::vec3 calm = blend(facing_normals_.calm);
  const auto behind = [&](const glm::vec3& normal) { return glm::dot(away, normal) < 0; };
  bool inside = behind(within ? flat : blend(corner_normals_));
  if (inside != behind(near) || inside != behind(calm)) inside = leaves_surface(point, away, inside);
  return Sample{inside ? -hit->distance : hit->distance, near, calm, hit->face};
}

/// Whether a ray first meets the surface from within; `otherwise` where the face met has no reliable normal.
bool GapField::leaves_surface(const glm::vec3& start, const glm::vec3& direction, bool otherwise) const {
  const glm::vec3 unit = unit_or_zero(direction);
  if (unit == glm::vec3(0.0F)) return otherwise;
  const auto hit = scene_.first_hit(start, unit, 0.0F, std::numeric_limits<float>::max());
  if (!hit) return false;
  const glm::vec3 normal = face_normals_[hit->face];
  return normal == glm::vec3(0.0F) ? otherwise : glm::dot(unit, normal) > 0;
}

Gaps gaps(const mesh::Mesh& a, const GapField& b, const Rigid& b_to_a, double max_distance) {
  constexpr std::size_t kGrain = 512;
  const auto distance = static_cast<float>(max_distance);
  const FacingNormals normals = facing_normals(a);
  const Rigid a_to_b = inverse(b_to_a);
  const glm::dvec3 offset = a_to_b(a.origin) - b.surface().origin;
  const Reach reach(b.surface(), distance);
  Gaps result{std::vector<float>(a.vertices.size(), kNone), std::vector<float>(a.vertices.size(), kNone)};
  parallel_for(a.vertices.size(), kGrain, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const glm::vec3 point(a_to_b.rotation * glm::dvec3(a.vertices[i]) + offset);
      if (!reach.holds(point)) continue;
      const auto sample = b.at(point, distance);
      if (!sample) continue;
      result.gap[i] = sample->gap;
      const auto facing = [&](const glm::vec3& mine, const glm::vec3& other) {
        return -glm::dot(glm::vec3(a_to_b.rotation * glm::dvec3(mine)), other);
      };
      result.facing[i] =
          std::max(facing(normals.near[i], sample->normal), facing(normals.calm[i], sample->calm_normal));
    }
  });
  return result;
}

std::vector<float> signed_gaps(const mesh::Mesh& a, const mesh::Mesh& b, const Rigid& b_to_a,
                               double max_distance) {
  return gaps(a, GapField(b), b_to_a, max_distance).gap;
}

Contact contact_of(const mesh::Mesh& a, const Gaps& gaps) {
  const std::vector<double> areas = vertex_areas(a);
  const std::vector<glm::vec3> normals = facing_normals(a).near;
  Contact result;
  std::vector<std::pair<double, double>> distances;
  for (std::size_t i = 0; i < a.vertices.size(); ++i) {
    if (!in_contact(gaps, i)) continue;
    const double gap = gaps.gap[i];
    distances.emplace_back(std::abs(gap), areas[i]);
    result.area += areas[i];
    result.penetration += areas[i] * std::max(0.0, -gap);
    result.normal += areas[i] * glm::dvec3(normals[i]);
    result.centre += areas[i] * glm::dvec3(a.vertices[i]);
  }
  if (result.area <= 0) return {};
  result.gap_median = weighted_quantile(distances, 0.5);
  result.gap_p90 = weighted_quantile(distances, 0.9);
  result.penetration /= result.area;
  result.centre = result.centre / result.area + a.origin;
  const double length = glm::length(result.normal);
  result.normal = length > 0 ? result.normal / length : glm::dvec3(0.0);
  return result;
}

}  // namespace rejoin::match
