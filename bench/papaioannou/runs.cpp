#include "runs.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "mesh/point_index.hpp"
#include "mesh/samples.hpp"

namespace rejoin::bench {
namespace {

constexpr double kRightAngle = 5 * 3.14159265358979323846 / 180;  // the project's measure of "found"
constexpr double kRightDisplacement = 0.02;
constexpr double kSameDisplacement = 0.05;  // figure 12: +-5 % RMS deviation counts as the same pose
constexpr std::size_t kSamples = 20000;

// Points of A that have B's surface opposite to them close by, at the true pose.
std::optional<glm::dvec3> contact_direction(const match::Fragment& a, const match::Fragment& b,
                                            const Rigid& pose) {
  const mesh::Samples of_a = mesh::sample_surface(a.coarse, kSamples);
  mesh::Samples of_b = mesh::sample_surface(b.coarse, kSamples);
  for (std::size_t k = 0; k < of_b.size(); ++k) {
    of_b.points[k] = glm::vec3(pose(glm::dvec3(of_b.points[k]) + b.coarse.origin) - a.coarse.origin);
    of_b.normals[k] = glm::vec3(pose.rotation * glm::dvec3(of_b.normals[k]));
  }
  const mesh::PointIndex index(of_b.points);
  const double reach = 2 * std::max(of_a.spacing, of_b.spacing);
  glm::dvec3 sum(0.0);
  for (std::size_t k = 0; k < of_a.size(); ++k) {
    const auto nearest = index.nearest(of_a.points[k]);
    if (!nearest || nearest->second > reach) continue;
    if (glm::dot(of_a.normals[k], of_b.normals[nearest->first]) > -0.7F) continue;
    sum += glm::dvec3(of_a.normals[k]);
  }
  const double length = glm::length(sum);
  if (!(length > 0)) return std::nullopt;
  return sum / length;
}

match::Options search_options(Knowledge knowledge, const PairTruth& truth, const RunOptions& run) {
  match::Options options;
  options.search = match::Search::Esa;
  options.constraint =
      knowledge == Knowledge::Nothing ? match::Constraint::None : match::Constraint::Direction;
  if (knowledge == Knowledge::TrueDirection) {
    options.directions_a = {*truth.direction()};
    options.directions_b = {-(glm::transpose(truth.pose().rotation) * *truth.direction())};
  }
  options.resolution = run.resolution;
  options.backend = run.backend;
  options.chains = run.seeds;
  options.seed = run.first_seed;
  return options;
}

// A run is one chain of every combination; its answer is the one with the lowest energy.
std::vector<match::EsaHypothesis> best_of_each_run(const std::vector<match::EsaHypothesis>& ends, int seeds) {
  std::vector<match::EsaHypothesis> best(static_cast<std::size_t>(seeds));
  for (match::EsaHypothesis& h : best) h.energy = std::numeric_limits<double>::infinity();
  for (const match::EsaHypothesis& h : ends) {
    match::EsaHypothesis& present = best[static_cast<std::size_t>(h.chain)];
    if (h.energy < present.energy) present = h;
  }
  std::erase_if(best, [](const match::EsaHypothesis& h) { return !std::isfinite(h.energy); });
  return best;
}

void add(Group& group, const match::EsaHypothesis& h) {
  group.mean_error = (group.mean_error * group.runs + h.score.error) / (group.runs + 1);
  ++group.runs;
}

// The largest set of wrong answers around one of them.
Group most_frequent(const std::vector<match::EsaHypothesis>& wrong, const PairTruth& truth) {
  Group largest;
  for (const match::EsaHypothesis& centre : wrong) {
    Group group;
    for (const match::EsaHypothesis& h : wrong) {
      if (truth.deviation(h.pose, centre.pose).displacement <= kSameDisplacement) add(group, h);
    }
    if (group.runs > largest.runs) largest = group;
  }
  return largest;
}

std::optional<double> error_at(const match::Fragment& a, const match::Fragment& b, const PairTruth& truth,
                               const RunOptions& run) {
  if (!truth.direction()) return std::nullopt;
  const zbuffer::ViewOptions view = match::whole_fragment_view(a, b, run.resolution);
  const match::ViewCentres centres{a.coarse.origin + glm::dvec3(view.centre_a),
                                   b.coarse.origin + glm::dvec3(view.centre_b)};
  const auto facing = match::facing_view(truth.pose(), *truth.direction(), centres);
  zbuffer::PairScore score;
  zbuffer::make_scorer(run.backend, a.coarse, b.coarse, view)->score({&facing.view, 1}, {&score, 1});
  return score.error;
}

}  // namespace

PairTruth::PairTruth(const match::Fragment& a, const match::Fragment& b, const Rigid& pose)
    : pose_(pose), direction_(contact_direction(a, b, pose)) {
  constexpr std::size_t kMostPoints = 4000;
  const auto points_of = [](const mesh::Mesh& mesh) {
    std::vector<glm::dvec3> points;
    const std::size_t step = std::max<std::size_t>(1, mesh.vertices.size() / kMostPoints);
    for (std::size_t v = 0; v < mesh.vertices.size(); v += step) {
      points.push_back(mesh.origin + glm::dvec3(mesh.vertices[v]));
    }
    return points;
  };
  points_ = points_of(b.scan);
  std::vector<glm::dvec3> both = points_of(a.scan);
  for (const glm::dvec3& p : points_) both.push_back(pose(p));
  glm::dvec3 low = both.front();
  glm::dvec3 high = low;
  for (const glm::dvec3& p : both) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  diameter_ = glm::length(high - low);
}

Deviation PairTruth::deviation(const Rigid& first, const Rigid& second) const {
  double sum = 0;
  for (const glm::dvec3& p : points_) sum += glm::length(first(p) - second(p));
  return {angle_between(first, second), sum / static_cast<double>(points_.size()) / diameter_};
}

bool PairTruth::right(const Rigid& pose) const {
  const Deviation off = deviation(pose, pose_);
  return off.angle_rad <= kRightAngle && off.displacement <= kRightDisplacement;
}

std::optional<Outcome> measure(const match::Fragment& a, const match::Fragment& b, const PairTruth& truth,
                               Knowledge knowledge, const RunOptions& run) {
  if (knowledge == Knowledge::TrueDirection && !truth.direction()) return std::nullopt;
  match::EsaOptions esa;
  esa.maps = run.maps;
  esa.rule.overlap_bias = run.overlap_bias;
  esa.directions_per_fragment = run.directions;
  esa.shift_range = run.shift_range;
  esa.annealing.equilibrium = run.equilibrium;
  esa.annealing.failed_stages = run.failed_stages;
  esa.every_chain = true;
  match::EsaStats stats;
  const auto begin = std::chrono::steady_clock::now();
  const auto ends = match::esa_search(a, b, search_options(knowledge, truth, run), esa, Context(), &stats);
  if (ends.empty()) return std::nullopt;

  Outcome outcome;
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  outcome.evaluations = stats.evaluations;
  outcome.error_at_truth = error_at(a, b, truth, run);
  outcome.runs = run.seeds;
  std::vector<match::EsaHypothesis> wrong;
  for (const match::EsaHypothesis& h : best_of_each_run(ends, run.seeds)) {
    if (truth.right(h.pose)) {
      add(outcome.right, h);
    } else {
      wrong.push_back(h);
    }
  }
  outcome.wrong = most_frequent(wrong, truth);
  return outcome;
}

}  // namespace rejoin::bench
