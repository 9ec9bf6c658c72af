#include "mesh/detail/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <string>

#include "core/error.hpp"
#include "core/utf8.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr std::string_view kBlank = " \t\r\f\v";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

/// Lines of OBJ and MTL files that hold a name, which may have "#" in it, as "Material_#1".
constexpr std::array<std::string_view, 4> kNaming{"usemtl", "newmtl", "mtllib", "map_Kd"};

/// Where "#" begins a comment: anywhere, but in lines with names only behind a blank.
std::size_t start_of_comment(std::string_view line) {
  std::size_t place = line.find('#');
  if (place == std::string_view::npos) return place;
  const bool named =
      std::ranges::any_of(kNaming, [text = trimmed(line)](auto word) { return text.starts_with(word); });
  while (named && place != std::string_view::npos && place > 0 &&
         kBlank.find(line[place - 1]) == std::string_view::npos)
    place = line.find('#', place + 1);
  return place;
}

/// What from_chars() leaves alone because no number holds it: 0 or infinite.
double beyond_range(std::string_view word, double /*type*/) {
  return std::strtod(std::string(word).c_str(), nullptr);
}

/// The last number on its side of zero.
long long beyond_range(std::string_view word, long long /*type*/) {
  return word.starts_with('-') ? std::numeric_limits<long long>::min()
                               : std::numeric_limits<long long>::max();
}

template <class T>
std::optional<T> parse(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc::invalid_argument || end != word.data() + word.size()) return std::nullopt;
  return error == std::errc::result_out_of_range ? beyond_range(word, value) : value;
}

}  // namespace

bool ends_within_a_line(std::string_view text) {
  const std::size_t start = text.find_last_of("\n\r") + 1;  // 0 if there is no line end
  const std::size_t word = text.find_first_not_of(" \t", start);
  return word != std::string_view::npos && text[word] != '#';
}

std::optional<double> to_number(std::string_view word) {
  return parse<double>(word);
}

const char* mend_of_number(std::string_view word) {
  std::string point(word);
  const std::size_t comma = point.find(',');
  if (comma != std::string::npos) point[comma] = '.';
  return comma != std::string::npos && to_number(point) ? "export the scan with points as decimal marks"
                                                        : "export the scan again";
}

std::optional<long long> to_integer(std::string_view word) {
  return parse<long long>(word);
}

TextLines::TextLines(const Source& source) : source_(source), rest_(without_byte_order_mark(source.bytes)) {
  if (rest_.starts_with("\xFF\xFE") || rest_.starts_with("\xFE\xFF"))
    throw InputError(source.name, "is text in UTF-16", "save it as UTF-8");
}

bool TextLines::next_line() {
  joined_.clear();
  while (!rest_.empty()) {
    const std::size_t end = std::min(rest_.find_first_of("\n\r"), rest_.size());
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end);
    rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : std::min<std::size_t>(1, rest_.size()));
    ++number_;
    line = trimmed(line.substr(0, start_of_comment(line)));
    if (line.ends_with('\\')) {
      joined_.append(line.substr(0, line.size() - 1)).push_back(' ');
      continue;
    }
    if (!joined_.empty()) line = joined_.append(line);
    if (line.empty()) continue;
    line_ = line;
    return true;
  }
  return false;
}

std::string_view TextLines::peek_word() const {
  const std::size_t first = line_.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return line_.substr(first, line_.find_first_of(kBlank, first) - first);
}

std::string_view TextLines::rest() const {
  return trimmed(line_);
}

std::string_view TextLines::next_word() {
  const std::string_view word = peek_word();
  line_.remove_prefix(word.empty() ? line_.size() : word.data() + word.size() - line_.data());
  return word;
}

std::optional<double> TextLines::next_number() {
  const std::string_view word = next_word();
  if (word.empty()) return std::nullopt;
  const std::optional<double> value = to_number(word);
  if (!value) {
    throw InputError(source_.name,
                     fmt::format("line {}: \"{}\" is not a number", number_, word.substr(0, 20)),
                     mend_of_number(word));
  }
  return value;
}

glm::dvec3 TextLines::next_triple() {
  glm::dvec3 triple;
  for (int k = 0; k < 3; ++k) {
    const std::optional<double> value = next_number();
    if (!value) fail(fmt::format("three numbers expected, {} found", k));
    triple[k] = *value;
  }
  return triple;
}

void TextLines::fail_at(std::size_t line, const std::string& problem) const {
  throw InputError(source_.name, fmt::format("line {}: {}", line, problem), "export the scan again");
}

}  // namespace rejoin::mesh::detail
