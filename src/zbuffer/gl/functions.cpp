#include "zbuffer/gl/functions.hpp"

#include "core/error.hpp"

namespace rejoin::zbuffer::gl {
namespace {

const char* error_name(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "invalid enum";
    case GL_INVALID_VALUE:
      return "invalid value";
    case GL_INVALID_OPERATION:
      return "invalid operation";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "incomplete framebuffer";
    case GL_OUT_OF_MEMORY:
      return "out of memory";
    case GL_CONTEXT_LOST:
      return "context lost";
    default:
      return "unknown error";
  }
}

}  // namespace

Functions load_functions(const std::string& subject, const FunctionLoader& loader) {
  Functions gl;
  const auto find = [&](const char* name) {
    const AnyFunction function = loader(name);
    if (function == nullptr) {
      throw BackendError(subject, std::string("the driver lacks ") + name,
                         "use a driver with OpenGL 4.3 or --backend raster");
    }
    return function;
  };
#define REJOIN_GL_LOAD(name, type) gl.name = reinterpret_cast<type>(find("gl" #name));
  REJOIN_GL_FUNCTIONS(REJOIN_GL_LOAD)
#undef REJOIN_GL_LOAD
  return gl;
}

void check_errors(const Functions& gl, const std::string& subject, const char* doing) {
  const GLenum first = gl.GetError();
  if (first == GL_NO_ERROR) return;
  // A lost context may report its error for ever, so the emptying of the queue is bounded.
  for (int i = 0; i < 16 && gl.GetError() != GL_NO_ERROR; ++i) {
  }
  throw BackendError(subject, std::string("OpenGL: ") + error_name(first) + " while " + doing,
                     "choose a smaller --resolution or --backend raster");
}

}  // namespace rejoin::zbuffer::gl
