/// Where nothing can lie inside a fragment, told without looking for its surface.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "match/gap.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::assembly {

/// How deep the points of small cubes can lie inside a surface, at most: the depth in the cube's middle and half its diagonal, as
/// no distance changes by more than the way.  Const members may be called from several threads.
class DepthBound {
 public:
  /// \param gap  of a closed surface, or of one that is nearly so; not kept
  explicit DepthBound(const match::GapField& gap);

  /// Upper bound of the depth, mesh units; 0 where all of the cube is outside.
  /// \param point  relative to the surface's origin
  float at(const glm::vec3& point) const;

 private:
  mesh::Box box_{};
  float cell_ = 0;  ///< edge of a cube, mesh units
  glm::ivec3 count_{0};
  std::vector<float> bound_;  ///< x fastest
};

}  // namespace rejoin::assembly
