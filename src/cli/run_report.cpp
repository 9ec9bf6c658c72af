#include "cli/run_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "batch/inputs.hpp"
#include "batch/shelf.hpp"
#include "batch/sizes.hpp"
#include "cli/assemble_input.hpp"
#include "cli/json_values.hpp"
#include "core/error.hpp"
#include "core/words.hpp"
#include "mesh/load.hpp"
#include "mesh/surface.hpp"
#include "store/remains.hpp"
#include "store/results.hpp"
#include "store/run.hpp"

namespace rejoin::cli {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostFaces = 10'000'000;  ///< of all fragments together: a gigabyte
constexpr std::size_t kFragmentFaces = 40'000;  ///< finer than the pictures show
constexpr std::size_t kLeastFaces = 4'000;

/// Numbers of the fragments by name.
using Numbers = std::map<std::string, std::size_t>;

constexpr const char* kGapFigure = "median gap";
constexpr const char* kContactFigure = "contact area";

constexpr const char* kStaleMend = "make it again with rejoin assemble";

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& problem) {
  throw InputError(path.string(), problem, kStaleMend);
}

/// Takes poses, groups and joins over from the assembly.
class AssemblyReader {
 public:
  /// \param stored   of the report's fragments, in their order
  /// \param results  store::results_hash() of the run
  AssemblyReader(std::filesystem::path path, report::RunReport& report, const Numbers& numbers,
                 const std::vector<store::Fragment>& stored, std::string results)
      : path_(std::move(path)),
        report_(report),
        numbers_(numbers),
        stored_(stored),
        results_(std::move(results)) {}

  /// Reasons why fragments are left out hold only if the run has not changed since.
  /// \return what changed since it was made, for the user; empty: nothing
  std::string read() {
    try {
      return read_fields();
    } catch (const ordered_json::exception& error) {  // a value of another type than the schema has
      refuse(path_, std::string("is no assembly (") + error.what() + ")");
    }
  }

 private:
  std::string read_fields() {
    const ordered_json json = ordered_json::parse(read_json_text(path_.string(), kStaleMend), nullptr, false);
    if (!json.is_object() || json.value("schema", "") != "rejoin.assembly/1")
      refuse(path_, "is no assembly (schema rejoin.assembly/1)");
    if (!json.contains("fragments") || !json["fragments"].is_object()) refuse(path_, "has no \"fragments\"");
    if (json.contains("pairs_missing") && !json["pairs_missing"].is_number_unsigned())
      refuse(path_, "\"pairs_missing\" is no number of pairs");
    const std::size_t missing = json.value("pairs_missing", report_.missing_pairs);
    const std::size_t later = missing - std::min(missing, report_.missing_pairs);
    if (later > 0) change_ = fmt::format("the assembly is older than {} of the pairs", later);
    look_for_changes(json["fragments"]);
    if (change_.empty() && json.value("results", results_) != results_)
      change_ = "the assembly was made before pairs were matched anew";
    for (const auto& [name, value] : json["fragments"].items()) place(name, value);
    const ordered_json joins = json.value("joins", ordered_json::array());
    for (const ordered_json& join : joins) use(join);
    if (json.contains("constraints")) tell_constraints(json["constraints"]);
    tell(json.value("doubts", ordered_json::array()));
    return change_;
  }

  /// Nothing for a fragment that the run has no longer.
  std::optional<std::size_t> number_of(const ordered_json& name) const {
    if (!name.is_string()) refuse(path_, "has no name of a fragment where one belongs: " + name.dump());
    const auto at = numbers_.find(name.get<std::string>());
    return at == numbers_.end() ? std::nullopt : std::optional(at->second);
  }

  /// Scans that came, went or are others since.
  void look_for_changes(const ordered_json& fragments) {
    for (const auto& [name, value] : fragments.items()) {
      const auto number = number_of(name);
      if (!change_.empty() || !value.is_object()) return;
      if (!number) {
        change_ = "the assembly was made with " + name + ", which the run no longer has";
      } else if (is_of_another_scan(*number, value)) {
        change_ = "the assembly was made with another scan of " + name;
      }
    }
    for (const store::Fragment& fragment : stored_) {
      if (change_.empty() && !fragments.contains(fragment.name))
        change_ = "the assembly was made without " + fragment.name;
    }
  }

  /// Poses and joins of another scan say nothing of this one.
  bool is_of_another_scan(std::size_t number, const ordered_json& value) const {
    const std::string& hash = stored_[number].hash;
    return value.value("scan", hash) != hash;
  }

  void place(const std::string& name, const ordered_json& value) {
    const auto number = number_of(name);
    if (!number) return;
    report::ReportFragment& fragment = report_.fragments[*number];
    if (!value.is_object()) refuse(path_, "fragment \"" + name + "\" is no object");
    if (is_of_another_scan(*number, value)) {
      if (fragment.reason.empty()) fragment.reason = "the assembly has another scan of it (rejoin assemble)";
      replaced_.insert(*number);
      return;
    }
    if (change_.empty()) fragment.reason = value.value("reason", fragment.reason);
    const int group = value.value("group", -1);
    if (group < 0 || !value.contains("pose") || value["pose"].is_null()) return;
    fragment.pose = rigid_from_json(value["pose"]);
    if (!fragment.pose) refuse(path_, fmt::format("pose of \"{}\" {}", name, why_no_rigid(value["pose"])));
    fragment.group = group;
    if (value.contains("confidence") && value["confidence"].is_number())
      fragment.confidence = value["confidence"].get<double>();
    fragment.reason.clear();
  }

  void use(const ordered_json& join) {
    if (!join.is_object() || !join.contains("a") || !join.contains("b"))
      refuse(path_, "a join has no \"a\" and \"b\"");
    const auto a = number_of(join["a"]);
    const auto b = number_of(join["b"]);
    if (join["a"] == join["b"]) refuse(path_, "a join is of " + join["a"].dump() + " with itself");
    if (!a || !b || replaced_.count(*a) != 0 || replaced_.count(*b) != 0) return;
    const auto same = [&](const report::ReportPair& pair) {
      return std::minmax(pair.a, pair.b) == std::minmax(*a, *b);
    };
    const auto known = std::find_if(report_.pairs.begin(), report_.pairs.end(), same);
    if (known != report_.pairs.end()) {
      known->used = true;
      show_used_pose(*known, join);
      return;
    }
    report::ReportPair pair;
    pair.a = *a;
    pair.b = *b;
    pair.score = join.value("score", 0.0);
    pair.verdict = "touch";
    pair.comparison = report::Comparison::Touches;
    pair.used = true;
    pair.figures = figures_of(join);
    report_.pairs.push_back(std::move(pair));
  }

  /// What the assembly measured of a join; nothing of what it does not have.
  static std::vector<report::ReportFigure> figures_of(const ordered_json& join) {
    std::vector<report::ReportFigure> list;
    for (const auto& [key, name] :
         {std::pair("gap_median", kGapFigure), std::pair("contact", kContactFigure)})
      if (join.contains(key) && join[key].is_number()) list.push_back({name, join[key].get<double>()});
    return list;
  }

  /// The score and the figures of the joint that the assembly stands on, where that is not the best pose of the pair's own search.
  static void show_used_pose(report::ReportPair& pair, const ordered_json& join) {
    const double score = join.value("score", pair.score);
    const bool found = join.value("found_by", "match") == "contact";
    if (pair.comparison == report::Comparison::Failed || (!found && score == pair.score)) return;
    pair.note = fmt::format(
        "{} The best pose of that search: {}, score {:.2f}.",
        found ? "Found by contact: the two touch where other joins put them; the pair's own "
                "search missed this pose."
              : "Shown is the pose of the assembly, which is not the best of the pair's own search.",
        pair.verdict, pair.score);
    if (found) pair.verdict = "found by contact";
    pair.score = score;
    pair.figures = figures_of(join);
  }

  /// What the user asked for, also among the parameters, and what could not be kept of it.
  void tell_constraints(const ordered_json& json) const {
    if (!json.is_object()) refuse(path_, "\"constraints\" is no object");
    take_pairs(json, "must_join", "must join", report_.constraints.must_join);
    take_pairs(json, "must_not_join", "must not join", report_.constraints.must_not_join);
    std::string posed;
    const ordered_json poses = json.value("poses", ordered_json::object());
    if (!poses.is_object()) refuse(path_, "\"poses\" is no object");
    for (const auto& [name, value] : poses.items()) {
      posed += (posed.empty() ? "" : ", ") + name;
      const auto number = number_of(name);
      const std::optional<Rigid> pose = rigid_from_json(value);
      if (!pose)
        refuse(path_, fmt::format("pose of \"{}\" in \"constraints\" {}", name, why_no_rigid(value)));
      if (number) report_.constraints.pinned.emplace_back(*number, *pose);
    }
    if (!posed.empty()) report_.parameters.emplace_back("pose given", posed);
    tell(json.value("problems", ordered_json::array()));
  }

  /// Pairs of which the run has both fragments go into the list.
  void take_pairs(const ordered_json& json, const char* key, const char* label,
                  std::vector<std::pair<std::size_t, std::size_t>>& list) const {
    std::string told;
    const ordered_json pairs = json.value(key, ordered_json::array());
    for (const ordered_json& pair : pairs) {
      if (!pair.is_array() || pair.size() != 2) refuse(path_, fmt::format("\"{}\" is no list of pairs", key));
      const auto a = number_of(pair[0]);
      const auto b = number_of(pair[1]);
      told += fmt::format("{}{} + {}", told.empty() ? "" : ", ", pair[0].get<std::string>(),
                          pair[1].get<std::string>());
      if (a && b) list.emplace_back(*a, *b);
    }
    if (!told.empty()) report_.parameters.emplace_back(label, told);
  }

  void tell(const ordered_json& warnings) const {
    for (const ordered_json& warning : warnings)
      if (warning.is_string()) report_.warnings.push_back(warning.get<std::string>());
  }

  std::filesystem::path path_;
  report::RunReport& report_;
  const Numbers& numbers_;
  const std::vector<store::Fragment>& stored_;
  std::string results_;
  std::string change_;              ///< of the run since the assembly was made
  std::set<std::size_t> replaced_;  ///< fragments whose scan is another since
};

/// The scan's surface, or the one that the run keeps of it where that is no longer what was matched.
/// \throws Error there is neither
mesh::Mesh surface_of(const store::Fragment& fragment, bool is_as_matched, const std::filesystem::path& cache,
                      std::size_t faces) {
  std::optional<mesh::Mesh> kept;
  if (!is_as_matched) kept = batch::kept_surface(fragment, cache);
  mesh::Mesh scan = kept ? std::move(*kept) : mesh::load(fragment.path).mesh;
  if (!kept && !is_as_matched) {  // poses are the old one's
    throw InputError(fragment.path,
                     "is no longer what rejoin batch matched, and the run keeps no surface of that",
                     "run rejoin batch again");
  }
  if (scan.is_cloud()) scan = mesh::surface_of_cloud(scan);
  return mesh::simplify(scan, faces);
}

void warn(report::RunReport& report, Console& console, const std::string& text) {
  console.end_progress();
  console.warning(text);
  report.warnings.push_back(text);
}

/// \param stored  of the report's fragments, in their order
/// \param copies  of these, which need no surface
void read_scans(report::RunReport& report, const std::vector<store::Fragment>& stored,
                const std::map<std::string, std::string>& copies, const std::filesystem::path& folder,
                Console& console, const Context& context) {
  const std::size_t count = report.fragments.size();
  const std::size_t faces =
      std::clamp(kMostFaces / std::max<std::size_t>(1, count), kLeastFaces, kFragmentFaces);
  const batch::ChangedScans changed = batch::changed_scans(stored);
  std::set<std::string> other(changed.gone.begin(), changed.gone.end());
  other.insert(changed.changed.begin(), changed.changed.end());
  bool any = false;
  for (std::size_t k = 0; k < count && !context.cancelled(); ++k) {
    context.report("scans", static_cast<double>(k) / static_cast<double>(count));
    report::ReportFragment& fragment = report.fragments[k];
    if (copies.count(fragment.name) != 0) continue;
    try {
      if (stored[k].state == store::FragmentState::Bad) {
        warn(report, console, stored[k].error);
      } else {
        fragment.mesh =
            surface_of(stored[k], other.count(fragment.name) == 0, folder / batch::kCacheName, faces);
      }
    } catch (const Error& error) {
      warn(report, console, error.what());
    }
    if (fragment.mesh.faces.empty()) fragment.mesh = {};
    any = any || !fragment.mesh.faces.empty();
  }
  const batch::ChangedScans kept = batch::kept_ones(changed, stored, folder / batch::kCacheName);
  for (const std::string& line : batch::told(kept, "shown is")) warn(report, console, line);
  if (!any && !context.cancelled())
    warn(report, console,
         "no surface could be read, so the page has no pictures: run rejoin batch again on the scans, where "
         "they are now");
}

std::vector<report::ReportFigure> figures(const store::Pair& pair,
                                          const std::vector<store::Candidate>& candidates) {
  std::vector<report::ReportFigure> list;
  if (!candidates.empty()) {
    const store::Candidate& best = candidates.front();
    list = {{kGapFigure, best.gap_median},
            {"penetration", best.penetration},
            {kContactFigure, best.contact_area},
            {"slope difference, whole fragments", best.slope},
            {"the same, ray cast", best.raycast},
            {"depth error, whole fragments", best.depth},
            {"silhouette overlap, %", 100 * best.overlap}};
  }
  list.push_back({"poses found", static_cast<double>(candidates.size())});
  if (candidates.size() > 1) list.push_back({"second pose's score", candidates[1].score});
  list.push_back({"seconds", pair.seconds});
  return list;
}

std::string verdict_of(const store::Pair& pair) {
  return pair.stage == store::Stage::Failed ? "failed: " + pair.error : pair.verdict;
}

/// Without what only those need that are listed.
/// \return the run's pairs in the report's order
std::vector<store::Pair> add_pairs(report::RunReport& report, const store::Run& run, const Numbers& numbers) {
  std::vector<store::Pair> added;
  for (store::Pair& stored : run.pairs()) {
    if (stored.stage == store::Stage::Apart) {
      ++report.apart_pairs;
      continue;
    }
    report::ReportPair pair;
    pair.a = numbers.at(stored.name_a);
    pair.b = numbers.at(stored.name_b);
    pair.score = stored.score;
    pair.verdict = verdict_of(stored);
    if (stored.stage == store::Stage::Failed) pair.comparison = report::Comparison::Failed;
    report.pairs.push_back(std::move(pair));
    added.push_back(std::move(stored));
  }
  return added;
}

/// Figures and pose of the listed pairs; figures that the assembly gave stay.
/// \param stored  of the report's first pairs
void fill_listed(report::RunReport& report, const store::Run& run, const std::vector<store::Pair>& stored,
                 std::size_t listed) {
  for (const std::size_t k : report::listed_pairs(report, listed)) {
    if (k >= stored.size()) continue;
    report::ReportPair& pair = report.pairs[k];
    const std::vector<store::Candidate> candidates = run.candidates(stored[k]);
    if (pair.figures.empty()) pair.figures = figures(stored[k], candidates);
    if (!candidates.empty()) pair.pose = candidates.front().pose;
  }
}

/// What can be said of a fragment that the assembly leaves out without a word.
/// \param all  what holds for every such fragment; empty: its pairs tell
void add_reasons(report::RunReport& report, const std::string& all, const store::Remains& remains) {
  std::vector<const report::ReportPair*> best(report.fragments.size(), nullptr);
  for (const report::ReportPair& pair : report.pairs) {
    if (pair.comparison == report::Comparison::Failed) continue;
    for (const std::size_t k : {pair.a, pair.b}) {
      if (best[k] == nullptr || pair.score > best[k]->score) best[k] = &pair;
    }
  }
  for (std::size_t k = 0; k < report.fragments.size(); ++k) {
    report::ReportFragment& fragment = report.fragments[k];
    if (fragment.pose || !fragment.reason.empty()) continue;
    const std::string missing = store::told(remains, fragment.name);
    if (all.empty() && !store::is_searched(remains, fragment.name)) {
      fragment.reason = missing;
      continue;
    }
    if (!all.empty()) {
      fragment.reason = all;
    } else if (best[k] == nullptr) {
      fragment.reason = "compared with no other fragment";
    } else {
      fragment.reason = best[k]->verdict == "join" ? "its joints contradict the assembly"
                                                   : "none of its joints is sure enough";
    }
    if (!missing.empty()) fragment.reason += "; " + missing;
  }
}

/// A parameter as the options of rejoin batch have it; nullopt: it had no influence.
std::optional<std::pair<std::string, std::string>> option_of(const std::string& name,
                                                             const ordered_json& value,
                                                             const ordered_json& all) {
  const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  if (name == "resolution" || name == "backend") return std::pair("--" + name, text);
  if (name == "solid") return std::pair("--solid", value == true ? "yes" : "no");
  if (name == "max_candidates") return std::pair("poses kept of a pair", text);
  if (name == "chains" && all.value("search", "") == "sweep") return std::nullopt;  // of the annealing
  return std::pair(name, text);
}

/// Without the option pairs may be searched in full too, as those of small boxes are.
std::string thorough(bool promising_only, const std::vector<store::Pair>& pairs) {
  if (!promising_only) return "yes";
  const auto ended_early = [](const store::Pair& pair) { return pair.stage == store::Stage::Sweep; };
  return pairs.empty() || std::ranges::any_of(pairs, ended_early) ? "no" : "no, but no pair ended early";
}

/// \param pairs  of the run
void add_parameters(report::RunReport& report, const store::Run& run, const std::filesystem::path& folder,
                    const std::vector<store::Pair>& pairs) {
  const store::Parameters parameters = run.parameters();
  report.parameters = {{"run", folder.string()},
                       {"matched by", "rejoin " + parameters.version},
                       {"--seed", std::to_string(parameters.seed)}};
  const std::vector<store::Fragment> fragments = run.fragments();
  const auto laid = std::ranges::count_if(fragments, [](const auto& f) { return !f.pose.empty(); });
  const auto painted = std::ranges::count_if(fragments, [](const auto& f) { return !f.facets.empty(); });
  if (laid > 0)
    report.parameters.emplace_back("--layout", fmt::format("lays {} of {} scans", laid, fragments.size()));
  if (painted > 0)
    report.parameters.emplace_back("--facets", fmt::format("of {} of {} scans", painted, fragments.size()));
  const ordered_json json = ordered_json::parse(parameters.json, nullptr, false);
  if (!json.is_object()) return;
  for (const auto& [name, value] : json.items()) {
    if (name == "promising_only") {
      report.parameters.emplace_back("--thorough", thorough(value != false, pairs));
    } else if (const auto option = option_of(name, value, json)) {
      report.parameters.push_back(*option);
    }
  }
}

}  // namespace

report::RunReport read_run(const std::filesystem::path& run, std::size_t listed, Console& console,
                           const Context& context) {
  const store::Run database = store::Run::open(run);
  const std::filesystem::path folder = store::folder_of(run);
  report::RunReport report;
  report.title = std::filesystem::weakly_canonical(folder).filename().string();
  Numbers numbers;
  const std::vector<store::Fragment> fragments = database.fragments();
  const std::map<std::string, std::string> copies = database.copies();
  for (const auto& [copy, first] : copies) report.warnings.push_back(store::told_of_copy(copy, first));
  for (std::string& doubt : batch::doubts_about_lengths(fragments))
    report.warnings.push_back(std::move(doubt));
  for (const store::Fragment& stored : fragments) {
    numbers[stored.name] = report.fragments.size();
    report::ReportFragment fragment;
    fragment.name = stored.name;
    fragment.path = stored.path;
    fragment.faces = static_cast<std::size_t>(std::max<std::int64_t>(0, stored.faces));
    fragment.diameter = stored.diameter;
    if (stored.state == store::FragmentState::Bad)
      fragment.reason = "its file cannot be used: " + stored.error;
    const auto copy = copies.find(stored.name);
    if (copy != copies.end()) fragment.reason = store::reason_of_copy(copy->second);
    report.fragments.push_back(std::move(fragment));
  }
  const std::vector<store::Pair> pairs = add_pairs(report, database, numbers);
  add_parameters(report, database, folder, pairs);
  const std::filesystem::path assembly = folder / kAssemblyName;
  const store::Remains remains = store::remains(database);
  report.missing_pairs = remains.missing;
  std::string not_placed = "not assembled yet (rejoin assemble)";
  if (std::filesystem::exists(assembly)) {
    const std::string change =
        AssemblyReader(assembly, report, numbers, fragments, store::results_hash(database)).read();
    not_placed = change.empty() ? "" : change + " (rejoin assemble)";
    if (!change.empty()) {
      report.warnings.push_back(change + "; make it again with rejoin assemble");
      console.warning(report.warnings.back());
    }
  }
  fill_listed(report, database, pairs, listed);
  const std::string missing = store::told(remains);
  if (!missing.empty()) report.warnings.push_back(missing);
  add_reasons(report, not_placed, remains);
  read_scans(report, fragments, copies, folder, console, context);
  return report;
}

}  // namespace rejoin::cli
