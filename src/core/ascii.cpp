#include "core/ascii.hpp"

#include <string_view>

namespace rejoin {
namespace {

/// U+00C0 to U+017F by their nearest letters.
constexpr std::string_view kLatin =
    "A A A A A A AE C E E E E I I I I D N O O O O O x O U U U U Y Th ss a a a a a a ae c e e e e i i i i d n "
    "o o "
    "o o o ? o u u u u y th y A a A a A a C c C c C c C c D d D d E e E e E e E e E e G g G g G g G g H h H "
    "h I i "
    "I i I i I i I i IJ ij J j K k k L l L l L l L l L l N n N n N n n N n O o O o O o OE oe R r R r R r S s "
    "S s S "
    "s S s T t T t T t U u U u U u U u U u U u W w Y y Y Z z Z z Z z s ";
constexpr unsigned kLatinFirst = 0xC0;
constexpr unsigned kLatinEnd = 0x180;

std::string_view nearest_letters(unsigned character) {
  std::string_view rest = kLatin;
  for (unsigned c = kLatinFirst; c < character; ++c) rest.remove_prefix(rest.find(' ') + 1);
  return rest.substr(0, rest.find(' '));
}

}  // namespace

std::string ascii(const std::string& text) {
  std::string result;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto byte = static_cast<unsigned char>(text[k]);
    const auto next = k + 1 < text.size() ? static_cast<unsigned char>(text[k + 1]) : 0U;
    if ((byte & 0xC0U) == 0x80U) continue;  // the later bytes of a UTF-8 character
    // Of two bytes, as all letters of the table and the accents after their letters.
    const unsigned character =
        (byte & 0xE0U) == 0xC0U && (next & 0xC0U) == 0x80U ? ((byte & 0x1FU) << 6U) | (next & 0x3FU) : 0U;
    if (character >= 0x300 && character < 0x370) continue;
    if (character >= kLatinFirst && character < kLatinEnd) {
      result += nearest_letters(character);
    } else {
      result += byte >= 32 && byte < 127 ? text[k] : '?';
    }
  }
  return result;
}

}  // namespace rejoin
