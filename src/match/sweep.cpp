#include "match/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <mutex>
#include <utility>

#include "core/angle.hpp"
#include "core/parallel.hpp"
#include "match/cuts.hpp"
#include "match/strip.hpp"
#include "mesh/neighbours.hpp"

namespace rejoin::match {
namespace {

constexpr double kAcross = 5.0;   // pixels across a strip, at least
constexpr double kSide = 18.0;    // pixels in the root of a facet's area, at least
constexpr double kLarger = 36.0;  // and in that of the larger facet's: a part of it may be all that joins,
constexpr double kFine = 2.0;     // but only as far as pixels are that many of the scans' resolution
constexpr double kMost = 512.0;   // pixels in the root of the larger map, at most: else maps take gigabytes
constexpr double kFinest = 0.7;   // of the scans' resolution: below it there is nothing to see
constexpr double kCoarse = 1.6;   // pixels of a first look at plates against those of the second,
constexpr double kWorthALook = 1.3;  // and at least: looks with hardly larger pixels save nothing
constexpr double kTurnsKept = 0.15;  // share of a first look's turns that get a second
constexpr std::size_t kLeastTurns = 3;
constexpr double kSlack = 0.25;  // of a step of the second look, by which its turns may lie further apart
constexpr int kPeaksNear = 200;  // a turn, where all but those near a rough pose are dropped
constexpr double kWorn = 0.18;   // wall thicknesses from a wall, where a break is taken for worn,
constexpr double kLeastUnworn = 0.3;  // unless less than that of a facet lies farther
constexpr double kSmallFacet = 0.02;  // of the largest facet's area: too small to tell
constexpr double kLargeFacet = 0.25;  // of the largest facet's area: may join with a part alone

/// Pixel size of the maps, mesh units.
double pitch_for(const FacetPatch& a, const FacetPatch& b, double resolution) {
  const double finer = are_strips(a, b)
                           ? std::min(a.across, b.across) / kAcross
                           : std::max(std::sqrt(std::max(a.area, b.area)) / kLarger, kFine * resolution);
  const double pitch = std::min(std::sqrt(std::min(a.area, b.area)) / kSide, finer);
  return std::max(pitch, std::sqrt(std::max(a.length * a.width, b.length * b.width)) / kMost);
}

std::vector<double> turns_for(const FacetPatch& a, const FacetPatch& b, double step) {
  if (are_strips(a, b)) return turns_along(a, b, step);
  const int count = static_cast<int>(std::ceil(kTurn / step));
  std::vector<double> turns;
  turns.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) turns.push_back(kTurn * k / count);
  return turns;
}

/// Rotation of b's patch against a's frame: the half turn, then the turn.
glm::dmat3 facing(double turn_rad) {
  const glm::dmat3 half_turn(-1, 0, 0, 0, 1, 0, 0, 0, -1);
  return axis_rotation({0, 0, 1}, turn_rad) * half_turn;
}

/// The turns that may come near the rough pose; all without one.
std::vector<double> turns_near(const std::optional<Near>& near, const FacetPatch& a, const FacetPatch& b,
                               std::vector<double> turns) {
  if (!near) return turns;
  const auto far = [&](double turn) {
    return !near->may_become(a.frame * facing(turn) * glm::transpose(b.frame));
  };
  turns.erase(std::remove_if(turns.begin(), turns.end(), far), turns.end());
  return turns;
}

/// Pose of a peak: the half turn, the turn, the shift; then the tilt of the plane between the two; then contact at the mean height.
Rigid pose_of_peak(const FacetPatch& a, const FacetPatch& b, const ReliefMap& map_a, const ReliefMap& map_b,
                   const Agreement& peak, double turn_rad) {
  const glm::dvec2 shift = map_a.low - map_b.low + map_a.pitch * glm::dvec2(peak.shift_u, peak.shift_v);
  const PlaneBetween plane = plane_between(map_a, map_b, peak.shift_u, peak.shift_v);
  const Rigid in_plane{facing(turn_rad), glm::dvec3(shift, plane.offset)};
  const double slope = glm::length(plane.tilt);
  Rigid tilt;
  if (slope > 1e-9) {
    const glm::dvec3 axis(plane.tilt.y / slope, -plane.tilt.x / slope, 0.0);
    tilt.rotation = axis_rotation(axis, std::atan(slope));
    const glm::dvec3 pivot(plane.middle, 0.0);
    tilt.translation = pivot - tilt.rotation * pivot;
  }
  const Rigid from_a{a.frame, a.centre};
  const Rigid from_b{b.frame, b.centre};
  return from_a * tilt * in_plane * inverse(from_b);
}

bool better(const SweepHit& x, const SweepHit& y) {
  if (x.agreement.score != y.agreement.score) return x.agreement.score > y.agreement.score;
  if (x.facet_a != y.facet_a) return x.facet_a < y.facet_a;
  if (x.facet_b != y.facet_b) return x.facet_b < y.facet_b;
  return x.turn_rad < y.turn_rad;
}

/// How far two poses put points apart that lie about `reach` from `centre` (in B's frame), root mean square.
double pose_distance(const Rigid& x, const Rigid& y, const glm::dvec3& centre, double reach) {
  const glm::dmat3 d = x.rotation - y.rotation;
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) sum += glm::dot(d[k], d[k]);
  const glm::dvec3 t = x(centre) - y(centre);
  return std::sqrt(glm::dot(t, t) + sum * reach * reach / 3.0);
}

/// The best `most` and, of every pair of facets, the best `of_each`: foot rings and rims that are taken for breaks lie in each other
/// in so many ways that they would take all places.
std::vector<SweepHit> distinct(std::vector<SweepHit> hits, double near, const glm::dvec3& centre,
                               double reach, std::size_t most, std::size_t of_each = 0) {
  std::sort(hits.begin(), hits.end(), better);
  std::vector<SweepHit> kept;
  std::map<std::pair<int, int>, std::size_t> taken;
  for (const auto& hit : hits) {
    if (of_each == 0 && kept.size() >= most) break;
    std::size_t& of_these = taken[{hit.facet_a, hit.facet_b}];
    if (kept.size() >= most && of_these >= of_each) continue;
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const SweepHit& other) {
      return pose_distance(hit.pose, other.pose, centre, reach) < near;
    });
    if (known) continue;
    kept.push_back(hit);
    ++of_these;
  }
  return kept;
}

/// A facet that may join.
struct SweptFacet {
  int facet = -1;    ///< match/cuts.hpp
  FacetPatch patch;  ///< the facet, or a part of it, whose outline says nothing
};

struct Task {
  const SweptFacet* a;
  const SweptFacet* b;
  float outline_weight;
};

double turn_step(const FacetPatch& a, const FacetPatch& b, double pitch, double step_px) {
  return std::clamp(2.0 * step_px * pitch / std::min(a.length, b.length), 0.02, 0.25);
}

/// b's patch at every turn.
std::vector<ReliefMap> turned_maps(const FacetPatch& b, double pitch, const std::vector<double>& turns,
                                   const Context& context) {
  std::vector<ReliefMap> maps;
  for (const double turn : turns) {
    if (context.cancelled()) return {};
    maps.push_back(facing_relief_of(b, pitch, turn));
  }
  return maps;
}

/// Of turns all around (near the rough pose, if there is one), those at which the patches agree best, each as `parts` of its step.
/// \param evaluations  poses looked at are added
std::vector<double> best_turns(const Task& task, double pitch, const std::vector<double>& all_around,
                               int parts, const std::optional<Near>& near, const Context& context,
                               long& evaluations) {
  const FacetPatch& a = task.a->patch;
  const FacetPatch& b = task.b->patch;
  const std::vector<double> turns = turns_near(near, a, b, all_around);
  const std::vector<ReliefMap> maps = turned_maps(b, pitch, turns, context);
  Correlator correlator(relief_of(a, pitch), {.outline_weight = task.outline_weight, .most_peaks = 1});
  std::vector<std::pair<float, std::size_t>> ranked;
  for (const std::size_t t : correlator.cheapest_order(maps)) {
    if (context.cancelled()) break;
    const std::vector<Agreement> peaks = correlator.peaks(maps[t]);
    evaluations += correlator.shifts();
    if (!peaks.empty()) ranked.emplace_back(-peaks.front().score, t);
  }
  std::sort(ranked.begin(), ranked.end());
  const auto wanted =
      static_cast<std::size_t>(std::ceil(kTurnsKept * static_cast<double>(all_around.size())));
  ranked.resize(std::min(ranked.size(), std::max(kLeastTurns, wanted)));
  const double part = kTurn / static_cast<double>(all_around.size()) / parts;
  std::vector<double> finer;
  for (const auto& [score, t] : ranked) {
    for (int k = 0; k < parts; ++k) finer.push_back(turns[t] + part * (k - 0.5 * (parts - 1)));
  }
  std::sort(finer.begin(), finer.end());
  return finer;
}

/// All shifts of b's patch on a's at all turns; of plates with pixels to spare, at the turns that a first look finds best.
/// \param most  peaks that are kept
SweepResult correlate_patches(const Task& task, double resolution, const SweepOptions& options,
                              std::size_t most, const Context& context) {
  const FacetPatch& a = task.a->patch;
  const FacetPatch& b = task.b->patch;
  const double wanted = pitch_for(a, b, resolution);
  const double pitch = std::max(wanted, kFinest * resolution);
  const double step = turn_step(a, b, pitch, options.turn_step_px);
  SweepResult result;
  std::vector<double> turns;
  if (are_strips(a, b) || kCoarse * wanted < kWorthALook * pitch) {
    turns = turns_near(options.near, a, b, turns_for(a, b, step));
  } else {
    const double coarse_pitch = kCoarse * wanted;
    const double coarse_step = turn_step(a, b, coarse_pitch, options.turn_step_px);
    const int parts = static_cast<int>(std::ceil(coarse_step / step - kSlack));
    turns = best_turns(task, coarse_pitch, turns_for(a, b, coarse_step), parts, options.near, context,
                       result.evaluations);
  }
  if (turns.empty()) return result;

  const ReliefMap map_a = relief_of(a, pitch);
  const std::vector<ReliefMap> maps_b = turned_maps(b, pitch, turns, context);
  CorrelateOptions peaks{.outline_weight = task.outline_weight};
  if (options.near) peaks.most_peaks = kPeaksNear;
  Correlator correlator(map_a, peaks);
  for (const std::size_t t : correlator.cheapest_order(maps_b)) {
    if (context.cancelled()) break;
    for (const Agreement& peak : correlator.peaks(maps_b[t])) {
      const Rigid pose = pose_of_peak(a, b, map_a, maps_b[t], peak, turns[t]);
      if (!options.near || options.near->holds(pose))
        result.hits.push_back({task.a->facet, task.b->facet, turns[t], pitch, peak, pose});
    }
    result.evaluations += correlator.shifts();
  }
  result.hits =
      distinct(std::move(result.hits), 3.0 * pitch, b.centre, 0.5 * std::min(a.length, b.length), most);
  return result;
}

/// The facet of every face of the coarse level, -1 on the worn edges of breaks, which lie along each other anywhere; facets of
/// which hardly more than the edges is left are whole.
std::vector<int> unworn(const mesh::Segmentation& s, const std::vector<int>& facet_of_face,
                        const std::vector<int>& sample_of_face) {
  std::vector<glm::vec3> walls;
  for (std::size_t i = 0; i < s.samples.size(); ++i) {
    if (s.surface[i] == mesh::Surface::Original) walls.push_back(s.samples.points[i]);
  }
  const mesh::Neighbours near_walls(walls, static_cast<float>(kWorn * s.wall_thickness));
  std::vector<int> rest = facet_of_face;
  std::vector<std::size_t> all(s.facets.size(), 0);
  std::vector<std::size_t> left(s.facets.size(), 0);
  for (std::size_t f = 0; f < rest.size(); ++f) {
    if (rest[f] < 0) continue;
    const auto facet = static_cast<std::size_t>(rest[f]);
    if (!s.facets[facet].fracture) continue;
    ++all[facet];
    const glm::vec3& point = s.samples.points[static_cast<std::size_t>(sample_of_face[f])];
    if (near_walls.any(point, [](std::uint32_t) { return true; })) {
      rest[f] = -1;
    } else {
      ++left[facet];
    }
  }
  for (std::size_t f = 0; f < rest.size(); ++f) {
    if (facet_of_face[f] < 0) continue;
    const auto facet = static_cast<std::size_t>(facet_of_face[f]);
    if (static_cast<double>(left[facet]) < kLeastUnworn * static_cast<double>(all[facet]))
      rest[f] = facet_of_face[f];
  }
  return rest;
}

double largest_fracture(const mesh::Cut& cut) {
  double largest = 0.0;
  for (const auto& facet : cut.facets) {
    if (facet.fracture) largest = std::max(largest, facet.area);
  }
  return largest;
}

/// Of one cut, the facets that may join.
/// \param first  number of the cut's first facet
/// \return indices into the cut's facets
std::vector<int> joinable(const mesh::Cut& cut, int first, const std::vector<int>& chosen) {
  const double least = kSmallFacet * largest_fracture(cut);
  std::vector<int> list;
  for (int f = 0; f < static_cast<int>(cut.facets.size()); ++f) {
    const auto& facet = cut.facets[static_cast<std::size_t>(f)];
    const bool wanted = chosen.empty() ? facet.fracture && facet.area > least
                                       : std::find(chosen.begin(), chosen.end(), first + f) != chosen.end();
    if (wanted) list.push_back(f);
  }
  return list;
}

/// A patch without faces on the coarse level is left out.
void add_patch(int facet, FacetPatch patch, std::vector<SweptFacet>& list) {
  if (!patch.points.empty()) list.push_back({facet, std::move(patch)});
}

/// The facets of one cut that may join.
/// \param first  number of the cut's first facet
std::vector<SweptFacet> candidates(const Fragment& fragment, const mesh::Cut& cut, int first,
                                   const std::vector<int>& chosen) {
  if (cut.facets.empty()) return {};
  std::vector<int> facet_of_face = mesh::facet_of_faces(cut, fragment.sample_of_face);
  if (fragment.facets.wall_thickness > 0)
    facet_of_face = unworn(fragment.facets, facet_of_face, fragment.sample_of_face);
  std::vector<SweptFacet> list;
  for (const int f : joinable(cut, first, chosen))
    add_patch(first + f, cut_patch(fragment.coarse, facet_of_face, cut, f), list);
  return list;
}

/// The quarters of the large facets of one cut: where two breaks share a part alone and third pieces lie between the rest, the
/// rest, seen as one with it, says that they do not agree.
/// \param first  number of the cut's first facet
std::vector<SweptFacet> large_parts(const Fragment& fragment, const mesh::Cut& cut, int first,
                                    const std::vector<int>& chosen) {
  const double least = kLargeFacet * largest_fracture(cut);
  std::vector<int> large = joinable(cut, first, chosen);
  std::erase_if(large, [&](int f) { return cut.facets[static_cast<std::size_t>(f)].area < least; });
  const mesh::Cut quarters = mesh::quarters(fragment.facets, cut, large);
  const std::vector<int> facet_of_face = mesh::facet_of_faces(quarters, fragment.sample_of_face);
  std::vector<SweptFacet> list;
  for (int k = 0; k < static_cast<int>(quarters.facets.size()); ++k) {
    const std::uint32_t sample = quarters.facets[static_cast<std::size_t>(k)].samples.front();
    add_patch(first + cut.facet_of_sample[sample], cut_patch(fragment.coarse, facet_of_face, quarters, k),
              list);
  }
  return list;
}

void add_tasks(const std::vector<SweptFacet>& a, const std::vector<SweptFacet>& b, float outline_weight,
               std::vector<Task>& tasks) {
  for (const SweptFacet& x : a) {
    for (const SweptFacet& y : b) tasks.push_back({&x, &y, outline_weight});
  }
}

}  // namespace

SweepResult sweep(const Fragment& a, const Fragment& b, const SweepOptions& options, const Context& context) {
  const auto seen_a = candidates(a, a.facets, 0, options.facets_a);
  const auto seen_b = candidates(b, b.facets, 0, options.facets_b);
  const auto creased_a = candidates(a, a.facets.creased, facet_numbers(a).creased, options.facets_a);
  const auto creased_b = candidates(b, b.facets.creased, facet_numbers(b).creased, options.facets_b);
  const auto parts_a = large_parts(a, a.facets.creased, facet_numbers(a).creased, options.facets_a);
  const auto parts_b = large_parts(b, b.facets.creased, facet_numbers(b).creased, options.facets_b);
  const float outlines = CorrelateOptions{}.outline_weight;
  std::vector<Task> tasks;
  add_tasks(seen_a, seen_b, outlines, tasks);
  add_tasks(creased_a, creased_b, outlines, tasks);
  add_tasks(parts_a, parts_b, 0.0F, tasks);
  const double resolution = std::max(a.resolution, b.resolution);
  const SweepOptions::Kept& kept = both_thin(a, b) ? options.kept_thin : options.kept;
  std::vector<SweepResult> parts(tasks.size());
  std::mutex reporting;
  std::size_t done = 0;
  parallel_for(tasks.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      if (context.cancelled()) return;
      parts[k] = correlate_patches(tasks[k], resolution, options,
                                   static_cast<std::size_t>(kept.a_pair_of_facets), context);
      const std::lock_guard lock(reporting);
      context.report("search", static_cast<double>(++done) / static_cast<double>(tasks.size()));
    }
  });
  SweepResult result;
  for (const SweepResult& part : parts) {
    result.hits.insert(result.hits.end(), part.hits.begin(), part.hits.end());
    result.evaluations += part.evaluations;
  }
  result.hits = distinct(std::move(result.hits), 3.0 * resolution, mesh::centroid(b.surface),
                         0.25 * std::min(a.diameter, b.diameter), static_cast<std::size_t>(kept.in_all),
                         static_cast<std::size_t>(kept.of_each));
  return result;
}

}  // namespace rejoin::match
