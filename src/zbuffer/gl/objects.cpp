#include "zbuffer/gl/objects.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "zbuffer/gl/shaders.hpp"

namespace rejoin::zbuffer::gl {
namespace {

using Shader = Handle<DeleteShader>;

/// The first line of a driver's log: messages are one line.
std::string first_line(std::string log) {
  log.resize(std::min(log.find_first_of(std::string("\n\0", 2)), log.size()));
  return log;
}

Shader compile(const Functions& gl, const std::string& subject, const Stage& stage,
               const std::string& defines) {
  Shader shader(gl, gl.CreateShader(stage.type));
  std::string source = "#version 430 core\n" + defines;
  for (const std::string_view file : stage.files) source += shader_source(file);
  const GLchar* text = source.c_str();
  gl.ShaderSource(shader.name(), 1, &text, nullptr);
  gl.CompileShader(shader.name());
  GLint good = GL_FALSE;
  gl.GetShaderiv(shader.name(), GL_COMPILE_STATUS, &good);
  if (good == GL_FALSE) {
    std::string log(4096, '\0');
    gl.GetShaderInfoLog(shader.name(), static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw BackendError(subject, "shader " + std::string(stage.files.back()) + ": " + first_line(log),
                       "choose --backend raster and report the driver");
  }
  return shader;
}

}  // namespace

Buffer make_buffer(const Functions& gl, GLenum target, std::size_t bytes, const void* data, GLenum usage) {
  GLuint name = 0;
  gl.GenBuffers(1, &name);
  Buffer buffer(gl, name);
  gl.BindBuffer(target, name);
  gl.BufferData(target, static_cast<GLsizeiptr>(bytes), data, usage);
  return buffer;
}

Texture make_texture(const Functions& gl) {
  GLuint name = 0;
  gl.GenTextures(1, &name);
  return {gl, name};
}

Framebuffer make_framebuffer(const Functions& gl) {
  GLuint name = 0;
  gl.GenFramebuffers(1, &name);
  return {gl, name};
}

VertexArray make_vertex_array(const Functions& gl) {
  GLuint name = 0;
  gl.GenVertexArrays(1, &name);
  return {gl, name};
}

Program make_program(const Functions& gl, const std::string& subject, const std::vector<Stage>& stages,
                     const std::string& defines) {
  Program program(gl, gl.CreateProgram());
  std::vector<Shader> shaders;
  for (const Stage& stage : stages) {
    shaders.push_back(compile(gl, subject, stage, defines));
    gl.AttachShader(program.name(), shaders.back().name());
  }
  gl.LinkProgram(program.name());
  GLint good = GL_FALSE;
  gl.GetProgramiv(program.name(), GL_LINK_STATUS, &good);
  if (good == GL_FALSE) {
    std::string log(4096, '\0');
    gl.GetProgramInfoLog(program.name(), static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw BackendError(subject, "linking " + std::string(stages.back().files.back()) + ": " + first_line(log),
                       "choose --backend raster and report the driver");
  }
  return program;
}

}  // namespace rejoin::zbuffer::gl
