#include "zbuffer/detail/view.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.hpp"
#include "zbuffer/detail/drawable.hpp"

namespace rejoin::zbuffer::detail {
namespace {

constexpr double kViewToDiameter = 1.3;
constexpr int kMinResolution = 8;
constexpr int kMaxResolution = 2048;

void require_faces(const mesh::Mesh& mesh, const std::string& name) {
  if (mesh.faces.empty()) {
    throw InputError(name, "has no faces, so it cannot be drawn", "make a surface of the cloud first");
  }
}

Projection projection(const glm::mat3& rotation, const glm::vec2& shift, const glm::vec3& centre,
                      const ViewOptions& options) {
  const double pixels = options.resolution / options.view_side;
  const glm::dvec3 scale(pixels, pixels, -1.0);
  const glm::dmat3 turned(rotation);
  const glm::dvec3 moved = glm::dvec3(shift, 0.0) - turned * glm::dvec3(centre);
  const double middle = options.resolution / 2.0;
  Projection result;
  for (int column = 0; column < 3; ++column) result.linear[column] = glm::vec3(scale * turned[column]);
  result.offset = glm::vec3(scale * moved + glm::dvec3(middle, middle, options.view_side / 2.0));
  return result;
}

}  // namespace

Gaze gaze_of(const Projection& projection) {
  const glm::dmat3 linear(projection.linear);
  const double volume = glm::determinant(linear);
  const glm::dvec3 along = glm::cross(glm::dvec3(linear[0][0], linear[1][0], linear[2][0]),
                                      glm::dvec3(linear[0][1], linear[1][1], linear[2][1])) /
                           volume;  // with x and y as they are, depth grows by 1
  const double length = glm::length(along);
  if (!std::isfinite(length) || length == 0.0) return {};
  return {glm::vec3(along / length), volume < 0.0};
}

ViewOptions completed(const mesh::Mesh& a, const mesh::Mesh& b, ViewOptions options) {
  require_faces(a, "fragment A");
  require_faces(b, "fragment B");
  if (options.resolution < kMinResolution || options.resolution > kMaxResolution) {
    throw InputError("resolution", std::to_string(options.resolution) + " pixels is out of range",
                     "choose " + std::to_string(kMinResolution) + " .. " + std::to_string(kMaxResolution));
  }
  if (!is_finite(options.centre_a) || !is_finite(options.centre_b)) {
    throw InputError("view centre", "is not finite");
  }
  if (options.view_side <= 0) {
    options.view_side = kViewToDiameter * std::max(mesh::diameter(a), mesh::diameter(b));
  }
  if (!std::isfinite(options.view_side) || options.view_side <= 0) {
    throw InputError("view side", "must be finite and above 0", "the fragments may have no extent");
  }
  return options;
}

Projection projection_a(const ViewPair& pose, const ViewOptions& options) {
  return projection(pose.rotation_a, pose.shift_a, options.centre_a, options);
}

Projection projection_b(const ViewPair& pose, const ViewOptions& options) {
  return projection(pose.rotation_b, glm::vec2(0.0F), options.centre_b, options);
}

}  // namespace rejoin::zbuffer::detail
