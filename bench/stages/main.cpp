// What every stage of the sweep search is worth, on sets of fragments with known poses: whether the true pose is still among
// those that go on, and what the answer would be if the search ended there, judged as fresh breaks.  With --knowledge, what it is worth to know the
// directions of the breaks or a facet instead; with --continuation, how much skin goes on across the borders of right and of
// wrong poses.  Markdown on stdout.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "fragment_set.hpp"
#include "match/refine.hpp"
#include "match/sweep.hpp"
#include "pair_truth.hpp"

namespace rejoin::bench {
namespace {

using match::Hypothesis;

struct Arguments {
  std::vector<std::string> sets;
  double least_contact = 0;
  bool knowledge = false;
  bool continuation = false;
};

/// How often a stage's answer is right, over the joins of a set.
struct Stage {
  std::string name;
  int kept_right = 0;     ///< the true pose is among those that go on
  int found = 0;          ///< the first is within 5 degrees and 2 %
  int precise = 0;        ///< and within 1 degree and 0.5 %
  int most_contact = 0;   ///< the one with the largest contact area is within 5 degrees and 2 %
  std::size_t poses = 0;  ///< that go on
  double seconds = 0;
};

class Stages {
 public:
  void add(std::size_t k, const std::string& name, const std::vector<Hypothesis>& list,
           const PairTruth& truth, const match::Fragment& a, const match::Fragment& b, double seconds) {
    if (stages_.size() <= k) stages_.push_back({.name = name});
    Stage& stage = stages_[k];
    stage.seconds += seconds;
    stage.poses += list.size();
    if (list.empty()) return;
    const auto pose_of = [&](const Hypothesis& h) {
      return Rigid{glm::dmat3(1.0), a.surface.origin} * h.pose * Rigid{glm::dmat3(1.0), -b.surface.origin};
    };
    const auto right = [&](const Hypothesis& h) { return truth.right(pose_of(h)); };
    const auto touching = std::max_element(list.begin(), list.end(), [](const auto& x, const auto& y) {
      return x.evidence.contact_area < y.evidence.contact_area;
    });
    stage.kept_right += std::any_of(list.begin(), list.end(), right) ? 1 : 0;
    stage.found += right(list.front()) ? 1 : 0;
    stage.precise += truth.precise(pose_of(list.front())) ? 1 : 0;
    stage.most_contact += right(*touching) ? 1 : 0;
  }

  void print(const std::string& set, int joins) const {
    for (const Stage& stage : stages_) {
      fmt::print("| {} | {} | {:.0f} | {} of {} | {} | {} | {} | {:.2f} |\n", set, stage.name,
                 static_cast<double>(stage.poses) / joins, stage.kept_right, joins, stage.found,
                 stage.precise, stage.most_contact, stage.seconds / joins);
    }
    std::fflush(stdout);
  }

 private:
  std::vector<Stage> stages_;
};

/// Processor seconds of all threads, so that other work on the machine counts little.
double lap(std::clock_t& last) {
  const std::clock_t now = std::clock();
  const double seconds = static_cast<double>(now - last) / CLOCKS_PER_SEC;
  last = now;
  return seconds;
}

/// \return the poses that are left in the end
std::vector<Hypothesis> measure_join(const match::Fragment& a, const match::Fragment& b,
                                     const PairTruth& truth, Stages& stages) {
  const match::Joint joint(a, b);
  std::clock_t last = std::clock();
  std::vector<Hypothesis> list;
  for (const match::SweepHit& hit : match::sweep(a, b, {}, Context()).hits) {
    list.push_back({hit.pose, {}, 0.0, hit.facet_a, hit.facet_b});
  }
  const double swept = lap(last);
  for (Hypothesis& h : list) h.evidence = joint.evidence(h.pose, 300);
  stages.add(0, "sweep", list, truth, a, b, swept);
  lap(last);
  const auto passes = match::passes(joint.tolerance(), match::Options().max_candidates);
  for (std::size_t k = 0; k < passes.size(); ++k) {
    match::refine(list, joint, passes[k], Context());
    list = match::shortlist(list, a, b, passes[k].kept);
    const double seconds = lap(last);
    stages.add(k + 1, fmt::format("pass {}", k + 1), list, truth, a, b, seconds);
    lap(last);
  }
  match::tighten(list, joint, b, std::min(a.diameter, b.diameter));
  stages.add(passes.size() + 1, "tightening", list, truth, a, b, lap(last));
  lap(last);
  match::weigh(list, joint);
  match::settle(list, joint, b, std::min(a.diameter, b.diameter));
  stages.add(passes.size() + 2, "settling", list, truth, a, b, lap(last));
  return list;
}

/// How many poses have how much skin that goes on across the border of the contact.
class Continuations {
 public:
  void add(const std::vector<Hypothesis>& list, const PairTruth& truth, const match::Fragment& a,
           const match::Fragment& b) {
    constexpr double kChance = 0.5;  // weaker poses have nothing to add to
    for (const Hypothesis& h : list) {
      if (h.strength < kChance) continue;
      const bool right = truth.right(match::to_files(a, b, h.pose));
      const auto above = std::upper_bound(kPatches.begin(), kPatches.end(), h.evidence.continuation);
      ++counts_[right ? 0 : 1][static_cast<std::size_t>(above - kPatches.begin())];
    }
  }

  static void print_head() {
    fmt::print("| set | poses | below {:.0f} |", kPatches.front());
    for (std::size_t k = 0; k + 1 < kPatches.size(); ++k)
      fmt::print(" {:.0f} to {:.0f} |", kPatches[k], kPatches[k + 1]);
    fmt::print(" {:.0f} and more |\n| --- | --- |", kPatches.back());
    for (std::size_t k = 0; k <= kPatches.size(); ++k) fmt::print(" ---: |");
    fmt::print("\n");
  }

  void print(const std::string& set) const {
    for (std::size_t k = 0; k < counts_.size(); ++k) {
      fmt::print("| {} | {} |", set, k == 0 ? "right" : "wrong");
      for (const int count : counts_[k]) fmt::print(" {} |", count);
      fmt::print("\n");
    }
    std::fflush(stdout);
  }

 private:
  static constexpr std::array kPatches{1.0, 4.0, 7.0, 10.0, 13.0};
  std::array<std::array<int, kPatches.size() + 1>, 2> counts_{};
};

/// What a user may know, with the options that say it; the true directions are the mean normals of the contact.
std::vector<std::pair<std::string, match::Options>> knowledge_of(const PairTruth& truth,
                                                                 const match::Result& free) {
  std::vector<std::pair<std::string, match::Options>> list;
  if (truth.direction()) {
    match::Options options;
    options.constraint = match::Constraint::Direction;
    options.directions_a = {*truth.direction()};
    options.directions_b = {-(glm::transpose(truth.pose().rotation) * *truth.direction())};
    list.emplace_back("both directions, 10 degrees", options);
  }
  if (!free.candidates.empty() && truth.right(free.candidates.front().pose)) {
    match::Options options;
    options.facets_a = {free.candidates.front().facet_a};
    list.emplace_back("A's facet", options);
  }
  return list;
}

/// How often the whole search is right with one kind of knowledge, and without.
struct Known {
  int joins = 0;
  int found = 0;
  int precise = 0;
  double seconds = 0;
  int free_found = 0;
  double free_seconds = 0;
};

match::Result timed(const match::Fragment& a, const match::Fragment& b, const match::Options& options,
                    double& seconds) {
  std::clock_t last = std::clock();
  match::Result result = match::match(a, b, options, Context());
  seconds += lap(last);
  return result;
}

void measure_knowledge(const match::Fragment& a, const match::Fragment& b, const PairTruth& truth,
                       std::map<std::string, Known>& table) {
  double free_seconds = 0;
  const match::Result free = timed(a, b, {}, free_seconds);
  const auto right = [&](const match::Result& result) {
    return !result.candidates.empty() && truth.right(result.candidates.front().pose);
  };
  for (const auto& [name, options] : knowledge_of(truth, free)) {
    Known& row = table[name];
    const match::Result result = timed(a, b, options, row.seconds);
    ++row.joins;
    row.free_seconds += free_seconds;
    row.free_found += right(free) ? 1 : 0;
    row.found += right(result) ? 1 : 0;
    row.precise += right(result) && truth.precise(result.candidates.front().pose) ? 1 : 0;
  }
}

void measure_set(const std::string& folder, const Arguments& arguments) {
  const FragmentSet set = read_set(folder);
  Shelf shelf(set);
  Stages stages;
  Continuations continuations;
  std::map<std::string, Known> known;
  int joins = 0;
  for (const Join& join : set.joins) {
    if (join.contact_area < arguments.least_contact) continue;
    const match::Fragment& a = shelf.get(join.a);
    const match::Fragment& b = shelf.get(join.b);
    const PairTruth truth(a, b, inverse(set.to_world.at(join.a)) * set.to_world.at(join.b));
    if (arguments.knowledge) {
      measure_knowledge(a, b, truth, known);
    } else {
      continuations.add(measure_join(a, b, truth, stages), truth, a, b);
    }
    ++joins;
  }
  for (const auto& [name, row] : known) {
    fmt::print("| {} | {} | {} | {} | {} | {} | {:.2f} | {:.2f} |\n", set.name, name, row.joins,
               row.free_found, row.found, row.precise, row.free_seconds / row.joins, row.seconds / row.joins);
  }
  if (arguments.continuation) {
    continuations.print(set.name);
  } else if (!arguments.knowledge && joins > 0) {
    stages.print(set.name, joins);
  }
  std::fflush(stdout);
}

void print_head(bool knowledge) {
  fmt::print("{}",
             knowledge
                 ? "| set | known | joins | found without | found | precise | s without | s |\n"
                 : "| set | after | poses a join | true pose kept | first: found | precise | most contact: "
                   "found | s a join |\n");
  fmt::print("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n");
}

int run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Measures every stage of the sweep search on fragment sets with known poses.");
  app.add_option("sets", arguments.sets, "folders with a truth.json")->required();
  app.add_option("--min-contact", arguments.least_contact, "leave out joins with less contact area");
  app.add_flag("--knowledge", arguments.knowledge,
               "whole searches that know directions or a facet, against free ones");
  app.add_flag(
         "--continuation", arguments.continuation,
         "how much skin goes on across the borders of right and of wrong poses that are left in the end")
      ->excludes("--knowledge");
  CLI11_PARSE(app, argc, argv);
  if (arguments.continuation) {
    Continuations::print_head();
  } else {
    print_head(arguments.knowledge);
  }
  for (const std::string& folder : arguments.sets) measure_set(folder, arguments);
  return 0;
}

}  // namespace
}  // namespace rejoin::bench

int main(int argc, char** argv) {
  try {
    return rejoin::bench::run(argc, argv);
  } catch (const rejoin::Error& error) {
    fmt::print(stderr, "stages: {}\n", error.what());
    return 1;
  }
}
