/// How many independent samples two series share that each go on smoothly.
#pragma once

#include <span>

namespace rejoin::outline::detail {

/// The number of independent pairs that would tell as much of a correlation as these do, by both series' own autocorrelation: the
/// squared correlation of two unrelated series is one over it on average.  Series of which each sample tells the next have fewer than
/// they have samples.
/// \pre as many samples in both
/// \return 0..a.size(); 0 if one of them is constant
/// \source bartlett 1935: n / (1 + 2 sum_j (1 - j/n) rho_a(j) rho_b(j)); deviation: less what the product is for the same noise on
/// both sides, as where two borders were one it is no sign of smoothness, and never more than n
double independent_samples(std::span<const double> a, std::span<const double> b);

}  // namespace rejoin::outline::detail
