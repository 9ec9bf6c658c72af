#include "store/records.hpp"

#include "core/words.hpp"

namespace rejoin::store {

std::map<std::string, std::string> copies(const std::vector<Fragment>& fragments) {
  std::map<std::string, std::string> first;  // by hash
  for (const Fragment& fragment : fragments) {
    std::string& name = first.try_emplace(fragment.hash, fragment.name).first->second;
    if (stands_for_both(fragment.name, name)) name = fragment.name;
  }
  std::map<std::string, std::string> result;
  for (const Fragment& fragment : fragments) {
    const std::string& name = first.at(fragment.hash);
    if (fragment.hash != kUnreadable && name != fragment.name) result[fragment.name] = name;
  }
  return result;
}

const char* name_of(Stage stage) {
  switch (stage) {
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
