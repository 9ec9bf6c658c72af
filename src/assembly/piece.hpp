/// A fragment as assembly looks at it: where it touches others, and where it would be inside them.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "assembly/depth_bound.hpp"
#include "match/gap.hpp"
#include "match/match.hpp"
#include "mesh/point_index.hpp"

namespace rejoin::assembly {

/// Points with unit normals, relative to the fragment's origin.
struct Points {
  std::vector<glm::vec3> at;
  std::vector<glm::vec3> normals;
  std::vector<float> areas;  ///< of `broken` alone: that each stands for
};

/// Const members may be called from several threads.
class Piece {
 public:
  /// \param fragment  kept by reference, must outlive the piece
  explicit Piece(const match::Fragment& fragment);

  const match::Fragment& fragment() const { return *fragment_; }
  const Points& broken() const { return broken_; }  ///< samples of the broken surface
  const Points& body() const { return body_; }      ///< samples of all of it, about 2,500
  const mesh::PointIndex& broken_index() const { return *broken_index_; }
  double body_area() const { return body_area_; }  ///< that one body sample stands for
  double spacing() const { return fragment_->facets.samples.spacing; }
  double area() const { return body_area_ * static_cast<double>(body_.at.size()); }

  glm::dvec3 centre() const { return centre_; }  ///< of the ball around it, file coordinates
  double radius() const { return radius_; }

  /// Whether a point lies inside, deeper than `depth` (>= 0, mesh units); false where an open border makes it uncertain.
  /// \param point  file coordinates
  bool holds(const glm::dvec3& point, double depth) const;

 private:
  const match::Fragment* fragment_;
  Points broken_;
  Points body_;
  std::unique_ptr<mesh::PointIndex> broken_index_;
  std::unique_ptr<match::GapField> gap_;
  std::unique_ptr<DepthBound> most_depth_;
  std::vector<bool> on_border_;  ///< faces with a corner on an open edge
  double body_area_ = 0;
  glm::dvec3 centre_{0.0};
  double radius_ = 0;
};

/// Two of b's and a's broken points that face each other.
struct Facing {
  glm::dvec3 on_a;       ///< a's file coordinates
  glm::dvec3 normal_a;   ///< a's axes
  glm::dvec3 on_b;       ///< b's file coordinates
  double area_of_b = 0;  ///< that b's point stands for, and those that are left out after it
};

/// b's broken points with their nearest neighbours on a's broken surface, within `reach` and face to face.
/// \param most  about how many are returned at most; 0: all
std::vector<Facing> facing_points(const Piece& a, const Piece& b, const Rigid& b_to_a, double reach,
                                  std::size_t most);

/// Whether the balls around two pieces come within a distance of each other.
bool are_near(const Piece& a, const Piece& b, const Rigid& b_to_a, double distance);

struct Touch {
  double area = 0;                                              ///< squared mesh units
  double gap_median = std::numeric_limits<double>::infinity();  ///< mesh units
};

/// The broken surfaces' contact: both figures as in match::Evidence.
Touch touch(const Piece& a, const Piece& b, const Rigid& b_to_a);

/// Contact below this share of the smaller piece's surface is none.
inline constexpr double kContact = 0.001;

/// Whether two pieces that must not join touch: more than two corners that meet do.
bool touch_forbidden(const Piece& a, const Piece& b, const Rigid& b_to_a);

/// Whether two pieces cannot lie as they do: more than 3 % of the smaller one's surface lies clearly inside the other (both ways added up),
/// or has both insides under it, which tells solids that coincide.
bool interpenetrate(const Piece& a, const Piece& b, const Rigid& b_to_a);

/// The same for poses that nobody searched: a twentieth of that surface is enough, as that of sherds which cross at a corner.
bool cross(const Piece& a, const Piece& b, const Rigid& b_to_a);

}  // namespace rejoin::assembly
