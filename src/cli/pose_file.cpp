#include "cli/pose_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "cli/json_values.hpp"
#include "core/error.hpp"
#include "core/utf8.hpp"

namespace rejoin::cli {
namespace fs = std::filesystem;
namespace {

using nlohmann::ordered_json;

constexpr const char* kPoseMend = "give the JSON of rejoin match, or four rows of four numbers";

/// What spreadsheets and people add to a matrix, as blanks: comments, and any of `marks`.
std::string without_comments_and(const char* marks, std::string text) {
  bool comment = false;
  for (char& c : text) {
    comment = c != '\n' && (comment || c == '#');
    if (comment || std::string_view(marks).find(c) != std::string_view::npos) c = ' ';
  }
  return text;
}

[[noreturn]] void refuse_assembly(const std::string& path) {
  throw InputError(
      path, "is an assembly, with a pose of every fragment, where the one of B to A is needed",
      "give the inverse of A's pose times B's as four rows of four numbers, or the JSON of rejoin match");
}

}  // namespace

ordered_json rows_of_numbers(const std::string& text) {
  std::istringstream in(without_comments_and(",", text));
  ordered_json rows = ordered_json::array();
  double value = 0;
  for (int k = 0; k < 16 && in >> value; ++k) {
    if (k % 4 == 0) rows.push_back(ordered_json::array());
    rows.back().push_back(value);
  }
  const bool whole = rows.size() == 4 && rows.back().size() == 4 && in && (in >> std::ws).eof();
  return whole ? rows : ordered_json(ordered_json::value_t::discarded);
}

bool has_decimal_commas(const std::string& text) {
  std::istringstream in(without_comments_and(";", text));
  std::string points;
  bool any = false;
  for (std::string word; in >> word;) {
    const std::size_t comma = word.find(',');
    any = any || comma != std::string::npos;
    if (comma != std::string::npos) word[comma] = '.';
    if (word.find(',') != std::string::npos) return false;
    points += word + ' ';
  }
  return any && !rows_of_numbers(points).is_discarded();
}

namespace {

/// The path that a match's JSON tells of a piece; empty: none.
std::string told_path(const ordered_json& json, const char* piece) {
  const ordered_json told = json.is_object() ? json.value(piece, ordered_json()) : ordered_json();
  const ordered_json path = told.is_object() ? told.value("path", ordered_json()) : ordered_json();
  return path.is_string() ? path.get<std::string>() : "";
}

/// How many names two paths have in common, from the files' own on; of one path also what is above all folders.
int names_in_common(fs::path a, fs::path b) {
  int count = 0;
  for (; a.has_filename() && a.filename() == b.filename(); a = a.parent_path(), b = b.parent_path()) ++count;
  return count > 0 && a == b ? count + 1 : count;
}

/// The same of the paths as they stand, or with all links followed where that is more.
int in_common(const std::string& a, const std::string& b) {
  const auto real = [](const std::string& path) {
    std::error_code ignored;
    return fs::weakly_canonical(fs::absolute(path), ignored);
  };
  const auto written = [](const std::string& path) { return fs::absolute(path).lexically_normal(); };
  if (a.empty() || b.empty()) return 0;
  return std::max(names_in_common(real(a), real(b)), names_in_common(written(a), written(b)));
}

/// Of which files a match's JSON tells.
enum class OfPair { AsGiven, Swapped, Others };

/// Where the files' names are the same their folders tell; a match may have been made in another folder, or its files have moved.
/// \return AsGiven too if it tells none, or one alone   \throws InputError they do not tell
OfPair pair_of(const std::string& path, const ordered_json& json, const std::string& path_a,
               const std::string& path_b) {
  const auto agreement = [&](const std::string& a, const std::string& b) {
    const int of_a = in_common(told_path(json, "a"), a);
    const int of_b = in_common(told_path(json, "b"), b);
    return of_a > 0 && of_b > 0 ? of_a + of_b : 0;
  };
  const int as_given = agreement(path_a, path_b);
  const int swapped = agreement(path_b, path_a);
  if (swapped > 0 && swapped == as_given) {
    throw InputError(
        path, fmt::format("does not tell which {} is A", fs::path(path_a).filename().string()),
        "give both paths as they were given to rejoin match, or the four rows of the pose alone");
  }
  if (swapped > as_given) return OfPair::Swapped;
  const bool tells = !told_path(json, "a").empty() && !told_path(json, "b").empty();
  return tells && as_given == 0 ? OfPair::Others : OfPair::AsGiven;
}

/// The file's pose, and its JSON.
std::pair<Rigid, ordered_json> pose_and_json(const std::string& path) {
  const std::string text = read_json_text(path, kPoseMend);
  ordered_json json = ordered_json::parse(text, nullptr, false);
  const std::string numbers(without_byte_order_mark(text));
  if (json.is_discarded()) json = rows_of_numbers(numbers);
  if (json.is_discarded() && has_decimal_commas(numbers)) throw InputError(path, kDecimalCommas, kPointsMend);
  if (json.is_discarded()) throw InputError(path, "is neither JSON nor a matrix of 4 x 4 numbers", kPoseMend);
  if (json.is_object() && json.value("schema", ordered_json()) == "rejoin.assembly/1") refuse_assembly(path);
  const bool named = json.is_object() && json.contains("pose");
  const ordered_json& rows = named ? json["pose"] : json;
  const std::optional<Rigid> pose = rigid_from_json(rows);
  if (!pose) throw InputError(path, (named ? "\"pose\" " : "") + why_no_rigid(rows), kPoseMend);
  return {*pose, std::move(json)};
}

}  // namespace

Rigid read_pose(const std::string& path) {
  return pose_and_json(path).first;
}

Rigid read_pose(const std::string& path, const std::string& path_a, const std::string& path_b,
                std::string& doubt) {
  const auto [pose, json] = pose_and_json(path);
  const OfPair pair = pair_of(path, json, path_a, path_b);
  if (pair == OfPair::Others) {
    doubt = fmt::format("{}: is the pose of {} and {}; is it of these two?", path, told_path(json, "a"),
                        told_path(json, "b"));
  }
  return pair == OfPair::Swapped ? inverse(pose) : pose;
}

}  // namespace rejoin::cli
