/// The two ways in which a GPU turns poses into records.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "zbuffer/gl/engine.hpp"

namespace rejoin::zbuffer::gl {

/// What is drawn of a mesh.
struct Surface {
  std::vector<glm::vec3> vertices;  ///< mesh units, relative to the mesh's origin
  std::vector<glm::uvec3> faces;    ///< without those that have a non-finite corner
  std::size_t front_only = 0;       ///< so many, the first, need not be drawn where they look away
};

/// (x, y in pixels, depth in mesh units) = rows * (corner, 1).
struct Placement {
  glm::vec4 x;
  glm::vec4 y;
  glm::vec4 depth;

  /// Faces that look at the viewer run counter-clockwise (x to the right, y upwards).
  bool front_is_counterclockwise() const {
    return glm::dot(glm::cross(glm::vec3(x), glm::vec3(y)), glm::vec3(depth)) < 0.0F;
  }
};

struct PairPlacement {
  Placement a;
  Placement b;
};

/// What comes back for a pose, as in shaders/compare.glsl.
struct Record {
  float sum;              ///< depth in mesh units, per pixel step
  std::uint32_t overlap;  ///< kUnfinished: the driver cut the work short, nothing here means anything
  std::uint32_t covered_a;
  std::uint32_t covered_b;
};

inline constexpr std::uint32_t kUnfinished = 0xffffffffU;

/// Scores one pair of meshes.  Every member is called, and the object made and destroyed, inside an
/// Engine::Session.
class Drawing {
 public:
  virtual ~Drawing() = default;
  /// records.size() == poses.size()
  virtual void score(std::span<const PairPlacement> poses, std::span<Record> records) = 0;
  /// Depths of both maps in mesh units, NaN = background, as rendered; nullopt if the driver cut the work
  /// short.
  virtual std::optional<std::pair<std::vector<float>, std::vector<float>>> depths(
      const PairPlacement& pose) = 0;
};

/// Two compute dispatches for many poses: one draws their maps, one compares them.
std::unique_ptr<Drawing> make_compute_drawing(Engine& engine, const Surface& a, const Surface& b,
                                              int resolution);

/// Whether the triangles fit into one buffer, and whether the work of one invocation stays below what a
/// software driver does before it gives up (which comes back as kUnfinished).
bool suits_compute(const Limits& limits, const Surface& a, const Surface& b, int resolution);

/// The fixed pipeline draws every map into a layer of one float target; a compute shader then compares all
/// pairs of layers.
std::unique_ptr<Drawing> make_pipeline_drawing(Engine& engine, const Surface& a, const Surface& b,
                                               int resolution);

}  // namespace rejoin::zbuffer::gl
