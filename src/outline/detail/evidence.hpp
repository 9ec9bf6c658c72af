/// How much two borders agree beyond chance.
#pragma once

#include <vector>

#include "outline/detail/closest.hpp"
#include "outline/signal.hpp"

namespace rejoin::outline::detail {

/// What pixels do to a border, see Outline.
struct Pixels {
  bool any = false;
  double raster = 0.0;
};

/// One piece's borders at all scales, with the scale at which poses are fitted.
struct ScaledBorder {
  const std::vector<ScaleSignal>* scales = nullptr;
  const std::vector<double>* limits =
      nullptr;    ///< of each scale: turning beyond is cut off (corners count once)
  Border border;  ///< the contacts' samples
  Pixels pixels;
};

/// Sum over the scales of -n/2 log(1 - r^2), with r the correlation of the two borders' turning along the boundary (B's
/// backward, sign changed) and n its number of samples (a bend between straight lines is not as many as it has samples), by
/// what a rough border's tell anew.  No more than the borders' independent samples tell, by independent_samples() and each once: smooth
/// borders show one shape at all scales.  What may be the pixels' steps alone says nothing.  In natural logarithms; about 1 by chance.
double agreement(const ScaledBorder& a, const ScaledBorder& b, const std::vector<Contact>& contacts);

}  // namespace rejoin::outline::detail
