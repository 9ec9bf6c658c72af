/// Repeated annealing of one pair, judged against the truth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "match/esa_search.hpp"
#include "match/match.hpp"
#include "pair_truth.hpp"

namespace rejoin::bench {

/// What the search is told.
enum class Knowledge {
  Nothing,         ///< figure 12
  RoughestFacets,  ///< figure 13: directions from the roughest facets
  TrueDirection,   ///< figure 13 (a): one direction a fragment, here the mean normal of the true contact
};

struct RunOptions {
  int seeds = 25;        ///< independent runs, each one chain a combination of directions
  int resolution = 128;  ///< pixels across
  int directions = 4;    ///< a fragment, for RoughestFacets
  bool overlap_bias = true;
  match::MapSource maps = match::MapSource::Fragment;
  zbuffer::Backend backend = zbuffer::Backend::Auto;
  std::uint64_t first_seed = 1;
  double shift_range = 0.1;  ///< bound of |x1| and |y1| as a fraction of R
  anneal::Equilibrium equilibrium = anneal::Equilibrium::Either;
  int failed_stages = 4;  ///< N_fail
};

/// Runs that ended at about the same pose.
struct Group {
  int runs = 0;
  double mean_error = 0;  ///< <e_d>, without biases
};

struct Outcome {
  int runs = 0;
  Group right;  ///< within 5 degrees and 2 % of the joint diameter of the truth
  Group wrong;  ///< the most frequent wrong pose (within 5 % of each other); runs 0 if none
  std::optional<double> error_at_truth;  ///< e_d of the true pose seen along the true direction
  long evaluations = 0;
  double seconds = 0;
};

/// \return nullopt if the search cannot be told what `knowledge` says
std::optional<Outcome> measure(const match::Fragment& a, const match::Fragment& b, const PairTruth& truth,
                               Knowledge knowledge, const RunOptions& options);

}  // namespace rejoin::bench
