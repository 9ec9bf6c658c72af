#include "mesh/area_normals.hpp"

namespace rejoin::mesh {

std::vector<glm::vec3> area_normals(const Mesh& mesh) {
  std::vector<glm::vec3> result(mesh.vertices.size(), glm::vec3(0.0F));
  for (const glm::uvec3& face : mesh.faces) {
    const glm::vec3& a = mesh.vertices[face.x];
    const glm::vec3 normal = glm::cross(mesh.vertices[face.y] - a, mesh.vertices[face.z] - a);
    for (int k = 0; k < 3; ++k) result[face[k]] += normal;
  }
  return result;
}

}  // namespace rejoin::mesh
