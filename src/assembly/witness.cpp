#include "assembly/witness.hpp"

#include <algorithm>
#include <cmath>

#include "assembly/spread.hpp"
#include "match/verify.hpp"

namespace rejoin::assembly {
namespace {

constexpr double kTouchTrue =
    0.85;  // share of what lies over another surface that touches it, in true contacts
constexpr double kTouchFalse = 0.45;   // and in false ones
constexpr double kMostPatches = 16.0;  // a contact is one surface, whose patches go together
constexpr double kHeard = 1.0;         // log-odds that false poses next to never get from their neighbours
constexpr double kSurprise = 2.0;      // what getting them adds

bool is_own(const Link& link, std::size_t a, std::size_t b) {
  return (link.a == a && link.b == b) || (link.a == b && link.b == a);
}

class Meeting {
 public:
  Meeting(const std::vector<Piece>& pieces, const Link& link, std::vector<Rigid> poses,
          const Options& options)
      : pieces_(pieces), link_(link), poses_(std::move(poses)), options_(options) {}

  double odds(const std::vector<std::size_t>& stay, const std::vector<std::size_t>& move) {
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
      sum += witness_odds(contact_evidence(pieces_[a], pieces_[b], relative(a, b)));
    }
    return sum >= kHeard ? sum + kSurprise : sum;
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
        const double least = kContact * std::min(pieces_[a].area(), pieces_[b].area());
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

double witness_odds(const match::Evidence& evidence) {
  const double over = evidence.shared_area + evidence.penetration_area;
  if (!(over > 0)) return 0.0;
  const double touching = evidence.contact_area / over;
  const double patches = std::min(kMostPatches, over / evidence.patch_area);
  const double contact = touching * std::log(kTouchTrue / kTouchFalse) +
                         (1.0 - touching) * std::log((1.0 - kTouchTrue) / (1.0 - kTouchFalse));
  const double shape = match::log_odds(match::strength(evidence)) - match::log_odds(0.0);
  return patches * contact + std::max(0.0, shape);
}

double witness_odds(const std::vector<Piece>& pieces, const Link& link, std::vector<Rigid> poses,
                    const std::vector<std::size_t>& stay, const std::vector<std::size_t>& move,
                    const Options& options) {
  return Meeting(pieces, link, std::move(poses), options).odds(stay, move);
}

}  // namespace rejoin::assembly
