#include "zbuffer/gl/context.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "core/error.hpp"

namespace rejoin::zbuffer::gl {

Context::Context(Backend backend)
    : subject_(std::string("backend ") + (backend == Backend::Gpu ? "gpu" : "osmesa")) {}

void Context::load(const FunctionLoader& loader, bool debug) {
  gl_ = load_functions(subject_, loader);
  const auto text = [&](GLenum what) {
    const auto* name = gl_.GetString(what);
    return std::string(name != nullptr ? reinterpret_cast<const char*>(name) : "unknown");
  };
  renderer_ = text(GL_RENDERER);
  version_ = text(GL_VERSION);
  GLint major = 0;
  GLint minor = 0;
  gl_.GetIntegerv(GL_MAJOR_VERSION, &major);
  gl_.GetIntegerv(GL_MINOR_VERSION, &minor);
  if (major * 10 + minor < 43) {
    throw BackendError(
        subject_, renderer_ + " offers only OpenGL " + std::to_string(major) + "." + std::to_string(minor),
        "use a driver with OpenGL 4.3 or --backend raster");
  }
  if (debug) {
    gl_.Enable(GL_DEBUG_OUTPUT);
    gl_.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    gl_.DebugMessageCallback(&Context::note, this);
  }
}

void APIENTRY Context::note(GLenum, GLenum type, GLuint, GLenum, GLsizei, const GLchar* message,
                            const void* context) {
  if (type != GL_DEBUG_TYPE_ERROR && type != GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR) return;
  std::string& misuse = static_cast<const Context*>(context)->misuse_;
  if (misuse.empty()) misuse = message;
}

void Context::check(const char* doing) const {
  if (!misuse_.empty()) {
    const std::string what = std::exchange(misuse_, {});
    throw BackendError(subject_, std::string("OpenGL while ") + doing + ": " + what);
  }
  check_errors(gl_, subject_, doing);
}

std::unique_ptr<Context> make_context(Backend backend, const ContextOptions& options) {
  return backend == Backend::OsMesa ? make_osmesa_context(options) : make_egl_context(options);
}

bool is_software_renderer(const std::string& renderer) {
  std::string lower(renderer.size(), ' ');
  std::transform(renderer.begin(), renderer.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array<std::string_view, 6> kNames{"llvmpipe", "softpipe",    "swrast",
                                                   "software", "swiftshader", "lavapipe"};
  return std::any_of(kNames.begin(), kNames.end(),
                     [&](std::string_view name) { return lower.find(name) != std::string::npos; });
}

}  // namespace rejoin::zbuffer::gl
