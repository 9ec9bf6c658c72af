#include "reassemble.hpp"

#include <algorithm>
#include <map>

#include "outline/detail/clip.hpp"
#include "outline/detail/pose_fit.hpp"
#include "outline/stitch.hpp"

namespace rejoin::bench {
namespace {

using outline::Outline;
using outline::Planar;

constexpr double kSewn = 2.0;    // pixels: narrower gaps are closed when two pieces become one
constexpr double kSure = 0.9;    // joins of this score are sewn side by side
constexpr double kLeast = 0.02;  // below, nothing fits

/// What has been sewn together, in the frame of its first piece.
struct Group {
  std::size_t id = 0;
  outline::Piece piece;
  std::vector<std::pair<std::size_t, Planar>> members;
};

struct Found {
  std::size_t a = 0;
  std::size_t b = 0;
  outline::JoinCandidate join;
};

/// What the scanned pixels cover: the border half a pixel outside their centres.
Outline outer_edge(const Outline& pixels) {
  return {outline::detail::largest(outline::detail::offset({pixels.points}, 0.5, 0.05)), {}, {}};
}

Group sewn(const Group& a, const Group& b, const Planar& pose, std::size_t id) {
  Group result{id, a.piece, a.members};
  for (const auto& [piece, placed] : b.members) result.members.emplace_back(piece, pose * placed);
  std::vector<Outline> united = outline::unite({a.piece.outline, moved(b.piece.outline, pose)}, kSewn);
  result.piece.outline = std::move(united.front());
  result.piece.outline.holes.clear();
  return result;
}

/// Where the unbroken shape lies, so that all pieces are least off.
Planar best_place(const Group& group, const outline::Shattered& broken) {
  std::vector<outline::detail::PointPair> pairs;
  for (const auto& [piece, placed] : group.members) {
    for (const glm::dvec2& p : broken.pieces[piece].border)
      pairs.push_back({placed(p), broken.pieces[piece].to_object(p), glm::dvec2(0.0)});
  }
  const auto& [first, placed] = group.members.front();
  return outline::detail::fit_pose(pairs, placed * inverse(broken.pieces[first].to_object));
}

class Assembly {
 public:
  Assembly(const outline::Shattered& broken, const outline::LcsOptions& options)
      : broken_(broken), matcher_(outline::make_lcs(options)) {
    for (std::size_t k = 0; k < broken.pieces.size(); ++k) {
      groups_.push_back({k, broken.pieces[k].piece, {{k, Planar{}}}});
      groups_.back().piece.outline = outer_edge(groups_.back().piece.outline);
    }
    next_id_ = groups_.size();
  }

  Group run(Reassembly& result) {
    while (groups_.size() > 1) {
      compare();
      const std::vector<Found> chosen = choose();
      if (chosen.empty()) break;
      sew(chosen, result);
    }
    result.whole = groups_.size() == 1;
    return *std::max_element(groups_.begin(), groups_.end(), [](const Group& x, const Group& y) {
      return x.members.size() < y.members.size();
    });
  }

 private:
  /// Pairs that were not compared in an earlier round.
  void compare() {
    std::vector<outline::Piece> pieces;
    for (const Group& group : groups_) pieces.push_back(group.piece);
    matcher_->prepare(pieces);
    for (std::size_t a = 0; a < groups_.size(); ++a) {
      for (std::size_t b = a + 1; b < groups_.size(); ++b) {
        const std::pair<std::size_t, std::size_t> ids{groups_[a].id, groups_[b].id};
        if (known_.find(ids) == known_.end()) known_[ids] = matcher_->match(a, b, Context());
      }
    }
  }

  std::vector<Found> choose() const {
    std::vector<Found> found;
    for (std::size_t a = 0; a < groups_.size(); ++a) {
      for (std::size_t b = a + 1; b < groups_.size(); ++b) {
        const outline::PairResult& result = known_.at({groups_[a].id, groups_[b].id});
        if (!result.candidates.empty() && result.candidates[0].score >= kLeast)
          found.push_back({a, b, result.candidates[0]});
      }
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Found& x, const Found& y) { return x.join.score > y.join.score; });
    std::vector<bool> used(groups_.size(), false);
    std::vector<Found> chosen;
    for (const Found& candidate : found) {
      if (used[candidate.a] || used[candidate.b]) continue;
      if (!chosen.empty() && candidate.join.score < kSure) break;
      used[candidate.a] = used[candidate.b] = true;
      chosen.push_back(candidate);
    }
    return chosen;
  }

  void sew(const std::vector<Found>& chosen, Reassembly& result) {
    std::vector<bool> used(groups_.size(), false);
    std::vector<Group> next;
    for (const Found& found : chosen) {
      next.push_back(sewn(groups_[found.a], groups_[found.b], found.join.pose, next_id_++));
      ++(is_true(next.back()) ? result.joins_true : result.joins_false);
      used[found.a] = used[found.b] = true;
    }
    for (std::size_t k = 0; k < groups_.size(); ++k)
      if (!used[k]) next.push_back(groups_[k]);
    groups_ = std::move(next);
  }

  /// Whether all members lie within 2 pixels of where they belong.
  bool is_true(const Group& group) const {
    const Planar place = best_place(group, broken_);
    for (const auto& [piece, placed] : group.members) {
      for (const glm::dvec2& p : broken_.pieces[piece].border)
        if (glm::distance(placed(p), place(broken_.pieces[piece].to_object(p))) > 2.0) return false;
    }
    return true;
  }

  const outline::Shattered& broken_;
  std::unique_ptr<outline::Matcher> matcher_;
  std::vector<Group> groups_;
  std::map<std::pair<std::size_t, std::size_t>, outline::PairResult> known_;
  std::size_t next_id_ = 0;
};

}  // namespace

Reassembly reassemble(const outline::Shattered& broken, const outline::Shattered& unbroken,
                      const outline::LcsOptions& options) {
  Reassembly result;
  const Group largest = Assembly(broken, options).run(result);
  std::vector<Outline> placed;
  for (const auto& [piece, pose] : largest.members)
    placed.push_back(moved({broken.pieces[piece].border, {}, {}}, pose));
  const outline::ShatteredPiece& object = unbroken.pieces.front();
  const Outline whole = moved({object.border, {}, {}}, best_place(largest, broken) * object.to_object);
  const outline::Misfit misfit = outline::misfit(placed, whole);
  result.overlap = misfit.overlap;
  result.gap = misfit.gap;
  return result;
}

}  // namespace rejoin::bench
