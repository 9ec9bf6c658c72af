/// Outlines of flat pieces, and how two of them join.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace rejoin::outline {

/// Sine of the angle from a to b times both lengths: positive where b is on the left of a (with y up).
inline double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// Motion of the plane: x -> R(angle) * (flipped ? (x, -y) : (x, y)) + translation.  `flipped`: the piece lies upside down.
struct Planar {
  double angle_rad = 0.0;
  glm::dvec2 translation{0.0};
  bool flipped = false;

  /// The point moved.
  glm::dvec2 operator()(const glm::dvec2& point) const;

  /// A direction moved: turned, not shifted.
  glm::dvec2 direction(const glm::dvec2& v) const;
};

/// A Planar for many points: its sine and cosine are computed once.
class Motion {
 public:
  explicit Motion(const Planar& pose)
      : cos_(std::cos(pose.angle_rad)),
        sin_(std::sin(pose.angle_rad)),
        translation_(pose.translation),
        flipped_(pose.flipped) {}

  glm::dvec2 operator()(const glm::dvec2& point) const { return direction(point) + translation_; }
  glm::dvec2 direction(const glm::dvec2& v) const {
    const double y = flipped_ ? -v.y : v.y;
    return {cos_ * v.x - sin_ * y, sin_ * v.x + cos_ * y};
  }

 private:
  double cos_;
  double sin_;
  glm::dvec2 translation_;
  bool flipped_;
};

inline glm::dvec2 Planar::operator()(const glm::dvec2& point) const {
  return Motion(*this)(point);
}

inline glm::dvec2 Planar::direction(const glm::dvec2& v) const {
  return Motion(*this).direction(v);
}

/// First apply b, then a.
Planar operator*(const Planar& a, const Planar& b);

Planar inverse(const Planar& a);

/// Angle between the turns of two motions, radians in 0 .. pi; pi if just one of them is flipped.
double angle_between(const Planar& a, const Planar& b);

/// The motion without turning over that takes `from` to `to` with the least sum of squared distances.
/// \pre as many points in both, at least one
Planar superposed(const std::vector<glm::dvec2>& from, const std::vector<glm::dvec2>& to);

/// The same motion as a matrix for (x, y, 1); glm is column major: matrix[column][row].
glm::dmat3 matrix(const Planar& pose);

/// A piece's border.  Units and axes are the file's: pixels with y down for pictures.  In these coordinates the border
/// runs so that its shoelace area is positive (counter-clockwise where y points up) and the holes the other way round,
/// so the piece is always on the left of the border if y is drawn upwards.
struct Outline {
  std::vector<glm::dvec2> points;              ///< closed, without a repeated end point; at least 3
  std::vector<std::vector<glm::dvec2>> holes;  ///< closed in the same way; may be empty
  std::vector<glm::dvec3> colour;  ///< of each point, sRGB 0..1, from just inside the border; empty: unknown
  bool of_pixels = false;          ///< taken from a picture
  std::string label = {};          ///< what its file calls it, as a feature's name; empty: nothing
  double raster =
      0.0;  ///< rms distance of the points from the true border where they follow the pixels' steps, file units
};

/// One of an outline's borders: 0 the outer one, k the k-th hole's.  \pre hole <= outline.holes.size()
inline const std::vector<glm::dvec2>& border_of(const Outline& outline, std::size_t hole) {
  return hole == 0 ? outline.points : outline.holes[hole - 1];
}

/// The outer border (0) and the holes, counted from 1, whose borders are `least` long or longer, file units.
std::vector<std::size_t> long_borders(const Outline& outline, double least);

/// A piece with its name.
struct Piece {
  std::string
      name;  ///< unique in its set: the file's name, with "#2" and so on for further pieces of one picture
  std::string path;  ///< where it came from; pictures are read again from here when they are shown
  Outline outline;
  bool y_up = false;  ///< whether its file's y points up, as on maps; pictures and drawings have it down
};

/// Two stretches of two borders that lie along each other: begin_a forward along A, begin_b backward along B
/// (forward where the pose is flipped).
struct Boundary {
  double begin_a =
      0.0;  ///< arc length from A's first point to where the stretch begins, file units, 0 <= begin_a < perimeter
  double begin_b = 0.0;    ///< the same on B, for the point that meets A's begin_a
  double length = 0.0;     ///< mean of the stretch's lengths on A and B, file units
  std::size_t hole_a = 0;  ///< the border of A along which it runs, see border_of(): a hole that B lies in
  std::size_t hole_b = 0;  ///< the same of B
  double longer_b =
      0.0;  ///< by how much the stretch on B is longer than that on A, as on a border that noise has made longer

  double length_a() const { return length - 0.5 * longer_b; }
  double length_b() const { return length + 0.5 * longer_b; }
};

/// One way in which B may join A.
struct JoinCandidate {
  Planar pose;         ///< B's file coordinates -> A's
  double score = 0.0;  ///< 0..1, higher = more likely a join, comparable across pairs
  Boundary boundary;   ///< where the two meet; see join_areas() for what lies between and over each other
};

/// Whether some are from pictures.
bool any_of_pixels(const std::vector<Piece>& pieces);

/// The same join as A on B.
/// \param perimeter_a  of the border along which it runs
JoinCandidate exchanged(const JoinCandidate& join, double perimeter_a, double perimeter_b);

/// A false join's score is hardly ever this high.
inline constexpr double kSureScore = 0.7;

/// What a matcher says of one pair.
struct PairResult {
  std::vector<JoinCandidate> candidates;  ///< best first, distinct poses; empty: nothing fits
};

/// Shoelace area of a closed polygon, positive if counter-clockwise with y up.
double signed_area(const std::vector<glm::dvec2>& polygon);

/// Length of a closed polygon.
double perimeter(const std::vector<glm::dvec2>& polygon);

/// A border that is so many times as long as most others' is in another unit, or is none of a piece.
inline constexpr double kOtherUnit = 200.0;

/// The middle one of the pieces' perimeters, the upper one of an even count.
/// \pre not empty
double median_perimeter(const std::vector<Piece>& pieces);

/// Arc length from the first point to each point, and the perimeter at the end: polygon.size() + 1 numbers.
std::vector<double> arc_lengths(const std::vector<glm::dvec2>& polygon);

/// The point `distance` along a closed polygon (any number; it wraps).
/// \param lengths  arc_lengths(polygon)
glm::dvec2 point_at(const std::vector<glm::dvec2>& polygon, const std::vector<double>& lengths,
                    double distance);

/// A point of a closed polygon: on the edge that begins at point `edge`, `share` (0..1) of its length along.
struct EdgePlace {
  std::size_t edge = 0;
  double share = 0.0;
};

/// Evenly spaced places along a closed polygon, beginning with its first point.
/// \param lengths  arc_lengths() of the polygon
std::vector<EdgePlace> even_places(const std::vector<double>& lengths, std::size_t count);

/// The point at a place of a closed polygon.
glm::dvec2 point_at(const std::vector<glm::dvec2>& polygon, const EdgePlace& place);

}  // namespace rejoin::outline
