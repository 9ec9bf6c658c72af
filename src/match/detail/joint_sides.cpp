#include "match/detail/joint_sides.hpp"

#include <cmath>
#include <numeric>

#include "mesh/neighbours.hpp"

namespace rejoin::match::detail {
namespace {

constexpr double kWallClear = 0.25;  // wall thicknesses next to the seam that are left out: worn edges lie
constexpr double kOpen = 0.05;  // of the surface has nothing behind it, of a scan whose walls may be missing
constexpr double kCannotTell = 0.2;  // tolerances: gap spread of joints as good as any
constexpr double kExplained = 5.0;   // deviations of both surfaces that sides of a break may lie apart by
constexpr double kPatch = 2.5;       // spacings: side of a patch of fresh surface, at least
constexpr double kWornPatch = 10.0;  // tolerances: side of a patch of worn surface, as of sherds
constexpr double kWornNoise = 1.0 / 6.0;  // tolerances, as of coarse scans
constexpr double kWornDepth =
    25.0;  // tolerances that surfaces lie in each other by at most, as of coarse scans
constexpr double kTableCell = 2.0;      // spacings: side of the cells of tables of near points
constexpr double kTableReach = 20.0;    // tolerances: how far a quick alignment looks
constexpr double kEnough = 1.0 / 3.0;   // of the samples asked for, at least, where the other piece is
constexpr double kWallTableCell = 3.0;  // the same for walls, which are smooth

Side side_of(const mesh::Segmentation& s, double edge_radius) {
  Side side;
  side.open = mesh::unbacked_share(s) > kOpen;
  side.body.points = s.samples.points;
  side.body.normals = s.normals;
  side.body.areas = s.samples.areas;
  side.all_body.resize(s.samples.size());
  std::iota(side.all_body.begin(), side.all_body.end(), 0U);
  side.body_index = std::make_shared<const mesh::PointIndex>(side.body.points);
  const mesh::Neighbours neighbours(side.body.points, static_cast<float>(edge_radius));
  side.broken_of_facet.resize(s.facets.size() + s.creased.facets.size());
  for (std::size_t i = 0; i < s.samples.size(); ++i) {
    if (s.surface[i] != mesh::Surface::Fracture) continue;
    const auto number = static_cast<std::uint32_t>(side.broken.points.size());
    side.all_broken.push_back(number);
    if (s.facet_of_sample[i] >= 0) {
      side.broken_of_facet[static_cast<std::size_t>(s.facet_of_sample[i])].push_back(number);
    }
    if (!s.creased.facets.empty() && s.creased.facet_of_sample[i] >= 0) {
      const auto facet = s.facets.size() + static_cast<std::size_t>(s.creased.facet_of_sample[i]);
      side.broken_of_facet[facet].push_back(number);
    }
    side.broken.points.push_back(s.samples.points[i]);
    side.broken.normals.push_back(s.normals[i]);
    side.broken.areas.push_back(s.samples.areas[i]);
    side.broken.backed.push_back(s.backed[i]);
    side.broken.edge.push_back(neighbours.any(
        s.samples.points[i], [&](std::uint32_t k) { return s.facet_of_sample[k] != s.facet_of_sample[i]; }));
  }
  side.broken_index = std::make_shared<const mesh::PointIndex>(side.broken.points);
  if (s.wall_thickness > 0) {
    for (std::size_t i = 0; i < s.samples.size(); ++i) {
      if (s.surface[i] != mesh::Surface::Original) continue;
      const auto seam = side.broken_index->nearest_within(s.samples.points[i],
                                                          static_cast<float>(kWallNear * s.wall_thickness));
      if (!seam || seam->second < kWallClear * s.wall_thickness) continue;
      side.all_walls.push_back(static_cast<std::uint32_t>(side.walls.points.size()));
      side.walls.points.push_back(s.samples.points[i]);
      side.walls.normals.push_back(s.normals[i]);
      side.walls.areas.push_back(s.samples.areas[i]);
    }
  }
  side.wall_index = std::make_shared<const mesh::PointIndex>(side.walls.points);
  side.broken_box = box_of(side.broken.points);
  side.wall_box = box_of(side.walls.points);
  side.body_box = box_of(side.body.points);
  return side;
}

JointLengths lengths_of(const Fragment& a, const Fragment& b) {
  const double scan = std::max(a.resolution, b.resolution);
  JointLengths l;
  l.thickness = thinner_wall(a, b);
  l.spacing = samples_spacing(a, b);
  l.tolerance = contact_tolerance(a, b, Breaks::Fresh);
  l.worn_tolerance = contact_tolerance(a, b, Breaks::Worn);
  l.noise = 0.05 * scan;
  l.explained = std::max(kCannotTell * l.tolerance, kExplained * std::hypot(a.waviness, b.waviness));
  l.deepest = l.thickness > 0 ? 0.6 * l.thickness : 8.0 * l.spacing;
  l.patch = std::max({0.5 * joint_ruler(a, b), kPatch * l.spacing, kPatch * scan});
  return l;
}

/// With samples as dense as they are to be.
std::shared_ptr<const Side> side_of(const Fragment& fragment, const JointLengths& lengths) {
  const double edge = std::max(0.2 * lengths.thickness, 1.2 * lengths.spacing);
  if (fragment.facets.samples.spacing <= lengths.spacing)
    return std::make_shared<const Side>(side_of(fragment.facets, edge));
  return std::make_shared<const Side>(
      side_of(mesh::denser(fragment.facets, open_surface(fragment), lengths.spacing), edge));
}

/// \pre no sample of the side was left out before
std::shared_ptr<const Side> with_fewer_looks(const std::shared_ptr<const Side>& side, std::size_t step) {
  if (step < 2) return side;
  Side fewer = *side;
  fewer.step = step;
  const auto left_out = [&](std::uint32_t i) { return i % step != 0; };
  std::erase_if(fewer.all_body, left_out);
  std::erase_if(fewer.all_broken, left_out);
  return std::make_shared<const Side>(std::move(fewer));
}

bool is_in(const mesh::Box& box, const glm::vec3& p) {
  return glm::all(glm::lessThanEqual(box.low, p)) && glm::all(glm::lessThanEqual(p, box.high));
}

}  // namespace

mesh::Box box_of(const std::vector<glm::vec3>& points) {
  return points.empty() ? mesh::Box{glm::vec3(1.0F), glm::vec3(-1.0F)} : mesh::bounds(points);
}

Chosen chosen_in(const mesh::Box& box, double reach, const std::vector<glm::vec3>& points,
                 const std::vector<std::uint32_t>& from, const Move& move, int most) {
  if (most <= 0 || from.size() <= static_cast<std::size_t>(most)) return {from};
  const auto more = glm::vec3(static_cast<float>(reach));
  const mesh::Box grown{box.low - more, box.high + more};
  const auto near = [&](std::size_t step) {
    std::vector<std::uint32_t> list;
    for (std::size_t k = 0; k < from.size(); k += step)
      if (is_in(grown, move(points[from[k]]))) list.push_back(from[k]);
    return list;
  };
  const std::size_t step = from.size() / static_cast<std::size_t>(most);
  const auto enough = static_cast<std::size_t>(kEnough * most);
  Chosen chosen{near(step), static_cast<double>(step)};
  if (step == 1 || chosen.list.size() >= enough) return chosen;
  const std::vector<std::uint32_t> all = near(1);
  const std::size_t fewer = std::max<std::size_t>(1, all.size() / std::max<std::size_t>(1, enough));
  chosen = {{}, static_cast<double>(fewer)};
  for (std::size_t k = 0; k < all.size(); k += fewer) chosen.list.push_back(all[k]);
  return chosen;
}

JointSides::JointSides(const Fragment& a, const Fragment& b) : lengths_(lengths_of(a, b)) {
  a_ = side_of(a, lengths_);
  b_ = side_of(b, lengths_);
}

std::unique_ptr<const JointSides> JointSides::worn() const {
  JointLengths lengths = lengths_;
  lengths.tolerance = lengths_.worn_tolerance;
  lengths.explained = std::max(lengths_.explained, kCannotTell * lengths.tolerance);
  lengths.patch = std::max(lengths_.patch, kWornPatch * lengths.tolerance);
  lengths.noise = std::max(lengths_.noise, kWornNoise * lengths.tolerance);
  lengths.deepest = std::max(lengths_.deepest, kWornDepth * lengths.tolerance);
  return std::unique_ptr<const JointSides>(new JointSides(a_, b_, lengths));
}

std::unique_ptr<const JointSides> JointSides::sparse() const {
  const double larger = lengths_.patch / (kPatch * lengths_.spacing);
  const auto step = static_cast<std::size_t>(larger * larger);
  return std::unique_ptr<const JointSides>(
      new JointSides(with_fewer_looks(a_, step), with_fewer_looks(b_, step), lengths_));
}

std::unique_ptr<const JointSides> JointSides::exchanged() const {
  return std::unique_ptr<const JointSides>(new JointSides(b_, a_, lengths_));
}

const JointSides::Tables& JointSides::ready_tables() const {
  std::call_once(made_tables_, [this] {
    const auto table = [](const Cloud& cloud, double cell, double reach) {
      return mesh::NearTable(cloud.points, static_cast<float>(cell), static_cast<float>(reach));
    };
    const double near = kWallNear * lengths_.thickness;
    tables_.broken =
        table(a_->broken, kTableCell * lengths_.spacing, std::max(kTableReach * lengths_.tolerance, near));
    tables_.body = table(a_->body, kTableCell * lengths_.spacing, lengths_.deepest);
    if (lengths_.thickness > 0) {
      tables_.walls =
          table(a_->walls, kWallTableCell * lengths_.spacing, near + 0.5 * kTableReach * lengths_.tolerance);
    }
  });
  return tables_;
}

}  // namespace rejoin::match::detail
