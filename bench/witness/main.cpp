/// What contacts that no search looked for say of true and of false poses: every candidate of a run puts its piece to all
/// others, which lie where they belong; or every two candidates put three pieces together.
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

constexpr std::array<double, 5> kBins{-1e300, -1.0, 1.0, 4.0, 8.0};

enum class Ask { AllOthers, OneOther, TwoTogether };

/// What candidates put together.
struct Question {
  std::vector<assembly::Link> links;  // b of each is moved to its a, in this order
  std::vector<std::vector<std::size_t>> groups;
  bool right = false;
};

/// How many candidates heard how much.
struct Table {
  std::array<int, kBins.size()> count{};
  int asked = 0;

  void add(double odds) {
    ++asked;
    std::size_t bin = 0;
    while (bin + 1 < kBins.size() && odds >= kBins[bin + 1]) ++bin;
    ++count[bin];
  }
};

class Survey {
 public:
  /// \param least  strength of a candidate that is asked about
  Survey(const FragmentSet& set, const store::Run& run, double least, Ask ask)
      : shelf_(set), least_(least), ask_(ask) {
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
    if (ask_ == Ask::TwoTogether) {
      ask_of_two();
    } else {
      for (const Candidate& candidate : candidates_) ask_of(candidate);
    }
  }

  /// Tables of false and of true candidates.
  std::array<Table, 2> run() const {
    std::vector<double> odds(questions_.size());
    parallel_for(questions_.size(), 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t k = first; k < last; ++k) odds[k] = ask(questions_[k]);
    });
    std::array<Table, 2> tables;
    for (std::size_t k = 0; k < questions_.size(); ++k) tables[questions_[k].right ? 1 : 0].add(odds[k]);
    return tables;
  }

 private:
  struct Candidate {
    assembly::Link link;
    bool right = false;
  };

  void add(const assembly::Link& link) {
    if (link.score < match::score_of(least_)) return;
    const Rigid b_to_a = inverse(truth_[link.a]) * truth_[link.b];
    const bool right =
        PairTruth(pieces_[link.a].fragment(), pieces_[link.b].fragment(), b_to_a).right(link.pose);
    candidates_.push_back({link, right});
    candidates_.push_back({{link.b, link.a, inverse(link.pose), link.score}, right});
  }

  void ask_of(const Candidate& candidate) {
    const auto [link, right] = candidate;
    std::vector<std::size_t> others;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      if (k != link.a && k != link.b) others.push_back(k);
    }
    if (ask_ == Ask::OneOther) {
      for (const std::size_t k : others) questions_.push_back({{link}, {{link.a, k}, {link.b}}, right});
    } else {
      others.push_back(link.a);
      questions_.push_back({{link}, {others, {link.b}}, right});
    }
  }

  /// About all three pieces that two candidates join.
  void ask_of_two() {
    for (const Candidate& one : candidates_) {
      for (const Candidate& two : candidates_) {
        if (one.link.a != two.link.a || one.link.b >= two.link.b) continue;
        questions_.push_back(
            {{one.link, two.link}, {{one.link.a}, {one.link.b}, {two.link.b}}, one.right && two.right});
      }
    }
  }

  double ask(const Question& question) const {
    std::vector<Rigid> poses = truth_;
    for (const assembly::Link& link : question.links) poses[link.b] = poses[link.a] * link.pose;
    return assembly::witness_odds(pieces_, question.links, question.groups, std::move(poses), {})
        .value_or(0.0);
  }

  Shelf shelf_;
  std::vector<assembly::Piece> pieces_;
  std::vector<Rigid> truth_;
  std::vector<Candidate> candidates_;  // each from both of its pieces
  std::vector<Question> questions_;
  double least_;
  Ask ask_;
};

void print(const std::string& set, const char* kind, const Table& table) {
  std::string row = fmt::format("| {} | {} | {} |", set, kind, table.asked);
  for (const int count : table.count) row += fmt::format(" {} |", count);
  fmt::print("{}\n", row);
}

}  // namespace
}  // namespace rejoin::bench

int main(int argc, char** argv) {
  CLI::App app("Log-odds that contacts which no search looked for give to the candidates of a run");
  std::string set;
  std::string run;
  app.add_option("SET", set, "folder of scans with truth.json, one object")->required();
  app.add_option("RUN", run, "what rejoin batch made of it")->required();
  double least = 2.25;
  bool one = false;
  bool two = false;
  app.add_option("--least", least, "strength from which candidates are asked about")->capture_default_str();
  auto* one_flag = app.add_flag("--one", one, "ask about one other piece at a time");
  app.add_flag("--two", two, "ask about every two candidates with a common piece")->excludes(one_flag);
  CLI11_PARSE(app, argc, argv);
  try {
    const auto fragments = rejoin::bench::read_set(set);
    const auto ask = two   ? rejoin::bench::Ask::TwoTogether
                     : one ? rejoin::bench::Ask::OneOther
                           : rejoin::bench::Ask::AllOthers;
    const rejoin::bench::Survey survey(fragments, rejoin::store::Run::open(run), least, ask);
    const auto tables = survey.run();
    fmt::print("| set | candidates | asked | below -1 | -1 to 1 | 1 to 4 | 4 to 8 | 8 and more |\n");
    fmt::print("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n");
    rejoin::bench::print(fragments.name, "false", tables[0]);
    rejoin::bench::print(fragments.name, "true", tables[1]);
  } catch (const rejoin::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
