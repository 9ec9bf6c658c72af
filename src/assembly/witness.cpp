#include "assembly/witness.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "assembly/pairs.hpp"
#include "assembly/spread.hpp"
#include "match/judge.hpp"
#include "match/verify.hpp"

namespace rejoin::assembly {
namespace {

constexpr double kTouchTrue =
    0.85;  // share of what lies over another surface that touches it, in true contacts
constexpr double kTouchFalse = 0.45;   // and in false ones
constexpr double kMostPatches = 16.0;  // a contact is one surface, whose patches go together
constexpr double kHeard = 1.0;         // log-odds that false poses next to never get from their neighbours
constexpr std::size_t kPlanePoints = 200;  // of a contact
constexpr double kSurprise = 2.0;          // what getting them adds

/// Root mean square distance of points from the plane that fits them best.
double off_plane(const std::vector<glm::dvec3>& points) {
  const auto count = static_cast<double>(std::max<std::size_t>(1, points.size()));
  glm::dvec3 centre(0.0);
  for (const glm::dvec3& p : points) centre += p / count;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const glm::dvec3& p : points) {
    const Eigen::Vector3d d(p.x - centre.x, p.y - centre.y, p.z - centre.z);
    spread += d * d.transpose() / count;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
}

class Meeting {
 public:
  Meeting(const std::vector<Piece>& pieces, const std::vector<Link>& links,
          const std::vector<std::vector<std::size_t>>& groups, std::vector<Rigid> poses,
          const Options& options)
      : pieces_(pieces), links_(links), groups_(groups), poses_(std::move(poses)), options_(options) {}

  std::optional<Heard> odds(const IsLinked& is_linked) {
    if (overlaps()) return std::nullopt;  // most do, and it shows soonest
    std::vector<Touching> contacts = between_groups();
    if (contacts.size() <= links_.size()) return Heard{};
    const std::size_t others = contacts.size();
    align(contacts);
    const bool steady = std::all_of(links_.begin(), links_.end(), [&](const Link& link) {
      return same_pose(pieces_[link.a], pieces_[link.b], link.pose, relative(link.a, link.b), options_);
    });
    if (!steady) return Heard{};
    if (forbidden_touch()) return std::nullopt;
    Heard sum;
    const LinksPlane plane(*this);
    const bool all_slide = std::ranges::all_of(links_, &Link::slides);
    for (std::size_t k = 0; k < others; ++k) {
      const auto [a, b, pose, known] = contacts[k];
      if (is_own(a, b)) continue;
      const match::Evidence contact =
          match::judge(pieces_[a].fragment(), pieces_[b].fragment(), relative(a, b)).evidence;
      const double in_plane = witness_odds(contact, true);
      double odds = witness_odds(contact, false);
      if (odds > in_plane && plane.lies_in(*this, a, b)) odds = in_plane;
      // What slides comes to lie on others by itself.
      if (all_slide && match::strength(contact) <= match::kEven) odds = std::min(0.0, odds);
      sum.all += odds;
      if (!is_linked(a, b, relative(a, b))) sum.unlinked += odds;
    }
    for (double* const odds : {&sum.all, &sum.unlinked})
      if (*odds >= kHeard) *odds += kSurprise;
    return sum;
  }

 private:
  Rigid relative(std::size_t a, std::size_t b) const { return inverse(poses_[a]) * poses_[b]; }

  /// Whether a link is of these two.
  bool is_own(std::size_t a, std::size_t b) const {
    return std::any_of(links_.begin(), links_.end(), [&](const Link& link) {
      return (link.a == a && link.b == b) || (link.a == b && link.b == a);
    });
  }

  /// Where two pieces face each other, in the common frame.
  std::vector<glm::dvec3> contact_points(std::size_t a, std::size_t b) const {
    const Piece& first = pieces_[a];
    const Piece& second = pieces_[b];
    const double reach = std::hypot(std::max(first.spacing(), second.spacing()), tolerance(a, b));
    std::vector<glm::dvec3> points;
    for (const Facing& facing : facing_points(first, second, relative(a, b), reach, kPlanePoints))
      points.push_back(poses_[a](facing.on_a));
    return points;
  }

  double tolerance(std::size_t a, std::size_t b) const {
    return match::contact_tolerance(pieces_[a].fragment(), pieces_[b].fragment(), match::Breaks::Worn);
  }

  /// The contacts of the links, once all is aligned.
  class LinksPlane {
   public:
    explicit LinksPlane(const Meeting& meeting) {
      for (const Link& link : meeting.links_) {
        const std::vector<glm::dvec3> points = meeting.contact_points(link.a, link.b);
        points_.insert(points_.end(), points.begin(), points.end());
        tolerance_ = std::max(tolerance_, meeting.tolerance(link.a, link.b));
      }
    }

    /// Whether another contact lies in one plane with them.
    bool lies_in(const Meeting& meeting, std::size_t a, std::size_t b) const {
      std::vector<glm::dvec3> points = meeting.contact_points(a, b);
      points.insert(points.end(), points_.begin(), points_.end());
      return off_plane(points) < std::max(tolerance_, meeting.tolerance(a, b));
    }

   private:
    std::vector<glm::dvec3> points_;
    double tolerance_ = 0.0;
  };

  bool is_forbidden(std::size_t a, std::size_t b) const {
    return among(options_.constraints.must_not_join, a, b);
  }

  /// Whether any two that must not join touch.
  bool forbidden_touch() const {
    const auto touching = [&](std::size_t a, std::size_t b) {
      return is_forbidden(a, b) && touch_forbidden(pieces_[a], pieces_[b], relative(a, b));
    };
    for (std::size_t g = 0; g < groups_.size(); ++g)
      for (std::size_t h = g + 1; h < groups_.size(); ++h)
        if (any_two(groups_[g], groups_[h], touching)) return true;
    return false;
  }

  bool are_linked(const std::vector<std::size_t>& first, const std::vector<std::size_t>& second) const {
    const auto in = [](const std::vector<std::size_t>& group, std::size_t piece) {
      return std::ranges::find(group, piece) != group.end();
    };
    return std::ranges::any_of(links_, [&](const Link& link) {
      return (in(first, link.a) && in(second, link.b)) || (in(first, link.b) && in(second, link.a));
    });
  }

  /// Visits every two pieces of two groups until one says true.
  template <typename Visit>
  static bool any_two(const std::vector<std::size_t>& first, const std::vector<std::size_t>& second,
                      const Visit& visit) {
    return std::ranges::any_of(first, [&](std::size_t a) {
      return std::ranges::any_of(second, [&](std::size_t b) { return visit(a, b); });
    });
  }

  /// The links' own pairs and all others that touch; a of the earlier group.
  std::vector<Touching> between_groups() const {
    std::vector<Touching> contacts;
    const auto add = [&](std::size_t a, std::size_t b) {
      const Rigid b_to_a = relative(a, b);
      const double least = kContact * std::min(pieces_[a].area(), pieces_[b].area());
      if (is_forbidden(a, b)) return false;
      if (is_own(a, b) || touch(pieces_[a], pieces_[b], b_to_a).area > least)
        contacts.push_back({a, b, b_to_a, Known::Asked});
      return false;
    };
    for (std::size_t g = 0; g < groups_.size(); ++g)
      for (std::size_t h = g + 1; h < groups_.size(); ++h) any_two(groups_[g], groups_[h], add);
    return contacts;
  }

  /// Looks last between groups with a link: they were asked about alone before.
  bool overlaps() const {
    const auto overlap = [&](std::size_t a, std::size_t b) {
      return interpenetrate(pieces_[a], pieces_[b], relative(a, b));
    };
    for (const bool linked : {false, true}) {
      for (std::size_t g = 0; g < groups_.size(); ++g) {
        for (std::size_t h = g + 1; h < groups_.size(); ++h) {
          if (are_linked(groups_[g], groups_[h]) == linked && any_two(groups_[g], groups_[h], overlap))
            return true;
        }
      }
    }
    return false;
  }

  /// The first group stays, as far as the others touch it; adds what holds the other groups together to the contacts.
  void align(std::vector<Touching>& contacts) {
    std::vector<std::size_t> members;
    for (std::size_t g = 1; g < groups_.size(); ++g) {
      const auto& group = groups_[g];
      members.insert(members.end(), group.begin(), group.end());
      for (std::size_t x = 0; x < group.size(); ++x) {
        for (std::size_t y = x + 1; y < group.size(); ++y)
          contacts.push_back({group[x], group[y], relative(group[x], group[y]), Known::Searched});
      }
    }
    std::vector<std::size_t> fixed;
    for (const std::size_t piece : groups_.front()) {
      if (std::any_of(contacts.begin(), contacts.end(), [&](const Touching& c) { return c.a == piece; }))
        fixed.push_back(piece);
    }
    members.insert(members.end(), fixed.begin(), fixed.end());
    spread_error(pieces_, members, contacts, fixed, poses_);
  }

  const std::vector<Piece>& pieces_;
  const std::vector<Link>& links_;
  const std::vector<std::vector<std::size_t>>& groups_;
  std::vector<Rigid> poses_;
  const Options& options_;
};

}  // namespace

double witness_odds(const match::Evidence& evidence, bool in_plane) {
  const double over = evidence.shared_area + evidence.penetration_area;
  if (!(over > 0)) return 0.0;
  const double touching = evidence.contact_area / over;
  const double patches = std::min(kMostPatches, over / evidence.patch_area);
  const double contact = touching * std::log(kTouchTrue / kTouchFalse) +
                         (1.0 - touching) * std::log((1.0 - kTouchTrue) / (1.0 - kTouchFalse));
  const double shape = match::log_odds(match::strength(evidence)) - match::log_odds(0.0);
  return patches * (in_plane ? std::min(0.0, contact) : contact) + std::max(0.0, shape);
}

std::optional<double> witness_odds(const std::vector<Piece>& pieces, const std::vector<Link>& links,
                                   const std::vector<std::vector<std::size_t>>& groups,
                                   std::vector<Rigid> poses, const Options& options) {
  const auto none = [](std::size_t /*a*/, std::size_t /*b*/, const Rigid& /*b_to_a*/) { return false; };
  const std::optional<Heard> heard = hear_contacts(pieces, links, groups, std::move(poses), options, none);
  return heard ? std::optional(heard->all) : std::nullopt;
}

std::optional<Heard> hear_contacts(const std::vector<Piece>& pieces, const std::vector<Link>& links,
                                   const std::vector<std::vector<std::size_t>>& groups,
                                   std::vector<Rigid> poses, const Options& options,
                                   const IsLinked& is_linked) {
  return Meeting(pieces, links, groups, std::move(poses), options).odds(is_linked);
}

}  // namespace rejoin::assembly
