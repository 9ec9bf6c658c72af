#include "cli/pose_file.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <optional>
#include <sstream>
#include <utility>

#include "cli/json_values.hpp"
#include "core/error.hpp"
#include "core/utf8.hpp"

namespace rejoin::cli {
namespace {

using nlohmann::ordered_json;

constexpr const char* kPoseMend = "give the JSON of rejoin match, or four rows of four numbers";

/// What spreadsheets and people add to a matrix, as blanks.
std::string without_commas_and_comments(std::string text) {
  bool comment = false;
  for (char& c : text) {
    comment = c != '\n' && (comment || c == '#');
    if (comment || c == ',') c = ' ';
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
  std::istringstream in(without_commas_and_comments(text));
  ordered_json rows = ordered_json::array();
  double value = 0;
  for (int k = 0; k < 16 && in >> value; ++k) {
    if (k % 4 == 0) rows.push_back(ordered_json::array());
    rows.back().push_back(value);
  }
  const bool whole = rows.size() == 4 && rows.back().size() == 4 && in && (in >> std::ws).eof();
  return whole ? rows : ordered_json(ordered_json::value_t::discarded);
}

namespace {

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

/// Whether a match's JSON tells of A as B and of B as A.
bool is_of_swapped(const ordered_json& json, const std::string& path_a, const std::string& path_b) {
  const auto names = [&](const char* piece, const std::string& path) {
    const ordered_json told = json.is_object() ? json.value(piece, ordered_json()) : ordered_json();
    const ordered_json of = told.is_object() ? told.value("path", ordered_json()) : ordered_json();
    return of.is_string() && file_name(of.get<std::string>()) == file_name(path);
  };
  return names("a", path_b) && names("b", path_a) && !names("a", path_a);
}

/// The file's pose, and its JSON.
std::pair<Rigid, ordered_json> pose_and_json(const std::string& path) {
  const std::string text = read_json_text(path, kPoseMend);
  ordered_json json = ordered_json::parse(text, nullptr, false);
  if (json.is_discarded()) json = rows_of_numbers(std::string(without_byte_order_mark(text)));
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

Rigid read_pose(const std::string& path, const std::string& path_a, const std::string& path_b) {
  const auto [pose, json] = pose_and_json(path);
  return is_of_swapped(json, path_a, path_b) ? inverse(pose) : pose;
}

}  // namespace rejoin::cli
