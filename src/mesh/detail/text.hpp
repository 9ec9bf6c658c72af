/// Lines and words of text formats, with the place for errors.
#pragma once

#include <cmath>
#include <optional>
#include <string_view>

#include "mesh/detail/soup.hpp"

namespace rejoin::mesh::detail {

/// Walks over the lines of a text and over the words of each.  Lines end as on any system; a byte order mark is skipped.
class TextLines {
 public:
  /// \throws InputError the text is UTF-16
  explicit TextLines(const Source& source);

  /// Goes to the next line that has a word before its "#" comment; false at the end.  A backslash at the end
  /// of a line joins it with the next.
  bool next_line();

  /// Next word of this line; empty at its end.
  std::string_view next_word();

  /// The same without going on.
  std::string_view peek_word() const;

  /// All that is left of this line, without blanks around it.
  std::string_view rest() const;

  /// Next word as a number; nullopt at the line's end.  \throws InputError the word is not a number
  std::optional<double> next_number();

  /// Next three words as numbers.  \throws InputError there are fewer
  glm::dvec3 next_triple();

  /// 1-based number of this line.
  std::size_t number() const { return number_; }

  /// \throws InputError with the file and this line
  [[noreturn]] void fail(const std::string& problem) const { fail_at(number_, problem); }
  [[noreturn]] void fail_at(std::size_t line, const std::string& problem) const;

 private:
  const Source& source_;
  std::string_view rest_;  ///< after this line
  std::string_view line_;  ///< what is left of this line
  std::string joined_;     ///< storage of a line joined by backslashes
  std::size_t number_ = 0;
};

/// Whether the last statement lacks its line end, as where a copy stopped: a number cut short is a number too.
bool ends_within_a_line(std::string_view text);

/// A whole word as a floating-point number ("nan" and "inf" included); infinite or 0 where it is beyond what one holds.
std::optional<double> to_number(std::string_view word);

/// What to do about a word that is no number.
const char* mend_of_number(std::string_view word);

/// A whole word as an integer; the largest or smallest one where it is beyond them.
std::optional<long long> to_integer(std::string_view word);

/// An index that no point has: readers store it for negative ones, the common check names the face.
constexpr std::uint32_t kNoPoint = 0xFFFFFFFFU;

/// kNoPoint for what is no index: negative, fractional, too large or no number.
inline std::uint32_t to_index(double value) {
  return value >= 0 && value < kNoPoint && value == std::floor(value) ? static_cast<std::uint32_t>(value)
                                                                      : kNoPoint;
}

}  // namespace rejoin::mesh::detail
