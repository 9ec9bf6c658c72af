#include "zbuffer/scorer.hpp"

#include "core/error.hpp"
#include "zbuffer/detail/backends.hpp"
#include "zbuffer/detail/view.hpp"
#include "zbuffer/gl/gl_backend.hpp"

namespace rejoin::zbuffer {
namespace {

/// Software GL is the slowest way to draw, a GPU the fastest.
bool has_hardware_gpu() {
  static const bool found = [] {
    const BackendInfo info = gl::probe(Backend::Gpu);
    return info.available && !gl::is_software(info);
  }();
  return found;
}

/// \param options  completed
std::unique_ptr<Scorer> make_fastest(const mesh::Mesh& a, const mesh::Mesh& b, const ViewOptions& options) {
  if (has_hardware_gpu()) {
    try {
      return gl::make(Backend::Gpu, a, b, options);
    } catch (const BackendError&) {
      // A GPU that is full or lost is no reason to stop: the CPU gives the same scores, within rounding.
    }
  }
  return detail::make_raster(a, b, options);
}

}  // namespace

std::string_view name_of(Backend backend) {
  switch (backend) {
    case Backend::Auto:
      return "auto";
    case Backend::Gpu:
      return "gpu";
    case Backend::OsMesa:
      return "osmesa";
    case Backend::Raster:
      return "raster";
    case Backend::RayCast:
      return "raycast";
    case Backend::Reference:
      return "reference";
  }
  return "unknown";
}

std::unique_ptr<Scorer> make_scorer(Backend backend, const mesh::Mesh& a, const mesh::Mesh& b,
                                    const ViewOptions& options) {
  const ViewOptions complete = detail::completed(a, b, options);
  switch (backend) {
    case Backend::Auto:
      return make_fastest(a, b, complete);
    case Backend::Gpu:
    case Backend::OsMesa:
      return gl::make(backend, a, b, complete);
    case Backend::Raster:
      return detail::make_raster(a, b, complete);
    case Backend::RayCast:
      return detail::make_raycast(a, b, complete);
    case Backend::Reference:
      return detail::make_reference(a, b, complete);
  }
  throw BackendError("backend", "has no such number", "choose one that `rejoin info` lists");
}

std::vector<BackendInfo> list_backends() {
  return {gl::probe(Backend::Gpu),
          gl::probe(Backend::OsMesa),
          {Backend::Raster, true, detail::raster_renderer(), ""},
          {Backend::RayCast, true, detail::raycast_renderer(), ""},
          {Backend::Reference, true, detail::reference_renderer(), ""}};
}

}  // namespace rejoin::zbuffer
