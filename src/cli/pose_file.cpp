#include "cli/pose_file.hpp"

#include <fmt/core.h>

#include <optional>
#include <sstream>

#include "cli/json_values.hpp"
#include "core/error.hpp"

namespace rejoin::cli {
namespace {

using nlohmann::ordered_json;

constexpr const char* kMend = "give the JSON of rejoin match, or four rows of four numbers";

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

Rigid read_pose(const std::string& path) {
  const std::string text = read_json_text(path, kMend);
  ordered_json json = ordered_json::parse(text, nullptr, false);
  if (json.is_discarded()) json = rows_of_numbers(text);
  if (json.is_discarded()) throw InputError(path, "is neither JSON nor a matrix of 4 x 4 numbers", kMend);
  if (json.is_object() && json.value("schema", ordered_json()) == "rejoin.assembly/1") refuse_assembly(path);
  const ordered_json& rows = json.is_object() && json.contains("pose") ? json["pose"] : json;
  const std::optional<Rigid> pose = rigid_from_json(rows);
  if (!pose) throw InputError(path, fmt::format("\"pose\" {}", kNoRigid), kMend);
  return *pose;
}

}  // namespace rejoin::cli
