#include "outline/common_boundary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "core/cyclic.hpp"

namespace rejoin::outline {
namespace {

// Samples added at once at one end.
constexpr long kBlock = 4;
// Samples around a moment that are taken as they are.
constexpr long kCore = 4;
// An end is given up where the plots differ by more than this share of what two unrelated ones would.
constexpr double kUnlike = 0.2;

struct Meeting {
  long a;
  long b;
  double difference;  // of the properties, turn in radians
};

/// Grows a stretch at both ends.
class Growth {
 public:
  Growth(const PropertyPlot& a, const PropertyPlot& b, const Moment& moment, const BoundaryOptions& options)
      : a_(a), b_(b), options_(options) {
    const auto at_a = static_cast<long>(moment.a);
    const auto at_b = static_cast<long>(moment.b);
    for (long k = -kCore; k <= kCore; ++k) add_back({at_a + k, at_b + k, difference(at_a + k, at_b + k)});
    limit_ =
        options.epsilon * (a.step * static_cast<double>(a.size()) + b.step * static_cast<double>(b.size()));
    room_ = static_cast<long>(std::min(a.size(), b.size()));
  }

  /// Enlarges while the cost allows.
  void enlarge() {
    bool front_open = true;
    bool back_open = true;
    while ((front_open || back_open) && static_cast<long>(meetings_.size()) + kBlock <= room_) {
      const Block front = block(-1);
      const Block back = block(1);
      const bool take_front = front_open && (!back_open || front.cost < back.cost);
      const Block& next = take_front ? front : back;
      if (within(next)) {
        for (const Meeting& m : next.meetings) take_front ? add_front(m) : add_back(m);
      } else {
        (take_front ? front_open : back_open) = false;
      }
    }
  }

  /// Drops each end's part that costs more than it is worth.
  /// \param unlike  difference of a sample that is not worth having, where both borders are nearly straight, radians
  void shrink(double unlike) {
    const std::size_t back = best_end(unlike, 1);
    const std::size_t front = best_end(unlike, -1);
    const auto first = meetings_.begin();
    meetings_ = std::deque<Meeting>(first + static_cast<long>(front), first + static_cast<long>(back) + 1);
  }

  Stretch stretch() const {
    Stretch out;
    out.a.reserve(meetings_.size());
    out.b.reserve(meetings_.size());
    for (const Meeting& m : meetings_) {
      out.a.push_back(m.a);
      out.b.push_back(m.b);
      out.gain += mean_turn_at(m) - m.difference;
    }
    return out;
  }

 private:
  struct Block {
    std::array<Meeting, kBlock> meetings;
    double cost = 0.0;
  };

  static float turn(const PropertyPlot& plot, long at) { return plot.channels[0][wrapped(at, plot.size())]; }

  double difference(long at_a, long at_b) const {
    const std::size_t i = wrapped(at_a, a_.size());
    const std::size_t j = wrapped(at_b, b_.size());
    const double turn = std::abs(a_.channels[0][i] - b_.channels[0][j]);
    const double share = options_.weights.colour;
    if (share <= 0.0 || a_.channels.size() < 4 || b_.channels.size() < 4) return turn;
    double colour = 0.0;
    for (std::size_t c = 1; c < 4; ++c) colour += std::abs(a_.channels[c][i] - b_.channels[c][j]);
    return (1.0 - share) * turn + share * M_PI * colour / 3.0;
  }

  double mean_turn_at(const Meeting& m) const {
    return 0.5 * (std::abs(turn(a_, m.a)) + std::abs(turn(b_, m.b)));
  }

  /// Index of the meeting at which the worth summed up from the moment is largest.
  std::size_t best_end(double unlike, long way) const {
    double sum = 0.0;
    double best = 0.0;
    auto end = core_;
    for (long i = core_ + way; i >= 0 && i < static_cast<long>(meetings_.size()); i += way) {
      const Meeting& m = meetings_[static_cast<std::size_t>(i)];
      sum += std::max(unlike, mean_turn_at(m)) - m.difference;
      if (sum <= best) continue;
      best = sum;
      end = i;
    }
    return static_cast<std::size_t>(end);
  }

  void add_back(const Meeting& m) {
    meetings_.push_back(m);
    sum_ += m.difference;
  }
  void add_front(const Meeting& m) {
    meetings_.push_front(m);
    ++core_;
    sum_ += m.difference;
  }

  /// The next block at one end, with the slip of B by at most one sample that costs least.
  Block block(long way) const {
    const Meeting& end = way > 0 ? meetings_.back() : meetings_.front();
    Block best;
    best.cost = -1.0;
    for (const long slip : {0L, -1L, 1L}) {
      Block trial;
      for (long k = 1; k <= kBlock; ++k) {
        const long at_a = end.a + way * k;
        const long at_b = end.b + way * k + (2 * k > kBlock ? slip : 0);
        trial.meetings[static_cast<std::size_t>(k - 1)] = {at_a, at_b, difference(at_a, at_b)};
        trial.cost += trial.meetings[static_cast<std::size_t>(k - 1)].difference;
      }
      if (slip != 0) trial.cost *= 1.1;  // a slip must be worth it
      if (best.cost < 0.0 || trial.cost < best.cost) best = trial;
    }
    return best;
  }

  /// Whether a block more keeps the earth mover's cost within the limit.  The meetings are one way to move the
  /// sand, so their cost is an upper bound that grows with each block; only where it fails are all ways looked at.
  bool within(const Block& next) {
    const double bound = a_.step * options_.weights.property * (sum_ + next.cost) / M_PI;
    if (bound <= limit_) return true;
    if (solved_ >= options_.most_solved) return false;
    ++solved_;
    const Meeting& outmost = next.meetings.back();
    const long first_a = std::min(meetings_.front().a, outmost.a);
    const long first_b = std::min(meetings_.front().b, outmost.b);
    const auto count = static_cast<std::size_t>(std::max(meetings_.back().a, outmost.a) - first_a + 1);
    const auto count_b = static_cast<std::size_t>(std::max(meetings_.back().b, outmost.b) - first_b + 1);
    const Sand sand_a(a_, first_a, count, options_.bins);
    const Sand sand_b(b_, first_b, count_b, options_.bins);
    const double length = a_.step * static_cast<double>(std::max(count, count_b));
    return transport_within(sand_a, sand_b, options_.weights, limit_ / length);
  }

  const PropertyPlot& a_;
  const PropertyPlot& b_;
  const BoundaryOptions& options_;
  std::deque<Meeting> meetings_;
  double sum_ = 0.0;
  long core_ = kCore;  // index of the moment among the meetings
  double limit_ = 0.0;
  long room_ = 0;
  int solved_ = 0;
};

double mean_turn(const PropertyPlot& plot) {
  double sum = 0.0;
  for (const float value : plot.channels[0]) sum += std::abs(value);
  return sum / static_cast<double>(plot.size());
}

}  // namespace

Stretch longest_boundary(const PropertyPlot& a, const PropertyPlot& b, const Moment& moment,
                         const BoundaryOptions& options) {
  Growth growth(a, b, moment, options);
  growth.enlarge();
  growth.shrink(kUnlike * (mean_turn(a) + mean_turn(b)));
  return growth.stretch();
}

}  // namespace rejoin::outline
