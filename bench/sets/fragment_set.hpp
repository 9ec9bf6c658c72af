/// A folder of fragments whose assembly is known.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/rigid.hpp"
#include "match/match.hpp"

namespace rejoin::bench {

/// Two fragments that touch in the assembled object.
struct Join {
  std::string a;
  std::string b;
  double contact_area = 0;  ///< squared units of the set
};

struct FragmentSet {
  std::filesystem::path folder;
  std::string name;
  std::map<std::string, Rigid> to_world;  ///< file coordinates -> assembled object
  std::vector<Join> joins;
};

/// Reads FOLDER/truth.json: {"fragments": {NAME: {"to_world": 4x4 row major}}, "joins": [[A, B, AREA]...]}.
/// \throws InputError if the file is not of that form   \throws IoError if it cannot be opened
FragmentSet read_set(const std::filesystem::path& folder);

/// Fragments of a set, loaded and made ready when first asked for.
class Shelf {
 public:
  explicit Shelf(const FragmentSet& set) : set_(set) {}
  const match::Fragment& get(const std::string& name);

 private:
  const FragmentSet& set_;
  std::map<std::string, match::Fragment> fragments_;
};

}  // namespace rejoin::bench
