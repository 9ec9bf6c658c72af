#include "outline/layout.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace rejoin::outline {
namespace {

constexpr double kFacing = 0.5;

/// Unknowns of a piece: a turn about its centre, times its arm so that all three are lengths, and a shift.
struct Frame {
  glm::dvec2 centre;  // in the group's frame
  double arm;
};

Eigen::Vector3d row_of(const Frame& frame, const glm::dvec2& point, const glm::dvec2& direction) {
  const glm::dvec2 off = (point - frame.centre) / frame.arm;
  return {direction.y * off.x - direction.x * off.y, direction.x, direction.y};
}

/// Two placed pieces, of which b's border is drawn to a's.
struct Pull {
  const Silhouette& a;
  const Silhouette& b;
  const Planar& pose_a;
  const Planar& pose_b;
  double tolerance;
};

/// Normal equations of all pulls of a group, three unknowns a piece.
class System {
 public:
  explicit System(std::size_t pieces)
      : normal_(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * pieces),
                                      static_cast<Eigen::Index>(3 * pieces))),
        right_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * pieces))) {}

  void add(const Pull& pull, std::size_t index_a, const Frame& frame_a, std::size_t index_b,
           const Frame& frame_b) {
    const auto at_a = static_cast<Eigen::Index>(3 * index_a);
    const auto at_b = static_cast<Eigen::Index>(3 * index_b);
    const Motion relative(inverse(pull.pose_a) * pull.pose_b);
    const Motion to_group(pull.pose_a);
    const auto add = [&](std::size_t k, const glm::dvec2& p) {
      const double depth = pull.a.field(p);
      if (std::abs(depth) > pull.tolerance) return;
      const glm::dvec2 inward = pull.a.field.gradient(p);
      if (glm::dot(relative.direction(pull.b.normals[k]), inward) < kFacing * glm::length(inward)) return;
      const glm::dvec2 direction = to_group.direction(inward);
      const glm::dvec2 place = to_group(p);
      const Eigen::Vector3d of_a = -row_of(frame_a, place, direction);
      const Eigen::Vector3d of_b = row_of(frame_b, place, direction);
      normal_.block<3, 3>(at_a, at_a) += of_a * of_a.transpose();
      normal_.block<3, 3>(at_b, at_b) += of_b * of_b.transpose();
      normal_.block<3, 3>(at_a, at_b) += of_a * of_b.transpose();
      normal_.block<3, 3>(at_b, at_a) += of_b * of_a.transpose();
      right_.segment<3>(at_a) -= of_a * depth;
      right_.segment<3>(at_b) -= of_b * depth;
    };
    for (const Ring& ring : pull.b.rings) visit_near(pull.b, ring, relative, pull.a.field, add);
  }

  /// nullopt: nothing pulls.
  std::optional<Eigen::VectorXd> solved() {
    if (normal_.trace() <= 0.0) return std::nullopt;
    // The group as a whole is free to move, and nothing may slide along a straight border.
    normal_.diagonal().array() += 1e-3 * normal_.trace() / static_cast<double>(right_.size());
    return normal_.ldlt().solve(right_);
  }

 private:
  Eigen::MatrixXd normal_;
  Eigen::VectorXd right_;
};

}  // namespace

Layout::Layout(const std::vector<Silhouette>& silhouettes, double tolerance)
    : silhouettes_(&silhouettes), tolerance_(tolerance), poses_(silhouettes.size()) {
  groups_.reserve(silhouettes.size());
  members_.reserve(silhouettes.size());
  for (std::size_t i = 0; i < silhouettes.size(); ++i) {
    groups_.push_back(i);
    members_.push_back({i});
  }
}

bool Layout::near(std::size_t a, const Planar& pose_a, std::size_t b, const Planar& pose_b) const {
  const Silhouette& sa = (*silhouettes_)[a];
  const Silhouette& sb = (*silhouettes_)[b];
  const double reach = 0.5 * (glm::distance(sa.low, sa.high) + glm::distance(sb.low, sb.high)) + tolerance_;
  return glm::distance(pose_a(0.5 * (sa.low + sa.high)), pose_b(0.5 * (sb.low + sb.high))) < reach;
}

bool Layout::visit_contacts(std::size_t first, std::size_t second, const Planar& moved,
                            const std::function<bool(const PlacedContact&)>& goes_on) const {
  for (const std::size_t a : members_[first]) {
    for (const std::size_t b : members_[second]) {
      const Planar pose_b = moved * poses_[b];
      if (!near(a, poses_[a], b, pose_b)) continue;
      const Planar relative = inverse(poses_[a]) * pose_b;
      if (!goes_on({a, b, measure_contact((*silhouettes_)[a], (*silhouettes_)[b], relative, tolerance_)}))
        return false;
    }
  }
  return true;
}

std::vector<PlacedContact> Layout::contacts_within(std::size_t group) const {
  std::vector<PlacedContact> contacts;
  const std::vector<std::size_t>& all = members_[group];
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      if (!near(all[i], poses_[all[i]], all[j], poses_[all[j]])) continue;
      const Planar relative = inverse(poses_[all[i]]) * poses_[all[j]];
      contacts.push_back(
          {all[i], all[j],
           measure_contact((*silhouettes_)[all[i]], (*silhouettes_)[all[j]], relative, tolerance_)});
    }
  }
  return contacts;
}

double Layout::support(std::size_t piece) const {
  double sum = 0.0;
  for (const std::size_t other : members_[groups_[piece]]) {
    if (other == piece || !near(piece, poses_[piece], other, poses_[other])) continue;
    const Planar relative = inverse(poses_[piece]) * poses_[other];
    sum += measure_contact((*silhouettes_)[piece], (*silhouettes_)[other], relative, tolerance_).information;
  }
  return sum;
}

void Layout::merge(std::size_t first, std::size_t second, const Planar& moved) {
  for (const std::size_t piece : members_[second]) {
    poses_[piece] = moved * poses_[piece];
    groups_[piece] = first;
    members_[first].push_back(piece);
  }
  members_[second].clear();
  std::sort(members_[first].begin(), members_[first].end());
}

void Layout::take_off(std::size_t piece) {
  std::vector<std::size_t>& from = members_[groups_[piece]];
  if (from.size() == 1) return;
  from.erase(std::find(from.begin(), from.end(), piece));
  // There are as many slots as pieces and at least one group has two, so an empty slot exists.
  const auto slot = std::find_if(members_.begin(), members_.end(), [](const auto& m) { return m.empty(); });
  slot->push_back(piece);
  groups_[piece] = static_cast<std::size_t>(slot - members_.begin());
}

void Layout::spread_error(std::size_t group, double tolerance, int iterations) {
  const std::vector<std::size_t>& all = members_[group];
  for (int iteration = 0; iteration < iterations && all.size() > 1; ++iteration) {
    std::vector<Frame> frames;
    frames.reserve(all.size());
    for (const std::size_t piece : all) {
      const Silhouette& s = (*silhouettes_)[piece];
      frames.push_back({poses_[piece](0.5 * (s.low + s.high)), 0.5 * glm::distance(s.low, s.high)});
    }
    System system(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = 0; j < all.size(); ++j) {
        if (i == j || !near(all[i], poses_[all[i]], all[j], poses_[all[j]])) continue;
        const Pull pull{(*silhouettes_)[all[i]], (*silhouettes_)[all[j]], poses_[all[i]], poses_[all[j]],
                        tolerance};
        system.add(pull, i, frames[i], j, frames[j]);
      }
    }
    const std::optional<Eigen::VectorXd> step = system.solved();
    if (!step) return;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Eigen::Vector3d own = step->segment<3>(static_cast<Eigen::Index>(3 * i));
      const double turn = own[0] / frames[i].arm;
      const Planar rotation{turn, {}, false};
      const glm::dvec2 target = frames[i].centre + glm::dvec2(own[1], own[2]);
      poses_[all[i]] = Planar{turn, target - rotation.direction(frames[i].centre), false} * poses_[all[i]];
    }
  }
}

void Layout::split_loose(std::size_t group, double information) {
  const std::vector<std::size_t> all = members_[group];
  std::vector<std::size_t> part(size());
  for (const std::size_t piece : all) part[piece] = piece;
  const auto root = [&](std::size_t piece) {
    while (part[piece] != piece) piece = part[piece];
    return piece;
  };
  for (const PlacedContact& c : contacts_within(group))
    if (c.contact.information >= information)
      part[std::max(root(c.a), root(c.b))] = std::min(root(c.a), root(c.b));
  for (const std::size_t piece : all)
    if (root(piece) == piece && piece != root(all[0])) take_off(piece);
  for (const std::size_t piece : all) {
    const std::size_t home = root(piece);
    if (groups_[piece] == groups_[home]) continue;
    const Planar stays;
    take_off(piece);
    merge(groups_[home], groups_[piece], stays);
  }
}

}  // namespace rejoin::outline
