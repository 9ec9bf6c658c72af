/// What contacts that no search looked for say of true and of false poses: every candidate of a run puts its piece to all
/// others, which lie where they belong.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "assembly/witness.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "fragment_set.hpp"
#include "match/verify.hpp"
#include "pair_truth.hpp"
#include "store/run.hpp"

namespace rejoin::bench {
namespace {

constexpr double kLeastStrength = 2.25;  // of a candidate that is asked about
constexpr std::array<double, 5> kBins{0.0, 0.6, 2.0, 4.0, 8.0};

/// A candidate, seen from the piece that it moves.
struct Question {
  assembly::Link link;  // b moves
  bool right = false;
};

/// How many candidates heard how much.
struct Table {
  std::array<int, kBins.size()> count{};
  int asked = 0;

  void add(double strength) {
    ++asked;
    std::size_t bin = 0;
    while (bin + 1 < kBins.size() && strength >= kBins[bin + 1]) ++bin;
    ++count[bin];
  }
};

class Survey {
 public:
  Survey(const FragmentSet& set, const store::Run& run) : shelf_(set) {
    std::map<std::string, std::size_t> number;
    for (const auto& [name, to_world] : set.to_world) {
      number[name] = pieces_.size();
      truth_.push_back(to_world);
      pieces_.emplace_back(shelf_.get(name));
    }
    std::map<std::int64_t, std::size_t> by_id;
    for (const store::Fragment& fragment : run.fragments()) by_id[fragment.id] = number.at(fragment.name);
    for (const store::Pair& pair : run.pairs()) {
      for (const store::Candidate& candidate : run.candidates(pair))
        add({by_id.at(pair.a), by_id.at(pair.b), candidate.pose, candidate.score});
    }
  }

  /// Tables of false and of true candidates.
  std::array<Table, 2> run() const {
    std::vector<double> strengths(questions_.size());
    parallel_for(questions_.size(), 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t k = first; k < last; ++k) strengths[k] = ask(questions_[k].link);
    });
    std::array<Table, 2> tables;
    for (std::size_t k = 0; k < questions_.size(); ++k) tables[questions_[k].right ? 1 : 0].add(strengths[k]);
    return tables;
  }

 private:
  void add(const assembly::Link& link) {
    if (link.score < match::score_of(kLeastStrength)) return;
    const Rigid b_to_a = inverse(truth_[link.a]) * truth_[link.b];
    const bool right =
        PairTruth(pieces_[link.a].fragment(), pieces_[link.b].fragment(), b_to_a).right(link.pose);
    questions_.push_back({link, right});
    questions_.push_back({{link.b, link.a, inverse(link.pose), link.score}, right});
  }

  double ask(const assembly::Link& link) const {
    std::vector<Rigid> poses = truth_;
    poses[link.b] = poses[link.a] * link.pose;
    std::vector<std::size_t> stay;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      if (k != link.b) stay.push_back(k);
    }
    return assembly::witness_strength(pieces_, link, std::move(poses), stay, {link.b}, {});
  }

  Shelf shelf_;
  std::vector<assembly::Piece> pieces_;
  std::vector<Rigid> truth_;
  std::vector<Question> questions_;
};

void print(const std::string& set, const char* kind, const Table& table) {
  std::string row = fmt::format("| {} | {} | {} |", set, kind, table.asked);
  for (const int count : table.count) row += fmt::format(" {} |", count);
  fmt::print("{}\n", row);
}

}  // namespace
}  // namespace rejoin::bench

int main(int argc, char** argv) {
  CLI::App app("Strength of contacts that no search looked for, at candidates of a run");
  std::string set;
  std::string run;
  app.add_option("SET", set, "folder of scans with truth.json, one object")->required();
  app.add_option("RUN", run, "what rejoin batch made of it")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    const auto fragments = rejoin::bench::read_set(set);
    const rejoin::bench::Survey survey(fragments, rejoin::store::Run::open(run));
    const auto tables = survey.run();
    fmt::print("| set | candidates | asked | below 0.6 | 0.6 to 2 | 2 to 4 | 4 to 8 | 8 and more |\n");
    fmt::print("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n");
    rejoin::bench::print(fragments.name, "false", tables[0]);
    rejoin::bench::print(fragments.name, "true", tables[1]);
  } catch (const rejoin::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
