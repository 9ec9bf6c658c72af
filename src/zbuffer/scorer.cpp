#include "zbuffer/scorer.hpp"

#include "core/error.hpp"
#include "zbuffer/detail/backends.hpp"
#include "zbuffer/detail/view.hpp"
#if __has_include("zbuffer/gl/gl_backend.hpp")
#include "zbuffer/gl/gl_backend.hpp"
#define REJOIN_GL_BACKENDS
#endif

namespace rejoin::zbuffer {
namespace {

#ifdef REJOIN_GL_BACKENDS
BackendInfo probe_gl(Backend backend) {
  return gl::probe(backend);
}
#else
BackendInfo probe_gl(Backend backend) {
  return {backend, false, "", "built without GL"};
}
#endif

std::unique_ptr<Scorer> make_gl(Backend backend, const mesh::Mesh& a, const mesh::Mesh& b,
                                const ViewOptions& options) {
#ifdef REJOIN_GL_BACKENDS
  return gl::make(backend, a, b, options);
#else
  static_cast<void>(a), static_cast<void>(b), static_cast<void>(options);
  throw BackendError(std::string(name_of(backend)), "built without GL", "choose raster");
#endif
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
    case Backend::Gpu:
    case Backend::OsMesa:
      return make_gl(backend, a, b, complete);
    case Backend::RayCast:
      return detail::make_raycast(a, b, complete);
    case Backend::Reference:
      return detail::make_reference(a, b, complete);
    case Backend::Auto:
    case Backend::Raster:
      break;
  }
  return detail::make_raster(a, b, complete);
}

std::vector<BackendInfo> list_backends() {
  return {probe_gl(Backend::Gpu),
          probe_gl(Backend::OsMesa),
          {Backend::Raster, true, detail::raster_renderer(), ""},
          {Backend::RayCast, true, detail::raycast_renderer(), ""},
          {Backend::Reference, true, detail::reference_renderer(), ""}};
}

}  // namespace rejoin::zbuffer
