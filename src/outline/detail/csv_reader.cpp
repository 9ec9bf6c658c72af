#include <fmt/core.h>

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "outline/detail/readers.hpp"

namespace rejoin::outline::detail {
namespace {

constexpr std::string_view kSeparators = ",; \t\r";
constexpr std::string_view kBlanks = " \t";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // spreadsheets begin files with it

/// The next number of a line, taken off it; nullopt: what comes is none.
std::optional<double> take_number(std::string_view& line) {
  const std::size_t begin = line.find_first_not_of(kSeparators);
  if (begin == std::string_view::npos) return std::nullopt;
  line.remove_prefix(begin);
  const std::string_view word = line.substr(0, line.find_first_of(kSeparators));
  double value = 0.0;
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (problem != std::errc() || end != word.data() + word.size()) return std::nullopt;
  line.remove_prefix(word.size());
  return value;
}

/// The next line, taken off the text, without the separators around it.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  const std::size_t begin = line.find_first_not_of(kSeparators);
  if (begin == std::string_view::npos) return {};
  return line.substr(begin, line.find_last_not_of(kSeparators) + 1 - begin);
}

bool is_digit(std::string_view text, std::size_t i) {
  return i < text.size() && text[i] >= '0' && text[i] <= '9';
}

/// Whether a line is two numbers with decimal commas and blanks or tabs between them, and nothing else.
bool is_pair_with_decimal_commas(std::string_view line) {
  const std::size_t end = line.find_first_of(kBlanks);
  if (end == std::string_view::npos) return false;
  const std::string_view second = line.substr(line.find_first_not_of(kBlanks, end));
  const auto has_comma = [](std::string_view word) {
    const std::size_t comma = word.find(',');
    return comma != std::string_view::npos && comma > 0 && is_digit(word, comma - 1) &&
           is_digit(word, comma + 1) && word.find_first_of(", ;\t", comma + 1) == std::string_view::npos;
  };
  return has_comma(line.substr(0, end)) && has_comma(second);
}

/// A line with points in place of decimal commas.  A semicolon, or in a table of is_pair_with_decimal_commas() blanks, part the
/// columns, so a comma between two digits that is the only one of its column is no separator.
/// \return nullopt: what the commas mean is open
std::optional<std::string> with_points(std::string_view line, bool blanks_part) {
  std::string text(line);
  const bool semicolons = line.find(';') != std::string_view::npos;
  if (!semicolons && !blanks_part) return text;
  const std::string_view parting = semicolons ? ";" : kBlanks;
  std::size_t commas = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (parting.find(text[i]) != std::string_view::npos) commas = 0;
    if (text[i] != ',') continue;
    if (++commas > 1 || i == 0 || !is_digit(text, i - 1) || !is_digit(text, i + 1)) return std::nullopt;
    text[i] = '.';
  }
  return text;
}

std::optional<glm::dvec2> parse_point(std::string_view line) {
  const auto x = take_number(line);
  const auto y = x ? take_number(line) : std::nullopt;
  if (!y) return std::nullopt;
  return glm::dvec2(*x, *y);
}

}  // namespace

std::vector<Rings> read_csv(const std::string& path, const std::string& file) {
  std::string_view text = file;
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  bool blanks_part = false;
  for (std::string_view rest = text; !rest.empty() && !blanks_part;)
    blanks_part = is_pair_with_decimal_commas(take_line(rest));
  std::vector<glm::dvec2> points;
  std::string_view rest = text;
  std::size_t number = 0;
  while (!rest.empty()) {
    std::string_view line = take_line(rest);
    ++number;
    if (line.empty() || line[0] == '#') continue;
    const auto plain = with_points(line, blanks_part);
    const auto point = plain ? parse_point(*plain) : std::nullopt;
    if (!point && points.empty() && number == 1 && !take_number(line)) continue;  // the columns' names
    if (!plain) {
      throw InputError(path,
                       fmt::format("line {} has commas that may be decimal ones or part columns", number),
                       "write \"x,y\" with decimal points in each line");
    }
    if (!point)
      throw InputError(path, fmt::format("line {} is no point", number), "write \"x,y\" in each line");
    points.push_back(*point);
  }
  if (points.empty()) throw InputError(path, "holds no points", "write \"x,y\" in each line");
  return {{{std::move(points)}, ""}};
}

}  // namespace rejoin::outline::detail
