#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "zbuffer/gl/drawing.hpp"

namespace rejoin::zbuffer::gl {
namespace {

constexpr GLuint kRecords = 2;     // binding in shaders/tile_compare.comp
constexpr int kTargetSide = 2048;  // pixels: 128 poses of 128 x 128, and 16 MB

/// A mesh as the fixed pipeline wants it.
struct Drawable {
  Buffer vertices;
  Buffer faces;
  GLsizei indices = 0;
  Buffer placements;  ///< one a pose
  VertexArray layout;
};

Drawable make_drawable(const Functions& gl, const Surface& mesh, std::size_t most_poses) {
  Drawable made;
  made.layout = make_vertex_array(gl);
  gl.BindVertexArray(made.layout.name());
  made.vertices = make_buffer(gl, GL_ARRAY_BUFFER, std::span<const glm::vec3>(mesh.vertices));
  gl.EnableVertexAttribArray(0);
  gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
  made.placements = make_buffer(gl, GL_ARRAY_BUFFER, most_poses * sizeof(Placement), nullptr, GL_STREAM_DRAW);
  for (GLuint row = 0; row < 3; ++row) {
    gl.EnableVertexAttribArray(1 + row);
    gl.VertexAttribPointer(1 + row, 4, GL_FLOAT, GL_FALSE, sizeof(Placement),
                           reinterpret_cast<const void*>(row * sizeof(glm::vec4)));
    gl.VertexAttribDivisor(1 + row, 1);
  }
  made.faces = make_buffer(gl, GL_ELEMENT_ARRAY_BUFFER, std::span<const glm::uvec3>(mesh.faces));
  made.indices = static_cast<GLsizei>(mesh.faces.size() * 3);
  gl.BindVertexArray(0);
  return made;
}

class PipelineDrawing : public Drawing {
 public:
  PipelineDrawing(Engine& engine, const Surface& a, const Surface& b, int resolution)
      : engine_(engine), resolution_(resolution) {
    const int most = engine.limits().texture_side / resolution;
    tiles_a_row_ = std::clamp(kTargetSide / resolution, 2, std::max(most, 2));
    side_ = tiles_a_row_ * resolution;
    poses_a_draw_ = static_cast<std::size_t>(tiles_a_row_) * tiles_a_row_ / 2;
    const Functions& gl = engine.gl();
    a_ = make_drawable(gl, a, poses_a_draw_);
    b_ = make_drawable(gl, b, poses_a_draw_);
    records_ =
        make_buffer(gl, GL_SHADER_STORAGE_BUFFER, poses_a_draw_ * sizeof(Record), nullptr, GL_STREAM_READ);
    make_target();
    engine.context().check("making the depth target");
  }

  void score(std::span<const PairPlacement> poses, std::span<Record> records) override {
    const Functions& gl = engine_.gl();
    for (std::size_t first = 0; first < poses.size(); first += poses_a_draw_) {
      const std::size_t count = std::min(poses_a_draw_, poses.size() - first);
      draw(poses.subspan(first, count));
      reduce(count);
      gl.BindBuffer(GL_SHADER_STORAGE_BUFFER, records_.name());
      gl.GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(count * sizeof(Record)),
                          records.data() + first);
      engine_.context().check("scoring");
    }
  }

  std::optional<std::pair<std::vector<float>, std::vector<float>>> depths(
      const PairPlacement& pose) override {
    draw(std::span(&pose, 1));
    std::pair<std::vector<float>, std::vector<float>> read{read_tile(0), read_tile(1)};
    engine_.context().check("reading the depth maps");
    return read;
  }

 private:
  void make_target() {
    const Functions& gl = engine_.gl();
    target_ = make_texture(gl);
    gl.BindTexture(GL_TEXTURE_2D, target_.name());
    gl.TexStorage2D(GL_TEXTURE_2D, 1, GL_R32F, side_, side_);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    framebuffer_ = make_framebuffer(gl);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target_.name(), 0);
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      throw BackendError(engine_.context().subject(), "the driver cannot draw into a 32 bit float target",
                         "choose --backend raster");
    }
  }

  /// A's tiles, then B's.
  void draw(std::span<const PairPlacement> poses) {
    const Functions& gl = engine_.gl();
    const GLuint program = engine_.program(
        {{GL_VERTEX_SHADER, {"depth_draw.vert"}}, {GL_FRAGMENT_SHADER, {"depth_draw.frag"}}}, {});
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    gl.Viewport(0, 0, side_, side_);
    constexpr std::array<float, 4> kFar{std::numeric_limits<float>::infinity(), 0, 0, 0};
    gl.ClearBufferfv(GL_COLOR, 0, kFar.data());
    gl.Enable(GL_BLEND);
    gl.BlendEquation(GL_MIN);
    gl.UseProgram(program);
    set_tiling(program);
    std::vector<Placement> placements(poses.size());
    std::transform(poses.begin(), poses.end(), placements.begin(),
                   [](const PairPlacement& p) { return p.a; });
    draw_fragment(a_, placements, program, 0);
    std::transform(poses.begin(), poses.end(), placements.begin(),
                   [](const PairPlacement& p) { return p.b; });
    draw_fragment(b_, placements, program, poses.size());
    gl.Disable(GL_BLEND);
    gl.BindVertexArray(0);
  }

  void draw_fragment(const Drawable& fragment, const std::vector<Placement>& placements, GLuint program,
                     std::size_t first_tile) {
    const Functions& gl = engine_.gl();
    gl.BindBuffer(GL_ARRAY_BUFFER, fragment.placements.name());
    gl.BufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(placements.size() * sizeof(Placement)),
                     placements.data());
    gl.Uniform1ui(gl.GetUniformLocation(program, "first_tile"), static_cast<GLuint>(first_tile));
    gl.BindVertexArray(fragment.layout.name());
    gl.DrawElementsInstanced(GL_TRIANGLES, fragment.indices, GL_UNSIGNED_INT, nullptr,
                             static_cast<GLsizei>(placements.size()));
  }

  void reduce(std::size_t count) {
    const Functions& gl = engine_.gl();
    const int group = resolution_ > 512 ? engine_.limits().group_size : engine_.limits().software ? 64 : 256;
    const GLuint program = engine_.program({{GL_COMPUTE_SHADER, {"compare.glsl", "tile_compare.comp"}}},
                                           "#define LOCAL_SIZE " + std::to_string(group) + "\n");
    gl.UseProgram(program);
    set_tiling(program);
    gl.BindTexture(GL_TEXTURE_2D, target_.name());
    gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, kRecords, records_.name());
    gl.DispatchCompute(static_cast<GLuint>(count), 1, 1);
    gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  }

  void set_tiling(GLuint program) {
    const Functions& gl = engine_.gl();
    gl.Uniform2ui(gl.GetUniformLocation(program, "tiling"), static_cast<GLuint>(tiles_a_row_),
                  static_cast<GLuint>(side_));
    gl.Uniform1ui(gl.GetUniformLocation(program, "resolution"), static_cast<GLuint>(resolution_));
  }

  std::vector<float> read_tile(int tile) {
    std::vector<float> depths(static_cast<std::size_t>(resolution_) * resolution_);
    engine_.gl().PixelStorei(GL_PACK_ALIGNMENT, 1);
    engine_.gl().ReadPixels(tile % tiles_a_row_ * resolution_, tile / tiles_a_row_ * resolution_, resolution_,
                            resolution_, GL_RED, GL_FLOAT, depths.data());
    std::replace_if(
        depths.begin(), depths.end(), [](float depth) { return std::isinf(depth); }, kBackground);
    return depths;
  }

  Engine& engine_;
  int resolution_;
  int tiles_a_row_ = 2;
  int side_ = 0;
  std::size_t poses_a_draw_ = 1;
  Drawable a_;
  Drawable b_;
  Buffer records_;
  Texture target_;
  Framebuffer framebuffer_;
};

}  // namespace

std::unique_ptr<Drawing> make_pipeline_drawing(Engine& engine, const Surface& a, const Surface& b,
                                               int resolution) {
  return std::make_unique<PipelineDrawing>(engine, a, b, resolution);
}

}  // namespace rejoin::zbuffer::gl
