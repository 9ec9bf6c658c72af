/// How two placed outlines touch: where, how closely, and how telling that is.
#pragma once

#include <cstddef>
#include <vector>

#include "outline/outline.hpp"

namespace rejoin::outline {

/// Signed distance to a piece's borders, the holes' among them, on a grid: exact near the borders, clamped further away.
class DistanceField {
 public:
  /// \param cell  side of a cell, file units, > 0; enlarged if the grid
  ///   would have more than 2^22 cells   \param reach  distances are exact up to here, file units
  DistanceField(const Outline& outline, double cell, double reach);

  /// Distance to the nearest border, positive in the piece, between -reach and reach; linear between the cells.
  double operator()(const glm::dvec2& point) const;

  /// How many points on, along a border whose points are at most `step` apart, the first one can come that has another value
  /// than -reach if this point lies beyond the field's grid; 1 if it does not.  \pre step > 0
  std::size_t stride(const glm::dvec2& point, double step) const;

  /// Direction in which the distance grows (into the piece), not of unit length; differences over two cells.
  glm::dvec2 gradient(const glm::dvec2& point) const;

 private:
  void measure_border(const std::vector<glm::dvec2>& polygon);
  void sign_inside(const Outline& outline);

  glm::dvec2 origin_{0.0};
  double cell_;
  double reach_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<float> values_;
};

/// A closed run of a silhouette's points.
struct Ring {
  std::size_t begin = 0;
  std::size_t end = 0;
  double step = 0.0;  ///< along the piece's own border between the points, file units
};

/// A piece made ready to be laid beside others: its borders at equal steps, smoothed, and its distance field.  Holes whose
/// border is shorter than 16 steps count as filled: at this scale they have no shape, and mostly they are specks.
struct Silhouette {
  /// \param step  between the points, file units; \param smoothing  of the points, deviation, in steps
  Silhouette(const Outline& outline, double step, double smoothing);

  double step;                      ///< of the outer border
  std::vector<Ring> rings;          ///< the outer border, then the holes
  std::vector<glm::dvec2> points;   ///< on the borders, ring by ring
  std::vector<glm::dvec2> normals;  ///< outward, of unit length
  glm::dvec2 low;                   ///< bounding box
  glm::dvec2 high;
  DistanceField field;
};

/// Calls visit(i, point) for the points of a ring, moved into the field's coordinates, that do not lie far beyond the field's grid.
template <typename Visit>
void visit_near(const Silhouette& shape, const Ring& ring, const Motion& motion, const DistanceField& field,
                const Visit& visit) {
  for (std::size_t i = ring.begin, next = i; i < ring.end; i = next) {
    const glm::dvec2 point = motion(shape.points[i]);
    next = i + field.stride(point, ring.step);
    visit(i, point);
  }
}

/// What measure_contact() counts.  Lengths are means of both sides, in file units.
struct Contact {
  double length = 0.0;       ///< of border within the tolerance of the other's, facing it
  double information = 0.0;  ///< how much better the borders follow each other than chance, in nats; >= 0
  double intrusion =
      0.0;  ///< length of border that lies deeper in the other piece than the tolerance, or along the
            ///< other border on the same side of it, so that both pieces cover the place
  double rms = 0.0;  ///< distance of the borders along the contact
};

/// Lays B on A with a pose and measures.  Both silhouettes have about the same step.
/// \param tolerance  distance up to which borders touch, file units, at most the fields' reach
Contact measure_contact(const Silhouette& a, const Silhouette& b, const Planar& b_to_a, double tolerance);

/// A run of the points of a silhouette's outer border, first to last, cyclic: `first` may be negative and `last` beyond the count.
struct PointRun {
  long first = 0;
  long last = 0;
};

/// A run with its ends moved inwards to where three points in a row touch B's border, and from there outwards as long as A's border does;
/// three points that do not, in a row, end it.
/// \param a_to_b  A's coordinates to B's   \param tolerance  as for measure_contact()
/// \return at most once round A
PointRun grown_run(const Silhouette& a, const Silhouette& b, const Planar& a_to_b, double tolerance,
                   PointRun run);

/// The pose moved so that the borders lie on each other where they are within `tolerance`: least squares of the
/// distances along the contact.
Planar settle(const Silhouette& a, const Silhouette& b, const Planar& b_to_a, double tolerance,
              int iterations = 6);

}  // namespace rejoin::outline
