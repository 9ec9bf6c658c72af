#include "match/esa_search.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "core/angle.hpp"
#include "mesh/surface.hpp"

namespace rejoin::match {
namespace {

constexpr double kViewToDiameter = 1.3;
constexpr std::size_t kMapFaces =
    10000;  // the paper's figure; docs/performance.md has what it does to errors

/// One space to anneal in, and where its directions came from.
struct Combination {
  SearchSpace space;
  int direction_a = -1;
  int direction_b = -1;
  int facet_a = -1;
  int facet_b = -1;
};

/// What draws the poses of one or more combinations.
struct Stand {
  std::unique_ptr<zbuffer::Scorer> scorer;
  ViewCentres centres;
  double view_side = 0;
};

Stand make_stand(const mesh::Mesh& a, const mesh::Mesh& b, zbuffer::Backend backend,
                 const zbuffer::ViewOptions& view) {
  return {zbuffer::make_scorer(backend, a, b, view),
          {a.origin + glm::dvec3(view.centre_a), b.origin + glm::dvec3(view.centre_b)},
          view.view_side};
}

/// The surfaces of a fragment's facets, each at a level of detail for depth maps, made when first asked for.
class FacetMeshes {
 public:
  explicit FacetMeshes(const Fragment& fragment) : fragment_(fragment) {}

  const mesh::Mesh& of(int facet) {
    if (facet_of_face_.empty())
      facet_of_face_ = mesh::facet_of_faces(fragment_.facets,
                                            mesh::sample_of_faces(fragment_.facets, open_surface(fragment_)));
    const auto [place, is_new] = meshes_.try_emplace(facet);
    if (is_new) {
      std::vector<std::uint32_t> faces;
      for (std::size_t f = 0; f < facet_of_face_.size(); ++f) {
        if (facet_of_face_[f] == facet) faces.push_back(static_cast<std::uint32_t>(f));
      }
      place->second = mesh::simplify(mesh::submesh(open_surface(fragment_), faces), kMapFaces);
    }
    return place->second;
  }

 private:
  const Fragment& fragment_;
  std::vector<int> facet_of_face_;
  std::map<int, mesh::Mesh> meshes_;
};

/// The search of one pair: its settings and what it has found so far.
class EsaRun {
 public:
  EsaRun(const Fragment& a, const Fragment& b, const Options& options, const EsaOptions& esa,
         const Context& context, EsaStats& stats)
      : a_(a),
        b_(b),
        options_(options),
        esa_(esa),
        context_(context),
        stats_(stats),
        plan_(plan_constraints(options)),
        rule_(at_resolution(esa.rule, options.resolution)) {
    if (esa.maps == MapSource::Facet) {
      plan_.directions = true;
      if (plan_.material == MaterialUse::Restrict) plan_.material = MaterialUse::Bias;
    }
    if (plan_.material == MaterialUse::Bias) {
      rule_.material_axes = {glm::normalize(*options.material_a), glm::normalize(*options.material_b)};
    }
  }

  std::vector<EsaHypothesis> search() {
    if (plan_.directions) {
      search_directions();
    } else {
      search_whole();
    }
    stats_.cancelled = context_.cancelled();
    return std::move(found_);
  }

 private:
  void search_whole();
  void search_directions();
  void search_facets(const std::vector<Combination>& combinations);
  void anneal(const Stand& stand, const std::vector<Combination>& combinations);
  void keep(const Stand& stand, const Combination& combination, int chain, const anneal::ChainResult& end);
  std::vector<Combination> combinations(double reach) const;
  double reach(double diameter) const { return esa_.shift_range * diameter; }
  Stand whole_stand() const {
    return make_stand(mesh::simplify(a_.coarse, kMapFaces), mesh::simplify(b_.coarse, kMapFaces),
                      options_.backend, whole_fragment_view(a_, b_, options_.resolution));
  }
  double larger_diameter() const { return std::max(a_.diameter, b_.diameter); }

  const Fragment& a_;
  const Fragment& b_;
  const Options& options_;
  const EsaOptions& esa_;
  const Context& context_;
  EsaStats& stats_;
  ConstraintPlan plan_;
  EnergyRule rule_;
  std::uint64_t next_stream_ = 0;
  std::vector<EsaHypothesis> found_;
};

void EsaRun::search_whole() {
  std::vector<Combination> list;
  if (plan_.material == MaterialUse::Restrict) {
    for (const bool opposite : {false, true}) {
      list.push_back(
          {.space = material_space(*options_.material_a, *options_.material_b, esa_.jitter_deg * kDegree,
                                   reach(larger_diameter()), opposite)});
    }
  } else {
    list.push_back({.space = free_space(reach(larger_diameter()))});
  }
  anneal(make_stand(a_.coarse, b_.coarse, options_.backend, whole_fragment_view(a_, b_, options_.resolution)),
         list);
}

std::vector<Combination> EsaRun::combinations(double reach) const {
  const int most = esa_.directions_per_fragment;
  const auto of_a = candidate_directions(a_, options_.directions_a, options_.facets_a, most);
  const auto of_b = candidate_directions(b_, options_.directions_b, options_.facets_b, most);
  std::vector<Combination> list;
  for (std::size_t m = 0; m < of_a.size(); ++m) {
    for (std::size_t n = 0; n < of_b.size(); ++n) {
      list.push_back(
          {direction_space(of_a[m].direction, of_b[n].direction, options_.tolerance_deg * kDegree, reach),
           static_cast<int>(m), static_cast<int>(n), of_a[m].facet, of_b[n].facet});
    }
  }
  return list;
}

void EsaRun::search_directions() {
  std::vector<Combination> list = combinations(reach(larger_diameter()));
  if (list.empty()) {
    stats_.warnings.push_back((a_.facets.facets.empty() ? a_.path : b_.path) +
                              ": no facet to take a direction from; give --direction-a and --direction-b");
    return;
  }
  if (esa_.maps == MapSource::Facet) return search_facets(list);
  const Stand stand = whole_stand();
  for (Combination& c : list) {
    if (context_.cancelled()) return;
    centre_on_silhouettes(c.space, *stand.scorer, stand.view_side, esa_.silhouette_rotations);
  }
  anneal(stand, list);
}

void EsaRun::search_facets(const std::vector<Combination>& list) {
  FacetMeshes facets_of_a(a_);
  FacetMeshes facets_of_b(b_);
  for (Combination c : list) {
    if (context_.cancelled()) return;
    const glm::dvec3 up(0, 0, 1);
    const auto facet_of = [&up](const Fragment& fragment, int facet, const glm::dmat3& alignment) {
      return facet >= 0 ? facet : facet_towards(fragment, glm::transpose(alignment) * up);
    };
    c.facet_a = facet_of(a_, c.facet_a, c.space.alignment.rotation_a);
    c.facet_b = facet_of(b_, c.facet_b, c.space.alignment.rotation_b);
    if (c.facet_a < 0 || c.facet_b < 0) {
      stats_.warnings.push_back((c.facet_a < 0 ? a_.path : b_.path) + ": no facet to draw");
      return;
    }
    const mesh::Mesh& surface_a = facets_of_a.of(c.facet_a);
    const mesh::Mesh& surface_b = facets_of_b.of(c.facet_b);
    const double diameter = std::max(mesh::diameter(surface_a), mesh::diameter(surface_b));
    zbuffer::ViewOptions view;
    view.resolution = options_.resolution;
    view.view_side = kViewToDiameter * diameter;
    view.centre_a = glm::vec3(view_centre(surface_a));
    view.centre_b = glm::vec3(view_centre(surface_b));
    const Stand stand = make_stand(surface_a, surface_b, options_.backend, view);
    const Alignment alignment = c.space.alignment;
    c.space =
        direction_space(glm::transpose(alignment.rotation_a) * up, glm::transpose(alignment.rotation_b) * up,
                        options_.tolerance_deg * kDegree, reach(diameter));
    centre_on_silhouettes(c.space, *stand.scorer, stand.view_side, esa_.silhouette_rotations);
    anneal(stand, {c});
  }
}

// All chains of all combinations advance together; chain k belongs to combination k / chains.
void EsaRun::anneal(const Stand& stand, const std::vector<Combination>& list) {
  const auto per_combination = static_cast<std::size_t>(options_.chains);
  anneal::Options settings = esa_.annealing;
  settings.chains = static_cast<int>(per_combination * list.size());
  settings.seed = options_.seed;
  settings.first_stream = next_stream_;
  next_stream_ += per_combination * list.size();

  std::vector<zbuffer::ViewPair> views;
  std::vector<zbuffer::PairScore> scores;
  const anneal::Energy cost = [&](std::span<const double> points, std::span<const int> chains,
                                  std::span<double> energies) {
    views.resize(chains.size());
    scores.resize(chains.size());
    for (std::size_t k = 0; k < chains.size(); ++k) {
      const Combination& c = list[static_cast<std::size_t>(chains[k]) / per_combination];
      views[k] = c.space.view(points.subspan(k * kPoseSize, kPoseSize));
    }
    stand.scorer->score(views, scores);
    for (std::size_t k = 0; k < chains.size(); ++k) energies[k] = energy(scores[k], views[k], rule_);
  };
  const anneal::Result result = anneal::minimise(list.front().space.variables, cost, settings, context_);

  stats_.evaluations += result.evaluations;
  stats_.backend = stand.scorer->backend();
  stats_.renderer = stand.scorer->renderer();
  for (std::size_t k = 0; k < result.chains.size(); ++k) {
    std::vector<Progress>& course = stats_.convergence.emplace_back();
    for (const anneal::Stage& s : result.chains[k].history)
      course.push_back({s.evaluations, s.best, s.temperature});
    keep(stand, list[k / per_combination], static_cast<int>(k % per_combination), result.chains[k]);
  }
}

void EsaRun::keep(const Stand& stand, const Combination& combination, int chain,
                  const anneal::ChainResult& end) {
  EsaHypothesis h;
  h.view = combination.space.view(end.point);
  h.energy = end.energy;
  h.centres = stand.centres;
  h.view_side = stand.view_side;
  h.direction_a = combination.direction_a;
  h.direction_b = combination.direction_b;
  h.facet_a = combination.facet_a;
  h.facet_b = combination.facet_b;
  h.chain = chain;
  h.ending = end.ending;
  const auto [map_a, map_b] = stand.scorer->depth_maps(h.view);
  h.score = zbuffer::slope_difference(map_a, map_b, stand.view_side);
  h.pose = pose_of(h.view, contact_offset(map_a, map_b, stand.view_side), stand.centres);
  found_.push_back(h);
}

bool lower_energy(const EsaHypothesis& x, const EsaHypothesis& y) {
  return x.energy < y.energy;
}

/// Poses that differ, lowest energy first.
std::vector<EsaHypothesis> distinct(std::vector<EsaHypothesis> all, const Fragment& b, double diameter) {
  std::erase_if(all, [](const EsaHypothesis& h) { return !std::isfinite(h.energy); });
  std::stable_sort(all.begin(), all.end(), lower_energy);
  const glm::dvec3 centre = b.coarse.origin + view_centre(b.coarse);
  std::vector<EsaHypothesis> kept;
  for (const EsaHypothesis& h : all) {
    const bool seen = std::any_of(kept.begin(), kept.end(), [&](const EsaHypothesis& k) {
      return same_pose(k.pose, h.pose, centre, diameter);
    });
    if (!seen) kept.push_back(h);
  }
  return kept;
}

/// The best of every combination of directions before the second best of any, as many as asked for: two smooth facets
/// fit at countless poses, which would leave no place for the one pose of the fracture.
std::vector<EsaHypothesis> shared_out(const std::vector<EsaHypothesis>& ranked, std::size_t most) {
  std::map<std::pair<int, int>, std::size_t> taken;
  std::vector<std::pair<std::size_t, std::size_t>> places;  // rank within its combination, rank among all
  for (std::size_t k = 0; k < ranked.size(); ++k) {
    places.emplace_back(taken[{ranked[k].direction_a, ranked[k].direction_b}]++, k);
  }
  std::sort(places.begin(), places.end());
  std::vector<EsaHypothesis> chosen;
  for (const auto& place : places) {
    if (chosen.size() < most) chosen.push_back(ranked[place.second]);
  }
  std::stable_sort(chosen.begin(), chosen.end(), lower_energy);
  return chosen;
}

}  // namespace

zbuffer::ViewOptions whole_fragment_view(const Fragment& a, const Fragment& b, int resolution) {
  zbuffer::ViewOptions view;
  view.resolution = resolution;
  view.view_side = kViewToDiameter * std::max(a.diameter, b.diameter);
  const auto middle = [](const Fragment& f) { return f.middle ? *f.middle : view_centre(f.coarse); };
  view.centre_a = glm::vec3(middle(a));
  view.centre_b = glm::vec3(middle(b));
  return view;
}

bool same_pose(const Rigid& first, const Rigid& second, const glm::dvec3& centre_b, double diameter) {
  constexpr double kAngle = 5 * kDegree;
  constexpr double kDistance = 0.02;
  return angle_between(first, second) <= kAngle &&
         glm::length(first(centre_b) - second(centre_b)) <= kDistance * diameter;
}

std::vector<EsaHypothesis> esa_search(const Fragment& a, const Fragment& b, const Options& options,
                                      const EsaOptions& esa, const Context& context, EsaStats* stats) {
  EsaStats unused;
  std::vector<EsaHypothesis> all = EsaRun(a, b, options, esa, context, stats ? *stats : unused).search();
  if (esa.every_chain) return all;
  const auto ranked = distinct(std::move(all), b, std::min(a.diameter, b.diameter));
  return shared_out(ranked, static_cast<std::size_t>(std::max(0, options.max_candidates)));
}

}  // namespace rejoin::match
