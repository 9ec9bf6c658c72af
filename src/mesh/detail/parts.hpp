/// What of a surface hangs together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/components.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::mesh::detail {

/// Box and weight of a part; of nothing at first.
struct Part {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
  double weight = 0;       ///< area, or number of points
  glm::dvec3 facing{0.0};  ///< its faces' area vectors

  void add(const Part& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
    weight += other.weight;
    facing += other.facing;
  }
  double distance(const Part& other) const {
    return glm::length(glm::max(glm::dvec3(0.0), glm::max(other.low - high, low - other.high)));
  }
};

/// Numbers parts from 0 in the order in which their elements are asked for.
class PartNumbers {
 public:
  PartNumbers(Components& components, std::size_t elements)
      : components_(components), number_(elements, kNone) {}

  std::uint32_t of(std::uint32_t element) {
    std::uint32_t& part = number_[components_.of(element)];
    if (part == kNone) part = count_++;
    return part;
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  Components& components_;
  std::vector<std::uint32_t> number_;
  std::uint32_t count_ = 0;
};

/// For every face the number of its part: the faces that share vertices with it.
std::vector<std::uint32_t> part_of_faces(const Mesh& mesh);

/// Every part's box, area and facing.
std::vector<Part> measured_parts(const Mesh& mesh, const std::vector<std::uint32_t>& part_of_face);

/// The same of a cloud: boxes, numbers of points, and the sums of their normals if it has some.
std::vector<Part> measured_point_parts(const Mesh& cloud, const std::vector<std::uint32_t>& part_of_point);

/// Every part's faces, or points, in ascending order.
std::vector<std::vector<std::uint32_t>> members_of_parts(const std::vector<std::uint32_t>& part_of,
                                                         std::size_t parts);

}  // namespace rejoin::mesh::detail
