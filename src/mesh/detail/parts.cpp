#include "mesh/detail/parts.hpp"

#include <algorithm>

namespace rejoin::mesh::detail {

std::vector<std::uint32_t> part_of_faces(const Mesh& mesh) {
  Components components(mesh.vertices.size());
  for (const glm::uvec3& face : mesh.faces) {
    components.unite(face.x, face.y);
    components.unite(face.x, face.z);
  }
  PartNumbers numbers(components, mesh.vertices.size());
  std::vector<std::uint32_t> result;
  result.reserve(mesh.faces.size());
  for (const glm::uvec3& face : mesh.faces) result.push_back(numbers.of(face.x));
  return result;
}

std::vector<Part> measured_parts(const Mesh& mesh, const std::vector<std::uint32_t>& part_of_face) {
  std::vector<Part> parts(*std::max_element(part_of_face.begin(), part_of_face.end()) + 1);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const glm::uvec3& face = mesh.faces[f];
    const glm::dvec3 a(mesh.vertices[face.x]);
    const glm::dvec3 b(mesh.vertices[face.y]);
    const glm::dvec3 c(mesh.vertices[face.z]);
    const glm::dvec3 facing = 0.5 * glm::cross(b - a, c - a);
    parts[part_of_face[f]].add(
        {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)), glm::length(facing), facing});
  }
  return parts;
}

std::vector<Part> measured_point_parts(const Mesh& cloud, const std::vector<std::uint32_t>& part_of_point) {
  std::vector<Part> parts(*std::max_element(part_of_point.begin(), part_of_point.end()) + 1);
  for (std::size_t i = 0; i < cloud.vertices.size(); ++i) {
    const glm::dvec3 point(cloud.vertices[i]);
    const glm::dvec3 facing = cloud.normals.empty() ? glm::dvec3(0.0) : glm::dvec3(cloud.normals[i]);
    parts[part_of_point[i]].add({point, point, 1.0, facing});
  }
  return parts;
}

std::vector<std::vector<std::uint32_t>> members_of_parts(const std::vector<std::uint32_t>& part_of,
                                                         std::size_t parts) {
  std::vector<std::vector<std::uint32_t>> members(parts);
  for (std::uint32_t i = 0; i < part_of.size(); ++i) members[part_of[i]].push_back(i);
  return members;
}

}  // namespace rejoin::mesh::detail
