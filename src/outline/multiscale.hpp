/// Multi-scale matching of outlines by their curvature.  \source leitao 2000, algorithm 1
#pragma once

#include <memory>
#include <vector>

#include "outline/matcher.hpp"

namespace rejoin::outline {

/// Parameters of one scale, in samples of that scale.
struct MultiscaleLevel {
  double xi = 0.0;     ///< critical mismatch of two samples, as a multiple of the scale's usual turning
  double zeta = 0.0;   ///< penalty of an asymmetric step, the same multiple
  double n_min = 0.0;  ///< least length that can be told from chance, samples
};

/// What works on most sets.
MultiscaleLevel default_level();

struct MultiscaleOptions {
  double step = 0.0;                     ///< delta of the finest scale, file units; 0: from the pieces
  double min_length = 0.0;               ///< L_min, the shortest boundary looked for, file units; 0: see next
  double min_length_share = 1.0 / 12.0;  ///< L_min as a share of the pieces' mean border
  double alpha = 3.0;        ///< corner blurring: a boundary's ends are lost for alpha * lambda at each scale
  int band = 4;              ///< q: refinement looks this many samples to either side
  std::size_t per_pair = 4;  ///< candidates of a pair kept at the finest scale, doubled with each coarser one
  std::size_t fitted = 40;   ///< candidates of a pair whose pose is fitted
  std::size_t per_coarse_scale =
      4;  ///< candidates that each scale adds at which boundaries of L_min are lost already
  std::vector<MultiscaleLevel> levels;  ///< finest first, from calibrate(); missing ones: defaults
};

/// The matcher; prepare() computes the scale space of all pieces.  A piece is compared with the holes of another too, if it is no
/// larger and the hole's border is as long as the shortest boundary looked for.
std::unique_ptr<Matcher> make_multiscale(const MultiscaleOptions& options = {});

}  // namespace rejoin::outline
