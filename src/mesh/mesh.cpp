#include "mesh/mesh.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/median.hpp"
#include "core/parallel.hpp"
#include "mesh/detail/directions.hpp"
#include "mesh/point_index.hpp"

namespace rejoin::mesh {
namespace {

/// Twice the area times the unit normal.
glm::dvec3 face_cross(const Mesh& mesh, const glm::uvec3& face) {
  const glm::dvec3 a(mesh.vertices[face.x]);
  return glm::cross(glm::dvec3(mesh.vertices[face.y]) - a, glm::dvec3(mesh.vertices[face.z]) - a);
}

constexpr std::size_t kDirections = 256;  // none is further than 7 degrees from one of them or its opposite
constexpr std::size_t kTogether = 16;     // directions that go through the vertices at once, in vectors
static_assert(kDirections % kTogether == 0);

/// Of each direction the index of the first vertex that lies furthest back, then of the one furthest along.
void extremes(const std::vector<glm::vec3>& vertices, const glm::vec3* directions, std::uint32_t* ends) {
  std::array<float, kTogether> x;
  std::array<float, kTogether> y;
  std::array<float, kTogether> z;
  std::array<float, kTogether> low;
  std::array<float, kTogether> high;
  std::array<std::uint32_t, kTogether> lowest{};
  std::array<std::uint32_t, kTogether> highest{};
  for (std::size_t k = 0; k < kTogether; ++k) {
    x[k] = directions[k].x;
    y[k] = directions[k].y;
    z[k] = directions[k].z;
    low[k] = std::numeric_limits<float>::infinity();
    high[k] = -low[k];
  }
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    const glm::vec3 v = vertices[i];
    for (std::size_t k = 0; k < kTogether; ++k) {
      const float along = v.x * x[k] + v.y * y[k] + v.z * z[k];
      lowest[k] = along < low[k] ? i : lowest[k];
      low[k] = along < low[k] ? along : low[k];
      highest[k] = along > high[k] ? i : highest[k];
      high[k] = along > high[k] ? along : high[k];
    }
  }
  for (std::size_t k = 0; k < kTogether; ++k) {
    ends[2 * k] = lowest[k];
    ends[2 * k + 1] = highest[k];
  }
}

double cloud_spacing(const Mesh& mesh) {
  // The median is settled by some ten thousand points; more would only take time.
  constexpr std::size_t kEnough = 20000;
  const std::size_t step = std::max<std::size_t>(1, mesh.vertices.size() / kEnough);
  const PointIndex index(mesh.vertices);
  std::vector<std::uint32_t> found;
  std::vector<float> distances;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += step) {
    index.nearest(mesh.vertices[i], 2, found);
    if (found.size() == 2)
      distances.push_back(glm::distance(mesh.vertices[found[0]], mesh.vertices[found[1]]));
  }
  return median(distances);
}

}  // namespace

Box bounds(std::span<const glm::vec3> points) {
  Box box{points.front(), points.front()};
  for (const glm::vec3& point : points) {
    box.low = glm::min(box.low, point);
    box.high = glm::max(box.high, point);
  }
  return box;
}

Box bounds(const Mesh& mesh) {
  return bounds(mesh.vertices);
}

double least_extent(std::span<const glm::vec3> points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const glm::vec3& p : points) mean += Eigen::Vector3d(p.x, p.y, p.z);
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const glm::vec3& p : points) {
    const Eigen::Vector3d off = Eigen::Vector3d(p.x, p.y, p.z) - mean;
    spread += off * off.transpose();
  }
  const Eigen::Vector3d axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
  double low = 0.0;
  double high = 0.0;
  for (const glm::vec3& p : points) {
    const double at = axis.dot(Eigen::Vector3d(p.x, p.y, p.z) - mean);
    low = std::min(low, at);
    high = std::max(high, at);
  }
  return high - low;
}

glm::dvec3 centroid(const Mesh& mesh) {
  glm::dvec3 sum(0.0);
  double weight = 0;
  for (const glm::uvec3& face : mesh.faces) {
    const double area = glm::length(face_cross(mesh, face));
    sum += area / 3.0 *
           (glm::dvec3(mesh.vertices[face.x]) + glm::dvec3(mesh.vertices[face.y]) +
            glm::dvec3(mesh.vertices[face.z]));
    weight += area;
  }
  if (weight > 0) return sum / weight;
  sum = glm::dvec3(0.0);
  for (const glm::vec3& vertex : mesh.vertices) sum += glm::dvec3(vertex);
  return mesh.vertices.empty() ? sum : sum / static_cast<double>(mesh.vertices.size());
}

double diameter(const Mesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  // The width along a direction 7 degrees off the longest chord is at least cos 7 = 0.993 of it.
  const std::vector<glm::vec3> directions = detail::half_sphere_directions(kDirections);
  std::vector<std::uint32_t> ends(2 * directions.size());
  parallel_for(directions.size() / kTogether, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first * kTogether; i < last * kTogether; i += kTogether) {
      extremes(mesh.vertices, &directions[i], &ends[2 * i]);
    }
  });
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  double longest = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t k = i + 1; k < ends.size(); ++k) {
      longest = std::max(
          longest, glm::distance(glm::dvec3(mesh.vertices[ends[i]]), glm::dvec3(mesh.vertices[ends[k]])));
    }
  }
  return longest;
}

double resolution(const Mesh& mesh) {
  if (mesh.is_cloud()) return cloud_spacing(mesh);
  std::vector<float> lengths;
  lengths.reserve(3 * mesh.faces.size());
  for (const glm::uvec3& face : mesh.faces) {
    lengths.push_back(glm::distance(mesh.vertices[face.x], mesh.vertices[face.y]));
    lengths.push_back(glm::distance(mesh.vertices[face.y], mesh.vertices[face.z]));
    lengths.push_back(glm::distance(mesh.vertices[face.z], mesh.vertices[face.x]));
  }
  return median(lengths);
}

double surface_area(const Mesh& mesh) {
  double twice = 0;
  for (const glm::uvec3& face : mesh.faces) twice += glm::length(face_cross(mesh, face));
  return twice / 2;
}

std::vector<glm::vec3> face_normals(const Mesh& mesh) {
  std::vector<glm::vec3> normals(mesh.faces.size(), glm::vec3(0.0F));
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const glm::dvec3 cross = face_cross(mesh, mesh.faces[i]);
    const double length = glm::length(cross);
    if (length > 0) normals[i] = glm::vec3(cross / length);
  }
  return normals;
}

void compute_normals(Mesh& mesh) {
  std::vector<glm::dvec3> sums(mesh.vertices.size(), glm::dvec3(0.0));
  std::vector<glm::dvec3> first(mesh.vertices.size(), glm::dvec3(0.0, 0.0, 1.0));
  std::vector<bool> seen(mesh.vertices.size(), false);
  for (const glm::uvec3& face : mesh.faces) {
    const glm::dvec3 cross = face_cross(mesh, face);
    for (int k = 0; k < 3; ++k) {
      sums[face[k]] += cross;
      if (!seen[face[k]] && glm::length(cross) > 0) {
        first[face[k]] = glm::normalize(cross);
        seen[face[k]] = true;
      }
    }
  }
  mesh.normals.resize(mesh.vertices.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double length = glm::length(sums[i]);
    // Faces that cancel (a sheet drawn from both sides) leave the first one's normal: still unit length.
    mesh.normals[i] = glm::vec3(length > 0 ? sums[i] / length : first[i]);
  }
}

Mesh submesh(const Mesh& mesh, const std::vector<std::uint32_t>& faces) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> renumbered(mesh.vertices.size(), kUnused);
  Mesh part;
  part.origin = mesh.origin;
  part.faces.reserve(faces.size());
  for (const std::uint32_t index : faces) {
    glm::uvec3 face = mesh.faces[index];
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t old = face[k];
      if (renumbered[old] == kUnused) {
        renumbered[old] = static_cast<std::uint32_t>(part.vertices.size());
        part.vertices.push_back(mesh.vertices[old]);
        if (!mesh.normals.empty()) part.normals.push_back(mesh.normals[old]);
        if (!mesh.colours.empty()) part.colours.push_back(mesh.colours[old]);
      }
      face[k] = renumbered[old];
    }
    part.faces.push_back(face);
  }
  return part;
}

Mesh points_of(const Mesh& cloud, const std::vector<std::uint32_t>& points) {
  Mesh part;
  part.origin = cloud.origin;
  for (const std::uint32_t i : points) {
    part.vertices.push_back(cloud.vertices[i]);
    if (!cloud.normals.empty()) part.normals.push_back(cloud.normals[i]);
    if (!cloud.colours.empty()) part.colours.push_back(cloud.colours[i]);
  }
  return part;
}

}  // namespace rejoin::mesh
