/// Corners of a polygon, to be found by the triangles that they lie in.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

namespace rejoin::mesh::detail {

/// Squares of squares, each with the number of corners in it: where a triangle crosses empty ones, nothing is looked at.
class CornerGrid {
 public:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  /// Counter-clockwise.
  using Triangle = std::array<glm::dvec2, 3>;

  /// \param places  of all corners that may ever be added, finite
  explicit CornerGrid(std::vector<glm::dvec2> places);

  const glm::dvec2& place(std::size_t corner) const { return places_[corner]; }
  bool has(std::size_t corner) const { return cells_[corner] != kNone; }

  /// \pre !has(corner)
  void add(std::size_t corner);

  /// \pre has(corner)
  void remove(std::size_t corner);

  /// Any one of the corners added that `wanted` accepts; kNone if there is none.  It is asked about all that lie in the
  /// triangle or on its border, and about some near it.
  template <class Wanted>
  std::size_t find(const Triangle& triangle, const Wanted& wanted) const {
    return find(triangle, wanted, 0, 0, 0);
  }

 private:
  static std::size_t first_of_level(std::size_t level) { return ((std::size_t{1} << (2 * level)) - 1) / 3; }

  /// Adds to the numbers of corners in the squares around a cell.
  void count(std::size_t cell, int change);

  /// Whether a square surely has nothing of the triangle, not even by rounding.
  bool misses(const Triangle& triangle, std::size_t level, std::size_t column, std::size_t row) const;

  template <class Wanted>
  std::size_t find(const Triangle& triangle, const Wanted& wanted, std::size_t level, std::size_t column,
                   std::size_t row) const {
    const std::size_t square = (row << level) + column;
    if (counts_[first_of_level(level) + square] == 0 || misses(triangle, level, column, row)) return kNone;
    if (level == levels_) {
      for (std::size_t corner = first_[square]; corner != kNone; corner = next_[corner])
        if (wanted(corner)) return corner;
      return kNone;
    }
    for (std::size_t quarter = 0; quarter < 4; ++quarter) {
      const std::size_t found =
          find(triangle, wanted, level + 1, 2 * column + quarter % 2, 2 * row + quarter / 2);
      if (found != kNone) return found;
    }
    return kNone;
  }

  std::vector<glm::dvec2> places_;
  glm::dvec2 low_;
  double size_ = 1.0;                ///< of the whole square
  std::size_t levels_ = 0;           ///< below the whole square; the last one's squares are the cells
  std::vector<std::size_t> counts_;  ///< level by level, row by row
  std::vector<std::size_t> first_;   ///< corner of each cell
  std::vector<std::size_t> next_;    ///< corner in the same cell
  std::vector<std::size_t> before_;
  std::vector<std::size_t> cells_;  ///< of each corner; kNone: not there
};

}  // namespace rejoin::mesh::detail
