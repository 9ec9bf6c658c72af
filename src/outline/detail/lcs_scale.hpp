/// One scale of the lcs method: the borders of a set at one spacing, their guesses and fits.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/context.hpp"
#include "outline/detail/pose_fit.hpp"
#include "outline/detail/turn_model.hpp"
#include "outline/lcs.hpp"
#include "outline/stitch.hpp"
#include "outline/turns.hpp"

namespace rejoin::outline::detail {

/// A join with what speaks for it.
struct LcsFit {
  JoinCandidate join;
  double evidence = 0.0;  ///< how much likelier the turning along the seam is of one line, natural logarithm
  double middle_a = 0.0;  ///< arc length of the seam's middle on A
  double middle_b = 0.0;  ///< and on B
};

/// Thread-safe after construction.
class LcsScale {
 public:
  /// \param step  between samples, file units
  LcsScale(const std::vector<Piece>& pieces, const LcsOptions& options, double step);

  double step() const { return step_; }

  /// Appends what fits; less if the context is cancelled.
  void search(std::size_t a, std::size_t b, const Context& context, std::vector<LcsFit>& found) const;

  /// A join of a coarser scale, fitted at this one; nullopt: the borders do not meet there when looked at closely.
  /// \param coarser  that scale's step
  std::optional<LcsFit> refine(std::size_t a, std::size_t b, const LcsFit& coarse, double coarser) const;

 private:
  /// What is known of a piece.
  struct Prepared {
    Turns turns;
    std::vector<std::uint8_t> levels;  ///< of every stride-th slope change
    /// The same as a partner meets it: backward and negated; upside down: negated.
    std::array<std::vector<std::uint8_t>, 2> partner;
    double area = 0.0;
    double perimeter = 0.0;
    Outline coarse;  ///< for the check of the union
  };
  using SamplePair = std::pair<std::uint32_t, std::uint32_t>;
  /// Samples of A and of B that may have been one.
  struct Guess {
    std::vector<SamplePair> pairs;
    std::size_t centre = 0;
    bool flipped = false;
  };

  std::size_t stride() const;
  Prepared prepared(const Piece& piece) const;
  std::vector<Guess> guesses(const Prepared& a, const Prepared& b, bool flipped) const;
  std::vector<PointPair> trusted(const Prepared& a, const Prepared& b, const Guess& guess) const;
  SamplePair meeting(const Prepared& a, const Prepared& b, const Planar& pose, SamplePair from) const;
  std::vector<PointPair> along(const Prepared& a, const Prepared& b, const Seam& seam) const;
  std::optional<LcsFit> fit(const Prepared& a, const Prepared& b, Planar pose, SamplePair start,
                            double reach) const;
  std::optional<LcsFit> judged(const Prepared& a, const Prepared& b, const Planar& pose,
                               const Seam& seam) const;
  double agreement(const Prepared& a, const Prepared& b, const Seam& seam, bool flipped) const;

  LcsOptions options_;
  double step_ = 1.0;
  std::vector<Prepared> pieces_;
  TurnModel model_;
};

}  // namespace rejoin::outline::detail
