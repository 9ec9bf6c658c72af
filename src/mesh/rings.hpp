/// Which vertices of a mesh lie beside each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// Vertices beside each other.
class Rings {
 public:
  explicit Rings(const Mesh& mesh) : first_(mesh.vertices.size() + 1, 0) {
    for (const glm::uvec3& face : mesh.faces)
      for (int k = 0; k < 3; ++k) first_[face[k] + 1] += 2;
    for (std::size_t v = 0; v + 1 < first_.size(); ++v) first_[v + 1] += first_[v];
    beside_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const glm::uvec3& face : mesh.faces) {
      for (int k = 0; k < 3; ++k) {
        beside_[next[face[k]]++] = face[(k + 1) % 3];
        beside_[next[face[k]]++] = face[(k + 2) % 3];
      }
    }
  }

  std::size_t size() const { return first_.size() - 1; }

  /// Neighbours, each as often as faces hold both.
  std::span<const std::uint32_t> of(std::size_t vertex) const {
    return {beside_.data() + first_[vertex], first_[vertex + 1] - first_[vertex]};
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> beside_;
};

}  // namespace rejoin::mesh
