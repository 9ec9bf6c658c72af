/// Pieces between cracks.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "core/context.hpp"
#include "mesh/samples.hpp"
#include "shatter/division.hpp"
#include "shatter/noise.hpp"

namespace rejoin::shatter {

/// A wide ball's surface.
struct Crack {
  glm::dvec3 centre;
  double radius;

  /// Below 0 inside.
  double distance(const glm::dvec3& point) const { return glm::distance(point, centre) - radius; }
};

/// One crack after another, each through one piece, from side to side: cracks end at older ones, and a piece may lie along a part of
/// another's side.  Roughened by noise.
class Cracks final : public Division {
 public:
  explicit Cracks(const Noise& warp) : warp_(warp), paths_(1) {}

  /// Breaks a piece in two: what is inside keeps its number.
  void add(std::size_t piece, const Crack& crack);

  std::size_t pieces() const override { return paths_.size(); }
  Walls walls(const glm::dvec3& point, std::size_t piece) const override;
  std::size_t piece_of(const glm::dvec3& point) const override { return piece_seen_at(bent(point)); }
  glm::dvec3 bent(const glm::dvec3& point) const { return point + warp_.at(point); }

 private:
  /// A crack and what lies inside and outside: another crack's number, or ~ that of a piece.
  struct Branch {
    Crack crack;
    std::array<int, 2> next;
  };

  std::size_t piece_seen_at(const glm::dvec3& bent_point, int next = kRoot) const;

  static constexpr int kRoot = 0;

  Noise warp_;
  std::vector<Branch> branches_;
  std::vector<std::vector<std::pair<int, int>>>
      paths_;  ///< of each piece: its cracks, and on which side of them it is
};

/// What of an object cracks may run through.
struct Inside {
  std::vector<glm::vec3> points;  ///< evenly spread, relative to the origin of the surface's samples
  double spacing = 0;             ///< typical distance of neighbours, mesh units
};

/// Cracks into `count` pieces, square to the surface where they begin, through large pieces rather than small ones, such that every
/// piece hangs together.
/// \param surface  samples   \param origin  of both kinds of points
/// \return nullopt if too few were found, or the context was cancelled
std::optional<Cracks> choose_cracks(const Inside& inside, const mesh::Samples& surface,
                                    const glm::dvec3& origin, std::size_t count, const Noise& warp,
                                    std::uint64_t seed, const Context& context);

}  // namespace rejoin::shatter
