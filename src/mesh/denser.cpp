#include <algorithm>

#include "mesh/detail/mean_normals.hpp"
#include "mesh/facets.hpp"

namespace rejoin::mesh {
namespace {

template <typename T>
std::vector<T> taken(const std::vector<T>& values, const std::vector<int>& from, T of_none) {
  if (values.empty()) return {};
  std::vector<T> out;
  out.reserve(from.size());
  for (const int i : from) out.push_back(i >= 0 ? values[static_cast<std::size_t>(i)] : of_none);
  return out;
}

void take_facets(const Cut& cut, const std::vector<int>& from, Cut& into) {
  into.facets = cut.facets;
  into.facet_of_sample = taken(cut.facet_of_sample, from, -1);
  for (Facet& facet : into.facets) facet.samples.clear();
  for (std::uint32_t i = 0; i < into.facet_of_sample.size(); ++i) {
    const int facet = into.facet_of_sample[i];
    if (facet >= 0) into.facets[static_cast<std::size_t>(facet)].samples.push_back(i);
  }
}

}  // namespace

Segmentation denser(const Segmentation& segmentation, const Mesh& mesh, double spacing) {
  Segmentation s;
  s.samples = sample_surface(mesh, count_at(mesh, spacing));
  s.normals = detail::mean_normals(
      s.samples.normals,
      detail::neighbours_within(s.samples.points, detail::kNormalRadius * s.samples.spacing), 0.0F);
  s.wall_thickness = segmentation.wall_thickness;
  s.sample_area = surface_area(mesh) / static_cast<double>(std::max<std::size_t>(1, s.samples.size()));
  const std::vector<int> from = nearest_alike(segmentation, s.samples.points, s.normals);
  s.surface = taken(segmentation.surface, from, Surface::Fracture);
  s.roughness = taken(segmentation.roughness, from, 0.0F);
  s.backed = taken(segmentation.backed, from, false);
  take_facets(segmentation, from, s);
  take_facets(segmentation.creased, from, s.creased);
  return s;
}

}  // namespace rejoin::mesh
