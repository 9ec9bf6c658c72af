// Text of points alone: .xyz, and .pts, whose first line counts them; with blanks, commas or semicolons between the numbers.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "mesh/detail/colour.hpp"
#include "mesh/detail/text.hpp"

namespace rejoin::mesh::detail {
namespace {

/// All numbers of the file, line after line.
struct Rows {
  std::vector<double> numbers;
  std::size_t columns = 0;
  bool may_be_cut = false;  ///< the file ends within a line, maybe within a number

  std::size_t size() const { return columns == 0 ? 0 : numbers.size() / columns; }
  glm::dvec3 triple(std::size_t row, std::size_t column) const {
    const double* const at = numbers.data() + row * columns + column;
    return {at[0], at[1], at[2]};
  }
};

/// What stands between a row's numbers besides blanks.  A comma between a number's digits, beside blanks, is a decimal mark.
char separator_of(std::string_view row) {
  if (row.find(';') != std::string_view::npos) return ';';
  const bool has_blanks = row.find_first_of(" \t") != std::string_view::npos;
  for (std::size_t k = row.find(','); k != std::string_view::npos; k = row.find(',', k + 1)) {
    const bool ends_word = k + 1 == row.size() || row[k + 1] == ' ' || row[k + 1] == '\t';
    if (has_blanks && !ends_word) return ' ';
  }
  return row.find(',') == std::string_view::npos ? ' ' : ',';
}

/// By the first rows of numbers, of which one may be the count of a .pts.
char separator_of(const Source& source) {
  constexpr int kLooked = 3;
  TextLines lines(source);
  char separator = ' ';
  for (int k = 0; k < kLooked && separator == ' ' && lines.next_line(); ++k) {
    const std::string_view row = lines.rest();
    if (row.find_first_of("+-.0123456789") == 0) separator = separator_of(row);
  }
  return separator;
}

/// What a first line of one number promises.
using Promise = std::optional<std::size_t>;

void read_row(TextLines& lines, Rows& rows, Promise& promised) {
  const std::size_t before = rows.numbers.size();
  while (const std::optional<double> value = lines.next_number()) rows.numbers.push_back(*value);
  const std::size_t count = rows.numbers.size() - before;
  if (before == 0 && count == 1 && !promised) {
    promised = to_index(rows.numbers[0]);
    rows.numbers.clear();
    return;
  }
  if (before == 0) rows.columns = count;
  if (count < 3) lines.fail(fmt::format("three numbers expected, {} found", count));
  if (count != rows.columns)
    lines.fail(fmt::format("{} numbers, where lines before have {}", count, rows.columns));
}

/// Characters behind the point of the line's last number.
std::size_t decimals_at_end(std::string_view line) {
  const std::string_view number = line.substr(line.find_last_of(" \t") + 1);
  const std::size_t point = number.find('.');
  return point == std::string_view::npos ? 0 : number.size() - point - 1;
}

/// Many writers leave the last line end out; where a copy stopped the last number has fewer decimals than any above it, too.
bool may_be_cut(const Source& source) {
  if (!ends_within_a_line(source.bytes)) return false;
  TextLines lines(source);
  lines.next_line();  // may name the columns, or count the points
  std::optional<std::size_t> fewest;
  std::optional<std::size_t> last;
  while (lines.next_line()) {
    if (last) fewest = std::min(*last, fewest.value_or(*last));
    last = decimals_at_end(lines.rest());
  }
  return fewest && *last < *fewest;
}

/// Whether the first line names the columns, as "//X Y Z" or "x y z", and is no garbled point: some word begins with a letter, be it behind
/// a quote or a bracket, and is no number such as nan.
bool is_heading(std::string_view line) {
  if (line.starts_with("//")) return true;
  const auto is_letter = [](char c) {
    const auto code = static_cast<unsigned char>(c);
    return std::isalpha(code) != 0 || code >= 0x80;
  };
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  while (!line.empty()) {
    const std::string_view word = line.substr(0, line.find_first_of(" \t"));
    const auto first = std::ranges::find_if(word, [&](char c) { return is_letter(c) || is_digit(c); });
    if (first != word.end() && is_letter(*first) && !to_number(word)) return true;
    line.remove_prefix(std::min(line.size(), word.size() + 1));
  }
  return false;
}

Rows read_rows(const Source& source) {
  TextLines lines(source);
  Rows rows;
  Promise promised;
  for (bool first = true; lines.next_line(); first = false) {
    if (first && !to_number(lines.peek_word()) && is_heading(lines.rest())) continue;
    read_row(lines, rows, promised);
  }
  if (promised && rows.size() < *promised) {
    throw IoError(
        source.name,
        fmt::format("its first line promises {} points but the file ends after {}", *promised, rows.size()),
        "copy or export the file again");
  }
  rows.may_be_cut = may_be_cut(source);
  return rows;
}

Rows read_separated_rows(const Source& source) {
  const char separator = separator_of(source);
  if (separator == ' ') return read_rows(source);
  Source blank = source;
  std::ranges::replace(blank.bytes, separator, ' ');
  return read_rows(blank);
}

/// The first of the last three columns together, behind the coordinates, that are in every line what `fits` says; 0 if there are none.
template <class Fits>
std::size_t find_triple(const Rows& rows, const Fits& fits) {
  for (std::size_t column = rows.columns; column >= 6; --column) {
    bool good = true;
    for (std::size_t row = 0; good && row < rows.size(); ++row) good = fits(rows.triple(row, column - 3));
    if (good) return column - 3;
  }
  return 0;
}

/// Unit vectors, to what few digits leave of them; zero where a program knew none.
bool is_normal(const glm::dvec3& v) {
  constexpr double kSlack = 0.02;
  const double length = glm::length(v);
  return length == 0 || std::abs(length - 1) < kSlack;
}

bool is_colour(const glm::dvec3& v) {
  return v == glm::round(v) && glm::all(glm::greaterThanEqual(v, glm::dvec3(0))) &&
         glm::all(glm::lessThanEqual(v, glm::dvec3(255)));
}

}  // namespace

Soup read_xyz(const Source& source) {
  const Rows rows = read_separated_rows(source);
  Soup soup;
  if (rows.may_be_cut)
    soup.notes.emplace_back(
        "ends within a line, in a number with fewer decimals than those above it: it may be cut short (copy "
        "or "
        "export it again)");
  const std::size_t normal = find_triple(rows, is_normal);
  const std::size_t colour = find_triple(rows, is_colour);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    soup.points.push_back(rows.triple(row, 0));
    if (normal != 0) soup.normals.emplace_back(rows.triple(row, normal));
    if (colour != 0 && colour != normal) soup.colours.push_back(to_bytes(rows.triple(row, colour)));
  }
  return soup;
}

}  // namespace rejoin::mesh::detail
