/// One interface for everything that can turn poses into matching errors.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"
#include "zbuffer/depth_map.hpp"
#include "zbuffer/error.hpp"

namespace rejoin::zbuffer {

/// How both fragments stand before the reference plane (p).
///
/// Each fragment is centred, turned by its rotation, fragment A shifted in the plane; both are seen from +Z
/// with (p) at z = +f_R / 2, so a point's depth is f_R / 2 - z.  B's map is mirrored when the two are
/// compared (B faces A after a half turn about Y). \source papaioannou 2002, sections 2 and 3.4
struct ViewPair {
  glm::mat3 rotation_a{1.0F};
  glm::vec2 shift_a{0.0F};  ///< (x1, y1), mesh units
  glm::mat3 rotation_b{1.0F};
};

/// Sampling of the view volume, a cube.
struct ViewOptions {
  int resolution = 128;      ///< N_u = N_v, pixels, 8 .. 2048
  double view_side = 0;      ///< f_R, mesh units; <= 0: 1.3 x the larger diameter
  glm::vec3 centre_a{0.0F};  ///< relative to the mesh's origin; the point that goes to the view's middle
  glm::vec3 centre_b{0.0F};
};

enum class Backend { Auto, Gpu, OsMesa, Raster, RayCast, Reference };

/// "auto", "gpu", "osmesa", "raster", "raycast", "reference".
std::string_view name_of(Backend backend);

/// Scores poses of one pair of fragments.  Not thread-safe itself; it uses threads inside.
class Scorer {
 public:
  virtual ~Scorer() = default;

  /// One score a pose; scores.size() == poses.size().  The same values for any number of threads and any
  /// split into calls.
  virtual void score(std::span<const ViewPair> poses, std::span<PairScore> scores) = 0;

  /// The two maps of one pose, each as rendered (B not mirrored), depths in mesh units.
  virtual std::pair<DepthMap, DepthMap> depth_maps(const ViewPair& pose) = 0;

  virtual Backend backend() const = 0;
  /// What draws: "llvmpipe (LLVM 15.0.6, 256 bits)", "Embree 3.13.5", "raster AVX3", ...
  virtual std::string renderer() const = 0;
};

/// A scorer for two meshes (with faces).  Auto takes the fastest that works.
/// \throws BackendError the backend is missing or cannot start; says why and what to install or choose
/// instead \throws InputError   a mesh has no faces, or an option is out of range
std::unique_ptr<Scorer> make_scorer(Backend backend, const mesh::Mesh& a, const mesh::Mesh& b,
                                    const ViewOptions& options);

/// What `rejoin info` lists.
struct BackendInfo {
  Backend backend;
  bool available;
  std::string renderer;  ///< empty if not available
  std::string why_not;   ///< empty if available
};
std::vector<BackendInfo> list_backends();

}  // namespace rejoin::zbuffer
