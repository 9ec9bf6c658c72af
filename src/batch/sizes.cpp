#include "batch/sizes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/median.hpp"
#include "match/units.hpp"

namespace rejoin::batch {
namespace {

/// "a.ply (diameter 12), b.ply (diameter 9)", the first few by name; empty of none.
std::string named(const std::vector<store::Fragment>& fragments) {
  constexpr std::size_t kNamed = 3;
  std::string names;
  for (std::size_t k = 0; k < std::min(kNamed, fragments.size()); ++k)
    names +=
        fmt::format("{}{} (diameter {:.3g})", k > 0 ? ", " : "", fragments[k].name, fragments[k].diameter);
  if (fragments.size() > kNamed) names += fmt::format(" and {} more", fragments.size() - kNamed);
  return names;
}

}  // namespace

OddSizes odd_sizes(const std::vector<store::Fragment>& fragments) {
  std::vector<double> diameters;
  for (const store::Fragment& fragment : fragments)
    if (fragment.state == store::FragmentState::Ready) diameters.push_back(fragment.diameter);
  OddSizes odd{median(diameters), {}};
  for (const store::Fragment& fragment : fragments) {
    if (fragment.state != store::FragmentState::Ready) continue;
    if (match::units_differ(fragment.diameter, odd.median)) odd.fragments.push_back(fragment);
  }
  return odd;
}

std::string told(const OddSizes& odd) {
  if (odd.fragments.empty()) return "";
  return fmt::format("{}: far from the median diameter of {:.3g}; are all scans in the same unit?",
                     named(odd.fragments), odd.median);
}

OddUnit odd_unit(const std::vector<store::Fragment>& fragments) {
  std::vector<store::Fragment> ready;
  std::vector<match::Lengths> lengths;
  for (const store::Fragment& fragment : fragments) {
    if (fragment.state != store::FragmentState::Ready) continue;
    ready.push_back(fragment);
    lengths.push_back({fragment.diameter, fragment.spacing, fragment.noise, fragment.wall});
  }
  const auto groups = match::units_apart(lengths);
  if (!groups) return {};
  OddUnit odd;
  const bool small = groups->small.size() <= groups->large.size();
  for (const std::size_t k : small ? groups->small : groups->large) odd.fragments.push_back(ready[k]);
  odd.ratio = small ? 1 / groups->ratio : groups->ratio;
  return odd;
}

std::string told(const OddUnit& odd) {
  if (odd.fragments.empty()) return "";
  const bool small = odd.ratio < 1;
  const double times = small ? 1 / odd.ratio : odd.ratio;
  const auto units = match::likely_units(times);
  return fmt::format(
      "{}: every length (diameter, points' spacing, noise, wall) is about {}{:.0f}{}; are all scans in the "
      "same unit{}?",
      named(odd.fragments), small ? "1/" : "", times,
      small ? " of those of the others" : " times those of the others",
      units ? fmt::format(", none in {} beside {}", small ? units->of_small : units->of_large,
                          small ? units->of_large : units->of_small)
            : "");
}

CoarseAmongSherds coarse_among_sherds(const std::vector<store::Fragment>& fragments) {
  constexpr double kEdgesAcross = 2.0;  // fewer points than that across a wall do not show it
  std::vector<double> walls;
  std::vector<store::Fragment> solid;
  for (const store::Fragment& fragment : fragments) {
    if (fragment.state != store::FragmentState::Ready) continue;
    if (fragment.wall > 0)
      walls.push_back(fragment.wall);
    else
      solid.push_back(fragment);
  }
  if (walls.size() <= solid.size()) return {};
  CoarseAmongSherds coarse{median(walls), std::move(solid)};
  std::erase_if(coarse.fragments, [&](const store::Fragment& fragment) {
    return kEdgesAcross * fragment.spacing < coarse.wall;
  });
  return coarse;
}

std::string told(const CoarseAmongSherds& coarse) {
  if (coarse.fragments.empty()) return "";
  return fmt::format(
      "{}: taken for solid among sherds with walls {:.3g} thick, which points as far apart as {:.3g} do not "
      "show; if these are sherds, too, scan or export them more finely",
      named(coarse.fragments), coarse.wall, coarse.fragments[0].spacing);
}

std::vector<std::string> doubts_about_lengths(const std::vector<store::Fragment>& fragments) {
  const OddUnit unit = odd_unit(fragments);
  OddSizes sizes = odd_sizes(fragments);
  CoarseAmongSherds coarse = coarse_among_sherds(fragments);
  const auto is_told = [&](const store::Fragment& fragment) {
    return std::ranges::count(unit.fragments, fragment.name, &store::Fragment::name) > 0;
  };
  std::erase_if(sizes.fragments, is_told);
  std::erase_if(coarse.fragments, is_told);
  std::vector<std::string> doubts{told(unit), told(sizes), told(coarse)};
  std::erase(doubts, "");
  return doubts;
}

}  // namespace rejoin::batch
