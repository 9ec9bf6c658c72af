#include "core/ascii.hpp"

#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>

#include "core/utf8.hpp"

namespace rejoin {
namespace {

/// Characters one after another with what stands for each, blanks between.
struct Alphabet {
  std::uint32_t first;
  std::uint32_t last;
  std::string_view letters;
};

// No two letters of Greek, or of Russian, are written alike but for accents: names must differ as they do.
constexpr std::array kAlphabets{
    Alphabet{
        0xC0, 0x17F,
        "A A A A A A AE C E E E E I I I I D N O O O O O x O U U U U Y Th ss a a a a a a ae c e e e e i i "
        "i i d n o o o o o ? o u u u u y th y A a A a A a C c C c C c C c D d D d E e E e E e E e E e G "
        "g G g G g G g H h H h I i I i I i I i I i IJ ij J j K k k L l L l L l L l L l N n N n N n n N n "
        "O o O o O o OE oe R r R r R r S s S s S s S s T t T t T t U u U u U u U u U u U u W w Y y Y Z z "
        "Z z Z z s "},
    Alphabet{
        0x386, 0x3CE,
        "A ? E H I ? O ? Y W i A B G D E Z H Th I K L M N X O P R ? S T Y F Ch Ps W I Y a e h i y a b g d "
        "e z h th i k l m n x o p r s s t y f ch ps w i y o y w "},
    Alphabet{
        0x400, 0x45F,
        "E Yo Dj Gj Ye Dz I Yi J Lj Nj Tj Kj I U Dzh A B V G D E Zh Z I Jj K L M N O P R S T U F Kh Ts Ch "
        "Sh Shch \" Y ' Eh Yu Ya a b v g d e zh z i jj k l m n o p r s t u f kh ts ch sh shch \" y ' eh "
        "yu ya e yo dj gj ye dz i yi j lj nj tj kj i u dzh "}};

std::string letters_for(std::uint32_t character) {
  constexpr std::uint32_t kAccentsFirst = 0x300;
  constexpr std::uint32_t kAccentsLast = 0x36F;
  if (character >= kAccentsFirst && character <= kAccentsLast) return "";
  for (const Alphabet& alphabet : kAlphabets) {
    if (character < alphabet.first || character > alphabet.last) continue;
    std::string_view rest = alphabet.letters;
    for (std::uint32_t c = alphabet.first; c < character; ++c) rest.remove_prefix(rest.find(' ') + 1);
    return std::string(rest.substr(0, rest.find(' ')));
  }
  std::array<char, 8> digits{};
  const auto [end, error] = std::to_chars(digits.begin(), digits.end(), character, 16);
  std::string number = "[";
  number.append(digits.begin(), end);
  return number += ']';
}

/// \param character  of UTF-8, of several bytes
std::uint32_t number_of(std::string_view character) {
  std::uint32_t number = static_cast<unsigned char>(character[0]) & (0x7FU >> character.size());
  for (const char byte : character.substr(1))
    number = number << 6U | (static_cast<unsigned char>(byte) & 0x3FU);
  return number;
}

}  // namespace

std::string ascii(const std::string& text) {
  std::string result;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t length = utf8_length(rest);
    const char first = rest.front();
    if (length > 1) {
      result += letters_for(number_of(rest.substr(0, length)));
    } else {
      result += length == 1 && first >= 32 && first < 127 ? first : '?';
    }
    rest.remove_prefix(length == 0 ? 1 : length);
  }
  return result;
}

}  // namespace rejoin
