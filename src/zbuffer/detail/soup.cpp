#include <cmath>

#include "zbuffer/detail/raster_kernel.hpp"

namespace rejoin::zbuffer::detail {
namespace {

bool is_finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void put(TriangleSoup& soup, std::size_t place, int corner, const glm::vec3& v) {
  float* block = soup.blocks.data() + place / kSoupBlock * 9 * kSoupBlock;
  for (int axis = 0; axis < 3; ++axis) {
    block[static_cast<std::size_t>(3 * corner + axis) * kSoupBlock + place % kSoupBlock] = v[axis];
  }
}

}  // namespace

TriangleSoup soup_of(const mesh::Mesh& mesh) {
  std::vector<glm::uvec3> faces;
  for (const glm::uvec3& f : mesh.faces) {
    if (is_finite(mesh.vertices[f.x]) && is_finite(mesh.vertices[f.y]) && is_finite(mesh.vertices[f.z])) {
      faces.push_back(f);
    }
  }
  TriangleSoup soup;
  if (faces.empty()) return soup;
  const std::size_t places = (faces.size() + kSoupBlock - 1) / kSoupBlock * kSoupBlock;
  soup.blocks.resize(9 * places);
  soup.low = soup.high = mesh.vertices[faces[0].x];
  for (std::size_t place = 0; place < places; ++place) {
    const glm::uvec3 f = place < faces.size() ? faces[place] : glm::uvec3(faces[0].x);
    for (int corner = 0; corner < 3; ++corner) {
      const glm::vec3& v = mesh.vertices[f[corner]];
      put(soup, place, corner, v);
      soup.low = glm::min(soup.low, v);
      soup.high = glm::max(soup.high, v);
    }
  }
  return soup;
}

}  // namespace rejoin::zbuffer::detail
