/// The OpenGL backends: Backend::Gpu (EGL) and Backend::OsMesa.
///
/// Both need OpenGL 4.3.  libEGL and libOSMesa are opened at run time, so a program starts without them.  The
/// environment's REJOIN_EGL_LIBRARY and REJOIN_OSMESA_LIBRARY name other files to open instead.
#pragma once

#include <memory>

#include "mesh/mesh.hpp"
#include "zbuffer/scorer.hpp"

namespace rejoin::zbuffer::gl {

/// A scorer on the backend's one context, which all scorers of the process share: they may live in several
/// threads and take turns.
///
/// A compute rasteriser covers exactly the CPU rasteriser's pixels; depths differ by rounding (1e-6 of the view
/// side).  What a driver cannot compute (with software: more than 512 pixels or 100,000 faces) the fixed
/// pipeline draws, on the driver's own sub-pixel grid (1/256 pixel, mostly); on hardware also what it draws
/// faster, by a measurement that the user's cache folder keeps (path_choice.hpp).
/// \pre backend is Gpu or OsMesa
/// \throws BackendError  the library or a driver is missing, or too old
/// \throws InputError    a mesh has no faces, or an option is out of range
std::unique_ptr<Scorer> make(Backend backend, const mesh::Mesh& a, const mesh::Mesh& b,
                             const ViewOptions& options);

/// Whether the backend works here and what draws.  The first call makes the context (about 0.1 s); later
/// ones cost nothing.
/// \pre backend is Gpu or OsMesa
BackendInfo probe(Backend backend);

/// Whether what draws is the CPU (llvmpipe and its like), so that a rasteriser of our own is the faster
/// choice.
bool is_software(const BackendInfo& info);

}  // namespace rejoin::zbuffer::gl
