/// What is known about a joint beforehand: which poses are searched, and what is added to the matching error.
/// \source papaioannou 2002, section 5
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "anneal/anneal.hpp"
#include "match/match.hpp"
#include "match/pose_space.hpp"
#include "zbuffer/scorer.hpp"

namespace rejoin::match {

/// How the material axes act.
enum class MaterialUse { None, Restrict, Bias };

/// Figure 11: the kind of search that the available constraints ask for.
struct ConstraintPlan {
  bool directions = false;  ///< fracture directions restrict the search
  MaterialUse material = MaterialUse::None;
};

/// Applies figure 11: material axes alone restrict; beside fracture directions they only bias.  (The overlap
/// bias goes with everything; see EnergyRule.)  Directions or axes that are given count as available whatever
/// options.constraint says, and so do the directions of facets that are named; options.constraint asks for one that
/// must then be found (Direction) or given (Material).
/// \throws InputError only one fragment's axis is given, Material is asked for without axes, an axis or a direction
///                    has no length, or the tolerance is out of range
ConstraintPlan plan_constraints(const Options& options);

/// A set of poses: seven variables and what they mean.
struct SearchSpace {
  std::vector<anneal::Variable> variables;  ///< in the order of PoseIndex
  Alignment alignment;
  RotationOrder order = RotationOrder::ZLast;
  bool locked = false;  ///< theta2 and phi2 hold the jitter about -theta1 and phi1 + pi
  std::vector<glm::dvec2>
      shift_of_rho;  ///< added to (x1, y1): samples over a turn of rho1, linear between; or empty

  /// The view that a point of the space stands for.  \pre point.size() == kPoseSize
  zbuffer::ViewPair view(std::span<const double> point) const;
};

/// All poses: angles 0 .. 2 pi, |x1|, |y1| <= reach.
/// \param reach  the paper's is 0.1 R, R the larger diameter of the two fragments; mesh units
SearchSpace free_space(double reach);

/// Facing fracture directions: each is laid along its Z axis; theta and phi of both stay within +-tolerance.
/// \param direction_a, direction_b  outwards, file axes, any length but 0
SearchSpace direction_space(const glm::dvec3& direction_a, const glm::dvec3& direction_b,
                            double tolerance_rad, double reach);

/// Collinear material axes: each is laid along Z, fragment 1 turns about Z first, theta2 = -theta1 and
/// phi2 = phi1 + pi, each with a jitter of +-jitter.
/// \param opposite  lays B's axis along -Z: an axis has no sign, so both spaces have to be searched
/// \source papaioannou 2002, section 5.2.1; deviation: the jitter is searched for (two more variables) rather
/// than
///         random, and both senses of the axis are available.
SearchSpace material_space(const glm::dvec3& axis_a, const glm::dvec3& axis_b, double jitter_rad,
                           double reach, bool opposite);

/// Fills space.shift_of_rho: for evenly spread rho1 (the other variables 0) the shift of fragment 1 at which
/// the silhouettes cover each other best, so that x1 and y1 search around the largest overlap. \source
/// papaioannou 2002, section 5.2.2, step b; deviation: done for `samples` rotations rather than for one, as
///         the best shift turns with rho1.
void centre_on_silhouettes(SearchSpace& space, zbuffer::Scorer& scorer, double view_side, int samples);

/// Pixels across a map from which on EnergyRule::least_pixels holds as it is.
inline constexpr int kFineMap = 32;

/// What is minimised.
struct EnergyRule {
  bool overlap_bias = true;     ///< lambda_d = min(A_S1, A_S2) / A_S, else 1
  double least_overlap = 0.05;  ///< share of the smaller silhouette below which a pose is forbidden, 0 .. 1
  /// N_S below which a pose is forbidden: slivers seen edge-on fit anything.  Of maps of kFineMap pixels across and more.
  int least_pixels = 32;
  double material_weight =
      0.1;  ///< lambda_mat, 0 .. 1; e_d's weight is 1 - lambda_mat.  Used with material_axes
  std::optional<std::pair<glm::dvec3, glm::dvec3>> material_axes;  ///< unit, file axes of A and B
};

/// The rule for maps of `resolution` pixels across: of coarser ones than kFineMap, which show whole fragments in a few pixels,
/// least_pixels is the same share of the map as there.
EnergyRule at_resolution(EnergyRule rule, int resolution);

/// e = lambda_d e_d + lambda_mat (1 - |a1 . a2|), +infinity for forbidden poses.
/// \source papaioannou 2002, eq. (11) and section 5.1; deviation: lambda_d of the overlap bias is multiplied
/// by
///         1 - lambda_mat; least_overlap and least_pixels (the paper sets no lower limit).
double energy(const zbuffer::PairScore& score, const zbuffer::ViewPair& view, const EnergyRule& rule);

}  // namespace rejoin::match
