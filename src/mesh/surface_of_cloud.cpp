#include "mesh/detail/surface_of_cloud.hpp"
#include "mesh/detail/cloud_normals.hpp"
#include "mesh/detail/fill_holes.hpp"
#include "mesh/detail/local_delaunay.hpp"
#include "mesh/detail/sheet.hpp"
#include "mesh/surface.hpp"

namespace rejoin::mesh {

Mesh detail::surface_of_cloud(const Mesh& cloud, CloudNeighbours& neighbours) {
  const Neighbourhoods around = local_delaunay(cloud, neighbours.wide());
  Sheet sheet(cloud.vertices, around.axes);
  for (const Candidate& candidate : around.candidates) sheet.add(candidate.corners);
  fill_holes(cloud, around, sheet);
  Mesh mesh = cloud;
  mesh.faces = sheet.faces();
  return mesh;
}

Mesh surface_of_cloud(const Mesh& cloud) {
  detail::CloudNeighbours neighbours(cloud.vertices);
  return detail::surface_of_cloud(cloud, neighbours);
}

void estimate_normals(Mesh& cloud) {
  cloud.normals = detail::estimate_normals(cloud.vertices, detail::CloudNeighbours(cloud.vertices).near());
}

}  // namespace rejoin::mesh
