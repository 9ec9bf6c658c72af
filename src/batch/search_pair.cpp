#include "batch/search_pair.hpp"

#include <chrono>
#include <exception>
#include <new>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "match/near.hpp"

namespace rejoin::batch {
namespace {

store::Candidate candidate_from(const match::Candidate& found) {
  store::Candidate candidate;
  candidate.score = found.score;
  candidate.pose = found.pose;
  candidate.slides = found.slides;
  candidate.facet_a = found.facet_a;
  candidate.facet_b = found.facet_b;
  candidate.depth = found.error.depth;
  candidate.slope = found.error.slope;
  candidate.raycast = found.error.raycast;
  candidate.overlap = found.error.overlap;
  candidate.contact_area = found.error.contact_area;
  candidate.gap_median = found.error.gap_median;
  candidate.penetration = found.error.penetration;
  return candidate;
}

constexpr const char* kSolid = "solid";  // of the parameters

/// A renderer's name may be no UTF-8, but JSON must be.
std::string text_of(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Searched searched(const match::Result& result) {
  Searched found;
  found.pair.stage = result.in_full ? store::Stage::Match : store::Stage::Sweep;
  found.pair.evidence = result.promise;
  found.pair.verdict = name_of(result.verdict);
  found.pair.result = text_of({{"evaluations", result.evaluations},
                               {"backend", zbuffer::name_of(result.backend)},
                               {"renderer", result.renderer},
                               {"breaks", name_of(result.breaks)},
                               {"warnings", result.warnings}});
  found.candidates.reserve(result.candidates.size());
  for (const match::Candidate& candidate : result.candidates)
    found.candidates.push_back(candidate_from(candidate));
  if (!found.candidates.empty()) found.pair.score = found.candidates.front().score;
  return found;
}

Searched failed(const std::string& error) {
  Searched found;
  found.pair.stage = store::Stage::Failed;
  found.pair.error = error;
  found.pair.result = "{}";
  return found;
}

Searched apart() {
  Searched found;
  found.pair.stage = store::Stage::Apart;
  found.pair.verdict = name_of(match::Verdict::NoJoin);
  found.pair.result = "{}";
  return found;
}

}  // namespace

std::optional<Searched> search_pair(const match::Fragment& a, const match::Fragment& b,
                                    const match::Options& options, const Context& context) {
  if (options.near && !match::may_touch(a, b, *options.near)) return apart();
  const auto begin = std::chrono::steady_clock::now();
  Searched found;
  try {
    const match::Result result = match::match(a, b, options, context);
    if (result.cancelled) return std::nullopt;
    found = searched(result);
  } catch (const std::bad_alloc&) {
    found = failed("out of memory; use fewer threads or smaller scans");
  } catch (const Error& error) {
    found = failed(error.what());
  }
  found.pair.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return found;
}

std::string parameters_json(const match::Options& options, mesh::PieceKind kind) {
  return text_of({{"search", options.search == match::Search::Esa ? "esa" : "sweep"},
                  {"resolution", options.resolution},
                  {"backend", zbuffer::name_of(options.backend)},
                  {"chains", options.chains},
                  {"promising_only", options.promising_only},
                  {"max_candidates", options.max_candidates},
                  {kSolid, kind == mesh::PieceKind::Solid}});
}

mesh::PieceKind kind_of(const store::Parameters& parameters) {
  const nlohmann::json json = nlohmann::json::parse(parameters.json, nullptr, false);
  const bool solid = json.is_object() && json.value(kSolid, nlohmann::json(false)) == true;
  return solid ? mesh::PieceKind::Solid : mesh::PieceKind::Found;
}

std::string pose_text(const Rigid& pose) {
  nlohmann::json rows = nlohmann::json::array();
  for (int row = 0; row < 3; ++row) {
    rows.push_back(
        {pose.rotation[0][row], pose.rotation[1][row], pose.rotation[2][row], pose.translation[row]});
  }
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return text_of(rows);
}

}  // namespace rejoin::batch
