#include "cli/match_json.hpp"

#include "cli/json_values.hpp"
#include "core/version.hpp"

namespace rejoin::cli {
namespace {

using nlohmann::ordered_json;

ordered_json triples(const std::vector<glm::dvec3>& list) {
  ordered_json json = ordered_json::array();
  for (const glm::dvec3& v : list) json.push_back(to_json(v));
  return json;
}

/// Infinite values (not measured) become null, as JSON has no infinity.
ordered_json error_json(const match::JointError& error) {
  return {{"depth", error.depth},
          {"slope", error.slope},
          {"raycast", error.raycast},
          {"overlap", error.overlap},
          {"contact_area", error.contact_area},
          {"gap_median", error.gap_median},
          {"penetration", error.penetration}};
}

ordered_json stability_json(const match::Stability& stability) {
  return {{"margin", stability.margin},         {"next_share", stability.next_share},
          {"repeat_deg", stability.repeat_deg}, {"repeat_shift", stability.repeat_shift},
          {"slide", stability.slide},           {"elsewhere", stability.elsewhere}};
}

ordered_json fragment_json(const match::Fragment& fragment) {
  return {{"path", fragment.path}, {"faces", fragment.surface.faces.size()}, {"diameter", fragment.diameter}};
}

ordered_json times_json(const std::vector<StageTime>& times) {
  ordered_json json = ordered_json::array();
  for (const StageTime& time : times) json.push_back({{"stage", time.stage}, {"seconds", time.seconds}});
  return json;
}

ordered_json search_json(const match::Options& options, const match::Result& result,
                         const std::vector<StageTime>& times, double seconds) {
  return {{"method", !options.proposals.empty()             ? "rims"
                     : options.search == match::Search::Esa ? "esa"
                                                            : "sweep"},
          {"constraint", options.constraint == match::Constraint::None        ? "none"
                         : options.constraint == match::Constraint::Direction ? "direction"
                                                                              : "material"},
          {"directions_a", triples(options.directions_a)},
          {"directions_b", triples(options.directions_b)},
          {"tolerance_deg", options.tolerance_deg},
          {"material_a", options.material_a ? to_json(*options.material_a) : ordered_json()},
          {"material_b", options.material_b ? to_json(*options.material_b) : ordered_json()},
          {"facets_a", options.facets_a},
          {"facets_b", options.facets_b},
          {"near", options.near ? to_json(*options.near) : ordered_json()},
          {"resolution", options.resolution},
          {"chains", options.chains},
          {"seed", options.seed},
          {"evaluations", result.evaluations},
          {"seconds", seconds},
          {"stages", times_json(times)},
          {"interrupted", result.cancelled}};
}

}  // namespace

std::vector<StageTime> stage_times(const match::Fragment& a, const match::Fragment& b,
                                   const match::Result& result) {
  std::vector<StageTime> times;
  for (const auto& [fragment, name] : {std::pair{&a, " a"}, std::pair{&b, " b"}}) {
    for (const StageTime& time : fragment->stages) times.push_back({time.stage + name, time.seconds});
  }
  times.insert(times.end(), result.stages.begin(), result.stages.end());
  return times;
}

std::string match_json(const match::Fragment& a, const match::Fragment& b, const match::Options& options,
                       const match::Result& result, double seconds) {
  ordered_json candidates = ordered_json::array();
  for (const match::Candidate& candidate : result.candidates) {
    candidates.push_back({{"pose", to_json(candidate.pose)},
                          {"score", candidate.score},
                          {"slides", candidate.slides},
                          {"facet_a", candidate.facet_a},
                          {"facet_b", candidate.facet_b},
                          {"error", error_json(candidate.error)}});
  }
  const bool found = !result.candidates.empty();
  const ordered_json json = {
      {"schema", "rejoin.match/1"},
      {"a", fragment_json(a)},
      {"b", fragment_json(b)},
      {"pose", found ? candidates[0]["pose"] : ordered_json()},
      {"score", found ? result.candidates[0].score : 0.0},
      {"verdict", name_of(result.verdict)},
      {"breaks", name_of(result.breaks)},
      {"against", result.against.empty() ? ordered_json() : ordered_json(result.against)},
      {"error", error_json(found ? result.candidates[0].error : match::JointError())},
      {"stability", result.stability ? stability_json(*result.stability) : ordered_json()},
      {"candidates", candidates},
      {"search", search_json(options, result, stage_times(a, b, result), seconds)},
      {"backend", {{"name", zbuffer::name_of(result.backend)}, {"renderer", result.renderer}}},
      {"warnings", result.warnings},
      {"version", kVersion}};
  return text_of(json);
}

}  // namespace rejoin::cli
