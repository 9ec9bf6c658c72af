#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/utf8.hpp"
#include "outline/detail/readers.hpp"
#include "outline/polygon.hpp"

namespace rejoin::outline::detail {
namespace {

constexpr std::string_view kSeparators = ",; \t\r";
constexpr std::string_view kBlanks = " \t";
constexpr std::array<std::string_view, 8> kNamesOfX = {"x",       "lon", "long",   "longitude",
                                                       "easting", "col", "column", "rechtswert"};
constexpr std::array<std::string_view, 6> kNamesOfY = {"y", "lat", "latitude", "northing", "row", "hochwert"};
constexpr std::array<std::string_view, 13> kNamesOfPieces = {
    "piece",   "fragment", "sherd", "part",  "object", "outline", "contour",
    "polygon", "name",     "label", "group", "id",     "roi"};
constexpr const char* kCsvMend = "write \"x,y\" in each line";

/// Which columns hold x and y.
struct Columns {
  std::size_t x = 0;
  std::size_t y = 1;
  std::optional<std::size_t> piece;  ///< which says whose outline a point is of

  bool first_two() const { return x == 0 && y == 1; }
};

/// The next number of a line, taken off it; nullopt: what comes is none.
std::optional<double> take_number(std::string_view& line) {
  const std::size_t begin = line.find_first_not_of(kSeparators);
  if (begin == std::string_view::npos) return std::nullopt;
  line.remove_prefix(begin);
  const std::string_view word = line.substr(0, line.find_first_of(kSeparators));
  const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-';  // which from_chars() does not take
  double value = 0.0;
  const auto [end, problem] = std::from_chars(word.data() + (plus ? 1 : 0), word.data() + word.size(), value);
  if (problem != std::errc() || end != word.data() + word.size()) return std::nullopt;
  line.remove_prefix(word.size());
  return value;
}

/// The next line, taken off the text with its end, which is one of "\n", "\r\n" and "\r".
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find_first_of("\r\n");
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(line.size(), text.size()));
  text.remove_prefix(text.starts_with("\r\n") ? 2 : text.empty() ? 0 : 1);
  return line;
}

/// The columns of a line, which semicolons part or, where there is none, commas, tabs or blanks.
std::vector<std::string_view> cells(std::string_view line) {
  char parting = ' ';
  for (const char c : {'\t', ',', ';'}) parting = line.find(c) != std::string_view::npos ? c : parting;
  if (parting == ' ') line = trimmed(line, kBlanks);
  std::vector<std::string_view> found;
  while (true) {
    const std::size_t end = line.find(parting);
    found.push_back(trimmed(line.substr(0, end), " \t\""));
    if (end == std::string_view::npos) return found;
    line.remove_prefix(end + 1);
    if (parting == ' ') line = trimmed(line, kBlanks);
  }
}

/// A column's name without unit: "X [mm]" is "x".
std::string name_of(std::string_view cell) {
  std::string name;
  for (const char c : cell) {
    if (std::isalpha(static_cast<unsigned char>(c)) == 0) break;
    name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return name;
}

/// The columns that a line of names calls x and y; nullopt: none of these, or they are not told apart.
std::optional<Columns> named_columns(std::string_view line) {
  const std::vector<std::string_view> names = cells(line);
  const auto find = [&](const auto& known) {
    const auto found = std::ranges::find_if(
        names, [&](std::string_view cell) { return std::ranges::find(known, name_of(cell)) != known.end(); });
    return static_cast<std::size_t>(found - names.begin());
  };
  Columns columns{find(kNamesOfX), find(kNamesOfY), find(kNamesOfPieces)};
  if (columns.x == names.size() || columns.y == names.size()) return std::nullopt;
  if (columns.piece == names.size()) columns.piece.reset();
  return columns;
}

/// Whether a column called y says that it points down, as in pictures: "y_down", or counts rows.
bool points_down(std::string_view cell) {
  if (name_of(cell) == "row") return true;
  constexpr std::string_view kDown = "y_down";
  return std::ranges::equal(cell.substr(0, kDown.size()), kDown,
                            [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

/// Whether a column is called as degrees are.
bool is_degrees(std::string_view cell) {
  const std::string name = name_of(cell);
  return name.starts_with("lon") || name.starts_with("lat");
}

bool is_digit(std::string_view text, std::size_t i) {
  return i < text.size() && text[i] >= '0' && text[i] <= '9';
}

/// Whether blanks or tabs part the columns of a line and all its commas are decimal ones: those of two columns, or between tabs of more.
bool has_decimal_commas_between_blanks(std::string_view line) {
  if (line.starts_with('#')) return false;
  const bool tabs = line.find('\t') != std::string_view::npos;
  std::size_t words = 0;
  std::size_t commas = 0;
  for (; !line.empty(); ++words) {
    const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
    line = trimmed(line.substr(word.size()), kBlanks);
    const std::size_t comma = word.find(',');
    if (comma == std::string_view::npos) continue;
    const bool decimal = comma > 0 && is_digit(word, comma - 1) && is_digit(word, comma + 1) &&
                         word.find_first_of(",;", comma + 1) == std::string_view::npos;
    if (!decimal) return false;
    ++commas;
  }
  return words > 1 && (commas == 2 || (tabs && commas > 2));
}

/// A line with points in place of decimal commas.  A semicolon, or in a table of has_decimal_commas_between_blanks() these, part the
/// columns, so a comma between two digits that is the only one of its column is no separator.  Where semicolons part them, words in quotes
/// keep theirs.
/// \return nullopt: what the commas mean is open
std::optional<std::string> with_points(std::string_view line, bool blanks_part) {
  std::string text(line);
  const bool semicolons = line.find(';') != std::string_view::npos;
  if (!semicolons && !blanks_part) return text;
  const std::string_view parting = semicolons ? ";" : kBlanks;
  std::size_t commas = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') quoted = !quoted;
    if (parting.find(text[i]) != std::string_view::npos) commas = 0;
    if (text[i] != ',' || (semicolons && quoted)) continue;
    if (++commas > 1 || i == 0 || !is_digit(text, i - 1) || !is_digit(text, i + 1)) return std::nullopt;
    text[i] = '.';
  }
  return text;
}

std::optional<glm::dvec2> point_of(const std::optional<double>& x, const std::optional<double>& y) {
  if (!x || !y) return std::nullopt;
  return glm::dvec2(*x, *y);
}

/// The first two numbers of a line, or those of the columns.
std::optional<glm::dvec2> parse_point(std::string_view line, const Columns& columns) {
  if (columns.first_two()) {
    const auto x = take_number(line);
    return point_of(x, take_number(line));
  }
  std::vector<std::string_view> row = cells(line);
  if (row.size() <= std::max(columns.x, columns.y)) return std::nullopt;
  const auto x = take_number(row[columns.x]);
  return point_of(x, take_number(row[columns.y]));
}

/// A line whose fields stand in quotes, without these; the comma in such a field is a decimal one; fields with
/// more than that keep their quotes.
std::string without_quotes(std::string_view line) {
  std::string text;
  while (true) {
    const std::size_t open = line.find('"');
    const std::size_t shut = open == std::string_view::npos ? open : line.find('"', open + 1);
    if (shut == std::string_view::npos) return text + std::string(line);
    std::string field(line.substr(open + 1, shut - open - 1));
    const std::size_t comma = field.find(',');
    const bool decimal = comma != std::string::npos && comma > 0 && is_digit(field, comma - 1) &&
                         is_digit(field, comma + 1) &&
                         field.find_first_of(",.", comma + 1) == std::string::npos;
    if (decimal) field[comma] = '.';
    const bool thousands = comma != std::string::npos && !decimal;  // or words
    text.append(line.substr(0, open)).append(thousands ? line.substr(open, shut + 1 - open) : field);
    line.remove_prefix(shut + 1);
  }
}

/// Whether each of several lines is an outline by itself, which its own end closes: not if blank lines part the points of one.
bool are_outlines(const std::vector<std::vector<glm::dvec2>>& lines) {
  constexpr std::size_t kLeastPoints = 12;
  return lines.size() > 1 && std::ranges::all_of(lines, [](const auto& line) {
           const bool is_closed = line.size() > 3 && line.front() == line.back();
           return is_closed || (line.size() >= kLeastPoints && !open_ends(line));
         });
}

/// Reads the lines of one file.
class CsvReader {
 public:
  CsvReader(const std::string& path, std::vector<std::string>& notes) : path_(path), notes_(notes) {}

  void read(std::string_view text) {
    for (std::string_view rest = text; !rest.empty() && !blanks_part_;)
      blanks_part_ = has_decimal_commas_between_blanks(trimmed(without_quotes(take_line(rest)), kSeparators));
    for (std::size_t number = 1; !text.empty(); ++number) {
      const std::string line = without_quotes(take_line(text));
      const std::string_view content = trimmed(line, kSeparators);
      if (content.empty()) blank_ = true;
      if (content.empty() || content[0] == '#') continue;
      add(columns_.first_two() ? content : line, line, number);  // an empty first cell counts as a column
    }
    if (lines.empty()) throw InputError(path_, "holds no points", kCsvMend);
    if (!are_outlines(lines)) join_lines();
    require_no_count();
    tell_doubts();
  }

  std::vector<std::vector<glm::dvec2>>
      lines;                       ///< what blank lines or names of pieces part, if these are outlines
  std::vector<std::string> names;  ///< of each of them; empty: none
  bool y_up = true;

 private:
  /// \param whole  the line with what parts cells at its ends
  void add(std::string_view line, std::string_view whole, std::size_t number) {
    const bool first = !std::exchange(begun_, true);
    const auto plain = with_points(line, blanks_part_);
    const auto point = plain ? parse_point(*plain, columns_) : std::nullopt;
    if (!point && first && !take_number(line)) return take_names(whole);
    if (!point && line.find("POLYGON") != std::string_view::npos) {
      throw InputError(path_, fmt::format("line {} holds WKT (\"POLYGON ...\"), which is not read", number),
                       "export the outlines as GeoJSON, or write \"x,y\" in each line");
    }
    if (!plain) {
      throw InputError(path_,
                       fmt::format("line {} has commas that may be decimal ones or part columns", number),
                       "write \"x,y\" with decimal points in each line");
    }
    if (!point) throw InputError(path_, fmt::format("line {} is no point", number), kCsvMend);
    require_fields(*plain, number);
    if (columns_.piece) part_by_piece(cells(*plain));
    if (blank_ || lines.empty()) {
      lines.emplace_back();
      names.push_back(piece_);
    }
    blank_ = false;
    lines.back().push_back(*point);
    more_columns_ = more_columns_ && cells(*plain).size() > 2;
  }

  void take_names(std::string_view line) {
    const auto named = named_columns(line);
    columns_ = named.value_or(Columns{});
    const std::vector<std::string_view> names = cells(line);
    fields_ = names.size();
    if (named) y_up = !points_down(names[named->y]);
    if (named) degrees_ = std::ranges::any_of(names, is_degrees);
    if (!named && names.size() > 2)
      notes_.push_back(path_ + ": no columns are named x and y; the first two are taken");
  }

  void part_by_piece(const std::vector<std::string_view>& row) {
    const std::string_view piece = *columns_.piece < row.size() ? row[*columns_.piece] : std::string_view();
    if (piece != piece_) blank_ = true;
    piece_ = piece;
  }

  /// Commas that are decimal ones and part the columns too give twice as many fields as there are names.
  void require_fields(const std::string& line, std::size_t number) const {
    const std::size_t found = line.find(';') == std::string::npos ? cells(line).size() : 0;
    if (fields_ == 0 || found != 2 * fields_) return;
    throw InputError(path_, fmt::format("line {} has {} fields under {} names", number, found, fields_),
                     "if its commas are decimal ones, part the columns by semicolons");
  }

  /// Blank lines mean nothing in one outline.
  void join_lines() {
    for (std::size_t i = 1; i < lines.size(); ++i)
      lines[0].insert(lines[0].end(), lines[i].begin(), lines[i].end());
    lines.resize(1);
    names.assign(1, {});
  }

  void tell_doubts() {
    if (lines.size() > 1)
      notes_.push_back(fmt::format("{}: {} {} outlines, each of which is a piece", path_,
                                   columns_.piece ? "a column of names parts" : "blank lines part",
                                   lines.size()));
    if (const auto doubt = doubt_ends(lines[0])) notes_.push_back(path_ + ": " + *doubt);
    if (degrees_) tell_degrees();
  }

  void tell_degrees() {
    if (std::optional<std::string> doubt = doubt_degrees(path_, lines[0]))
      notes_.push_back(std::move(*doubt));
  }

  /// Of a table whose first column counts its lines the outline would be no one's.
  void require_no_count() const {
    if (!more_columns_ || columns_.x != 0) return;
    for (const auto& line : lines)
      for (std::size_t i = 1; i < line.size(); ++i)
        if (line[i].x != line[i - 1].x + 1.0) return;
    throw InputError(path_, "its first column counts the points",
                     "take it out, or name the columns in the first line, as \"id,x,y\"");
  }

  const std::string& path_;
  std::vector<std::string>& notes_;
  Columns columns_;
  std::string piece_;       ///< whose the last point was
  std::size_t fields_ = 0;  ///< that are named; 0: none
  bool degrees_ = false;
  bool blank_ = false;  ///< the last line was blank
  bool begun_ = false;  ///< a line that is neither empty nor a comment was read
  bool blanks_part_ = false;
  bool more_columns_ = true;
};

}  // namespace

std::optional<std::string> doubt_degrees(const std::string& path, const std::vector<glm::dvec2>& points,
                                         const char* opening) {
  constexpr double kSame = 0.99;
  double latitude = 0.0;
  for (const glm::dvec2& p : points) latitude += p.y / static_cast<double>(points.size());
  const double share = std::cos(latitude * M_PI / 180.0);
  if (std::abs(latitude) > 90.0 || share > kSame) return std::nullopt;
  return fmt::format(
      "{}: {} no lengths (at a latitude of {:.0f} one of longitude is {:.2f} times as long as one of "
      "latitude), so that shapes are distorted; write x and y in metres, as of a national grid or UTM",
      path, opening, latitude, share);
}

std::vector<Rings> read_csv(const std::string& path, const std::string& file,
                            std::vector<std::string>& notes) {
  CsvReader reader(path, notes);
  reader.read(without_byte_order_mark(file));
  std::vector<Rings> outlines;
  for (std::size_t i = 0; i < reader.lines.size(); ++i) {
    const std::string place = reader.lines.size() > 1 ? fmt::format("outline {}", i + 1) : "";
    outlines.push_back({{std::move(reader.lines[i])}, place, reader.y_up, valid_utf8(reader.names[i])});
  }
  return outlines;
}

}  // namespace rejoin::outline::detail
