/// The scorer behind gl_backend.hpp, with its switches.
#pragma once

#include <memory>

#include "mesh/mesh.hpp"
#include "zbuffer/gl/engine.hpp"
#include "zbuffer/scorer.hpp"

namespace rejoin::zbuffer::gl {

enum class Path {
  Auto,           ///< Compute, or Pipeline where the driver cannot
  Compute,        ///< in shared memory where the maps fit, else in a buffer; never Pipeline as a whole
  ComputeBuffer,  ///< maps in a buffer
  ComputeShared,  ///< maps in the work group's memory
  Pipeline,       ///< fixed pipeline, then a compute reduction
};

/// \param path  never decided by a measurement here (preferred_path() of path_choice.hpp does that).  A pose
///              that the driver does not finish on a compute path is drawn by the pipeline.
/// \throws BackendError  also if the maps do not fit for Path::ComputeShared, or the work not for Path::Compute
/// \throws InputError    a mesh has no faces, or an option is out of range
std::unique_ptr<Scorer> make_gl_scorer(std::shared_ptr<Engine> engine, Backend backend, const mesh::Mesh& a,
                                       const mesh::Mesh& b, const ViewOptions& options, Path path);

}  // namespace rejoin::zbuffer::gl
