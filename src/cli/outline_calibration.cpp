#include "cli/outline_calibration.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "cli/json_values.hpp"
#include "core/error.hpp"
#include "core/version.hpp"
#include "outline/join_fit.hpp"
#include "outline/read.hpp"

namespace rejoin::cli {
namespace {

using nlohmann::ordered_json;

constexpr const char* kSchema = "rejoin.outline-calibration/1";
constexpr const char* kResolution = "dots_per_inch";
constexpr const char* kRecalibrate = "calibrate with pieces of their resolution and unit";
constexpr const char* kCalibrationMend = "give the JSON of rejoin outline calibrate";
/// Of xi, zeta and n_min; calibrate() finds 24 at most.
constexpr double kMostOfALevel = 1000.0;
/// With steps that are this many times those of the pieces, or this part of them, joins begin to be lost;
constexpr double kDoubtedStep = 2.0;
/// and with these a border has no sample left, or takes all memory.
constexpr double kImpossibleStep = 100.0;
/// Dots an inch that are so many times others are told.
constexpr double kOtherResolution = 1.1;

ordered_json parse_file(const std::string& path, const char* mend) {
  ordered_json json = ordered_json::parse(read_json_text(path, mend), nullptr, false);
  if (json.is_discarded() || !json.is_object()) throw InputError(path, "is no JSON object", mend);
  return json;
}

/// A similarity of the plane: file coordinates to a common frame, perhaps in another unit.
struct Similarity {
  outline::Planar motion;
  double scale = 1.0;
};

std::optional<Similarity> similarity_of(const ordered_json& rows) {
  if (!rows.is_array() || rows.size() < 2) return std::nullopt;
  for (std::size_t r = 0; r < 2; ++r) {
    if (!rows[r].is_array() || rows[r].size() != 3) return std::nullopt;
    for (const ordered_json& value : rows[r]) {
      if (!value.is_number()) return std::nullopt;
    }
  }
  const auto column = [&](std::size_t c) {
    return glm::dvec2(rows[0][c].get<double>(), rows[1][c].get<double>());
  };
  const glm::dvec2 x = column(0);
  if (!(glm::length(x) > 0.0)) return std::nullopt;
  const bool flipped = outline::cross(x, column(1)) < 0.0;
  return Similarity{{std::atan2(x.y, x.x), column(2), flipped}, glm::length(x)};
}

/// B's coordinates -> A's.
outline::Planar relative(const Similarity& a, const Similarity& b) {
  outline::Planar from_a = b.motion;
  from_a.translation = (b.motion.translation - a.motion.translation) / a.scale;
  return inverse(outline::Planar{a.motion.angle_rad, {}, a.motion.flipped}) * from_a;
}

/// The names of a join: ["a", "b", ...] or {"a": .., "b": ..}.
std::optional<std::pair<std::string, std::string>> names_of(const ordered_json& join) {
  const bool list = join.is_array() && join.size() >= 2;
  const bool object = join.is_object() && join.contains("a") && join.contains("b");
  if (!list && !object) return std::nullopt;
  const ordered_json& a = list ? join[0] : join["a"];
  const ordered_json& b = list ? join[1] : join["b"];
  if (!a.is_string() || !b.is_string()) return std::nullopt;
  return std::pair{a.get<std::string>(), b.get<std::string>()};
}

struct Placed {
  std::size_t piece = 0;
  Similarity place;
};

std::map<std::string, Placed> placed_pieces(const std::string& path, const ordered_json& json,
                                            const std::vector<outline::Piece>& pieces) {
  std::map<std::string, Placed> placed;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::string& name = pieces[i].name;
    if (!json.contains("fragments") || !json["fragments"].contains(name)) continue;
    const ordered_json& fragment = json["fragments"][name];
    const char* key = fragment.contains("pose") ? "pose" : "to_world";
    if (!fragment.contains(key) || fragment[key].is_null()) continue;
    const auto place = similarity_of(fragment[key]);
    if (!place)
      throw InputError(path, "the pose of " + name + " is no 3 x 3 matrix",
                       "give an assembly of these pieces");
    placed[name] = {i, *place};
  }
  return placed;
}

/// nullopt: the calibration's pieces had the resolution of these, or one of the two is not known
std::optional<std::string> doubt_resolution(const std::string& path,
                                            const std::vector<outline::Piece>& pieces) {
  const ordered_json json = parse_file(path, kCalibrationMend);
  const auto told = json.find(kResolution);
  if (told == json.end() || !told->is_number()) return std::nullopt;
  const double before = told->get<double>();
  const double now = outline::told_resolution(pieces).value_or(before);
  if (before <= kOtherResolution * now && now <= kOtherResolution * before) return std::nullopt;
  return fmt::format("{}: was made from files of {:.5g} dots an inch, and these have {:.5g}; {}", path,
                     before, now, kRecalibrate);
}

}  // namespace

std::vector<outline::KnownJoin> read_known_joins(const std::string& path,
                                                 const std::vector<outline::Piece>& pieces) {
  const ordered_json json = parse_file(path, "give the JSON of rejoin outline assemble, or truth.json");
  const auto placed = placed_pieces(path, json, pieces);
  std::vector<outline::KnownJoin> joins;
  for (const ordered_json& join : json.value("joins", ordered_json::array())) {
    const auto names = names_of(join);
    if (!names)
      throw InputError(path, "a join has no two names", "write [\"a\", \"b\"] or {\"a\": .., \"b\": ..}");
    const auto a = placed.find(names->first);
    const auto b = placed.find(names->second);
    if (a == placed.end() || b == placed.end()) continue;
    const outline::Planar pose = relative(a->second.place, b->second.place);
    if (!pose.flipped) joins.push_back({a->second.piece, b->second.piece, pose});
  }
  if (joins.empty())
    throw InputError(path, "holds no join of two of these pieces with the same side up",
                     "give an assembly of pieces from this folder");
  return joins;
}

std::string calibration_json(const std::vector<outline::CalibratedLevel>& levels,
                             std::optional<double> resolution) {
  ordered_json list = ordered_json::array();
  for (const outline::CalibratedLevel& l : levels) {
    list.push_back({{"step", l.step},
                    {"xi", l.level.xi},
                    {"zeta", l.level.zeta},
                    {"n_min", l.level.n_min},
                    {"mistaken", l.mistaken},
                    {"true_candidates", l.true_candidates},
                    {"false_candidates", l.false_candidates}});
  }
  ordered_json json = {{"schema", kSchema}, {"levels", list}};
  if (resolution) json[kResolution] = *resolution;
  json["version"] = kVersion;
  return text_of(json);
}

void read_calibration(const std::string& path, outline::MultiscaleOptions& options) {
  const ordered_json json = parse_file(path, kCalibrationMend);
  if (json.value("schema", ordered_json()) != kSchema || !json.contains("levels") ||
      !json["levels"].is_array() || json["levels"].empty())
    throw InputError(path, "is no calibration", kCalibrationMend);
  options.levels.clear();
  for (const ordered_json& level : json["levels"]) {
    for (const char* key : {"step", "xi", "zeta", "n_min"}) {
      if (!level.is_object() || !level.contains(key) || !level[key].is_number() ||
          !(level[key].get<double>() >= 0.0))
        throw InputError(path, std::string("a level has no \"") + key + "\"", kCalibrationMend);
      if (std::string_view(key) != "step" && level[key].get<double>() > kMostOfALevel)
        throw InputError(path, fmt::format("a level's \"{}\" is above {}", key, kMostOfALevel),
                         kCalibrationMend);
    }
    if (options.levels.empty()) options.step = level["step"].get<double>();
    options.levels.push_back(
        {level["xi"].get<double>(), level["zeta"].get<double>(), level["n_min"].get<double>()});
  }
}

std::optional<std::string> doubt_calibration(const std::string& path,
                                             const outline::MultiscaleOptions& options,
                                             const std::vector<outline::Piece>& pieces) {
  if (options.step == 0.0) return std::nullopt;
  const double usual = outline::automatic_step(pieces);
  const double ratio = std::max(options.step / usual, usual / options.step);
  if (ratio <= kDoubtedStep) return doubt_resolution(path, pieces);
  const std::string problem =
      fmt::format("its finest step of {:.4g} is {:.3g} times as {} as that of these pieces, {:.4g}",
                  options.step, ratio, options.step > usual ? "coarse" : "fine", usual);
  if (ratio > kImpossibleStep) throw InputError(path, problem, kRecalibrate);
  return InputError(path, problem, kRecalibrate).what();
}

}  // namespace rejoin::cli
