/// The masked agreement of two slope maps and of their outlines, at all shifts at once.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "match/relief.hpp"

namespace rejoin::match {

/// How well two reliefs agree at one shift, whatever the tilt of one against the other.
struct Agreement {
  int shift_u = 0;  ///< pixel (i, j) of the first map lies on pixel (i - shift_u, j - shift_v) of the second
  int shift_v = 0;
  float pixels = 0;     ///< overlap
  float explained = 0;  ///< share of the slopes' variance that the other explains, at most 1
  float along = 0;      ///< share of the shorter border that the other runs along; below 0 where it faces it
  float score = 0;      ///< how surprising the agreement is
};

struct CorrelateOptions {
  float noise_slope = 0.04F;    ///< slopes below this are scan noise: flat on flat explains nothing
  float least_overlap = 0.05F;  ///< of the smaller map's pixels
  float least_pixels = 24.0F;
  float outline_weight = 2.0F;  ///< of the outlines' score against that of the slopes
  int most_peaks = 6;           ///< best local maxima that are returned a call
};

/// Correlates a fixed map with many others.  Not thread-safe; one object a thread.
///
/// With g the masked slopes, k the masks, and all sums over the overlap at a shift:
///   cov = sum g1.g2 - (sum g1).(sum g2)/n,  var = sum |g|^2 - |sum g|^2/n,
///   explained = 2 cov / (var1 + var2 + 2 n noise^2),
/// and with o the gradients of the masks, summed over all pixels, and b the length of the shorter border,
///   along = sum o1.o2 / (e b), e the sum of |o|^2 across a straight border,
///   score = atanh(explained, held within 0 .. 0.98) sqrt(n) + outline_weight along sqrt(b).
/// Taking the means off removes the tilt of one facet against the other to first order, for every shift, in
/// closed form. Flat breaks have no slopes to agree on, but outlines. Each sum is a correlation of masked maps,
/// done by FFT.  \source papaioannou 2002, eq. (9), squared instead of absolute slope differences; masked
/// correlation after Padfield 2012; the outlines are ours.
class Correlator {
 public:
  Correlator(const ReliefMap& fixed, const CorrelateOptions& options);
  ~Correlator();
  Correlator(Correlator&&) noexcept;
  Correlator& operator=(Correlator&&) noexcept;

  /// Best local maxima of the score over all shifts, best first.
  std::vector<Agreement> peaks(const ReliefMap& other);

  /// Shifts that the last call of peaks() looked at.
  long shifts() const;

  /// The order in which peaks() is fastest on these maps: those that need fields of one size follow each other, so that the
  /// fixed map is transformed once a size.
  std::vector<std::size_t> cheapest_order(std::span<const ReliefMap> others) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The same at one shift by direct summation: the reference for tests, and the way to look at single shifts.
Agreement agreement_at(const ReliefMap& fixed, const ReliefMap& other, int shift_u, int shift_v,
                       const CorrelateOptions& options);

}  // namespace rejoin::match
