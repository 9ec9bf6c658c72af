#include "outline/detail/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "outline/detail/coding.hpp"
#include "outline/detail/independence.hpp"

namespace rejoin::outline::detail {
namespace {

/// Neighbouring samples and scales share what they tell: this part of a sample is new.
constexpr double kIndependent = 0.4;
/// So near to the boundary's ends, in steps, the smoothed border is drawn to what lies beyond.
constexpr double kBlurred = 1.5;
constexpr double kLeastSamples = 5.0;
/// A straight border turns by up to so much from sample to sample at the finest scale, as the pixels' raster has it, root mean square,
/// radians, and by half of it at each coarser one.  Straight borders of one slope have one raster and agree very well by it.
constexpr double kRaster = 0.03;
/// The same of pixels all in or all out, as a share of their raster and of the step: a staircase of steps of one pixel, smoothed, turns
/// by up to 0.15 pixels a step.  That hides the fine scales of broken borders too, so a scale counts where it or one of the next
/// coarser ones shows that the border is not straight.
constexpr double kSteps = 0.8;
constexpr std::size_t kWitnesses = 3;
/// Of what a place tells, what another one tells at least where borders repeat; of others the best of many places has less by chance.
constexpr double kRepeats = 0.5;

/// Correlation of paired numbers, summed up one pair at a time.
struct Sums {
  double count = 0.0;
  double a = 0.0;
  double b = 0.0;
  double aa = 0.0;
  double bb = 0.0;
  double ab = 0.0;
  double fourth = 0.0;  ///< of the squares' means

  void add(double x, double y) {
    count += 1.0;
    a += x;
    b += y;
    aa += x * x;
    bb += y * y;
    ab += x * y;
    const double square = 0.5 * (x * x + y * y);
    fourth += square * square;
  }

  /// How many of the pairs carry the squares: all where these spread as a normal distribution's do, about three where one
  /// corner has them all.
  double carrying() const {
    const double squares = 0.5 * (aa + bb);
    return fourth > 0.0 ? std::min(count, 3.0 * squares * squares / fourth) : count;
  }

  double size_a() const { return std::sqrt(aa / count); }  ///< root mean square
  double size_b() const { return std::sqrt(bb / count); }

  double correlation() const {
    const double variance_a = aa - a * a / count;
    const double variance_b = bb - b * b / count;
    const double product = variance_a * variance_b;
    return product > 0.0 ? (ab - a * b / count) / std::sqrt(product) : 0.0;
  }
};

double turning_at(const ScaleSignal& signal, double sample, double limit) {
  const auto count = static_cast<double>(signal.turning.size());
  const double rest = sample - std::floor(sample / count) * count;
  const auto low = std::min(static_cast<std::size_t>(rest), signal.turning.size() - 1);
  const std::size_t next = low + 1 < signal.turning.size() ? low + 1 : 0;
  const double share = rest - static_cast<double>(low);
  const double value = (1.0 - share) * static_cast<double>(signal.turning[low]) +
                       share * static_cast<double>(signal.turning[next]);
  return std::clamp(value, -limit, limit);
}

/// How much a straight border turns at a scale by its pixels' steps, root mean square, radians, where its slope is the worst for the
/// scale, with half as much again.
double turning_of_steps(const ScaledBorder& border, std::size_t k) {
  return kSteps * border.pixels.raster / (*border.scales)[k].step;
}

/// What one scale says.
struct Level {
  double told = 0.0;  ///< by each sample, natural logarithm
  double samples =
      0.0;  ///< that carry the turning, less what neighbours and other scales of a rough border share
  double independent = 0.0;  ///< of those that carry it, by the borders' own smoothness
  bool bent = false;         ///< both borders, by more than their pixels' steps may bend straight ones
};

/// What a sample tells, natural logarithm.
double told_by(double correlation) {
  const double r = std::clamp(correlation, 0.0, 0.999);
  return -0.5 * std::log(1.0 - r * r);
}

/// What a sample tells at the best place farther along the boundary, beyond what the best of so many tells by chance: borders that repeat,
/// as teeth and perforations do, agree there as well.
/// \param a, b  turning in step   \param here  their correlation so
double told_farther_along(std::span<const double> a, std::span<const double> b, double here) {
  constexpr double kTied = 3.0;  // samples that a correlation takes itself (Fisher)
  constexpr double kLeft = 0.5;  // of the correlation, what is left where a shift is one to another place
  double most = 0.0;
  for (const auto& [still, moved] : {std::pair(a, b), std::pair(b, a)}) {
    bool elsewhere = false;
    for (std::size_t shift = 1; shift <= still.size() / 2; ++shift) {
      Sums sums;
      for (std::size_t i = shift; i < still.size(); ++i) sums.add(still[i], moved[i - shift]);
      const double there = sums.correlation();
      elsewhere = elsewhere || there < kLeft * here;
      const double free = sums.carrying() - kTied;
      if (!elsewhere || free < 1.0) continue;
      const double chance = std::log(static_cast<double>(still.size())) / free;
      most = std::max(most, told_by(there) - chance);
    }
  }
  return most;
}

Level level_at(const ScaledBorder& a, const ScaledBorder& b, const std::vector<Contact>& contacts,
               std::size_t k) {
  const ScaleSignal& signal_a = (*a.scales)[k];
  const Border here_a{&signal_a, a.border.perimeter};
  const Border here_b{&(*b.scales)[k], b.border.perimeter};
  const double begin = sample_of(here_a, place_of(a.border, contacts.front().i));
  const double end = sample_of(here_a, place_of(a.border, contacts.back().i));
  Sums sums;
  std::vector<double> turning_a;
  std::vector<double> turning_b;
  const double limit = (*a.limits)[k];
  const auto first = static_cast<long>(std::ceil(begin + kBlurred));
  const auto last = static_cast<long>(std::floor(end - kBlurred));
  for (long sample = first; sample <= last; ++sample) {
    const auto i = static_cast<double>(sample);
    const double at = sample_of(a.border, place_of(here_a, i)) - contacts.front().i;
    const auto low = static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(contacts.size() - 2)));
    const double share = std::clamp(at - static_cast<double>(low), 0.0, 1.0);
    const double j = contacts[low].j + share * (contacts[low + 1].j - contacts[low].j);
    const double on_b = sample_of(here_b, place_of(b.border, j));
    turning_a.push_back(turning_at(signal_a, i, limit));
    turning_b.push_back(-turning_at(*here_b.signal, on_b, limit));
    sums.add(turning_a.back(), turning_b.back());
  }
  if (sums.count < kLeastSamples) return {};
  const double least = std::min(sums.size_a(), sums.size_b());
  const double straight =
      a.pixels.any || b.pixels.any ? std::ldexp(kRaster, -static_cast<int>(k)) : straight_turning(k);
  if (least < straight) return {};
  const double r = sums.correlation();
  const double here = told_by(r);
  const double elsewhere = told_farther_along(turning_a, turning_b, r);
  const double told = elsewhere > kRepeats * here ? here - elsewhere : here;
  const double carrying = sums.carrying();
  return {std::max(0.0, told), kIndependent * carrying,
          carrying / sums.count * independent_samples(turning_a, turning_b),
          sums.size_a() > turning_of_steps(a, k) && sums.size_b() > turning_of_steps(b, k)};
}

/// The most that the borders' independent samples tell together: a scale has those of the coarser ones too, so each counts once, by the
/// scale that agrees best of those that have it.
double most_told(std::vector<Level> levels) {
  std::stable_sort(levels.begin(), levels.end(),
                   [](const Level& x, const Level& y) { return x.independent > y.independent; });
  levels.emplace_back();
  double sum = 0.0;
  double told = 0.0;
  for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
    told = std::max(told, levels[k].told);
    sum += told * (levels[k].independent - levels[k + 1].independent);
  }
  return sum;
}

}  // namespace

double agreement(const ScaledBorder& a, const ScaledBorder& b, const std::vector<Contact>& contacts) {
  if (contacts.size() < 2) return 0.0;
  std::vector<Level> levels;
  levels.reserve(a.scales->size());
  double sum = 0.0;
  for (std::size_t k = 0; k < a.scales->size(); ++k) levels.push_back(level_at(a, b, contacts, k));
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const auto coarser = std::span(levels).subspan(k, std::min(kWitnesses, levels.size() - k));
    if (std::ranges::none_of(coarser, &Level::bent)) levels[k] = {};
    sum += levels[k].told * levels[k].samples;
  }
  return std::min(sum, most_told(std::move(levels)));
}

}  // namespace rejoin::outline::detail
