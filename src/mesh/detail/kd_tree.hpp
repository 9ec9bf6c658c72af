/// nanoflann's k-d tree over points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <nanoflann.hpp>
#include <vector>

namespace rejoin::mesh::detail {

struct KdPoints {
  std::vector<glm::vec3> data;
  std::size_t kdtree_get_point_count() const { return data.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const { return data[i][static_cast<int>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box& /*unused*/) const {
    return false;
  }
};

using KdTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, KdPoints>, KdPoints, 3,
                                                   std::uint32_t>;

inline constexpr std::size_t kKdLeaf = 12;  ///< points

}  // namespace rejoin::mesh::detail
