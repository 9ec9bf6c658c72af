/// The sweep: all turns and shifts of facet against facet.
#pragma once

#include <optional>
#include <vector>

#include "core/context.hpp"
#include "core/rigid.hpp"
#include "match/correlate.hpp"
#include "match/match.hpp"
#include "match/near.hpp"

namespace rejoin::match {

/// One peak of the sweep.
struct SweepHit {
  int facet_a = -1;  ///< match/cuts.hpp
  int facet_b = -1;
  double turn_rad = 0;  ///< of B's patch about A's facet normal, after the half turn
  double pitch = 0;     ///< of the maps, mesh units
  Agreement agreement;
  Rigid pose;  ///< B -> A, both relative to their mesh's origin
};

struct SweepOptions {
  std::vector<int> facets_a;  ///< facets that may join (match/cuts.hpp); empty: all fracture facets
  std::vector<int> facets_b;
  std::optional<Near> near;   ///< only hits that hold near a rough pose
  double turn_step_px = 2.0;  ///< how far the end of the shorter facet moves between turns, pixels
  /// Peaks that are kept.
  struct Kept {
    int a_pair_of_facets = 0;
    int in_all = 0;
    int of_each = 0;  ///< pair of facets, beside the best in all
  };
  Kept kept{.a_pair_of_facets = 96, .in_all = 1600};
  Kept kept_thin{.a_pair_of_facets = 24,
                 .in_all = 400,
                 .of_each = 4};  ///< where both pieces are thin: their strips tell more
};

struct SweepResult {
  std::vector<SweepHit> hits;  ///< best first, near-equal poses once
  long evaluations = 0;        ///< poses (turn and shift) whose agreement was computed
};

/// Correlates all pairs of facets of the same cut, and quarters of large facets of the second one.  Deterministic for any
/// number of threads.
SweepResult sweep(const Fragment& a, const Fragment& b, const SweepOptions& options, const Context& context);

}  // namespace rejoin::match
