/// Text that may be no UTF-8, such as names of files.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace rejoin {

/// Bytes of the UTF-8 character with which the text begins; 0 if it begins with none.
std::size_t utf8_length(std::string_view text);

bool is_utf8(std::string_view text);

/// The text behind its byte order mark, with which spreadsheets and editors begin files; all of it where there is none.
std::string_view without_byte_order_mark(std::string_view text);

/// The text with U+FFFD in place of every byte that belongs to no character.
std::string valid_utf8(std::string_view text);

}  // namespace rejoin
