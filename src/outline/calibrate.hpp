/// Parameters of the multi-scale method from pieces whose joins are known.
#pragma once

#include <cstdint>
#include <vector>

#include "core/context.hpp"
#include "outline/multiscale.hpp"
#include "outline/outline.hpp"

namespace rejoin::outline {

/// A join that is known to be true.
struct KnownJoin {
  std::size_t a = 0;
  std::size_t b = 0;
  Planar pose;  ///< B's file coordinates -> A's
};

struct CalibrateOptions {
  double step = 0.0;  ///< delta of the finest scale, file units; 0: from the pieces
  int scales = 5;
  int samples = 400;       ///< true and false candidates each, at most, for each scale
  std::uint64_t seed = 1;  ///< of the choice of pairs and places
};

/// What was found for one scale.
struct CalibratedLevel {
  double step = 0.0;  ///< file units
  MultiscaleLevel level;
  double mistaken =
      0.0;  ///< share of the known candidates on the wrong side of Delta = 0, true and false weighed alike
  std::size_t true_candidates = 0;
  std::size_t false_candidates = 0;
  bool calibrated = false;  ///< false: too few candidates of a kind, so that the level is the default
};

/// For each scale the xi, zeta and n_min whose line S^2 = xi^2 (l - n_min) best separates the mismatch of true candidates
/// from that of false ones, of several lengths l.  True candidates are stretches of the known joins; false ones are the
/// best chance resemblances of pairs that are no join.
/// \return finest scale first; a scale with fewer than 10 candidates of a kind keeps the defaults, with mistaken = 0.5
/// \source leitao 2000, "Obtaining the parameters"
std::vector<CalibratedLevel> calibrate(const std::vector<Piece>& pieces, const std::vector<KnownJoin>& joins,
                                       const CalibrateOptions& options, const Context& context);

}  // namespace rejoin::outline
