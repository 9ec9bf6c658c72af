#include "cli/outline_json.hpp"

#include "cli/json_values.hpp"
#include "cli/outline_command.hpp"
#include "core/version.hpp"
#include "outline/polygon.hpp"
#include "outline/stitch.hpp"

namespace rejoin::cli {
namespace {

using nlohmann::ordered_json;

/// Where a piece is found in its file.
void add_origin(const outline::Piece& piece, ordered_json& json) {
  std::vector<std::vector<glm::dvec2>> rings{piece.outline.points};
  rings.insert(rings.end(), piece.outline.holes.begin(), piece.outline.holes.end());
  const glm::dvec2 inside = outline::inner_point(rings);
  json["inside"] = {inside.x, inside.y};
  if (!piece.outline.label.empty()) json["label"] = piece.outline.label;
}

ordered_json piece_json(const outline::Piece& piece) {
  ordered_json json = {{"path", piece.path},
                       {"name", piece.name},
                       {"points", piece.outline.points.size()},
                       {"perimeter", outline::perimeter(piece.outline.points)},
                       {"area", outline::signed_area(piece.outline.points)}};
  add_origin(piece, json);
  return json;
}

ordered_json candidate_json(const outline::Piece& a, const outline::Piece& b,
                            const outline::JoinCandidate& candidate) {
  const outline::JoinAreas areas = outline::join_areas(a.outline, b.outline, candidate);
  const outline::Boundary& boundary = candidate.boundary;
  ordered_json where = {
      {"begin_a", boundary.begin_a}, {"begin_b", boundary.begin_b}, {"length", boundary.length}};
  if (boundary.hole_a > 0) where["hole_a"] = boundary.hole_a;
  if (boundary.hole_b > 0) where["hole_b"] = boundary.hole_b;
  return {{"pose", to_json(candidate.pose)}, {"flipped", candidate.pose.flipped},
          {"score", candidate.score},        {"boundary", where},
          {"gap_area", areas.gap},           {"overlap_area", areas.overlap}};
}

ordered_json left_out_json(const std::vector<outline::LeftOut>& list) {
  ordered_json json = ordered_json::array();
  for (const outline::LeftOut& one : list) json.push_back({{"name", one.name}, {"reason", one.reason}});
  return json;
}

ordered_json rivals_json(const std::vector<outline::Piece>& pieces,
                         const std::vector<outline::AssemblyRival>& list) {
  ordered_json json = ordered_json::array();
  for (const outline::AssemblyRival& one : list)
    json.push_back({{"name", pieces[one.piece].name}, {"at", pieces[one.at].name}, {"score", one.score}});
  return json;
}

}  // namespace

ordered_json to_json(const outline::Planar& pose) {
  const glm::dmat3 m = outline::matrix(pose);
  ordered_json rows = ordered_json::array();
  for (int row = 0; row < 3; ++row) rows.push_back({m[0][row], m[1][row], m[2][row]});
  return rows;
}

std::string outline_match_json(const outline::Piece& a, const outline::Piece& b,
                               const outline::PairResult& result, const OutlineSearch& search) {
  ordered_json candidates = ordered_json::array();
  for (const outline::JoinCandidate& candidate : result.candidates)
    candidates.push_back(candidate_json(a, b, candidate));
  const bool found = !result.candidates.empty();
  const double score = found ? result.candidates[0].score : 0.0;
  ordered_json json = {
      {"schema", "rejoin.outline-match/1"},
      {"a", piece_json(a)},
      {"b", piece_json(b)},
      {"pose", found ? candidates[0]["pose"] : ordered_json()},
      {"score", score},
      {"verdict", outline_verdict(score)},
      {"boundary", found ? candidates[0]["boundary"] : ordered_json()},
      {"gap_area", found ? candidates[0]["gap_area"] : ordered_json()},
      {"overlap_area", found ? candidates[0]["overlap_area"] : ordered_json()},
      {"candidates", candidates},
      {"search",
       {{"method", search.method}, {"seconds", search.seconds}, {"interrupted", search.interrupted}}},
      {"version", kVersion}};
  return text_of(json);
}

std::string assembly_json(const outline::PieceSet& set, const outline::Assembly& assembly,
                          const OutlineSearch& search) {
  const std::vector<outline::Piece>& pieces = set.pieces;
  ordered_json fragments = ordered_json::object();
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const outline::Placement& placement = assembly.placements[i];
    fragments[pieces[i].name] = {
        {"pose", to_json(placement.pose)}, {"group", placement.group}, {"confidence", placement.confidence}};
    add_origin(pieces[i], fragments[pieces[i].name]);
  }
  ordered_json joins = ordered_json::array();
  for (const outline::AssemblyJoin& join : assembly.joins) {
    joins.push_back({{"a", pieces[join.a].name},
                     {"b", pieces[join.b].name},
                     {"score", join.score},
                     {"contact", join.contact},
                     {"proposed", join.proposed},
                     {"rivals", rivals_json(pieces, join.rivals)}});
  }
  ordered_json touches = ordered_json::array();
  for (const outline::AssemblyJoin& touch : assembly.touches)
    touches.push_back({{"a", pieces[touch.a].name}, {"b", pieces[touch.b].name}, {"contact", touch.contact}});
  ordered_json unplaced = ordered_json::array();
  for (const std::size_t piece : assembly.unplaced) unplaced.push_back(pieces[piece].name);
  ordered_json untried = ordered_json::array();
  for (const std::size_t piece : assembly.untried) untried.push_back(pieces[piece].name);
  ordered_json congruent = ordered_json::array();
  for (const outline::AssemblyRepeat& repeat : assembly.repeats)
    congruent.push_back({{"name", pieces[repeat.piece].name},
                         {"of", pieces[repeat.of].name},
                         {"turned_over", repeat.turned_over}});
  // All that have no place, whatever the reason; the lists after it tell that.
  unplaced.insert(unplaced.end(), untried.begin(), untried.end());
  for (const auto* left_out : {&set.unusable, &set.repeated, &set.left_out})
    for (const outline::LeftOut& piece : *left_out) unplaced.push_back(piece.name);
  const ordered_json json = {
      {"schema", "rejoin.outline-assembly/1"},
      {"fragments", fragments},
      {"joins", joins},
      {"touches", touches},
      {"unplaced", unplaced},
      {"untried", untried},
      {"unusable", left_out_json(set.unusable)},
      {"repeated", left_out_json(set.repeated)},
      {"left_out", left_out_json(set.left_out)},
      {"congruent", congruent},
      {"refused", rivals_json(pieces, assembly.refused)},
      {"rms", assembly.rms},
      {"search",
       {{"method", search.method}, {"seconds", search.seconds}, {"interrupted", search.interrupted}}},
      {"version", kVersion}};
  return text_of(json);
}

}  // namespace rejoin::cli
