#include "match/cuts.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace rejoin::match {

FacetNumbers facet_numbers(const Fragment& fragment) {
  const auto seen = fragment.facets.facets.size();
  return {static_cast<int>(seen), static_cast<int>(seen + fragment.facets.creased.facets.size())};
}

const mesh::Facet& facet(const Fragment& fragment, int number) {
  const auto& seen = fragment.facets.facets;
  const auto k = static_cast<std::size_t>(number);
  return k < seen.size() ? seen[k] : fragment.facets.creased.facets[k - seen.size()];
}

int seen_facet(const Fragment& fragment, int number) {
  if (number < facet_numbers(fragment).creased) return number;
  std::map<int, int> samples;
  for (const auto i : facet(fragment, number).samples) ++samples[fragment.facets.facet_of_sample[i]];
  samples.erase(-1);
  const auto most = std::max_element(samples.begin(), samples.end(),
                                     [](const auto& x, const auto& y) { return x.second < y.second; });
  return most == samples.end() ? -1 : most->first;
}

std::vector<int> in_both_cuts(const Fragment& fragment, std::vector<int> seen) {
  const FacetNumbers numbers = facet_numbers(fragment);
  std::vector<int> both = std::move(seen);
  const auto count = static_cast<std::ptrdiff_t>(both.size());
  for (int f = numbers.creased; f < numbers.end; ++f) {
    const int lies_in = seen_facet(fragment, f);
    if (std::find(both.begin(), both.begin() + count, lies_in) != both.begin() + count) both.push_back(f);
  }
  return both;
}

}  // namespace rejoin::match
