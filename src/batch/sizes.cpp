#include "batch/sizes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/median.hpp"
#include "match/units.hpp"

namespace rejoin::batch {

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
  constexpr std::size_t kNamed = 3;
  std::string names;
  for (std::size_t k = 0; k < std::min(kNamed, odd.fragments.size()); ++k)
    names += fmt::format("{}{} (diameter {:.3g})", k > 0 ? ", " : "", odd.fragments[k].name,
                         odd.fragments[k].diameter);
  if (names.empty()) return "";
  if (odd.fragments.size() > kNamed) names += fmt::format(" and {} more", odd.fragments.size() - kNamed);
  return fmt::format("{}: far from the median diameter of {:.3g}; are all scans in the same unit?", names,
                     odd.median);
}

}  // namespace rejoin::batch
