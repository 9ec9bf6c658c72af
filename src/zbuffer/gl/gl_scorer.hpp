/// The scorer behind gl_backend.hpp, with its switches.
#pragma once

#include <memory>

#include "mesh/mesh.hpp"
#include "zbuffer/gl/engine.hpp"
#include "zbuffer/scorer.hpp"

namespace rejoin::zbuffer::gl {

enum class Path {
  Auto,           ///< Compute, or Pipeline where the driver cannot
  Compute,        ///< a compute rasteriser; never Pipeline as a whole
  ComputeAnyway,  ///< likewise, also where a software driver may cut the work short
  Pipeline,       ///< fixed pipeline, then a compute reduction
};

/// \param path  never decided by a measurement here (preferred_path() of path_choice.hpp does that).  A pose
///              that the driver does not finish on a compute path is drawn by the pipeline.
/// \throws BackendError  also if the driver cannot do the work of Path::Compute
/// \throws InputError    a mesh has no faces, or an option is out of range
std::unique_ptr<Scorer> make_gl_scorer(std::shared_ptr<Engine> engine, Backend backend, const mesh::Mesh& a,
                                       const mesh::Mesh& b, const ViewOptions& options, Path path);

}  // namespace rejoin::zbuffer::gl
