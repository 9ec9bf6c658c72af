#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "zbuffer/detail/fixed_triangle.hpp"
#include "zbuffer/gl/drawing.hpp"

namespace rejoin::zbuffer::gl {
namespace {

constexpr GLuint kMeshes = 0;  // bindings in shaders/rasterise.glsl
constexpr GLuint kPoses = 1;
constexpr GLuint kRecords = 2;
constexpr GLuint kMaps = 3;

constexpr int kLargeList = 512;             // words of shared memory for triangles drawn by the whole group
constexpr std::size_t kPosesARead = 16384;  // whose records are read back together

struct Tuning {
  int group_size;
  int team_size;  ///< invocations that draw a large triangle together; the width of the processor's vectors
  int large_pixels;             ///< a triangle whose box has more is drawn by such a team
  std::size_t groups;           ///< work groups that keep the device busy
  std::size_t poses;            ///< a dispatch, at most
  std::size_t map_bytes;        ///< a dispatch, at most
  std::size_t triangle_budget;  ///< triangles a dispatch: keeps one below a tenth of a second, or drivers
                                ///< with a watchdog stop it
};

/// Measured on an H100 (docs/performance.md) and with llvmpipe.
Tuning tuning_of(const Limits& limits) {
  constexpr std::size_t kMega = std::size_t{1} << 20U;
  const int group = static_cast<int>(std::bit_floor(static_cast<unsigned>(limits.group_size)));
  if (limits.software) return {std::min(group, 64), 8, 64, 16, 16, 256 * kMega, 16 * kMega};
  return {std::min(group, 512), 32, 64, 512, kPosesARead, 128 * kMega, 128 * kMega};
}

/// Corner by corner and component by component, all triangles one after the other, as rasterise.glsl reads them.
void append_corners(const Surface& mesh, std::vector<float>& words) {
  for (int which = 0; which < 3; ++which) {
    for (int k = 0; k < 3; ++k) {
      for (const glm::uvec3& face : mesh.faces) words.push_back(mesh.vertices[face[which]][k]);
    }
  }
}

constexpr std::uint32_t kEmpty = 0xffffffffU;  // as in rasterise.glsl

float decode(std::uint32_t key) {
  if (key == kEmpty) return kBackground;
  return std::bit_cast<float>((key & 0x80000000U) != 0 ? key & 0x7fffffffU : ~key);
}

class ComputeDrawing : public Drawing {
 public:
  ComputeDrawing(Engine& engine, const Surface& a, const Surface& b, int resolution)
      : engine_(engine), tuning_(tuning_of(engine.limits())), resolution_(resolution) {
    std::vector<float> words;
    words.reserve(9 * (a.faces.size() + b.faces.size()));
    append_corners(a, words);
    first_b_ = static_cast<GLuint>(words.size());
    append_corners(b, words);
    count_a_ = static_cast<GLuint>(a.faces.size());
    count_b_ = static_cast<GLuint>(b.faces.size());
    front_only_a_ = static_cast<GLuint>(a.front_only);
    front_only_b_ = static_cast<GLuint>(b.front_only);
    pair_bytes_ = 8 * static_cast<std::size_t>(resolution) * resolution;
    const std::size_t most =
        std::min({tuning_.poses, std::min(engine.limits().storage_bytes, tuning_.map_bytes) / pair_bytes_,
                  tuning_.triangle_budget / (count_a_ + count_b_ + pair_bytes_ / 64)});
    poses_a_dispatch_ = std::max<std::size_t>(most, 1);
    const Functions& gl = engine.gl();
    meshes_ = make_buffer(gl, GL_SHADER_STORAGE_BUFFER, std::span<const float>(words));
    poses_ = make_buffer(gl, GL_SHADER_STORAGE_BUFFER, kPosesARead * sizeof(PairPlacement), nullptr,
                         GL_STREAM_DRAW);
    const std::vector<Record> none(kPosesARead);
    records_ = make_buffer(gl, GL_SHADER_STORAGE_BUFFER, std::span<const Record>(none));
    clear_ = make_step("score_clear.comp");
    draw_ = make_step("score_draw.comp");
    compare_ = make_step("score_compare.comp");
    engine.context().check("loading the meshes");
  }

  void score(std::span<const PairPlacement> poses, std::span<Record> records) override {
    if (poses.empty()) return;
    for (std::size_t first = 0; first < poses.size(); first += kPosesARead) {
      const std::size_t count = std::min(kPosesARead, poses.size() - first);
      bind(poses.subspan(first, count));
      engine_.maps().empty = false;
      for (std::size_t k = 0; k < count; k += poses_a_dispatch_) {
        const std::size_t part = std::min(poses_a_dispatch_, count - k);
        draw(k, part);
        compare(k, part);
      }
      engine_.maps().empty = read_records(records.subspan(first, count));
    }
  }

  std::optional<std::pair<std::vector<float>, std::vector<float>>> depths(
      const PairPlacement& pose) override {
    bind(std::span(&pose, 1));
    engine_.maps().empty = false;
    draw(0, 1);
    const std::size_t pixels = static_cast<std::size_t>(resolution_) * resolution_;
    std::vector<std::uint32_t> keys(2 * pixels);
    read(engine_.maps().buffer, std::span(keys));
    compare(0, 1);
    Record record{};
    engine_.maps().empty = read_records(std::span(&record, 1));
    if (!engine_.maps().empty) return std::nullopt;
    std::vector<float> a(pixels);
    std::vector<float> b(pixels);
    std::transform(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(pixels), a.begin(), decode);
    std::transform(keys.begin() + static_cast<std::ptrdiff_t>(pixels), keys.end(), b.begin(), decode);
    return std::pair{std::move(a), std::move(b)};
  }

 private:
  /// A program and where its varying uniform is.
  struct Step {
    GLuint program = 0;
    GLint first_pose = -1;
  };

  template <typename Value>
  void read(const Buffer& buffer, std::span<Value> values) {
    const Functions& gl = engine_.gl();
    gl.BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer.name());
    gl.GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(values.size_bytes()),
                        values.data());
    engine_.context().check("scoring");
  }

  /// \return whether all are finished, and the maps with them
  bool read_records(std::span<Record> records) {
    read(records_, records);
    if (std::ranges::none_of(records, [](const Record& r) { return r.overlap == kUnfinished; })) return true;
    // The mark is set before a record is written, so it must not stay.
    const std::vector<Record> none(records.size());
    engine_.gl().BufferSubData(GL_SHADER_STORAGE_BUFFER, 0,
                               static_cast<GLsizeiptr>(none.size() * sizeof(Record)), none.data());
    return false;
  }

  Step make_step(const char* file) {
    const Functions& gl = engine_.gl();
    const GLuint program =
        engine_.program({{GL_COMPUTE_SHADER, {"compare.glsl", "rasterise.glsl", file}}}, defines());
    return {program, gl.GetUniformLocation(program, "first_pose")};
  }

  /// Uploads poses and binds all buffers, which other drawings of the context may have changed.
  void bind(std::span<const PairPlacement> poses) {
    const Functions& gl = engine_.gl();
    gl.BindBuffer(GL_SHADER_STORAGE_BUFFER, poses_.name());
    gl.BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(poses.size_bytes()), poses.data());
    gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, kMeshes, meshes_.name());
    gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, kPoses, poses_.name());
    gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, kRecords, records_.name());
    for (const Step& step : {draw_, compare_}) {
      gl.UseProgram(step.program);
      const auto uniform = [&](const char* name) { return gl.GetUniformLocation(step.program, name); };
      gl.Uniform3ui(uniform("mesh_a"), 0, count_a_, front_only_a_);
      gl.Uniform3ui(uniform("mesh_b"), first_b_, count_b_, front_only_b_);
      gl.Uniform1ui(uniform("resolution"), static_cast<GLuint>(resolution_));
      gl.Uniform1ui(uniform("probe_steps"), 3);
    }
    make_maps(std::min(poses.size(), poses_a_dispatch_));
  }

  /// Binds empty maps for at least so many poses.
  void make_maps(std::size_t poses) {
    const Functions& gl = engine_.gl();
    Engine::Maps& maps = engine_.maps();
    const std::size_t bytes = poses * pair_bytes_;
    if (maps.bytes < bytes) {
      // Twice as many as before, so that batches that grow do not make room each time.
      const std::size_t room = std::min(std::max(bytes, 2 * maps.bytes), poses_a_dispatch_ * pair_bytes_);
      maps = {};
      maps.buffer = make_buffer(gl, GL_SHADER_STORAGE_BUFFER, room, nullptr, GL_DYNAMIC_COPY);
      engine_.context().check("making room for the depth maps");
      maps.bytes = room;
    }
    gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, kMaps, maps.buffer.name());
    if (!maps.empty) clear(maps.bytes / 4);
  }

  void clear(std::size_t words) {
    constexpr std::size_t kWordsAnInvocation = 64;
    const Functions& gl = engine_.gl();
    gl.UseProgram(clear_.program);
    const std::size_t a_group = kWordsAnInvocation * static_cast<std::size_t>(tuning_.group_size);
    gl.DispatchCompute(static_cast<GLuint>((words + a_group - 1) / a_group), 1, 1);
    gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  }

  /// Draws the maps of `count` poses, 1 to poses_a_dispatch_.
  void draw(std::size_t first, std::size_t count) {
    const Functions& gl = engine_.gl();
    gl.UseProgram(draw_.program);
    gl.Uniform1ui(draw_.first_pose, static_cast<GLuint>(first));
    // As many parts as keep the device busy, but none of less than a triangle an invocation.
    const std::size_t most = std::max(count_a_, count_b_) / static_cast<std::size_t>(tuning_.group_size);
    const std::size_t parts = std::max<std::size_t>(std::min(tuning_.groups / (2 * count), most), 1);
    gl.DispatchCompute(static_cast<GLuint>(parts), 2, static_cast<GLuint>(count));
    gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  }

  void compare(std::size_t first, std::size_t count) {
    const Functions& gl = engine_.gl();
    gl.UseProgram(compare_.program);
    gl.Uniform1ui(compare_.first_pose, static_cast<GLuint>(first));
    gl.DispatchCompute(static_cast<GLuint>(count), 1, 1);
    gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  }

  std::string defines() const {
    std::string text;
    const auto define = [&text](const char* name, int value) {
      text.append("#define ").append(name).append(" ").append(std::to_string(value)).append("\n");
    };
    define("LOCAL_SIZE", tuning_.group_size);
    define("SUBPIXEL_BITS", std::countr_zero(static_cast<unsigned>(detail::kSubpixels)));
    define("REACH", static_cast<int>(detail::kReach));
    define("LARGE_PIXELS", tuning_.large_pixels);
    define("LARGE_LIST", kLargeList);
    define("TEAM_SIZE", tuning_.team_size);
    return text;
  }

  Engine& engine_;
  Tuning tuning_;
  int resolution_;
  GLuint first_b_ = 0;
  GLuint count_a_ = 0;
  GLuint count_b_ = 0;
  GLuint front_only_a_ = 0;
  GLuint front_only_b_ = 0;
  std::size_t poses_a_dispatch_ = 1;
  std::size_t pair_bytes_ = 0;  ///< of the maps of a pose
  Buffer meshes_;
  Buffer poses_;
  Buffer records_;
  Step clear_;
  Step draw_;
  Step compare_;
};

}  // namespace

bool suits_compute(const Limits& limits, const Surface& a, const Surface& b, int resolution) {
  const std::size_t triangles = a.faces.size() + b.faces.size();
  if (triangles * 9 * sizeof(float) > limits.storage_bytes) return false;
  return !limits.software || (triangles <= 100'000 && resolution <= 512);
}

std::unique_ptr<Drawing> make_compute_drawing(Engine& engine, const Surface& a, const Surface& b,
                                              int resolution) {
  return std::make_unique<ComputeDrawing>(engine, a, b, resolution);
}

}  // namespace rejoin::zbuffer::gl
