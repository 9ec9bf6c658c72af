#include "zbuffer/gl/gl_backend.hpp"

#include "core/error.hpp"
#include "zbuffer/gl/gl_scorer.hpp"

namespace rejoin::zbuffer::gl {

std::unique_ptr<Scorer> make(Backend backend, const mesh::Mesh& a, const mesh::Mesh& b,
                             const ViewOptions& options) {
  return make_gl_scorer(shared_engine(backend), backend, a, b, options, Path::Auto);
}

BackendInfo probe(Backend backend) {
  try {
    return {backend, true, shared_engine(backend)->context().renderer(), {}};
  } catch (const BackendError& error) {
    return {backend, false, {}, error.what()};
  }
}

bool is_software(const BackendInfo& info) {
  return is_software_renderer(info.renderer);
}

}  // namespace rejoin::zbuffer::gl
