/// From a rough idea of where two borders meet to a pose, its common boundary and a score: the last step of every method.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "outline/outline.hpp"

namespace rejoin::outline {

/// Two points, one on each border by arc length, that are taken to have been one.
struct PairedPlaces {
  double on_a = 0.0;
  double on_b = 0.0;
};

/// The finest scale that the pieces' own samples allow, file units: about two of them, on long borders more, of simplified outlines less.
/// \pre not empty, all with a border
double automatic_step(const std::vector<Piece>& pieces);

/// A border that is compared: see border_of().
struct BorderName {
  std::size_t piece = 0;
  std::size_t hole = 0;
};

struct FitOptions {
  double step = 0.0;  ///< finest scale, file units; 0: automatic_step()
  int scales = 6;     ///< looked at for agreement, each twice as coarse
  double tolerance =
      0.0;  ///< how far the two borders may be off each other along the join, file units; 0: from the pieces
  double shortest_hole = std::numeric_limits<double>::infinity();  ///< of those that are compared, file units
};

/// A fitted join with what speaks for it.
struct FittedJoin {
  JoinCandidate join;
  double evidence = 0.0;            ///< how much more the two borders agree than chance, natural logarithm
  double overlap_share = 0.0;       ///< area that lies deep in both / the smaller piece's area
  double residual = 0.0;            ///< rms of the gap's variation along the boundary, file units
  std::vector<PairedPlaces> pairs;  ///< along the boundary, as JoinFitter::fit() takes them
};

/// Fits joins between the pieces of one set.  Thread-safe after construction.
class JoinFitter {
 public:
  /// \throws InputError a piece has no border
  JoinFitter(const std::vector<Piece>& pieces, const FitOptions& options);
  ~JoinFitter();
  JoinFitter(JoinFitter&&) noexcept;
  JoinFitter& operator=(JoinFitter&&) noexcept;

  /// What can be fitted: the outer borders in the order of the pieces, then those of holes.  Holes do not change what the
  /// scales and tolerances of the set are.
  const std::vector<BorderName>& borders() const;

  /// Pose by least squares on the pairs, then by robust closest points along the boundary, which may stand a constant
  /// gap apart (worn edges); the boundary grows as far as the borders stay together.
  /// The score weighs how well the two borders' turning agrees along the boundary, scale by scale: -n/2 log(1 - r^2) for
  /// a correlation r of n samples, but no more than the samples say that the borders' own smoothness leaves independent.  So straight on straight says nothing, and what wear has taken from the fine scales is
  /// not missed at the coarse ones.  Overlap beyond the boundary's tolerance speaks against, and so does a distance between the
  /// two borders that varies along the boundary.
  /// \param a, b   positions in borders()
  /// \param pairs  at least 2; on_a rises, on_b falls (B upside down: rises), both without jumps at the borders' ends
  /// \return nullopt: the borders do not meet there
  std::optional<FittedJoin> fit(std::size_t a, std::size_t b, const std::vector<PairedPlaces>& pairs) const;

  /// Fits a join from B's side too: what a border's points meet depends on whose points they are, and where a boundary ends.
  /// \param join  a result of fit(a, b)
  /// \return the one with more evidence, as a result of fit(a, b), with the mean of both evidences
  FittedJoin fit_from_both_sides(std::size_t a, std::size_t b, const FittedJoin& join) const;

  /// The same join with A and B in each other's place.
  /// \param join  a result of fit(a, b)
  FittedJoin exchanged(std::size_t a, std::size_t b, const FittedJoin& join) const;

  /// The finest step in use, file units.
  double step() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Best first; poses within 5 degrees and `same_distance` (at B's far end, file units) of a better one are left out.
std::vector<FittedJoin> distinct(std::vector<FittedJoin> joins, const Piece& b, double same_distance,
                                 std::size_t most);

/// 0..1 for an evidence; one half where true and false joins of a few hundred candidates are equally likely.
double score_of(double evidence);

}  // namespace rejoin::outline
