#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/error.hpp"
#include "zbuffer/gl/drawing.hpp"

namespace rejoin::zbuffer::gl {
namespace {

constexpr GLuint kRecords = 2;                                // binding in shaders/map_compare.comp
constexpr std::size_t kTargetBytes = std::size_t{32} << 20U;  // 256 poses of 128 x 128

/// A mesh as the fixed pipeline wants it.
struct Drawable {
  Buffer vertices;
  Buffer faces;
  GLsizei indices = 0;
  GLsizei front_only = 0;  // of the indices
  VertexArray layout;
};

Drawable make_drawable(const Functions& gl, const Surface& surface) {
  Drawable made;
  made.layout = make_vertex_array(gl);
  gl.BindVertexArray(made.layout.name());
  made.vertices = make_buffer(gl, GL_ARRAY_BUFFER, std::span<const glm::vec3>(surface.vertices));
  gl.EnableVertexAttribArray(0);
  gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
  made.faces = make_buffer(gl, GL_ELEMENT_ARRAY_BUFFER, std::span<const glm::uvec3>(surface.faces));
  made.indices = static_cast<GLsizei>(surface.faces.size() * 3);
  made.front_only = static_cast<GLsizei>(surface.front_only * 3);
  gl.BindVertexArray(0);
  return made;
}

/// Every map has a layer of its own, so where in a batch a pose stands cannot show in its depths.
class PipelineDrawing : public Drawing {
 public:
  PipelineDrawing(Engine& engine, const Surface& a, const Surface& b, int resolution)
      : engine_(engine), resolution_(resolution) {
    const std::size_t pair_bytes = 8 * static_cast<std::size_t>(resolution) * resolution;
    const std::size_t most = std::max(engine.limits().texture_layers / 2, 1);
    poses_a_batch_ = std::clamp<std::size_t>(kTargetBytes / pair_bytes, 1, most);
    const Functions& gl = engine.gl();
    a_ = make_drawable(gl, a);
    b_ = make_drawable(gl, b);
    records_ =
        make_buffer(gl, GL_SHADER_STORAGE_BUFFER, poses_a_batch_ * sizeof(Record), nullptr, GL_STREAM_READ);
    make_target();
    engine.context().check("making the depth target");
  }

  void score(std::span<const PairPlacement> poses, std::span<Record> records) override {
    const Functions& gl = engine_.gl();
    for (std::size_t first = 0; first < poses.size(); first += poses_a_batch_) {
      const std::size_t count = std::min(poses_a_batch_, poses.size() - first);
      draw(poses.subspan(first, count));
      compare(count);
      gl.BindBuffer(GL_SHADER_STORAGE_BUFFER, records_.name());
      gl.GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(count * sizeof(Record)),
                          records.data() + first);
      engine_.context().check("scoring");
    }
  }

  std::optional<std::pair<std::vector<float>, std::vector<float>>> depths(
      const PairPlacement& pose) override {
    draw(std::span(&pose, 1));
    std::pair<std::vector<float>, std::vector<float>> read{read_layer(0), read_layer(1)};
    engine_.context().check("reading the depth maps");
    return read;
  }

 private:
  void make_target() {
    const Functions& gl = engine_.gl();
    target_ = make_texture(gl);
    gl.BindTexture(GL_TEXTURE_2D_ARRAY, target_.name());
    gl.TexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_R32F, resolution_, resolution_,
                    static_cast<GLsizei>(2 * poses_a_batch_));
    gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    framebuffer_ = make_framebuffer(gl);
    attach(0);
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      throw BackendError(engine_.context().subject(), "the driver cannot draw into a 32 bit float target",
                         "choose --backend raster");
    }
  }

  void attach(std::size_t layer) {
    const Functions& gl = engine_.gl();
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    gl.FramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, target_.name(), 0,
                               static_cast<GLint>(layer));
  }

  void draw(std::span<const PairPlacement> poses) {
    const Functions& gl = engine_.gl();
    const GLuint program = engine_.program(
        {{GL_VERTEX_SHADER, {"depth_draw.vert"}}, {GL_FRAGMENT_SHADER, {"depth_draw.frag"}}}, {});
    gl.UseProgram(program);
    gl.Uniform1f(gl.GetUniformLocation(program, "resolution"), static_cast<float>(resolution_));
    const GLint rows = gl.GetUniformLocation(program, "rows");
    gl.Viewport(0, 0, resolution_, resolution_);
    gl.Enable(GL_BLEND);
    gl.BlendEquation(GL_MIN);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      draw_map(a_, poses[k].a, rows, 2 * k);
      draw_map(b_, poses[k].b, rows, 2 * k + 1);
    }
    gl.Disable(GL_BLEND);
    gl.BindVertexArray(0);
  }

  void draw_map(const Drawable& fragment, const Placement& placement, GLint rows, std::size_t layer) {
    const Functions& gl = engine_.gl();
    constexpr std::array<float, 4> kFar{std::numeric_limits<float>::infinity(), 0, 0, 0};
    attach(layer);
    gl.ClearBufferfv(GL_COLOR, 0, kFar.data());
    gl.Uniform4fv(rows, 3, &placement.x.x);
    gl.BindVertexArray(fragment.layout.name());
    gl.FrontFace(placement.front_is_counterclockwise() ? GL_CCW : GL_CW);
    gl.Enable(GL_CULL_FACE);
    gl.DrawElements(GL_TRIANGLES, fragment.front_only, GL_UNSIGNED_INT, nullptr);
    gl.Disable(GL_CULL_FACE);
    const auto rest = static_cast<std::uintptr_t>(fragment.front_only) * sizeof(GLuint);
    // NOLINTNEXTLINE(performance-no-int-to-ptr): OpenGL takes the offset so
    const void* const offset = reinterpret_cast<const void*>(rest);
    gl.DrawElements(GL_TRIANGLES, fragment.indices - fragment.front_only, GL_UNSIGNED_INT, offset);
  }

  void compare(std::size_t count) {
    const Functions& gl = engine_.gl();
    // Software: small groups switch less; yet no invocation may come near 65,535 loop rounds (see
    // rasterise.glsl).
    const int small = engine_.limits().software ? 64 : 256;
    const int group = resolution_ > 512 ? engine_.limits().group_size : small;
    const GLuint program = engine_.program({{GL_COMPUTE_SHADER, {"compare.glsl", "map_compare.comp"}}},
                                           "#define LOCAL_SIZE " + std::to_string(group) + "\n");
    gl.UseProgram(program);
    gl.Uniform1ui(gl.GetUniformLocation(program, "resolution"), static_cast<GLuint>(resolution_));
    gl.BindTexture(GL_TEXTURE_2D_ARRAY, target_.name());
    gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, kRecords, records_.name());
    gl.DispatchCompute(static_cast<GLuint>(count), 1, 1);
    gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  }

  std::vector<float> read_layer(std::size_t layer) {
    std::vector<float> depths(static_cast<std::size_t>(resolution_) * resolution_);
    attach(layer);
    engine_.gl().PixelStorei(GL_PACK_ALIGNMENT, 1);
    engine_.gl().ReadPixels(0, 0, resolution_, resolution_, GL_RED, GL_FLOAT, depths.data());
    std::replace_if(
        depths.begin(), depths.end(), [](float depth) { return std::isinf(depth); }, kBackground);
    return depths;
  }

  Engine& engine_;
  int resolution_;
  std::size_t poses_a_batch_ = 1;
  Drawable a_;
  Drawable b_;
  Buffer records_;
  Texture target_;
  Framebuffer framebuffer_;
};

static_assert(sizeof(Placement) == 12 * sizeof(float));  // uploaded as three rows

}  // namespace

std::unique_ptr<Drawing> make_pipeline_drawing(Engine& engine, const Surface& a, const Surface& b,
                                               int resolution) {
  return std::make_unique<PipelineDrawing>(engine, a, b, resolution);
}

}  // namespace rejoin::zbuffer::gl
