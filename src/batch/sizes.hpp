/// Scans whose size says that they may be in another unit than the rest.
#pragma once

#include <string>
#include <vector>

#include "store/records.hpp"

namespace rejoin::batch {

/// Sizes that differ by more are doubted: metres and millimetres are 1,000 apart, the sherds of a pot rarely 50.
inline constexpr double kOddRatio = 100.0;

struct OddSizes {
  double median = 0;                       ///< diameter of all that are ready, mesh units
  std::vector<store::Fragment> fragments;  ///< more than kOddRatio times larger or smaller than that
};

/// Looks at those that are ready.
OddSizes odd_sizes(const std::vector<store::Fragment>& fragments);

/// A line for the user; empty if there are none.
std::string told(const OddSizes& odd);

}  // namespace rejoin::batch
