#include "mesh/detail/cloud_normals.hpp"
#include "mesh/detail/fill_holes.hpp"
#include "mesh/detail/local_delaunay.hpp"
#include "mesh/detail/sheet.hpp"
#include "mesh/surface.hpp"

namespace rejoin::mesh {

Mesh surface_of_cloud(const Mesh& cloud) {
  const detail::Neighbourhoods around = detail::local_delaunay(cloud);
  detail::Sheet sheet(cloud.vertices, around.axes);
  for (const detail::Candidate& candidate : around.candidates) sheet.add(candidate.corners);
  detail::fill_holes(cloud, around, sheet);
  Mesh mesh = cloud;
  mesh.faces = sheet.faces();
  return mesh;
}

void estimate_normals(Mesh& cloud) {
  cloud.normals = detail::estimate_normals(cloud.vertices, detail::neighbours_of(cloud.vertices));
}

}  // namespace rejoin::mesh
