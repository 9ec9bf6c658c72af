/// All bodies of a scene as one list of triangles in one frame, with what shading needs.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "report/renderer.hpp"

namespace rejoin::report::detail {

/// Vertices are relative to `centre`, so that far-away scans keep their precision.
struct Soup {
  glm::dvec3 centre{0.0};  ///< common frame
  double radius = 0;       ///< of a ball about the centre that holds everything
  std::vector<glm::vec3> vertices;
  std::vector<glm::vec3> normals;  ///< one a vertex, unit
  std::vector<glm::uvec3> faces;
  std::vector<std::uint32_t> first_face;      ///< one a body, and the end
  std::vector<Colour> vertex_colours;         ///< one a vertex
  std::vector<Colour> face_colours;           ///< one a face where any body has them, else empty
  std::vector<std::uint8_t> has_face_colour;  ///< one a body

  int body_of(std::uint32_t face) const;
};

/// \throws InputError a body has no faces
Soup make_soup(const std::vector<Body>& bodies);

/// A point of a face as it is shaded.
struct ShadingPoint {
  glm::vec3 normal;  ///< smooth, but creases over 50 degrees stay sharp; unit
  glm::vec3 flat;    ///< the face's own normal, unit
  glm::vec3 albedo;  ///< linear light, 0 .. 1
};

/// \param u, v  barycentric weights of the face's second and third corner
ShadingPoint shading_point(const Soup& soup, std::uint32_t face, float u, float v);

/// sRGB <-> linear light, 0 .. 1.
float to_linear(float srgb);
float to_srgb(float linear);

}  // namespace rejoin::report::detail
