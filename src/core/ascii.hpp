/// Text for fonts that have no more than the letters of ASCII.
#pragma once

#include <string>

namespace rejoin {

/// UTF-8 as printable ASCII: letters of Latin alphabets lose their accents, also those that are characters of their own, Greek and
/// Cyrillic ones are transliterated, other characters become their number, as "[7897]", and what is no UTF-8 or cannot be printed '?'.
std::string ascii(const std::string& text);

}  // namespace rejoin
