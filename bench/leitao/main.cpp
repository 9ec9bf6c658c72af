/// Leitao and Stolfi's experiment at its size: five tiles in 112 pieces, all pairs, five scales.
///
///   leitao [SEED [WEAR]]     SEED of the break (1), WEAR of the edges in pixels (1)
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>

#include "core/parallel.hpp"
#include "outline/multiscale.hpp"
#include "outline/shatter.hpp"

namespace rejoin::outline {
namespace {

constexpr double kMinLength = 210.0;  ///< L_min of the paper, pixels
constexpr double kSaid = 0.5;         ///< a candidate with this score counts as said
/// A pose is right within these.
constexpr double kAngle = 5.0 * M_PI / 180.0;
constexpr double kShareOfDiameter = 0.02;

struct Row {
  std::size_t a = 0;
  std::size_t b = 0;
  PairResult result;
};

double diameter(const Outline& outline) {
  glm::dvec2 low = outline.points[0];
  glm::dvec2 high = low;
  for (const glm::dvec2& p : outline.points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  return glm::distance(low, high);
}

bool is_right(const Planar& pose, const ShatteredPiece& a, const ShatteredPiece& b) {
  const Planar truth = inverse(a.to_object) * b.to_object;
  double off = 0.0;
  for (const glm::dvec2& p : b.piece.outline.points) off += glm::distance(pose(p), truth(p));
  off /= static_cast<double>(b.piece.outline.points.size());
  return angle_between(pose, truth) <= kAngle &&
         off <= kShareOfDiameter * (diameter(a.piece.outline) + diameter(b.piece.outline));
}

std::vector<Row> match_all(const std::vector<Piece>& pieces, double& seconds) {
  std::vector<Row> rows;
  for (std::size_t a = 0; a < pieces.size(); ++a) {
    for (std::size_t b = a + 1; b < pieces.size(); ++b) rows.push_back({a, b, {}});
  }
  const auto begin = std::chrono::steady_clock::now();
  MultiscaleOptions options;
  options.min_length = kMinLength;
  const auto matcher = make_multiscale(options);
  matcher->prepare(pieces);
  const Context context;
  parallel_for(rows.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) rows[i].result = matcher->match(rows[i].a, rows[i].b, context);
  });
  seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return rows;
}

void report(const Shattered& set, const std::vector<Row>& rows, double seconds) {
  std::map<std::pair<std::size_t, std::size_t>, double> joins;
  std::size_t long_joins = 0;
  for (const TrueJoin& join : set.joins) {
    joins[{join.a, join.b}] = join.length;
    long_joins += join.length >= kMinLength ? 1 : 0;
  }
  std::size_t said = 0;
  std::size_t right = 0;
  std::size_t found = 0;
  for (const Row& row : rows) {
    if (row.result.candidates.empty() || row.result.candidates[0].score < kSaid) continue;
    ++said;
    const auto join = joins.find({row.a, row.b});
    if (join == joins.end() || !is_right(row.result.candidates[0].pose, set.pieces[row.a], set.pieces[row.b]))
      continue;
    ++right;
    found += join->second >= kMinLength ? 1 : 0;
  }
  fmt::print("{} pieces, {} pairs, {:.1f} s on {} threads\n", set.pieces.size(), rows.size(), seconds,
             thread_count());
  fmt::print("{} joins, {} longer than L_min = {:.0f} pixels\n", set.joins.size(), long_joins, kMinLength);
  fmt::print("recall {:.1f} % ({} of {}), precision {:.1f} % ({} of {} said)\n",
             100.0 * static_cast<double>(found) / static_cast<double>(std::max<std::size_t>(1, long_joins)),
             found, long_joins,
             100.0 * static_cast<double>(right) / static_cast<double>(std::max<std::size_t>(1, said)), right,
             said);
}

void run(std::uint64_t seed, double wear) {
  ShatterOptions options;
  options.kind = ObjectKind::Tile;
  options.objects = 5;
  options.pieces = 112;
  options.resolution = 300.0;
  options.wear = wear;
  options.noise = 0.4;
  options.seed = seed;
  const Shattered set = shatter(options);
  std::vector<Piece> pieces;
  pieces.reserve(set.pieces.size());
  for (const ShatteredPiece& piece : set.pieces) pieces.push_back(piece.piece);
  double seconds = 0.0;
  const std::vector<Row> rows = match_all(pieces, seconds);
  report(set, rows, seconds);
}

}  // namespace
}  // namespace rejoin::outline

int main(int argc, char** argv) {
  const std::uint64_t seed = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
  rejoin::outline::run(seed, argc > 2 ? std::strtod(argv[2], nullptr) : 1.0);
  return 0;
}
