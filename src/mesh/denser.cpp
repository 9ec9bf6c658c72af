#include <algorithm>

#include "core/parallel.hpp"
#include "mesh/detail/mean_normals.hpp"
#include "mesh/facets.hpp"
#include "mesh/point_index.hpp"

namespace rejoin::mesh {
namespace {

/// Of every sample the nearest of other samples that looks the same way; of none that does, the nearest.
std::vector<std::uint32_t> alike(const Segmentation& from, const Samples& samples,
                                 const std::vector<glm::vec3>& normals) {
  constexpr std::size_t kLooks = 4;
  const PointIndex index(from.samples.points);
  std::vector<std::uint32_t> found(samples.size());
  parallel_for(found.size(), 512, [&](std::size_t first, std::size_t last) {
    std::vector<std::uint32_t> near;
    for (std::size_t i = first; i < last; ++i) {
      index.nearest(samples.points[i], kLooks, near);
      const auto same = std::ranges::find_if(
          near, [&](std::uint32_t k) { return glm::dot(from.normals[k], normals[i]) >= 0.0F; });
      found[i] = same != near.end() ? *same : near.front();
    }
  });
  return found;
}

template <typename T>
std::vector<T> taken(const std::vector<T>& values, const std::vector<std::uint32_t>& from) {
  if (values.empty()) return {};
  std::vector<T> out;
  out.reserve(from.size());
  for (const auto i : from) out.push_back(values[i]);
  return out;
}

void take_facets(const Cut& cut, const std::vector<std::uint32_t>& from, Cut& into) {
  into.facets = cut.facets;
  into.facet_of_sample = taken(cut.facet_of_sample, from);
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
  const std::vector<std::uint32_t> from = alike(segmentation, s.samples, s.normals);
  s.surface = taken(segmentation.surface, from);
  s.roughness = taken(segmentation.roughness, from);
  s.backed = taken(segmentation.backed, from);
  take_facets(segmentation, from, s);
  take_facets(segmentation.creased, from, s.creased);
  return s;
}

}  // namespace rejoin::mesh
