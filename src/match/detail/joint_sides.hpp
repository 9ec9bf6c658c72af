/// Two fragments' samples, indexed to look from one to the other.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "match/match.hpp"
#include "mesh/near_table.hpp"
#include "mesh/point_index.hpp"

namespace rejoin::match::detail {

inline constexpr float kFacing = -0.5F;    ///< facing normals differ from opposite by at most 60 degrees
inline constexpr double kWallNear = 1.2;   ///< wall thicknesses from the seam in which walls are compared
inline constexpr float kWallAlike = 0.7F;  ///< wall normals across a seam differ by at most 45 degrees

/// Samples of one class of one fragment.
struct Cloud {
  std::vector<glm::vec3> points;
  std::vector<glm::vec3> normals;
  std::vector<float> areas;  ///< that points stand for
  std::vector<bool> backed;  ///< of `broken`: mesh::Segmentation::backed
  std::vector<bool> edge;    ///< next to another facet: worn, of no use for the relief
};

/// Box of points; empty without any.
mesh::Box box_of(const std::vector<glm::vec3>& points);

/// Looks for the point of a cloud that is nearest to another.
class Finder {
 public:
  /// \param table  for nearly the nearest point, sooner; nullptr: exactly
  Finder(const mesh::PointIndex& index, const mesh::NearTable* table) : index_(&index), table_(table) {}

  std::optional<std::pair<std::uint32_t, float>> within(const glm::vec3& point, double radius) const {
    const auto r = static_cast<float>(radius);
    return table_ != nullptr ? table_->nearest_within(point, r) : index_->nearest_within(point, r);
  }

  /// \param known  of the point's last look by this finder; not used with a table
  std::optional<std::pair<std::uint32_t, float>> within(const glm::vec3& point, double radius,
                                                        mesh::PointIndex::Known& known) const {
    const auto r = static_cast<float>(radius);
    return table_ != nullptr ? table_->nearest_within(point, r) : index_->nearest_within(point, r, known);
  }

 private:
  const mesh::PointIndex* index_;
  const mesh::NearTable* table_;
};

/// One fragment; copies share the indices.
struct Side {
  bool open = false;  ///< the scan lacks surface: walls with nothing behind them count as broken
  Cloud broken;
  Cloud walls;  ///< thin pieces: original surface near the fracture
  Cloud body;   ///< every sample
  std::shared_ptr<const mesh::PointIndex> broken_index;
  std::shared_ptr<const mesh::PointIndex> wall_index;
  std::shared_ptr<const mesh::PointIndex> body_index;
  mesh::Box broken_box;  ///< of `broken`
  mesh::Box wall_box;    ///< of `walls`
  mesh::Box body_box;    ///< of `body`
  std::size_t step = 1;  ///< samples for one in `all_body` and `all_broken`: these look at the other fragment
  std::vector<std::uint32_t> all_body;    ///< 0, step, ... into `body`
  std::vector<std::uint32_t> all_walls;   ///< 0, 1, ... into `walls`
  std::vector<std::uint32_t> all_broken;  ///< 0, step, ... into `broken`
  std::vector<std::vector<std::uint32_t>>
      broken_of_facet;  ///< all into `broken`; by match/cuts.hpp's numbers
  /// The broken samples of one facet; of all for -1.
  const std::vector<std::uint32_t>& broken_of(int facet) const {
    return facet < 0 ? all_broken : broken_of_facet[static_cast<std::size_t>(facet)];
  }
  /// Samples that each of these stands for.
  double each_of(int facet) const { return facet < 0 ? static_cast<double>(step) : 1.0; }
};

/// What both fragments' scans allow, mesh units.
struct JointLengths {
  double thickness = 0;  ///< of the thinner wall; 0 if not both are thin
  double spacing = 0;    ///< of the sparser samples
  double tolerance = 0;  ///< distance below which surfaces touch
  double noise = 0;      ///< of the scans
  /// Gap spread that the scans' errors explain at most, or that tells nothing; infinite where these are not known.
  double explained = std::numeric_limits<double>::infinity();
  double patch = 0;           ///< side of a patch of surface whose relief is independent of the next one's
  double worn_tolerance = 0;  ///< tolerance for worn breaks

  double deepest = 0;  ///< how deep a body's surface can lie in the other one's
};

/// Seen from A: B's points are looked for among A's.  Const members may be called from several threads.
class JointSides {
 public:
  JointSides(const Fragment& a, const Fragment& b);

  /// To be judged by the distances of worn breaks; shares the samples.
  std::unique_ptr<const JointSides> worn() const;

  /// Joint::sparse(); shares what is looked for.
  std::unique_ptr<const JointSides> sparse() const;

  /// A and B exchanged; shares the samples.
  std::unique_ptr<const JointSides> exchanged() const;

  const Side& a() const { return *a_; }
  const Side& b() const { return *b_; }
  const JointLengths& lengths() const { return lengths_; }

  /// Look for points of A: broken surface, walls, all.
  /// \param quick  in tables, made when first asked: nearly the nearest
  Finder broken_finder(bool quick) const {
    return {*a_->broken_index, quick ? &ready_tables().broken : nullptr};
  }
  Finder wall_finder(bool quick) const { return {*a_->wall_index, quick ? &ready_tables().walls : nullptr}; }
  Finder body_finder(bool quick) const { return {*a_->body_index, quick ? &ready_tables().body : nullptr}; }

 private:
  /// Of A.
  struct Tables {
    mesh::NearTable broken;
    mesh::NearTable walls;
    mesh::NearTable body;
  };

  JointSides(std::shared_ptr<const Side> a, std::shared_ptr<const Side> b, const JointLengths& lengths)
      : lengths_(lengths), a_(std::move(a)), b_(std::move(b)) {}
  const Tables& ready_tables() const;

  JointLengths lengths_;
  std::shared_ptr<const Side> a_;
  std::shared_ptr<const Side> b_;
  mutable Tables tables_;
  mutable std::once_flag made_tables_;
};

/// A pose in single precision, for samples.
class Move {
 public:
  explicit Move(const Rigid& pose) : rotation_(pose.rotation), shift_(pose.translation) {}
  glm::vec3 operator()(const glm::vec3& point) const { return rotation_ * point + shift_; }
  glm::vec3 direction(const glm::vec3& d) const { return rotation_ * d; }

 private:
  glm::mat3 rotation_;
  glm::vec3 shift_;
};

/// Some samples of many.
struct Chosen {
  std::vector<std::uint32_t> list;
  double each = 1;  ///< samples that one of them stands for
};

/// Evenly chosen samples that come to lie in a box grown by `reach`: those of about `most` of all that do or, if these are less than a third of
/// `most`, denser ones, as of a piece much larger than the other one only few lie near it.
/// \param most  <= 0: all of `from`, wherever they lie
Chosen chosen_in(const mesh::Box& box, double reach, const std::vector<glm::vec3>& points,
                 const std::vector<std::uint32_t>& from, const Move& move, int most);

}  // namespace rejoin::match::detail
