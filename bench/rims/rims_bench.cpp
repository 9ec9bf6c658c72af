// How many true joins of sets with known poses are among the best proposals of the rims, and in what time, against the
// sweep.  Usage: rims_bench SET... (folders with a truth.json); Markdown on stdout.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>

#include "fragment_set.hpp"
#include "match/sweep.hpp"
#include "pair_truth.hpp"
#include "rims/propose.hpp"

namespace {

using namespace rejoin;
using Seconds = std::chrono::duration<double>;

constexpr int kNone = 1000;

/// Rank of the first right pose, from 1.
template <typename List, typename PoseOf>
int rank_of(const List& list, const bench::PairTruth& truth, const PoseOf& pose_of) {
  int rank = 1;
  for (const auto& item : list) {
    if (truth.right(pose_of(item))) return rank;
    ++rank;
  }
  return kNone;
}

struct Tally {
  int pairs = 0, first = 0, five = 0, forty = 0, sweep_five = 0;
  double seconds = 0.0, sweep_seconds = 0.0;
};

void add_pair(const match::Fragment& a, const match::Fragment& b, const bench::PairTruth& truth,
              const bench::Join& join, Tally& tally) {
  const auto begin = std::chrono::steady_clock::now();
  const auto proposals = rims::propose(a, b, {}, {});
  const Seconds rims = std::chrono::steady_clock::now() - begin;
  const int rank = rank_of(proposals, truth, [](const rims::Proposal& p) { return p.pose; });
  const auto swept_from = std::chrono::steady_clock::now();
  const auto swept = match::sweep(a, b, {}, {});
  const Seconds sweep = std::chrono::steady_clock::now() - swept_from;
  const Rigid to_a{glm::dmat3(1.0), a.surface.origin};
  const Rigid from_b{glm::dmat3(1.0), -b.surface.origin};
  const int swept_rank =
      rank_of(swept.hits, truth, [&](const match::SweepHit& hit) { return to_a * hit.pose * from_b; });
  ++tally.pairs;
  tally.first += rank == 1 ? 1 : 0;
  tally.five += rank <= 5 ? 1 : 0;
  tally.forty += rank <= 40 ? 1 : 0;
  tally.sweep_five += swept_rank <= 5 ? 1 : 0;
  tally.seconds += rims.count();
  tally.sweep_seconds += sweep.count();
  const auto text = [](int r) { return r == kNone ? std::string("-") : fmt::format("{}", r); };
  fmt::print("| {} | {} | {:.0f} | {} | {:.2f} | {} | {:.2f} |\n", join.a, join.b, join.contact_area,
             text(rank), rims.count(), text(swept_rank), sweep.count());
  std::fflush(stdout);
}

void run_set(const std::string& folder) {
  const bench::FragmentSet set = bench::read_set(folder);
  bench::Shelf shelf(set);
  fmt::print("\n{}\n\n| A | B | contact | rank of the truth, rims | s | rank, sweep | s |\n", set.name);
  fmt::print("| --- | --- | ---: | ---: | ---: | ---: | ---: |\n");
  Tally tally;
  for (const bench::Join& join : set.joins) {
    const match::Fragment& a = shelf.get(join.a);
    const match::Fragment& b = shelf.get(join.b);
    const Rigid pose = inverse(set.to_world.at(join.a)) * set.to_world.at(join.b);
    add_pair(a, b, bench::PairTruth(a, b, pose), join, tally);
  }
  fmt::print(
      "\n{} joins; rims: {} first, {} among 5, {} among 40, {:.2f} s a pair; sweep: {} among 5, {:.2f} s a "
      "pair\n",
      tally.pairs, tally.first, tally.five, tally.forty, tally.seconds / std::max(tally.pairs, 1),
      tally.sweep_five, tally.sweep_seconds / std::max(tally.pairs, 1));
}

}  // namespace

int main(int count, char** arguments) {
  try {
    for (int i = 1; i < count; ++i) run_set(arguments[i]);
  } catch (const std::exception& problem) {
    fmt::print(stderr, "{}\n", problem.what());
    return 1;
  }
  return count > 1 ? 0 : 2;
}
