#include "match/detail/fft_plan.hpp"
#include "core/angle.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace rejoin::match::detail {
namespace {

constexpr std::size_t kSmallest = 8;
/// Lines that are transformed in step on the widest vectors.
constexpr std::size_t kLines = 16;

struct Radix {
  int radix;
  double cost;  ///< of a pass, operations and moves a number
};
/// Largest first, so that few passes are needed; 4 leads, as zeros and products are put in there.
constexpr std::array<Radix, 4> kRadices = {{{5, 20.0}, {3, 15.0}, {4, 13.0}, {2, 10.0}}};

/// Calls visit(radix) for the factors of a length without the leading 4.
/// \return whether it has no others than 2, 3 and 5; else some may have been visited
template <class Visit>
bool factorise(std::size_t length, const Visit& visit) {
  if (length < kSmallest || length % 4 != 0) return false;
  std::size_t left = length / 4;
  for (const Radix& r : kRadices) {
    for (; left % static_cast<std::size_t>(r.radix) == 0; left /= static_cast<std::size_t>(r.radix)) visit(r);
  }
  return left == 1;
}

struct Length {
  std::size_t length;
  double cost;  ///< of a line
};

/// Lengths from `least` on; the last has a power of two, so one is always cheap enough.
std::vector<Length> lengths_from(std::size_t least) {
  std::vector<Length> lengths;
  for (std::size_t length = (std::max(least, kSmallest) + 3) / 4 * 4;; length += 4) {
    double cost = kRadices[2].cost;
    if (!factorise(length, [&cost](const Radix& r) { cost += r.cost; })) continue;
    lengths.push_back({length, cost * static_cast<double>(length)});
    if (length > least + least / 3) return lengths;
  }
}

std::size_t whole_blocks(std::size_t lines) {
  return (lines + kLines - 1) / kLines * kLines;
}

}  // namespace

FftPlan plan_fft(std::size_t length) {
  FftPlan plan;
  plan.length = length;
  std::vector<int> radices = {4};
  factorise(length, [&radices](const Radix& r) { radices.push_back(r.radix); });
  std::size_t done = 1;
  for (const int radix : radices) {
    const auto r = static_cast<std::size_t>(radix);
    const std::size_t left = length / done;
    const FftStage stage{radix, left / r, done, plan.twiddles.size()};
    for (std::size_t p = 0; p < stage.groups; ++p) {
      for (std::size_t k = 1; k < r; ++k) {
        const double angle = -kTurn * static_cast<double>(p * k) / static_cast<double>(left);
        plan.twiddles.push_back(static_cast<float>(std::cos(angle)));
        plan.twiddles.push_back(static_cast<float>(std::sin(angle)));
      }
    }
    plan.stages.push_back(stage);
    done *= r;
  }
  return plan;
}

FftSize fft_size(std::size_t least_width, std::size_t least_height) {
  FftSize best;
  double least_cost = std::numeric_limits<double>::max();
  const std::vector<Length> widths = lengths_from(least_width);
  for (const Length& height : lengths_from(least_height)) {
    for (const Length& width : widths) {
      const double cost = static_cast<double>(whole_blocks(height.length)) * width.cost +
                          static_cast<double>(whole_blocks(width.length)) * height.cost;
      if (cost >= least_cost) continue;
      least_cost = cost;
      best = {width.length, height.length};
    }
  }
  return best;
}

}  // namespace rejoin::match::detail
