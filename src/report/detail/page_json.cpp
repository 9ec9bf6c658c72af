#include "report/detail/page_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/version.hpp"
#include "report/fragment_colours.hpp"

namespace rejoin::report::detail {
namespace {

using nlohmann::ordered_json;

/// Column major, as WebGL has it.
ordered_json columns(const Rigid& pose) {
  ordered_json list = ordered_json::array();
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) list.push_back(pose.rotation[column][row]);
    list.push_back(0.0);
  }
  for (int row = 0; row < 3; ++row) list.push_back(pose.translation[row]);
  list.push_back(1.0);
  return list;
}

ordered_json mesh_json(const PackedMesh& mesh) {
  if (mesh.vertices == 0) return nullptr;
  return {{"vertices", mesh.vertices},
          {"faces", mesh.faces},
          {"low", {mesh.low.x, mesh.low.y, mesh.low.z}},
          {"step", mesh.step},
          {"vertex", base64(mesh.vertex_stream)},
          {"colour", base64(mesh.colour_stream)},
          {"index", base64(mesh.index_stream)}};
}

ordered_json colour_json(Colour colour) {
  return {colour.x / 255.0, colour.y / 255.0, colour.z / 255.0};
}

/// Those of the placed fragments as in assembly_picture(), where others have none.
std::vector<Colour> colours_of(const RunReport& report) {
  std::vector<std::size_t> number(report.fragments.size());
  std::size_t placed = 0;
  std::size_t others = 0;
  for (std::size_t k = 0; k < number.size(); ++k) number[k] = report.fragments[k].pose ? placed++ : others++;
  std::vector<std::pair<std::size_t, std::size_t>> joins;
  for (const ReportPair& pair : report.pairs) {
    if (pair.used && report.fragments[pair.a].pose && report.fragments[pair.b].pose)
      joins.emplace_back(number[pair.a], number[pair.b]);
  }
  const std::vector<Colour> of_placed = fragment_colours(placed, joins);
  std::vector<Colour> colours;
  for (std::size_t k = 0; k < number.size(); ++k)
    colours.push_back(report.fragments[k].pose ? of_placed[number[k]] : list_colour(placed + number[k]));
  return colours;
}

ordered_json fragment_json(const ReportFragment& fragment, Colour colour, const PackedMesh& mesh) {
  return {{"name", fragment.name},
          {"path", fragment.path},
          {"faces", fragment.faces},
          {"diameter", fragment.diameter},
          {"group", fragment.pose ? ordered_json(fragment.group) : ordered_json()},
          {"confidence", fragment.confidence},
          {"reason", fragment.reason},
          {"colour", colour_json(colour)},
          {"object_colour",
           fragment.pose ? colour_json(list_colour(static_cast<std::size_t>(std::max(0, fragment.group))))
                         : ordered_json()},
          {"pose", fragment.pose ? columns(*fragment.pose) : ordered_json()},
          {"mesh", mesh_json(mesh)}};
}

ordered_json constraints_json(const ReportConstraints& constraints) {
  ordered_json poses = ordered_json::array();
  for (const auto& [fragment, pose] : constraints.pinned) poses.push_back({fragment, columns(pose)});
  return {
      {"must_join", constraints.must_join}, {"must_not_join", constraints.must_not_join}, {"poses", poses}};
}

ordered_json pictures_json(const std::vector<ReportPicture>& pictures) {
  ordered_json list = ordered_json::array();
  for (const ReportPicture& picture : pictures) {
    list.push_back({{"title", picture.title},
                    {"width", picture.width},
                    {"height", picture.height},
                    {"jpeg", base64(picture.jpeg)}});
  }
  return list;
}

ordered_json pair_json(const ReportPair& pair, const std::vector<ReportPicture>& pictures) {
  ordered_json figures = ordered_json::array();
  for (const ReportFigure& figure : pair.figures) figures.push_back({figure.name, figure.value});
  return {{"a", pair.a},
          {"b", pair.b},
          {"score", pair.score},
          {"verdict", pair.verdict},
          {"failed", pair.comparison == Comparison::Failed},
          {"used", pair.used},
          {"note", pair.note},
          {"figures", figures},
          {"pictures", pictures_json(pictures)}};
}

/// "<" only occurs inside of JSON's strings, where it may be written so.
std::string without_less_than(const std::string& json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

std::vector<std::uint8_t> score_triangle(const RunReport& report) {
  constexpr std::uint8_t kNotCompared = 255;
  constexpr std::uint8_t kFailed = 254;
  const std::size_t n = report.fragments.size();
  std::vector<std::uint8_t> scores(n < 2 ? 0 : n * (n - 1) / 2, kNotCompared);
  for (const ReportPair& pair : report.pairs) {
    const std::size_t row = std::min(pair.a, pair.b);
    const std::size_t column = std::max(pair.a, pair.b);
    scores[row * (2 * n - row - 1) / 2 + column - row - 1] =
        pair.comparison == Comparison::Failed
            ? kFailed
            : static_cast<std::uint8_t>(std::lround(253.0 * std::clamp(pair.score, 0.0, 1.0)));
  }
  return scores;
}

std::string page_json(const PageData& data) {
  const RunReport& report = *data.report;
  const auto number_of = [&](Comparison wanted) {
    return std::count_if(report.pairs.begin(), report.pairs.end(),
                         [&](const ReportPair& pair) { return pair.comparison == wanted; });
  };
  ordered_json fragments = ordered_json::array();
  const std::vector<Colour> colours = colours_of(report);
  for (std::size_t k = 0; k < report.fragments.size(); ++k)
    fragments.push_back(fragment_json(report.fragments[k], colours[k], data.meshes[k]));
  ordered_json pairs = ordered_json::array();
  for (const std::size_t k : data.listed) pairs.push_back(pair_json(report.pairs[k], data.pictures[k]));
  ordered_json parameters = ordered_json::array();
  for (const auto& [name, value] : report.parameters) parameters.push_back({name, value});
  const ordered_json json = {{"schema", "rejoin.report/1"},
                             {"version", kVersion},
                             {"title", report.title},
                             {"fragments", fragments},
                             {"gap_scale", data.gap_scale},
                             {"compared", number_of(Comparison::Done)},
                             {"failed", number_of(Comparison::Failed)},
                             {"apart", report.apart_pairs},
                             {"missing", report.missing_pairs},
                             {"pairs", pairs},
                             {"scores", base64(score_triangle(report))},
                             {"parameters", parameters},
                             {"constraints", constraints_json(report.constraints)},
                             {"warnings", report.warnings}};
  return without_less_than(json.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
}

}  // namespace rejoin::report::detail
