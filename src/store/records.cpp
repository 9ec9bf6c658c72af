#include "store/records.hpp"

#include <fmt/format.h>

#include "core/words.hpp"

namespace rejoin::store {

std::map<std::string, std::string> copies(const std::vector<Fragment>& fragments,
                                          const SearchedPairs& searched) {
  const auto pairs_of = [&searched](const std::string& name) {
    const auto known = searched.find(name);
    return known == searched.end() ? 0 : known->second;
  };
  const auto stands = [&pairs_of](const std::string& name, const std::string& other) {
    const std::size_t pairs = pairs_of(name);
    const std::size_t pairs_of_other = pairs_of(other);
    return pairs != pairs_of_other ? pairs > pairs_of_other : stands_for_both(name, other);
  };
  std::map<std::string, std::string> first;  // by hash
  for (const Fragment& fragment : fragments) {
    std::string& name = first.try_emplace(fragment.hash, fragment.name).first->second;
    if (stands(fragment.name, name)) name = fragment.name;
  }
  std::map<std::string, std::string> result;
  for (const Fragment& fragment : fragments) {
    const std::string& name = first.at(fragment.hash);
    if (fragment.hash != kUnreadable && name != fragment.name) result[fragment.name] = name;
  }
  return result;
}

std::string told_of_copy(const std::string& copy, const std::string& first) {
  return fmt::format("{0} and {1} are the same scan: {1} is left out", first, copy);
}

std::string reason_of_copy(const std::string& first) {
  return fmt::format("is the same scan as {}, which stands for both", first);
}

const char* name_of(Stage stage) {
  switch (stage) {
    case Stage::Apart:
      return "apart";
    case Stage::Sweep:
      return "sweep";
    case Stage::Match:
      return "match";
    case Stage::Failed:
      break;
  }
  return "failed";
}

}  // namespace rejoin::store
