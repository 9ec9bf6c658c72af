/// Lengths and factors of the discrete Fourier transforms of the sweep.
#pragma once

#include <cstddef>
#include <vector>

namespace rejoin::match::detail {

/// One pass over a line: groups * radix * stride = length, and in the k-th of `radix` terms the value at
/// q + stride * (radix * p + k) comes from those at q + stride * (p + groups * j).
struct FftStage {
  int radix = 0;
  std::size_t groups = 0;
  std::size_t stride = 0;
  std::size_t twiddles =
      0;  ///< where those of group 0 start: (radix - 1) pairs of real and imaginary part a group
};

/// A transform without bit reversal (Stockham): X[f] = sum x[t] exp(-2 pi i f t / length).
struct FftPlan {
  std::size_t length = 0;
  std::vector<FftStage> stages;  ///< at least two, the first of radix 4
  std::vector<float> twiddles;
};

/// \param length  a side of fft_size()
FftPlan plan_fft(std::size_t length);

/// Sides of a field that is to be transformed.
struct FftSize {
  std::size_t width = 0;
  std::size_t height = 0;
  bool operator==(const FftSize&) const = default;
};

/// The field of at least these sides that takes the fewest operations: multiples of 4 without factors but 2, 3 and 5.
/// The choice does not depend on the processor.
FftSize fft_size(std::size_t least_width, std::size_t least_height);

}  // namespace rejoin::match::detail
