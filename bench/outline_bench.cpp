/// Google Benchmarks of the multi-scale method against the plain one, over the number of pieces N and the border's length L.
#include <benchmark/benchmark.h>

#include "core/parallel.hpp"
#include "outline/detail/coding.hpp"
#include "outline/detail/pairing.hpp"
#include "outline/multiscale.hpp"
#include "outline/shatter.hpp"
#include "outline/signal.hpp"

namespace rejoin::outline {
namespace {

constexpr int kPiecesOfATile = 22;  ///< leitao 2000: 112 pieces of 5 tiles

/// Pieces of broken tiles, at a resolution (dots an inch) that sets the length of their borders.
std::vector<Piece> broken_tiles(int count, int resolution) {
  ShatterOptions options;
  options.kind = ObjectKind::Tile;
  options.objects = std::max(1, count / kPiecesOfATile);
  options.pieces = count;
  options.resolution = resolution;
  options.noise = 0.3;
  std::vector<Piece> pieces;
  for (ShatteredPiece& piece : shatter(options).pieces) pieces.push_back(std::move(piece.piece));
  return pieces;
}

void add_counters(benchmark::State& state, const std::vector<Piece>& pieces) {
  double length = 0.0;
  for (const Piece& piece : pieces)
    length += perimeter(piece.outline.points) / static_cast<double>(pieces.size());
  state.counters["L"] = length;
  state.counters["pairs"] = static_cast<double>(pieces.size() * (pieces.size() - 1) / 2);
}

/// Arguments: pieces, dots an inch.  All pairs, one thread.
void multiscale(benchmark::State& state) {
  const ThreadLimit limit(1);
  const std::vector<Piece> pieces =
      broken_tiles(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  const Context context;
  for ([[maybe_unused]] auto step : state) {
    const auto matcher = make_multiscale();
    matcher->prepare(pieces);
    for (std::size_t a = 0; a < pieces.size(); ++a) {
      for (std::size_t b = a + 1; b < pieces.size(); ++b)
        benchmark::DoNotOptimize(matcher->match(a, b, context));
    }
  }
  add_counters(state, pieces);
}
BENCHMARK(multiscale)
    ->Args({11, 150})
    ->Args({22, 150})
    ->Args({44, 150})
    ->Args({22, 75})
    ->Args({22, 300})
    ->Unit(benchmark::kMillisecond);

/// The same pairs by dynamic programming over all samples of the finest scale.
void plain(benchmark::State& state) {
  const ThreadLimit limit(1);
  const std::vector<Piece> pieces =
      broken_tiles(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  std::vector<std::vector<ScaleSignal>> scales;
  for (const Piece& piece : pieces) scales.push_back(scale_space(piece.outline.points, {1.4, 1}));
  const double usual = detail::usual_turning(scales, 0, any_of_pixels(pieces));
  std::vector<detail::Coded> coded;
  for (const auto& piece : scales) coded.push_back(detail::encode(piece[0], usual));
  const MultiscaleLevel level = default_level();
  for ([[maybe_unused]] auto step : state) {
    for (std::size_t a = 0; a < pieces.size(); ++a) {
      for (std::size_t b = a + 1; b < pieces.size(); ++b) {
        benchmark::DoNotOptimize(detail::refine_everywhere({&coded[a].forward, &coded[b].backward},
                                                           {level.xi, level.zeta, level.n_min}));
      }
    }
  }
  add_counters(state, pieces);
}
BENCHMARK(plain)->Args({11, 150})->Args({22, 75})->Args({22, 150})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rejoin::outline
