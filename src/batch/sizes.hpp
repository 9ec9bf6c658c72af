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

}  // namespace rejoin::batch
