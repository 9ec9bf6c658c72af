#include "cli/outline_rims.hpp"

#include <fmt/core.h>

#include <chrono>
#include <filesystem>

#include "cli/fragment.hpp"
#include "cli/json_values.hpp"
#include "cli/outputs.hpp"
#include "core/files.hpp"
#include "core/version.hpp"
#include "match/verify.hpp"
#include "rims/propose.hpp"

namespace rejoin::cli {
namespace {

using nlohmann::ordered_json;

std::string proposals_json(const match::Fragment& a, const match::Fragment& b,
                           const std::vector<rims::Proposal>& proposals, double seconds, bool interrupted) {
  ordered_json list = ordered_json::array();
  for (const rims::Proposal& proposal : proposals) {
    list.push_back({{"pose", to_json(proposal.pose)},
                    {"score", match::score_of(proposal.strength)},
                    {"evidence", proposal.evidence},
                    {"length", proposal.length}});
  }
  const bool found = !proposals.empty();
  const ordered_json json = {{"schema", "rejoin.rims/1"},
                             {"a", {{"path", a.path}, {"diameter", a.diameter}}},
                             {"b", {{"path", b.path}, {"diameter", b.diameter}}},
                             {"pose", found ? list[0]["pose"] : ordered_json()},
                             {"score", found ? list[0]["score"] : ordered_json(0.0)},
                             {"proposals", list},
                             {"search", {{"seconds", seconds}, {"interrupted", interrupted}}},
                             {"version", kVersion}};
  return text_of(json);
}

std::string summary(const std::vector<rims::Proposal>& proposals) {
  if (proposals.empty()) return "no proposal: the rims meet nowhere\n";
  const rims::Proposal& best = proposals.front();
  std::string text = fmt::format("{} proposals; the best has {:.4g} of rim in contact (in the scans' unit)\n",
                                 proposals.size(), best.length);
  text += "pose (B's coordinates to A's):\n";
  for (int row = 0; row < 3; ++row) {
    text += fmt::format("  {:12.8f} {:12.8f} {:12.8f} {:16.10g}\n", best.pose.rotation[0][row],
                        best.pose.rotation[1][row], best.pose.rotation[2][row], best.pose.translation[row]);
  }
  return text;
}

}  // namespace

ExitCode match_rims(const std::string& path_a, const std::string& path_b, std::optional<std::string> json,
                    Console& console, Context& context) {
  const match::Fragment a = load_fragment(path_a, console, context);
  const match::Fragment b = load_fragment(path_b, console, context);
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<rims::Proposal> proposals = rims::propose(a, b, {}, context);
  const double seconds = seconds_since(begin);
  console.end_progress();
  const bool cancelled = context.cancelled();
  if (cancelled) console.warning("interrupted; what follows is the best so far");
  if (json && cancelled && keeps_earlier(*json, {*json}, "match", console)) json.reset();
  if (json) write_file(*json, proposals_json(a, b, proposals, seconds, cancelled));
  console.result(summary(proposals));
  if (json) console.result(fmt::format("wrote {}\n", *json));
  return cancelled ? kInterrupted : kDone;
}

}  // namespace rejoin::cli
