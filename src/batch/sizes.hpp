/// Scans whose lengths say that they may be in another unit than the rest, or too coarse beside them.
#pragma once

#include <string>
#include <vector>

#include "store/records.hpp"

namespace rejoin::batch {

struct OddSizes {
  double median = 0;                       ///< diameter of all that are ready, mesh units
  std::vector<store::Fragment> fragments;  ///< of which match::units_differ() from that
};

/// Looks at those that are ready.
OddSizes odd_sizes(const std::vector<store::Fragment>& fragments);

/// A line for the user; empty if there are none.
std::string told(const OddSizes& odd);

/// Scans of which every length differs from those of the others alike (match::units_apart()).
struct OddUnit {
  std::vector<store::Fragment> fragments;  ///< the group that is fewer
  double ratio = 1;  ///< of its lengths to those of the others, below 1 where they are smaller
};

/// Looks at those that are ready.
OddUnit odd_unit(const std::vector<store::Fragment>& fragments);

/// A line for the user; empty if there are none.
std::string told(const OddUnit& odd);

/// Scans without walls, as of solid pieces, among sherds whose walls they would not show: their points are too far apart.
struct CoarseAmongSherds {
  double wall = 0;                         ///< median thickness of the sherds' walls, mesh units
  std::vector<store::Fragment> fragments;  ///< none unless most of those that are ready are sherds
};

/// Looks at those that are ready.
CoarseAmongSherds coarse_among_sherds(const std::vector<store::Fragment>& fragments);

/// A line for the user; empty if there are none.
std::string told(const CoarseAmongSherds& coarse);

/// All lines, without the empty ones; a scan of an odd unit is told as such alone.
std::vector<std::string> doubts_about_lengths(const std::vector<store::Fragment>& fragments);

}  // namespace rejoin::batch
