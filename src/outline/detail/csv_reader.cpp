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

/// A line of a table whose numbers have decimal commas, with points in their place: a semicolon, or else blanks and tabs
/// between numbers, part the columns, so a comma between two digits that is the only one of its column is no separator.
/// \return nullopt: semicolons and commas are both there, and what the commas mean is open
std::optional<std::string> with_points(std::string_view line) {
  std::string text(line.substr(0, line.find_last_not_of(" \t\r") + 1));
  const bool semicolons = text.find(';') != std::string::npos;
  const std::string_view parting = semicolons ? ";" : " \t";
  if (text.find(',') == std::string::npos || text.find_first_of(parting) == std::string::npos) return text;
  const std::string given = text;
  const auto digit = [&](std::size_t i) { return i < text.size() && text[i] >= '0' && text[i] <= '9'; };
  std::size_t commas = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (parting.find(text[i]) != std::string_view::npos) commas = 0;
    if (text[i] != ',') continue;
    if (++commas > 1 || i == 0 || !digit(i - 1) || !digit(i + 1))
      return semicolons ? std::nullopt : std::optional(given);
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

std::vector<Rings> read_csv(const std::string& path, const std::string& text) {
  std::vector<glm::dvec2> points;
  std::string_view rest = text;
  std::size_t number = 0;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    ++number;
    if (line.find_first_not_of(kSeparators) == std::string_view::npos || line[0] == '#') continue;
    const auto plain = with_points(line);
    const auto point = plain ? parse_point(*plain) : std::nullopt;
    if (!point && points.empty() && number == 1) continue;  // the columns' names
    if (!plain) {
      throw InputError(path, fmt::format("line {} has semicolons and commas, and not as \"1,5;2,5\"", number),
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
