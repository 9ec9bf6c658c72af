#include "zbuffer/gl/gl_backend.hpp"

#include "core/error.hpp"
#include "zbuffer/gl/gl_scorer.hpp"
#include "zbuffer/gl/path_choice.hpp"

namespace rejoin::zbuffer::gl {

std::unique_ptr<Scorer> make(Backend backend, const mesh::Mesh& a, const mesh::Mesh& b,
                             const ViewOptions& options) {
  const std::shared_ptr<Engine> engine = shared_engine(backend);
  return make_gl_scorer(engine, backend, a, b, options, preferred_path(engine, backend, options.resolution));
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
