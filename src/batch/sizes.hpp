/// Scans whose size says that they may be in another unit than the rest.
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

/// A line of scans of which every length is about ten times that of the others, or a tenth (match::ten_times_apart()), those that are
/// fewer; empty if there are none.
std::string told_of_ten_times(const std::vector<store::Fragment>& fragments);

/// Both lines, without the empty ones.
std::vector<std::string> doubts_about_units(const std::vector<store::Fragment>& fragments);

}  // namespace rejoin::batch
