/// Text for fonts that have no more than the letters of ASCII.
#pragma once

#include <string>

namespace rejoin {

/// UTF-8 as printable ASCII: letters of Latin alphabets lose their accents, also those that are characters of their own; the rest
/// becomes '?'.
std::string ascii(const std::string& text);

}  // namespace rejoin
