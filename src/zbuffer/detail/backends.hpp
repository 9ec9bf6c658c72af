/// The CPU backends behind make_scorer.
#pragma once

#include <memory>
#include <string>

#include "zbuffer/scorer.hpp"

namespace rejoin::zbuffer::detail {

/// All: \param options completed.  The meshes are copied; they need not outlive the scorer.
std::unique_ptr<Scorer> make_raster(const mesh::Mesh& a, const mesh::Mesh& b, const ViewOptions& options);
/// \throws BackendError  Embree does not start or cannot build a scene
std::unique_ptr<Scorer> make_raycast(const mesh::Mesh& a, const mesh::Mesh& b, const ViewOptions& options);
std::unique_ptr<Scorer> make_reference(const mesh::Mesh& a, const mesh::Mesh& b, const ViewOptions& options);

/// What Scorer::renderer() says, without making one.
std::string raster_renderer();
std::string raycast_renderer();
std::string reference_renderer();

}  // namespace rejoin::zbuffer::detail
