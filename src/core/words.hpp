/// Numbers in sentences.
#pragma once

#include <cstddef>
#include <string>

namespace rejoin {

/// "1 pair", "2 pairs".
inline std::string counted(std::size_t number, const std::string& word) {
  return std::to_string(number) + " " + word + (number == 1 ? "" : "s");
}

}  // namespace rejoin
