/// What the shape of a joint is worth.
#pragma once

#include "match/evidence.hpp"

namespace rejoin::match::detail {

/// What the shape of the broken surfaces is worth, within the tolerance and within kNear of it.
struct Worth {
  double close = 0;
  double near = 0;

  double strength() const;
  bool none() const { return close <= 0.0 && near <= 0.0; }
};

/// \source docs/scoring.md
Worth worth_of(const Evidence& evidence);

/// What both ways agree on: the geometric means, of what is above 0.
Worth agreed(const Worth& there, const Worth& back);

/// At most what skin that goes on across the contact's border adds to the strength.
double most_of_skin(const Evidence& evidence);

}  // namespace rejoin::match::detail
