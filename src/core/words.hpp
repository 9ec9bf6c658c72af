/// Numbers in sentences, and names of files.
#pragma once

#include <cstddef>
#include <string>

namespace rejoin {

/// "1 pair", "2 pairs".
inline std::string counted(std::size_t number, const std::string& word) {
  return std::to_string(number) + " " + word + (number == 1 ? "" : "s");
}

/// Whether, of two names of one content, the first stands for both: the shorter one, as "sherd.ply" before "Copy of sherd.ply".
inline bool stands_for_both(const std::string& name, const std::string& other) {
  return name.size() != other.size() ? name.size() < other.size() : name < other;
}

}  // namespace rejoin
