/// Sewing two placed pieces together: the seam, its gaps and overlaps, and the united piece.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "outline/outline.hpp"

namespace rejoin::outline {

struct SeamOptions {
  double tolerance = 2.0;  ///< pairs further apart do not belong to the seam, file units
  int misses = 3;          ///< so many of them in a row end the seam
};

/// Where two borders lie along each other.
struct Seam {
  /// Indices of points of A and B that lie side by side: A's go up, B's go down (up if B lies upside down), both cyclic.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  double length = 0.0;        ///< of the seam along A, file units
  double gap_area = 0.0;      ///< between the two along the seam
  double overlap_area = 0.0;  ///< covered by both along the seam
  double mean_gap = 0.0;      ///< mean signed distance of B outside A
  double residual = 0.0;      ///< deviation of that distance
};

/// Grows a seam from one pair of points in both directions: to the next point of A belongs the nearest of the next few
/// points of B, if it is near enough.
/// \param a, b  evenly sampled closed borders, positive area, the same spacing
/// \param pose  B's coordinates to A's
/// \source naiman 2018, sections 7.3 (micro-stitching) and 7.4 (gap and overlap along the seam); deviation: the tolerance is
///         given, not 0.4 of the mean distance of the matches
Seam find_seam(const std::vector<glm::dvec2>& a, const std::vector<glm::dvec2>& b, const Planar& pose,
               std::pair<std::uint32_t, std::uint32_t> start, const SeamOptions& options);

/// Area that both pieces cover, whole pieces, holes left out.
/// \source naiman 2018, section 7.4, the check of the union
double overlap_area(const Outline& a, const Outline& b, const Planar& pose);

/// Areas of a join in file units squared.
struct JoinAreas {
  double gap =
      0.0;  ///< between the two stretches of the boundary and the lines between their ends, in neither piece
  double overlap = 0.0;  ///< covered by both pieces, anywhere
};

/// The areas of a join of the outlines as the files have them, by polygons: exact but for the rounding of coordinates to
/// 1e-9 of the pieces' extent.  The same for every method.
JoinAreas join_areas(const Outline& a, const Outline& b, const JoinCandidate& join);

/// Outlines that are placed in one frame, as one region: the area between them that is narrower than `tolerance` belongs to
/// it.  One outline for each connected part, largest first.
/// \param tolerance  file units; 0: only where they touch or overlap
std::vector<Outline> unite(const std::vector<Outline>& placed, double tolerance);

/// An outline moved; its borders keep their sense.
Outline moved(const Outline& outline, const Planar& pose);

/// Widest places, as the diameters of the largest discs that fit in, to 0.05 of a file unit.
struct Misfit {
  double overlap = 0.0;  ///< of what two or more pieces cover
  double gap = 0.0;      ///< of what is missing of the whole
  double excess = 0.0;   ///< of what sticks out of the whole
};

/// How placed pieces fill the object that they are known to come from.
/// \param whole  in the frame of the placed pieces
Misfit misfit(const std::vector<Outline>& placed, const Outline& whole);

}  // namespace rejoin::outline
