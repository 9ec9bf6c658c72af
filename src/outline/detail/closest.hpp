/// Robust closest points along the common boundary of two borders.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "outline/join_fit.hpp"
#include "outline/outline.hpp"
#include "outline/signal.hpp"

namespace rejoin::outline::detail {

/// A piece's border at the scale at which poses are fitted.
struct Border {
  const ScaleSignal* signal = nullptr;
  double perimeter = 0.0;  ///< of the piece's own border, the unit of its places
};

/// Sample `i` of A (it may run beyond the end and wraps) meets `j` on B, in B's samples, a fraction in between.
struct Contact {
  std::int32_t i = 0;
  double j = 0.0;
  double distance = 0.0;  ///< along A's outward normal, file units; negative: B overlaps A
  bool close = false;     ///< within tolerance of the usual distance, and the borders run against each other
};

/// A fitted pose with the boundary it rests on.
struct ContactFit {
  Planar pose;
  std::vector<Contact> contacts;  ///< of the whole boundary, i ascending without a gap
  double gap = 0.0;               ///< median distance, file units
  double residual = 0.0;          ///< rms of the distance about the gap where close, file units
};

/// \param tolerance  the most by which the distance may vary, file units
/// \return nullopt: no boundary of at least 6 samples is left
std::optional<ContactFit> fit_contact(const Border& a, const Border& b,
                                      const std::vector<PairedPlaces>& pairs, double tolerance);

/// Fractional sample of a place on a border; whole turns are kept: place + perimeter gives sample + count.
double sample_of(const Border& border, double place);

/// The inverse of sample_of().
double place_of(const Border& border, double sample);

}  // namespace rejoin::outline::detail
