/// Correlation of slope maps and of their outlines over all shifts: the arithmetic of Correlator.
#pragma once

#include <hwy/aligned_allocator.h>

#include <array>
#include <cstddef>
#include <vector>

#include "match/detail/fft_plan.hpp"
#include "match/relief.hpp"

namespace rejoin::match::detail {

/// Numbers in whole vectors, with a vector to spare before them.
class Field {
 public:
  /// Grows if need be, and is zero then; else keeps what it holds.
  void reserve(std::size_t count);
  float* data() const { return numbers_.get() + kSpare; }

 private:
  static constexpr std::size_t kSpare = 16;
  hwy::AlignedFreeUniquePtr<float[]> numbers_;
  std::size_t count_ = 0;
};

struct ComplexField {
  Field re;
  Field im;
  void reserve(std::size_t count);
};

/// Gradients of masks are taken by these weights along their direction, and these across it.
inline constexpr std::size_t kBorderReach = 3;
inline constexpr std::array<float, 7> kBorderSlope = {-0.1F, -0.4F, -0.5F, 0.0F, 0.5F, 0.4F, 0.1F};
inline constexpr std::array<float, 7> kBorderMean = {1.0F / 64,  6.0F / 64, 15.0F / 64, 20.0F / 64,
                                                     15.0F / 64, 6.0F / 64, 1.0F / 64};
/// Sum of the squared gradients across a straight border in rows or columns: twice that of 0.1, 0.5 and 1.
inline constexpr float kBorderEnergy = 2.52F;

/// Sums over the overlap at each shift.  A pixel counts where both masks do; g are the slopes.
struct Sums {
  float n = 0;         ///< pixels
  float energy = 0;    ///< |g1|^2 + |g2|^2
  float together = 0;  ///< g1 . g2
  float along = 0;     ///< o1 . o2 over all pixels, o the gradients of the masks
  float u1 = 0, v1 = 0, u2 = 0, v2 = 0;
};

/// What scores a shift; see Correlator.
struct ScoreRule {
  float least_pixels = 0;  ///< shifts with fewer score 0
  float noise_slope = 0;
  float outline = 0;  ///< what a shift scores for `along`
};

/// Spectra of a map: frequency after frequency along v, row after row along u.
struct Spectra {
  ComplexField packed;  ///< mask + i energy
  ComplexField mask;    ///< 1 where the map counts
  ComplexField energy;  ///< squared slopes
  ComplexField slopes;  ///< along u + i along v
  ComplexField slope_u;
  ComplexField slope_v;
};

/// Squares of what kBorderSlope and kBorderMean do to each frequency along one side.
struct BorderFilter {
  Field slope;
  Field mean;
};

/// What fields need along one side.
struct SideTables {
  FftPlan plan;
  BorderFilter border;
};

/// Correlates a fixed map with others on fields of one size at a time.
///
/// With K, Q, R = U + i V the spectra of mask, energy and slopes of the maps 1 and 2, and G the power that taking the
/// gradient of a mask gives each frequency, four inverse transforms give all sums: n + i energy come from
/// (K1 + i Q1) K2* + i K1 Q2*, u1 + i v1 from R1 K2*, u2 - i v2 from K1 R2*, and together + i along from
/// U1 U2* + V1 V2* + i G K1 K2*.
struct CorrelateFields {
  FftSize size;
  std::size_t map_stride = 0;       ///< of rows of maps and sums, along u
  std::size_t spectrum_stride = 0;  ///< of rows of spectra, along v
  std::size_t score_stride = 0;
  const SideTables* along_u = nullptr;
  const SideTables* along_v = nullptr;
  std::array<Field, 4> map;          ///< mask, energy, slopes along u and v, filled up to the stride
  std::array<ComplexField, 4> half;  ///< transformed along one side only
  Spectra first;
  Spectra second;
  std::array<Field, 8> sums;  ///< n, energy, u1, v1, u2, -v2, together, along
  Field scores;               ///< with a frame of one shift that repeats the opposite side
  std::array<Field, 2> scratch;
};

/// Works on circular shifts of this size from now on; the first map is to be set anew.
void resize(CorrelateFields& fields, FftSize size);

/// \pre the map is no larger than the fields
void set_first(CorrelateFields& fields, const ReliefMap& map);

/// Finds sums and scores of all shifts of a second map.
/// \pre it is no larger than the fields
void correlate(CorrelateFields& fields, const ReliefMap& second, const ScoreRule& rule);

/// Shifts v * width + u, ascending, that score above 0, more than the next in u and in v, and no less than those before.
void local_maxima(const CorrelateFields& fields, std::vector<std::size_t>& places);

Sums sums_at(const CorrelateFields& fields, std::size_t place);

}  // namespace rejoin::match::detail
