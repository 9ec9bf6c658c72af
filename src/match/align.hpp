/// From a rough pose to the scans' accuracy, and what the joint then looks like.
#pragma once

#include <memory>
#include <optional>

#include "core/rigid.hpp"
#include "match/evidence.hpp"
#include "match/match.hpp"

namespace rejoin::match {

namespace detail {
class JointSides;
}

struct AlignOptions {
  double reach_start = 0;  ///< facing samples farther apart than this do not count at first, mesh units
  double reach_end = 0;    ///< nor than this in the end
  int iterations = 12;
  int most_samples = 400;  ///< of B's samples; 0: all
  bool core_only = false;  ///< leave out what is next to another facet: worn edges lie
  int facet_b = -1;    ///< only samples of this facet of B (match/cuts.hpp); -1: of all its broken surface
  int facet_a = -1;    ///< the same of A's, where `both`
  bool quick = false;  ///< nearest points are looked up in tables: they are nearly the nearest
  bool both =
      false;      ///< A's samples are compared with B's, too: each finds what the other has no samples for
  int half = -1;  ///< 0 or 1: every other of B's broken samples: the two share none; -1: all
};

struct LookOptions {
  int most_samples = 0;  ///< of B's samples are looked at; 0: all
  int facet_b = -1;      ///< only samples of this facet of B touch; -1: all its broken surface
  bool quick =
      false;  ///< as in AlignOptions, for what speaks against the joint; the contact is measured exactly
};

/// Two prepared fragments, indexed for alignment.  Poses are B -> A, both relative to their mesh's origin.
/// Const members may be called from several threads.
class Joint {
 public:
  /// To be judged by the distances of fresh breaks.
  Joint(const Fragment& a, const Fragment& b);

  /// The same, to be judged by those of worn ones.
  Joint worn() const;

  /// The same, for poses that are looked at again: of both pieces look no more samples a patch than where patches are as small as samples
  /// allow.  Worn breaks have larger ones.
  Joint sparse() const;

  ~Joint();

  /// Robust point-to-plane alignment of the facing broken surfaces; for thin pieces the walls across the seam
  /// are lined up too. Gaps are tolerated (worn surfaces recede): outliers weigh nothing (Tukey).
  Rigid align(const Rigid& start, const AlignOptions& options) const;

  /// The direction in which what faces each other, and thin pieces' walls, hold a shift least: along a groove, or the seam of a sherd.
  /// \param reach  as AlignOptions::reach_end
  /// \return unit, A's axes
  glm::dvec3 least_held(const Rigid& pose, double reach) const;

  /// The parameters are those of LookOptions.
  Evidence evidence(const Rigid& pose, int most_samples, int facet_b = -1, bool quick = false) const;

  /// The same, or nullopt, sooner, where the contact alone tells that its strength() is not above the limit.
  std::optional<Evidence> evidence_above(double limit, const Rigid& pose, const LookOptions& options) const;

  /// The evidence of all samples, with what both surfaces agree on.  What the shape is worth is the geometric mean of what B's
  /// samples over A and A's over B say: shape that one of the two has alone, as a rough break on a plane, says nothing.  Of the
  /// continuation the lesser counts.
  Evidence agreed_evidence(const Rigid& pose) const;

  /// The same as evidence_above() is to evidence().
  std::optional<Evidence> agreed_evidence_above(double limit, const Rigid& pose) const;

  /// The geometric means of both ways, as in agreed_evidence().
  Scales scales(const Rigid& pose) const;

  /// contact_tolerance() of the two, as they are judged.
  double tolerance() const;

  /// Of the thinner wall, mesh units; 0 if not both pieces are thin.
  double thickness() const;

 private:
  explicit Joint(std::unique_ptr<const detail::JointSides> sides);

  std::unique_ptr<const detail::JointSides> sides_;
  std::unique_ptr<const detail::JointSides> exchanged_;
};

}  // namespace rejoin::match
