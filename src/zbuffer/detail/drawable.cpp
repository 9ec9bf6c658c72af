#include "zbuffer/detail/drawable.hpp"

#include <algorithm>

namespace rejoin::zbuffer::detail {

std::vector<glm::uvec3> finite_faces(const mesh::Mesh& mesh) {
  std::vector<glm::uvec3> faces;
  faces.reserve(mesh.faces.size());
  std::ranges::copy_if(mesh.faces, std::back_inserter(faces), [&](const glm::uvec3& f) {
    return is_finite(mesh.vertices[f.x]) && is_finite(mesh.vertices[f.y]) && is_finite(mesh.vertices[f.z]);
  });
  return faces;
}

mesh::Box box_of(const mesh::Mesh& mesh, const std::vector<glm::uvec3>& faces) {
  if (faces.empty()) return {};
  mesh::Box box{mesh.vertices[faces[0].x], mesh.vertices[faces[0].x]};
  for (const glm::uvec3& face : faces) {
    for (int corner = 0; corner < 3; ++corner) {
      box.low = glm::min(box.low, mesh.vertices[face[corner]]);
      box.high = glm::max(box.high, mesh.vertices[face[corner]]);
    }
  }
  return box;
}

mesh::Box projected(const mesh::Box& box, const Projection& projection) {
  mesh::Box result{projection(box.low), projection(box.low)};
  for (unsigned corner = 1; corner < 8; ++corner) {
    const glm::vec3 p =
        projection({(corner & 1U) != 0 ? box.high.x : box.low.x, (corner & 2U) != 0 ? box.high.y : box.low.y,
                    (corner & 4U) != 0 ? box.high.z : box.low.z});
    result.low = glm::min(result.low, p);
    result.high = glm::max(result.high, p);
  }
  return result;
}

}  // namespace rejoin::zbuffer::detail
