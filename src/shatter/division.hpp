/// Which piece a point of space belongs to.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <string_view>

namespace rejoin::shatter {

/// The stage of the work in which a division is chosen, as Context::report() takes it.
inline constexpr std::string_view kChoosing = "choose breaks";

/// Distance from a point to the walls of one piece: the two nearest, and which piece is behind the nearest.
struct Walls {
  double nearest = -1e300;  ///< signed, below 0 inside the piece; mesh units, exact where there is no noise
  double second = -1e300;
  int behind = -1;  ///< -1: there is no other piece

  /// Takes account of one more wall. \return whether it is the nearest so far
  bool add(double distance) {
    if (distance > nearest) {
      second = nearest;
      nearest = distance;
      return true;
    }
    if (distance > second) second = distance;
    return false;
  }
};

/// Space, divided among the pieces.  Both neighbours of a wall see the same wall.
class Division {
 public:
  virtual ~Division() = default;
  virtual std::size_t pieces() const = 0;
  virtual Walls walls(const glm::dvec3& point, std::size_t piece) const = 0;
  virtual std::size_t piece_of(const glm::dvec3& point) const = 0;
};

}  // namespace rejoin::shatter
