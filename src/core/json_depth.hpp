/// Nesting of JSON.
#pragma once

#include <string_view>

namespace rejoin {

/// Deeper JSON is refused: libraries copy and write it by calling themselves, and no file that is read has need of it.
inline constexpr int kDeepestJson = 200;

/// How many brackets of a JSON text lie in one another; those within its strings do not count.  Of what is no JSON, any number.
int json_depth(std::string_view text);

}  // namespace rejoin
