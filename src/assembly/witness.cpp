#include "assembly/witness.hpp"

#include <algorithm>

#include "assembly/spread.hpp"
#include "match/verify.hpp"

namespace rejoin::assembly {
namespace {

constexpr double kHeard = 0.6;         // strength below which a contact says nothing
constexpr double kSurprise = 2.5;      // log-odds of a contact that says something at all
constexpr double kLeastTouch = 0.001;  // share of the smaller piece's surface

bool is_own(const Link& link, std::size_t a, std::size_t b) {
  return (link.a == a && link.b == b) || (link.a == b && link.b == a);
}

class Meeting {
 public:
  Meeting(const std::vector<Piece>& pieces, const Link& link, std::vector<Rigid> poses,
          const Options& options)
      : pieces_(pieces), link_(link), poses_(std::move(poses)), options_(options) {}

  double strength(const std::vector<std::size_t>& stay, const std::vector<std::size_t>& move) {
    std::vector<Touching> contacts = between(stay, move);
    if (contacts.size() < 2 || overlaps(stay, move)) return 0.0;
    const std::size_t others = contacts.size();
    for (std::size_t x = 0; x < move.size(); ++x) {
      for (std::size_t y = x + 1; y < move.size(); ++y)
        contacts.push_back({move[x], move[y], relative(move[x], move[y]), true});
    }
    std::vector<std::size_t> members = move;
    std::vector<std::size_t> fixed;
    for (std::size_t k = 0; k < others; ++k) fixed.push_back(contacts[k].a);
    std::sort(fixed.begin(), fixed.end());
    fixed.erase(std::unique(fixed.begin(), fixed.end()), fixed.end());
    members.insert(members.end(), fixed.begin(), fixed.end());
    spread_error(pieces_, members, contacts, fixed, poses_);
    if (!same_pose(pieces_[link_.a], pieces_[link_.b], link_.pose, relative(link_.a, link_.b), options_)) {
      return 0.0;
    }
    double sum = 0.0;
    for (std::size_t k = 0; k < others; ++k) {
      const auto [a, b, pose, matched] = contacts[k];
      if (is_own(link_, a, b)) continue;
      const double found = contact_strength(pieces_[a], pieces_[b], relative(a, b));
      if (found >= kHeard) sum += found;
    }
    return sum;
  }

 private:
  Rigid relative(std::size_t a, std::size_t b) const { return inverse(poses_[a]) * poses_[b]; }

  /// The link's own pair and all others that touch; a of the group that stays.
  std::vector<Touching> between(const std::vector<std::size_t>& stay,
                                const std::vector<std::size_t>& move) const {
    std::vector<Touching> contacts;
    for (const std::size_t a : stay) {
      for (const std::size_t b : move) {
        const Rigid b_to_a = relative(a, b);
        const double least = kLeastTouch * std::min(pieces_[a].area(), pieces_[b].area());
        if (is_own(link_, a, b) || touch(pieces_[a], pieces_[b], b_to_a).area > least)
          contacts.push_back({a, b, b_to_a, false});
      }
    }
    return contacts;
  }

  bool overlaps(const std::vector<std::size_t>& stay, const std::vector<std::size_t>& move) const {
    return std::any_of(stay.begin(), stay.end(), [&](std::size_t a) {
      return std::any_of(move.begin(), move.end(), [&](std::size_t b) {
        return overlap(pieces_[a], pieces_[b], relative(a, b)) > kMostOverlap;
      });
    });
  }

  const std::vector<Piece>& pieces_;
  const Link& link_;
  std::vector<Rigid> poses_;
  const Options& options_;
};

}  // namespace

double witness_odds(double strength) {
  return strength >= kHeard ? kSurprise + match::log_odds(strength) - match::log_odds(0.0) : 0.0;
}

double witness_strength(const std::vector<Piece>& pieces, const Link& link, std::vector<Rigid> poses,
                        const std::vector<std::size_t>& stay, const std::vector<std::size_t>& move,
                        const Options& options) {
  return Meeting(pieces, link, std::move(poses), options).strength(stay, move);
}

}  // namespace rejoin::assembly
