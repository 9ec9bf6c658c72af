/// Repeats the experiment of naiman 2018: random shapes broken by random walks, scanned, turned and turned over, put
/// together again; in how many shapes nothing overlaps or gapes beyond two pixels.
///
///   naiman_bench [SHAPES [PIECES [RESOLUTION [WINDOW [STRAIGHT [MATCH [CONFIDENCE [SEED]]]]]]]]
///   naiman_bench table SHAPES PIECES RESOLUTION    one line for each value of each parameter around the paper's
#include <fmt/core.h>

#include <chrono>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "reassemble.hpp"

namespace rejoin::bench {
namespace {

struct Trial {
  std::size_t shapes = 100;
  int pieces = 8;
  double resolution = 200.0;
  std::uint64_t seed = 1;
  outline::LcsOptions options;
};

void print_header() {
  fmt::print("{:>10} {:>6} {:>8} {:>6} {:>10} {:>6} {:>6} {:>7} {:>11} {:>12} {:>8}\n", "resolution",
             "window", "straight", "match", "confidence", "shapes", "whole", "within2", "true joins",
             "false joins", "seconds");
}

void run(const Trial& trial) {
  const auto begin = std::chrono::steady_clock::now();
  std::vector<Reassembly> results(trial.shapes);
  parallel_for(trial.shapes, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      outline::ShatterOptions shatter;
      shatter.scan = outline::ScanKind::Pixels;
      shatter.pieces = trial.pieces;
      shatter.resolution = trial.resolution;
      shatter.flip = true;
      shatter.seed = trial.seed + k;
      const outline::Shattered broken = outline::shatter(shatter);
      shatter.pieces = 1;
      results[k] = reassemble(broken, outline::shatter(shatter), trial.options);
      const Reassembly& r = results[k];
      if (std::getenv("NAIMAN_BENCH_VERBOSE") != nullptr)
        fmt::print(stderr, "seed {}: {} overlap {:.2f} gap {:.2f} true {} false {}\n", shatter.seed,
                   r.whole ? "whole" : "parts", r.overlap, r.gap, r.joins_true, r.joins_false);
    }
  });
  std::size_t whole = 0;
  std::size_t good = 0;
  std::size_t joins_true = 0;
  std::size_t joins_false = 0;
  for (const Reassembly& result : results) {
    whole += result.whole ? 1 : 0;
    good += result.whole && result.overlap <= 2.0 && result.gap <= 2.0 ? 1 : 0;
    joins_true += result.joins_true;
    joins_false += result.joins_false;
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  const outline::LcsOptions& o = trial.options;
  fmt::print("{:>10} {:>6} {:>8} {:>6} {:>10} {:>6} {:>6} {:>7} {:>11} {:>12} {:>8.1f}\n", trial.resolution,
             o.window, o.straight_deg, o.match_deg, o.confidence, trial.shapes, whole, good, joins_true,
             joins_false, seconds.count());
  std::fflush(stdout);
}

double argument(int count, char** arguments, int index, double otherwise) {
  return index < count ? std::atof(arguments[index]) : otherwise;
}

/// Tables 1 and 2 say which values of each parameter work; here every value is tried with the others as they are.
void table(Trial trial) {
  const bool fine = trial.resolution >= 150.0;
  const outline::LcsOptions usual = trial.options;
  for (const int window :
       fine ? std::vector<int>{17, 25, 31, 35, 37, 45} : std::vector<int>{11, 17, 23, 27, 29, 37}) {
    trial.options = usual;
    trial.options.window = window;
    run(trial);
  }
  for (const double straight : {0.1, 0.3, 0.4, 0.8, 1.6}) {
    trial.options = usual;
    trial.options.straight_deg = straight;
    run(trial);
  }
  for (const double match : {0.01, 0.1, 0.2, 0.4, 0.8}) {
    trial.options = usual;
    trial.options.match_deg = match;
    run(trial);
  }
  for (const double confidence : {0.05, 0.1, 0.25, 0.5}) {
    trial.options = usual;
    trial.options.confidence = confidence;
    run(trial);
  }
}

}  // namespace
}  // namespace rejoin::bench

int main(int count, char** arguments) {
  using namespace rejoin::bench;
  const bool all = count > 1 && std::string_view(arguments[1]) == "table";
  const int first = all ? 2 : 1;
  Trial trial;
  trial.shapes = static_cast<std::size_t>(argument(count, arguments, first, 100));
  trial.pieces = static_cast<int>(argument(count, arguments, first + 1, 8));
  trial.resolution = argument(count, arguments, first + 2, 200);
  trial.options.step = 1.0;
  trial.options.scales = 1;  // nothing is worn
  trial.options.window = trial.resolution >= 150.0 ? 37 : 27;
  if (!all) {
    trial.options.window = static_cast<int>(argument(count, arguments, 4, trial.options.window));
    trial.options.straight_deg = argument(count, arguments, 5, trial.options.straight_deg);
    trial.options.match_deg = argument(count, arguments, 6, trial.options.match_deg);
    trial.options.confidence = argument(count, arguments, 7, trial.options.confidence);
    trial.seed = static_cast<std::uint64_t>(argument(count, arguments, 8, 1));
  }
  try {
    print_header();
    all ? table(trial) : run(trial);
  } catch (const rejoin::Error& error) {
    fmt::print(stderr, "naiman_bench: {}\n", error.what());
    return 1;
  }
  return 0;
}
