#include "outline/detail/closest.hpp"

#include <algorithm>
#include <cmath>

#include "core/cyclic.hpp"
#include "core/median.hpp"

namespace rejoin::outline::detail {
namespace {

constexpr int kSteps = 8;
/// Closest points are looked for this many samples to either side of where the boundary runs on.
constexpr int kWindow = 5;
/// The borders run against each other if their directions' cosine is below minus this.
constexpr double kLeastCosine = 0.7;
/// Weight of the first pairs along the boundary, against sliding where it is straight.
constexpr double kAlong = 0.01;
/// Weight of a gap of 0 against the distances: a gap is believed where distances alone tell it this well.
constexpr double kNoGap = 0.002;
constexpr std::size_t kLeastContacts = 6;
/// A sample that is not close costs as much as this many close ones when the boundary's ends are found.
constexpr double kBreakCost = 2.0;
/// Of the determinant of the equations, arms of turns taken as 1: less tells nothing.
constexpr double kNothingTold = 1e-12;

glm::dvec2 sample_point(const ScaleSignal& signal, std::int64_t index) {
  return signal.points[wrapped(index, signal.points.size())];
}

glm::dvec2 point_of(const ScaleSignal& signal, double sample) {
  const double low = std::floor(sample);
  const auto index = static_cast<std::int64_t>(low);
  return glm::mix(sample_point(signal, index), sample_point(signal, index + 1), sample - low);
}

glm::dvec2 tangent(const ScaleSignal& signal, std::int64_t index) {
  const glm::dvec2 chord = sample_point(signal, index + 1) - sample_point(signal, index - 1);
  const double length = glm::length(chord);
  return length > 0.0 ? chord / length : glm::dvec2(1, 0);
}

/// Where the pairs of the start say that sample i of A meets B.
struct Guide {
  std::vector<double> i;
  std::vector<double> j;

  double at(double sample) const {
    const auto above = std::upper_bound(i.begin(), i.end(), sample);
    std::size_t k = above == i.begin() ? 0 : static_cast<std::size_t>(above - i.begin()) - 1;
    k = std::min(k, i.size() - 2);
    if (sample < i.front()) return j.front() + (i.front() - sample);
    if (sample > i.back()) return j.back() - (sample - i.back());
    const double span = i[k + 1] - i[k];
    return span > 0.0 ? j[k] + (sample - i[k]) / span * (j[k + 1] - j[k]) : j[k];
  }
};

Guide guide_of(const Border& a, const Border& b, const std::vector<PairedPlaces>& pairs) {
  Guide guide;
  for (const PairedPlaces& pair : pairs) {
    const double i = sample_of(a, pair.on_a);
    if (!guide.i.empty() && i <= guide.i.back()) continue;
    guide.i.push_back(i);
    guide.j.push_back(sample_of(b, pair.on_b));
  }
  return guide;
}

class Fitter {
 public:
  Fitter(const Border& a, const Border& b, Guide guide, double tolerance)
      : a_(a), b_(b), guide_(std::move(guide)), tolerance_(tolerance) {
    core_begin_ = static_cast<std::int32_t>(std::ceil(guide_.i.front()));
    core_end_ = static_cast<std::int32_t>(std::floor(guide_.i.back()));
    const auto most = static_cast<std::int32_t>(std::min(a.signal->points.size(), b.signal->points.size()));
    core_end_ = std::min(core_end_, core_begin_ + most - 1);
    start();
  }

  std::optional<ContactFit> run() {
    if (core_end_ - core_begin_ + 1 < static_cast<std::int32_t>(kLeastContacts)) return std::nullopt;
    for (int round = 0; round < kSteps; ++round) {
      find_contacts(round >= 2);
      judge();
      if (!keep_boundary()) return std::nullopt;
      if (round + 1 < kSteps) improve();
    }
    return std::move(fit_);
  }

 private:
  void start() {
    std::vector<glm::dvec2> from;
    std::vector<glm::dvec2> to;
    for (std::int32_t i = core_begin_; i <= core_end_; ++i) {
      from.push_back(point_of(*b_.signal, guide_.at(i)));
      to.push_back(sample_point(*a_.signal, i));
    }
    if (!from.empty()) fit_.pose = superposed(from, to);
  }

  /// Closest point on B near sample `expected` to a point in B's coordinates.
  Contact closest(const glm::dvec2& point, double expected) const {
    const auto middle = static_cast<std::int64_t>(std::lround(expected));
    Contact best;
    double best_square = 1e300;
    const std::vector<glm::dvec2>& points = b_.signal->points;
    std::size_t at = wrapped(middle - kWindow, points.size());
    glm::dvec2 next = points[at];
    for (std::int64_t j = middle - kWindow; j < middle + kWindow; ++j) {
      const glm::dvec2 from = next;
      if (++at == points.size()) at = 0;
      next = points[at];
      const glm::dvec2 edge = next - from;
      const double square = glm::dot(edge, edge);
      const double share = square > 0.0 ? std::clamp(glm::dot(point - from, edge) / square, 0.0, 1.0) : 0.0;
      const glm::dvec2 off = from + share * edge - point;
      if (glm::dot(off, off) >= best_square) continue;
      best_square = glm::dot(off, off);
      best.j = static_cast<double>(j) + share;
    }
    return best;
  }

  /// \param there  from B to A   \param back  from A to B
  void add_contact(std::int32_t i, double expected, const Motion& there, const Motion& back,
                   std::vector<Contact>& contacts) const {
    const glm::dvec2 on_a = sample_point(*a_.signal, i);
    Contact contact = closest(back(on_a), expected);
    contact.i = i;
    const glm::dvec2 along = tangent(*a_.signal, i);
    const glm::dvec2 normal(along.y, -along.x);  // outwards: the piece is on the left
    contact.distance = glm::dot(there(point_of(*b_.signal, contact.j)) - on_a, normal);
    const auto j = static_cast<std::int64_t>(std::lround(contact.j));
    contact.close = glm::dot(along, there.direction(tangent(*b_.signal, j))) < -kLeastCosine;
    contacts.push_back(contact);
  }

  /// Contacts of the present boundary and, if `extend`, of what follows it on both sides.
  void find_contacts(bool extend) {
    const auto all = static_cast<std::int32_t>(std::min(a_.signal->points.size(), b_.signal->points.size()));
    const std::int32_t begin = fit_.contacts.empty() ? core_begin_ : fit_.contacts.front().i;
    const std::int32_t end = fit_.contacts.empty() ? core_end_ : fit_.contacts.back().i;
    const std::int32_t length = end - begin + 1;
    const std::int32_t more = extend ? std::max(0, std::min(length / 2 + 8, (all - length) / 2)) : 0;
    const bool known = !fit_.contacts.empty();
    const std::vector<Contact> old = std::move(fit_.contacts);
    const Motion there(fit_.pose);
    const Motion back(inverse(fit_.pose));
    std::vector<Contact> before;
    std::vector<Contact> contacts;
    const auto expected = [&](std::int32_t i) {
      return known ? old[static_cast<std::size_t>(i - begin)].j : guide_.at(i);
    };
    double j = expected(begin);
    for (std::int32_t i = begin - 1; i >= begin - more; --i) {
      add_contact(i, j + 1.0, there, back, before);
      j = before.back().j;
    }
    contacts.assign(before.rbegin(), before.rend());
    for (std::int32_t i = begin; i <= end; ++i) add_contact(i, expected(i), there, back, contacts);
    j = contacts.back().j;
    for (std::int32_t i = end + 1; i <= end + more; ++i) {
      add_contact(i, j - 1.0, there, back, contacts);
      j = contacts.back().j;
    }
    fit_.contacts = std::move(contacts);
  }

  /// The usual distance of the core, and who is near it.
  void judge() {
    std::vector<double> distances;
    distances.reserve(fit_.contacts.size());
    for (const Contact& c : fit_.contacts) {
      if (c.close && c.i >= core_begin_ && c.i <= core_end_) distances.push_back(c.distance);
    }
    if (distances.empty()) return;
    fit_.gap = median(distances);
    for (Contact& c : fit_.contacts) c.close = c.close && std::abs(c.distance - fit_.gap) <= tolerance_;
  }

  /// Keeps the stretch with the most close contacts, where each of the others costs kBreakCost.
  bool keep_boundary() {
    double sum = 0.0;
    double best = 0.0;
    std::size_t begin = 0;
    std::size_t best_begin = 0;
    std::size_t best_end = 0;
    for (std::size_t k = 0; k < fit_.contacts.size(); ++k) {
      sum += fit_.contacts[k].close ? 1.0 : -kBreakCost;
      if (sum <= 0.0) {
        sum = 0.0;
        begin = k + 1;
      } else if (sum > best) {
        best = sum;
        best_begin = begin;
        best_end = k + 1;
      }
    }
    if (best_end - best_begin < kLeastContacts) return false;
    fit_.contacts = {fit_.contacts.begin() + static_cast<std::ptrdiff_t>(best_begin),
                     fit_.contacts.begin() + static_cast<std::ptrdiff_t>(best_end)};
    core_begin_ = fit_.contacts.front().i;
    core_end_ = fit_.contacts.back().i;
    double squares = 0.0;
    double count = 0.0;
    for (const Contact& c : fit_.contacts) {
      if (!c.close) continue;
      squares += (c.distance - fit_.gap) * (c.distance - fit_.gap);
      count += 1.0;
    }
    fit_.residual = std::sqrt(squares / std::max(count, 1.0));
    return true;
  }

  /// One Gauss-Newton step of the pose and of the gap that worn edges leave: distances towards the gap with Tukey's
  /// weights, first pairs along the boundary, and the gap towards 0 where the boundary's shape does not tell it.
  void improve() {
    glm::dvec2 centre(0.0);
    for (const Contact& c : fit_.contacts) centre += sample_point(*a_.signal, c.i);
    centre /= static_cast<double>(fit_.contacts.size());
    glm::dmat4 normal_matrix(0.0);
    glm::dvec4 right(0.0);
    const auto add = [&](const glm::dvec4& row, double distance, double weight) {
      normal_matrix += weight * glm::outerProduct(row, row);
      right -= weight * distance * row;
    };
    const auto row_of = [&](const glm::dvec2& place, const glm::dvec2& direction, double gap) {
      const glm::dvec2 arm = place - centre;
      return glm::dvec4(cross(arm, direction), direction, gap);
    };
    const Motion motion(fit_.pose);
    double weights = 0.0;
    double arms = 0.0;  // mean square
    for (const Contact& c : fit_.contacts) {
      const glm::dvec2 arm = sample_point(*a_.signal, c.i) - centre;
      arms += glm::dot(arm, arm) / static_cast<double>(fit_.contacts.size());
    }
    for (const Contact& c : fit_.contacts) {
      const glm::dvec2 along = tangent(*a_.signal, c.i);
      const glm::dvec2 on_a = sample_point(*a_.signal, c.i);
      if (c.close) {
        const double share = (c.distance - fit_.gap) / (tolerance_ * 1.5);
        const double weight = (1.0 - share * share) * (1.0 - share * share);
        add(row_of(on_a, {along.y, -along.x}, -1.0), c.distance, weight);
        weights += weight;
      }
      if (c.i < guide_.i.front() || c.i > guide_.i.back()) continue;
      const glm::dvec2 off = motion(point_of(*b_.signal, guide_.at(c.i))) - on_a;
      add(row_of(on_a, along, 0.0), std::clamp(glm::dot(off, along), -tolerance_, tolerance_), kAlong);
    }
    add({0.0, 0.0, 0.0, 1.0}, 0.0, kNoGap * weights);
    // Turns are told by arms, so the determinant goes with their square: in metres as in micrometres.
    if (std::abs(glm::determinant(normal_matrix)) < kNothingTold * arms) return;
    const glm::dvec4 change = glm::inverse(normal_matrix) * right;
    const Planar turn{change.x, {}, false};
    const Planar update{change.x, centre + glm::dvec2(change.y, change.z) - turn.direction(centre), false};
    fit_.pose = update * fit_.pose;
  }

  Border a_;
  Border b_;
  Guide guide_;
  double tolerance_;
  std::int32_t core_begin_ = 0;
  std::int32_t core_end_ = -1;
  ContactFit fit_;
};

}  // namespace

double sample_of(const Border& border, double place) {
  const std::vector<double>& places = border.signal->places;
  const double turns = std::floor(place / border.perimeter);
  const double rest = place - turns * border.perimeter;
  const auto count = static_cast<double>(places.size());
  // Samples lie nearly evenly, so the first place above is near.
  std::size_t above = std::min(static_cast<std::size_t>(rest / border.perimeter * count), places.size());
  while (above < places.size() && places[above] <= rest) ++above;
  while (above > 0 && places[above - 1] > rest) --above;
  if (above == 0) return turns * count + (rest - places.front()) / (places[1] - places[0]);
  const std::size_t k = above - 1;
  const double next = k + 1 < places.size() ? places[k + 1] : places[0] + border.perimeter;
  return turns * count + static_cast<double>(k) + (rest - places[k]) / (next - places[k]);
}

double place_of(const Border& border, double sample) {
  const std::vector<double>& places = border.signal->places;
  const auto count = static_cast<double>(places.size());
  const double turns = std::floor(sample / count);
  const double rest = sample - turns * count;
  const std::size_t k = std::min(static_cast<std::size_t>(rest), places.size() - 1);
  const double next = k + 1 < places.size() ? places[k + 1] : places[0] + border.perimeter;
  return turns * border.perimeter + places[k] + (rest - static_cast<double>(k)) * (next - places[k]);
}

std::optional<ContactFit> fit_contact(const Border& a, const Border& b,
                                      const std::vector<PairedPlaces>& pairs, double tolerance) {
  Guide guide = guide_of(a, b, pairs);
  if (guide.i.size() < 2) return std::nullopt;
  return Fitter(a, b, std::move(guide), tolerance).run();
}

}  // namespace rejoin::outline::detail
