/// The one surface type that all modules share.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace rejoin::mesh {

/// A triangle mesh, or an oriented point cloud when `faces` is empty.
///
/// Vertices are stored relative to `origin`, so that scans far from the origin keep their precision: the
/// file's coordinates are origin + vertices[i].  Open, non-manifold and unconnected surfaces are normal.
struct Mesh {
  glm::dvec3 origin{0.0};
  std::vector<glm::vec3> vertices;  ///< mesh units, relative to origin
  std::vector<glm::vec3> normals;   ///< unit length, one a vertex; may be empty for a mesh, never for a cloud
  std::vector<glm::uvec3> faces;    ///< counter-clockwise seen from outside; empty for a cloud
  std::vector<glm::u8vec3> colours;  ///< sRGB, one a vertex, or empty

  bool is_cloud() const { return faces.empty(); }
};

/// Axis-aligned box, relative to the mesh's origin.
struct Box {
  glm::vec3 low{0.0F};
  glm::vec3 high{0.0F};
};

/// Box of points.  \pre there is one
Box bounds(std::span<const glm::vec3> points);
/// Box of all vertices.  \pre the mesh has one
Box bounds(const Mesh& mesh);

/// Extent along the axis along which the points spread least.  \pre there is one
double least_extent(std::span<const glm::vec3> points);

/// Area-weighted centroid of the surface (of the points, for a cloud), relative to mesh.origin.
glm::dvec3 centroid(const Mesh& mesh);

/// Diameter: the largest distance between two vertices, found to within 1 % (never above the true value by
/// more than rounding), mesh units.
double diameter(const Mesh& mesh);

/// Typical spacing of the samples: median edge length of a mesh, median distance to the nearest neighbour of
/// a cloud.
double resolution(const Mesh& mesh);

/// Total area of the faces, squared mesh units; 0 for a cloud.
double surface_area(const Mesh& mesh);

/// Unit normal of every face; (0,0,0) for a face without area.
std::vector<glm::vec3> face_normals(const Mesh& mesh);

/// Sets mesh.normals to the area-weighted mean of the adjacent faces' normals.  \pre the mesh has faces
void compute_normals(Mesh& mesh);

/// The mesh of the chosen faces alone, with the vertices that they use.  Same origin.
Mesh submesh(const Mesh& mesh, const std::vector<std::uint32_t>& faces);

/// The cloud of the chosen points alone.  Same origin.
Mesh points_of(const Mesh& cloud, const std::vector<std::uint32_t>& points);

}  // namespace rejoin::mesh
