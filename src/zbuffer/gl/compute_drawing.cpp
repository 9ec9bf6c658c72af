#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "zbuffer/detail/fixed_triangle.hpp"
#include "zbuffer/gl/drawing.hpp"

namespace rejoin::zbuffer::gl {
namespace {

constexpr GLuint kMeshes = 0;  // bindings in shaders/score.comp
constexpr GLuint kPoses = 1;
constexpr GLuint kRecords = 2;
constexpr GLuint kMaps = 3;

constexpr int kLargeList = 512;  // words of shared memory for triangles drawn by the whole group

struct Tuning {
  int group_size;
  int team_size;  ///< invocations that draw a large triangle together; the width of the processor's vectors
  int large_pixels;             ///< a triangle whose box has more is drawn by such a team
  std::size_t groups;           ///< work groups in flight, each with maps of its own
  std::size_t poses_a_group;    ///< in one dispatch, at most: see loops_work() in shaders/score.comp
  std::size_t triangle_budget;  ///< triangles a dispatch: keeps one below a tenth of a second, or drivers
                                ///< with a watchdog stop it
};

Tuning tuning_of(const Limits& limits) {
  if (limits.software) return {std::min(limits.group_size, 64), 8, 64, 16, 1, std::size_t{1} << 24U};
  return {std::min(static_cast<int>(std::bit_floor(static_cast<unsigned>(limits.group_size))), 512),
          32,
          64,
          512,
          16,
          std::size_t{1} << 27U};
}

std::size_t scratch_bytes(const Tuning& tuning) {
  return 4 * (4 * static_cast<std::size_t>(tuning.group_size) + std::size_t{kLargeList} + 16);
}

/// Corner by corner and component by component, all triangles one after the other, as score.comp reads them.
void append_corners(const Surface& mesh, std::vector<float>& words) {
  for (int which = 0; which < 3; ++which) {
    for (int k = 0; k < 3; ++k) {
      for (const glm::uvec3& face : mesh.faces) words.push_back(mesh.vertices[face[which]][k]);
    }
  }
}

constexpr std::uint32_t kEmpty = 0xffffffffU;  // as in score.comp

float decode(std::uint32_t key) {
  if (key == kEmpty) return kBackground;
  return std::bit_cast<float>((key & 0x80000000U) != 0 ? key & 0x7fffffffU : ~key);
}

class ComputeDrawing : public Drawing {
 public:
  ComputeDrawing(Engine& engine, const Surface& a, const Surface& b, int resolution, bool in_shared_memory)
      : engine_(engine),
        tuning_(tuning_of(engine.limits())),
        resolution_(resolution),
        shared_(in_shared_memory) {
    std::vector<float> words;
    words.reserve(9 * (a.faces.size() + b.faces.size()));
    append_corners(a, words);
    first_b_ = static_cast<GLuint>(words.size());
    append_corners(b, words);
    count_a_ = static_cast<GLuint>(a.faces.size());
    count_b_ = static_cast<GLuint>(b.faces.size());
    front_only_a_ = static_cast<GLuint>(a.front_only);
    front_only_b_ = static_cast<GLuint>(b.front_only);
    const std::size_t map_bytes = 8 * static_cast<std::size_t>(resolution) * resolution;
    groups_ = std::clamp<std::size_t>(std::min(engine.limits().storage_bytes, kMostMapBytes) / map_bytes, 1,
                                      tuning_.groups);
    poses_a_dispatch_ = std::clamp<std::size_t>(
        tuning_.triangle_budget / (count_a_ + count_b_ + map_bytes / 64), 1, groups_ * tuning_.poses_a_group);
    const Functions& gl = engine.gl();
    meshes_ = make_buffer(gl, GL_SHADER_STORAGE_BUFFER, std::span<const float>(words));
    poses_ = make_buffer(gl, GL_SHADER_STORAGE_BUFFER, poses_a_dispatch_ * sizeof(PairPlacement), nullptr,
                         GL_STREAM_DRAW);
    records_ = make_buffer(gl, GL_SHADER_STORAGE_BUFFER, poses_a_dispatch_ * sizeof(Record), nullptr,
                           GL_STREAM_READ);
    engine.context().check("loading the meshes");
  }

  void score(std::span<const PairPlacement> poses, std::span<Record> records) override {
    for (std::size_t first = 0; first < poses.size(); first += poses_a_dispatch_) {
      const std::size_t count = std::min(poses_a_dispatch_, poses.size() - first);
      dispatch(poses.subspan(first, count), shared_);
      read(records_, records.subspan(first, count));
    }
  }

  std::optional<std::pair<std::vector<float>, std::vector<float>>> depths(
      const PairPlacement& pose) override {
    dispatch(std::span(&pose, 1), false);
    Record record{};
    read(records_, std::span(&record, 1));
    if (record.overlap == kUnfinished) return std::nullopt;
    const std::size_t pixels = static_cast<std::size_t>(resolution_) * resolution_;
    std::vector<std::uint32_t> keys(2 * pixels);
    read(maps_, std::span(keys));
    std::vector<float> a(pixels);
    std::vector<float> b(pixels);
    std::transform(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(pixels), a.begin(), decode);
    std::transform(keys.begin() + static_cast<std::ptrdiff_t>(pixels), keys.end(), b.begin(), decode);
    return std::pair{std::move(a), std::move(b)};
  }

 private:
  static constexpr std::size_t kMostMapBytes = std::size_t{256} << 20U;

  template <typename Value>
  void read(const Buffer& buffer, std::span<Value> values) {
    const Functions& gl = engine_.gl();
    gl.BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer.name());
    gl.GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(values.size_bytes()),
                        values.data());
    engine_.context().check("scoring");
  }

  void dispatch(std::span<const PairPlacement> poses, bool in_shared_memory) {
    const Functions& gl = engine_.gl();
    const GLuint program =
        engine_.program({{GL_COMPUTE_SHADER, {"compare.glsl", "score.comp"}}}, defines(in_shared_memory));
    gl.UseProgram(program);
    gl.Uniform3ui(gl.GetUniformLocation(program, "mesh_a"), 0, count_a_, front_only_a_);
    gl.Uniform3ui(gl.GetUniformLocation(program, "mesh_b"), first_b_, count_b_, front_only_b_);
    gl.Uniform1ui(gl.GetUniformLocation(program, "pose_count"), static_cast<GLuint>(poses.size()));
    gl.Uniform1ui(gl.GetUniformLocation(program, "probe_steps"), 3);
    if (!in_shared_memory) {
      if (maps_.name() == 0) make_maps();
      gl.Uniform1ui(gl.GetUniformLocation(program, "resolution"), static_cast<GLuint>(resolution_));
      gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, kMaps, maps_.name());
    }
    gl.BindBuffer(GL_SHADER_STORAGE_BUFFER, poses_.name());
    gl.BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(poses.size_bytes()), poses.data());
    gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, kMeshes, meshes_.name());
    gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, kPoses, poses_.name());
    gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, kRecords, records_.name());
    gl.DispatchCompute(static_cast<GLuint>(std::min(groups_, poses.size())), 1, 1);
    // The maps are written again by the next dispatch, the records read by the CPU.
    gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  }

  std::string defines(bool in_shared_memory) const {
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
    if (in_shared_memory) define("SHARED_SIDE", resolution_);
    return text;
  }

  void make_maps() {
    const std::size_t bytes = groups_ * 8 * static_cast<std::size_t>(resolution_) * resolution_;
    maps_ = make_buffer(engine_.gl(), GL_SHADER_STORAGE_BUFFER, bytes, nullptr, GL_DYNAMIC_COPY);
    engine_.context().check("making room for the depth maps");
  }

  Engine& engine_;
  Tuning tuning_;
  int resolution_;
  bool shared_;
  GLuint first_b_ = 0;
  GLuint count_a_ = 0;
  GLuint count_b_ = 0;
  GLuint front_only_a_ = 0;
  GLuint front_only_b_ = 0;
  std::size_t groups_ = 1;
  std::size_t poses_a_dispatch_ = 1;
  Buffer meshes_;
  Buffer poses_;
  Buffer records_;
  Buffer maps_;
};

}  // namespace

bool suits_compute(const Limits& limits, const Surface& a, const Surface& b, int resolution) {
  const std::size_t triangles = a.faces.size() + b.faces.size();
  if (triangles * 9 * sizeof(float) > limits.storage_bytes) return false;
  return !limits.software || (triangles <= 100'000 && resolution <= 512);
}

bool fits_shared_memory(const Limits& limits, int resolution) {
  const std::size_t maps = 8 * static_cast<std::size_t>(resolution) * resolution;
  return maps + scratch_bytes(tuning_of(limits)) <= limits.shared_bytes;
}

std::unique_ptr<Drawing> make_compute_drawing(Engine& engine, const Surface& a, const Surface& b,
                                              int resolution, bool in_shared_memory) {
  return std::make_unique<ComputeDrawing>(engine, a, b, resolution, in_shared_memory);
}

}  // namespace rejoin::zbuffer::gl
