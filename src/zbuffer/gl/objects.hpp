/// RAII handles for OpenGL objects.  All must be made and destroyed while their context is current.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "zbuffer/gl/functions.hpp"

namespace rejoin::zbuffer::gl {

/// A name that GL gave out; `Deleter::destroy(gl, name)` gives it back.
template <typename Deleter>
class Handle {
 public:
  Handle() = default;
  Handle(const Functions& gl, GLuint name) : gl_(&gl), name_(name) {}
  ~Handle() { reset(); }
  Handle(Handle&& other) noexcept : gl_(other.gl_), name_(std::exchange(other.name_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(name_, other.name_);
    return *this;
  }

  GLuint name() const { return name_; }
  void reset() {
    if (name_ != 0) Deleter::destroy(*gl_, name_);
    name_ = 0;
  }

 private:
  const Functions* gl_ = nullptr;
  GLuint name_ = 0;
};

struct DeleteBuffer {
  static void destroy(const Functions& gl, GLuint name) { gl.DeleteBuffers(1, &name); }
};
struct DeleteTexture {
  static void destroy(const Functions& gl, GLuint name) { gl.DeleteTextures(1, &name); }
};
struct DeleteFramebuffer {
  static void destroy(const Functions& gl, GLuint name) { gl.DeleteFramebuffers(1, &name); }
};
struct DeleteVertexArray {
  static void destroy(const Functions& gl, GLuint name) { gl.DeleteVertexArrays(1, &name); }
};
struct DeleteShader {
  static void destroy(const Functions& gl, GLuint name) { gl.DeleteShader(name); }
};
struct DeleteProgram {
  static void destroy(const Functions& gl, GLuint name) { gl.DeleteProgram(name); }
};

using Buffer = Handle<DeleteBuffer>;
using Texture = Handle<DeleteTexture>;
using Framebuffer = Handle<DeleteFramebuffer>;
using VertexArray = Handle<DeleteVertexArray>;
using Program = Handle<DeleteProgram>;

/// A buffer of `bytes` bytes, filled from `data` unless that is null.
Buffer make_buffer(const Functions& gl, GLenum target, std::size_t bytes, const void* data, GLenum usage);

template <typename Value>
Buffer make_buffer(const Functions& gl, GLenum target, std::span<const Value> values) {
  return make_buffer(gl, target, values.size_bytes(), values.data(), GL_STATIC_DRAW);
}

Texture make_texture(const Functions& gl);
Framebuffer make_framebuffer(const Functions& gl);
VertexArray make_vertex_array(const Functions& gl);

/// One stage: the named files of shaders/ one after the other, after "#version" and `defines` ("#define N
/// 3\n").
struct Stage {
  GLenum type;
  std::vector<std::string_view> files;
};

/// \throws BackendError  with the driver's log, if a stage does not compile or they do not link
Program make_program(const Functions& gl, const std::string& subject, const std::vector<Stage>& stages,
                     const std::string& defines);

}  // namespace rejoin::zbuffer::gl
