#include "outline/frechet.hpp"

#include <algorithm>
#include <array>

#include "core/cyclic.hpp"

namespace rejoin::outline {
namespace {

const glm::dvec2& sample(const PropertyPlot& plot, long i) {
  return plot.points[wrapped(i, plot.size())];
}

constexpr std::size_t kWidth = static_cast<std::size_t>(2 * kBand + 1);

/// How a cell of the free space was reached.
enum class From : char { Nowhere, Both, A, B };
using Row = std::array<From, kWidth>;

/// The free space from one end of the stretch onwards, row by row of A.
class Walk {
 public:
  Walk(const PropertyPlot& a, const PropertyPlot& b, const Planar& pose, double tolerance)
      : a_(a), b_(b), pose_(pose), tolerance_(tolerance) {}

  /// Meetings after (from_a, from_b), `way` = 1 or -1, at most `room` samples of either.
  std::vector<std::pair<long, long>> follow(long from_a, long from_b, long way, long room) const {
    std::vector<Row> rows;
    Row first{};
    if (near(from_a, from_b)) first[kBand] = From::Both;
    spread(first, 0, from_a, from_b, way, room);
    rows.push_back(first);
    while (static_cast<long>(rows.size()) < room) {
      const Row next = row_after(rows.back(), static_cast<long>(rows.size()), from_a, from_b, way, room);
      if (std::all_of(next.begin(), next.end(), [](From f) { return f == From::Nowhere; })) break;
      rows.push_back(next);
    }
    return path(rows, from_a, from_b, way);
  }

 private:
  bool near(long i, long j) const { return glm::distance(sample(a_, i), pose_(sample(b_, j))) <= tolerance_; }

  /// Cells of a row reached by steps of B alone.
  void spread(Row& row, long i, long from_a, long from_b, long way, long room) const {
    for (std::size_t k = 1; k < kWidth; ++k) {
      const long j = i + static_cast<long>(k) - kBand;
      if (j < 0 || j >= room || row[k] != From::Nowhere || row[k - 1] == From::Nowhere) continue;
      if (near(from_a + way * i, from_b + way * j)) row[k] = From::B;
    }
  }

  Row row_after(const Row& before, long i, long from_a, long from_b, long way, long room) const {
    Row row{};
    for (std::size_t k = 0; k < kWidth; ++k) {
      const long j = i + static_cast<long>(k) - kBand;
      if (j < 0 || j >= room) continue;
      const bool both = before[k] != From::Nowhere && j > 0;
      const bool only_a = k + 1 < kWidth && before[k + 1] != From::Nowhere;
      if ((both || only_a) && near(from_a + way * i, from_b + way * j)) row[k] = both ? From::Both : From::A;
    }
    spread(row, i, from_a, from_b, way, room);
    return row;
  }

  /// The way back from the last row's cell nearest to the diagonal.
  static std::vector<std::pair<long, long>> path(const std::vector<Row>& rows, long from_a, long from_b,
                                                 long way) {
    std::vector<std::pair<long, long>> meetings;
    auto i = static_cast<long>(rows.size()) - 1;
    long k = -1;
    for (long off = 0; off <= kBand && k < 0; ++off)
      for (const long trial : {kBand - off, kBand + off})
        if (k < 0 && rows.back()[static_cast<std::size_t>(trial)] != From::Nowhere) k = trial;
    while (k >= 0 && i >= 0) {
      const long j = i + k - kBand;
      const From from = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
      if (from != From::B) meetings.emplace_back(from_a + way * i, from_b + way * j);
      if (i == 0 && j == 0) break;
      if (from == From::B) --k;
      if (from == From::A) ++k;
      if (from != From::B) --i;
    }
    std::reverse(meetings.begin(), meetings.end());
    return meetings;
  }

  const PropertyPlot& a_;
  const PropertyPlot& b_;
  const Planar& pose_;
  double tolerance_;
};

}  // namespace

Planar aligned(const PropertyPlot& a, const PropertyPlot& b, const Stretch& stretch) {
  std::vector<glm::dvec2> on_a;
  std::vector<glm::dvec2> on_b;
  for (std::size_t k = 0; k < stretch.a.size(); ++k) {
    on_a.push_back(sample(a, stretch.a[k]));
    on_b.push_back(sample(b, stretch.b[k]));
  }
  return superposed(on_b, on_a);
}

Stretch longest_frechet(const PropertyPlot& a, const PropertyPlot& b, const Moment& moment,
                        const FrechetOptions& options) {
  const auto at_a = static_cast<long>(moment.a);
  const auto at_b = static_cast<long>(moment.b);
  const auto room = static_cast<long>(std::min(a.size(), b.size()) / 2);
  const long reach = std::min(static_cast<long>(options.reach), room);
  Stretch stretch;
  for (long k = -reach; k <= reach; ++k) {
    stretch.a.push_back(at_a + k);
    stretch.b.push_back(at_b + k);
  }
  for (int round = 0; round < options.rounds && stretch.a.size() >= 2; ++round) {
    const Planar pose = aligned(a, b, stretch);
    const Walk walk(a, b, pose, options.tolerance);
    auto back = walk.follow(at_a, at_b, -1, room);
    const auto front = walk.follow(at_a, at_b, 1, room);
    stretch = {};
    for (auto it = back.rbegin(); it != back.rend(); ++it) {
      stretch.a.push_back(it->first);
      stretch.b.push_back(it->second);
    }
    for (std::size_t k = 1; k < front.size(); ++k) {
      stretch.a.push_back(front[k].first);
      stretch.b.push_back(front[k].second);
    }
  }
  for (std::size_t k = 0; k < stretch.a.size(); ++k) {
    const auto turn = [](const PropertyPlot& plot, long i) {
      return plot.channels[0][wrapped(i, plot.size())];
    };
    const float of_a = turn(a, stretch.a[k]);
    const float of_b = turn(b, stretch.b[k]);
    stretch.gain += 0.5 * (std::abs(of_a) + std::abs(of_b)) - std::abs(of_a - of_b);
  }
  return stretch;
}

}  // namespace rejoin::outline
