#include "rims/propose.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/parallel.hpp"
#include "match/align.hpp"
#include "match/verify.hpp"
#include "mesh/point_index.hpp"
#include "rims/rim.hpp"

namespace rejoin::rims {
namespace {

/// Of the rims' curves, steps: takes away what the mesh's triangles and the sampling of its facets add.
constexpr double kCurveSmoothing = 2.0;
/// Of the stretches that are compared, steps.
constexpr std::array<std::size_t, 3> kLengths{32, 64, 128};
constexpr std::size_t kStride = 2;
constexpr std::size_t kStretches = 200;  // of a pair of rims, of each length
constexpr std::size_t kApart = 8;        // steps between two of them
constexpr std::size_t kSettled = 300;    // in all
constexpr double kNoise = 1.0;           // variance of a rim's place, squared steps
constexpr double kCorrelated = 8.0;      // steps that tell one thing, twice
constexpr int kRounds = 6;
constexpr double kReachStart = 6.0;  // steps, of what lies together
constexpr double kReachEnd = 2.5;
constexpr double kOpposed = -0.6;    // cosine of the rims' directions there, at most
constexpr double kWallsAgree = 0.6;  // cosine of the walls' normals there, at least
constexpr std::size_t kLeastContacts = 12;
constexpr double kIndependent = 0.25;  // of a contact: neighbours are smoothed together
constexpr std::size_t kJudged = 120;   // proposals whose broken surfaces are looked at
constexpr int kAlignSamples = 120;
constexpr int kJudgeSamples = 400;
constexpr double kSameTurn = 0.1;    // radians
constexpr double kSameShift = 0.03;  // of B's diameter

/// The rims of one fragment with what searching needs.
struct Prepared {
  std::vector<Rim> rims;
  std::vector<RimPoint> points;           ///< of all rims
  std::optional<mesh::PointIndex> index;  ///< of these

  Prepared(const match::Fragment& fragment, double step) : rims(find_rims(fragment, step, kCurveSmoothing)) {
    std::vector<glm::vec3> places;
    for (const Rim& rim : rims) {
      for (const RimPoint& point : rim.points) {
        points.push_back(point);
        places.emplace_back(point.place);
      }
    }
    index.emplace(places);
  }
};

/// Two places that are taken to have been one.
struct Contact {
  const RimPoint* on_a;
  const RimPoint* on_b;
};

/// Least squares motion of B's places and wall normals (as places `arm` above the wall) to A's.
Rigid superpose(const std::vector<Contact>& contacts, double arm) {
  const auto count = static_cast<Eigen::Index>(contacts.size());
  Eigen::Matrix3Xd from(3, 2 * count);
  Eigen::Matrix3Xd to(3, 2 * count);
  const auto put = [](Eigen::Matrix3Xd& matrix, Eigen::Index column, const glm::dvec3& p) {
    matrix.col(column) = Eigen::Vector3d(p.x, p.y, p.z);
  };
  for (Eigen::Index k = 0; k < count; ++k) {
    const Contact& contact = contacts[static_cast<std::size_t>(k)];
    put(from, 2 * k, contact.on_b->place);
    put(to, 2 * k, contact.on_a->place);
    put(from, 2 * k + 1, contact.on_b->place + arm * contact.on_b->wall);
    put(to, 2 * k + 1, contact.on_a->place + arm * contact.on_a->wall);
  }
  const Eigen::Matrix4d motion = Eigen::umeyama(from, to, false);
  Rigid pose;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) pose.rotation[column][row] = motion(row, column);
    pose.translation[column] = motion(column, 3);
  }
  return pose;
}

/// Correlation of paired numbers, 0 if one side does not vary.
double correlation(const std::vector<Contact>& contacts, double RimPoint::*signal, double sign) {
  const auto n = static_cast<double>(contacts.size());
  double a = 0.0;
  double b = 0.0;
  double aa = 0.0;
  double bb = 0.0;
  double ab = 0.0;
  for (const Contact& contact : contacts) {
    const double x = contact.on_a->*signal;
    const double y = sign * (contact.on_b->*signal);
    a += x;
    b += y;
    aa += x * x;
    bb += y * y;
    ab += x * y;
  }
  const double product = (aa - a * a / n) * (bb - b * b / n);
  return product > 0.0 ? (ab - a * b / n) / std::sqrt(product) : 0.0;
}

/// Two stretches of equal length, one on each rim, that may have been one.
struct Stretch {
  std::size_t rim_a = 0;
  std::size_t rim_b = 0;
  std::size_t begin_a = 0;  ///< runs forward from here
  std::size_t begin_b = 0;  ///< runs backward from here
  std::size_t length = 0;
  double score = 0.0;
};

/// Sums over paired places and wall normals, to which pairs can be added and taken off again.
struct Sums {
  double count = 0.0;
  Eigen::Vector3d a = Eigen::Vector3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  Eigen::Matrix3d ab = Eigen::Matrix3d::Zero();
  double squares = 0.0;

  void add(const Eigen::Vector3d& p, const Eigen::Vector3d& q, double weight) {
    count += weight;
    a += weight * p;
    b += weight * q;
    ab += weight * q * p.transpose();
    squares += weight * (p.squaredNorm() + q.squaredNorm());
  }

  /// Mean squared distance after the best motion.  \source Kabsch 1976
  double residual() const {
    const Eigen::Matrix3d covariance = ab - b * a.transpose() / count;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(covariance.transpose() * covariance, Eigen::EigenvaluesOnly);
    const Eigen::Vector3d values = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    const double least = covariance.determinant() < 0.0 ? -values[0] : values[0];
    const double total = squares - (a.squaredNorm() + b.squaredNorm()) / count;
    return std::max(0.0, total - 2.0 * (values[1] + values[2] + least)) / count;
  }
};

/// Mean squared distance of each stretch of `length` from its own straight line.
std::vector<double> reliefs(const std::vector<Eigen::Vector3d>& places, std::size_t length) {
  std::vector<double> result;
  for (std::size_t i = 0; i < places.size(); ++i) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < length; ++k) {
      const Eigen::Vector3d p = places[(i + k) % places.size()] - places[i];
      mean += p;
      products += p * p.transpose();
    }
    const auto n = static_cast<double>(length);
    products -= mean * mean.transpose() / n;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(products, Eigen::EigenvaluesOnly);
    result.push_back(std::max(0.0, solver.eigenvalues()[0] + solver.eigenvalues()[1]) / n);
  }
  return result;
}

/// A rim as the search over stretches takes it.
struct Track {
  std::vector<Eigen::Vector3d> places;
  std::vector<Eigen::Vector3d> raised;  ///< the place above the wall

  Track(const Rim& rim, double arm) {
    for (const RimPoint& point : rim.points) {
      const glm::dvec3 up = point.place + arm * point.wall;
      places.emplace_back(point.place.x, point.place.y, point.place.z);
      raised.emplace_back(up.x, up.y, up.z);
    }
  }
};

bool same(const Rigid& x, const Rigid& y, const glm::dvec3& centre, double diameter) {
  return angle_between(x, y) < kSameTurn && glm::distance(x(centre), y(centre)) < kSameShift * diameter;
}

class Proposer {
 public:
  Proposer(const match::Fragment& a, const match::Fragment& b, double step)
      : step_(step),
        arm_(std::max(5.0 * step, std::max(a.facets.wall_thickness, b.facets.wall_thickness))),
        centre_(mesh::centroid(b.surface)),
        diameter_(b.diameter),
        a_(a, step),
        b_(b, step) {}

  /// Poses relative to the meshes' origins.
  std::vector<Proposal> run(const Context& context) const {
    std::vector<Stretch> tasks;
    for (std::size_t i = 0; i < a_.rims.size(); ++i)
      for (std::size_t j = 0; j < b_.rims.size(); ++j)
        for (const std::size_t length : kLengths) tasks.push_back({i, j, 0, 0, length, 0.0});
    std::vector<std::vector<Stretch>> found(tasks.size());
    parallel_for(tasks.size(), 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t t = first; t < last && !context.cancelled(); ++t) found[t] = compare(tasks[t]);
    });
    std::vector<Stretch> stretches;
    for (const auto& some : found) stretches.insert(stretches.end(), some.begin(), some.end());
    sort_best(stretches, stretches.size());
    const std::vector<Rigid> starts = distinct_starts(stretches);
    std::vector<std::optional<Proposal>> settled(starts.size());
    parallel_for(starts.size(), 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t k = first; k < last && !context.cancelled(); ++k) settled[k] = settle(starts[k]);
    });
    std::vector<Proposal> all;
    for (const auto& proposal : settled)
      if (proposal) all.push_back(*proposal);
    return all;
  }

 private:
  static void sort_best(std::vector<Stretch>& list, std::size_t most) {
    std::stable_sort(list.begin(), list.end(),
                     [](const Stretch& p, const Stretch& q) { return p.score > q.score; });
    if (list.size() > most) list.resize(most);
  }

  /// Best stretches of the task's length on its two rims, a few steps apart.
  std::vector<Stretch> compare(const Stretch& task) const {
    const Track a(a_.rims[task.rim_a], arm_);
    const Track b(b_.rims[task.rim_b], arm_);
    const std::size_t count_a = a.places.size();
    const std::size_t count_b = b.places.size();
    if (task.length > count_a || task.length > count_b) return {};
    const std::vector<double> relief_a = reliefs(a.places, task.length);
    const std::vector<double> relief_b = reliefs(b.places, task.length);
    const double noise = kNoise * step_ * step_;
    std::vector<Stretch> found;
    for (std::size_t start = 0; start < count_b; start += kStride) {
      Sums sums;
      const auto put = [&](std::size_t k, double weight) {
        const std::size_t i = k % count_a;
        const std::size_t j = (start + 2 * count_b * (1 + count_a / count_b) - k) % count_b;
        sums.add(a.places[i], b.places[j], weight);
        sums.add(a.raised[i], b.raised[j], weight);
      };
      for (std::size_t k = 0; k < task.length; ++k) put(k, 1.0);
      for (std::size_t i = 0; i < count_a; ++i) {
        if (i % kStride == 0) {
          const std::size_t j = (start + 2 * count_b * (1 + count_a / count_b) - i) % count_b;
          const std::size_t end_b = (j + count_b + 1 - task.length) % count_b;
          const double relief = std::min(relief_a[i], relief_b[end_b]);
          const double score = static_cast<double>(task.length) / kCorrelated *
                               std::log((relief + noise) / (2.0 * sums.residual() + noise));
          if (score > 0.0) found.push_back({task.rim_a, task.rim_b, i, j, task.length, score});
        }
        put(i, -1.0);
        put(i + task.length, 1.0);
      }
    }
    return spread_out(std::move(found), count_a, count_b);
  }

  /// The best ones that are not next to a better one.
  static std::vector<Stretch> spread_out(std::vector<Stretch> found, std::size_t count_a,
                                         std::size_t count_b) {
    sort_best(found, 40 * kStretches);
    const auto apart = [](std::size_t p, std::size_t q, std::size_t count) {
      const std::size_t gap = p > q ? p - q : q - p;
      return std::min(gap, count - gap);
    };
    std::vector<Stretch> kept;
    for (const Stretch& stretch : found) {
      if (kept.size() == kStretches) break;
      const bool known = std::any_of(kept.begin(), kept.end(), [&](const Stretch& other) {
        return apart(other.begin_a, stretch.begin_a, count_a) < kApart &&
               apart(other.begin_b, stretch.begin_b, count_b) < kApart;
      });
      if (!known) kept.push_back(stretch);
    }
    return kept;
  }

  std::vector<Rigid> distinct_starts(const std::vector<Stretch>& stretches) const {
    std::vector<Rigid> kept;
    for (const Stretch& stretch : stretches) {
      if (kept.size() == kSettled) break;
      const Rigid pose = pose_of(stretch);
      const bool known = std::any_of(kept.begin(), kept.end(), [&](const Rigid& other) {
        return same(other, pose, centre_, diameter_);
      });
      if (!known) kept.push_back(pose);
    }
    return kept;
  }

  Rigid pose_of(const Stretch& stretch) const {
    const std::vector<RimPoint>& on_a = a_.rims[stretch.rim_a].points;
    const std::vector<RimPoint>& on_b = b_.rims[stretch.rim_b].points;
    std::vector<Contact> contacts;
    for (std::size_t k = 0; k < stretch.length; ++k) {
      contacts.push_back({&on_a[(stretch.begin_a + k) % on_a.size()],
                          &on_b[(stretch.begin_b + on_b.size() - k) % on_b.size()]});
    }
    return superpose(contacts, arm_);
  }

  std::vector<Contact> together(const Rigid& pose, double reach, std::size_t stride) const {
    const Rigid back = inverse(pose);
    std::vector<Contact> contacts;
    for (std::size_t i = 0; i < a_.points.size(); i += stride) {
      const RimPoint& point = a_.points[i];
      const auto near = b_.index->nearest(glm::vec3(back(point.place)));
      if (!near || static_cast<double>(near->second) > reach) continue;
      const RimPoint& other = b_.points[near->first];
      if (glm::dot(point.along, pose.rotation * other.along) > kOpposed) continue;
      if (glm::dot(point.wall, pose.rotation * other.wall) < kWallsAgree) continue;
      contacts.push_back({&point, &other});
    }
    return contacts;
  }

  std::optional<Proposal> settle(Rigid pose) const {
    for (int round = 0; round < kRounds; ++round) {
      const double share = static_cast<double>(round) / (kRounds - 1);
      const auto contacts =
          together(pose, step_ * (kReachStart + share * (kReachEnd - kReachStart)), kStride);
      if (contacts.size() < kLeastContacts) return std::nullopt;
      pose = superpose(contacts, arm_);
    }
    const auto contacts = together(pose, step_ * kReachEnd, 1);
    if (contacts.size() < kLeastContacts) return std::nullopt;
    return Proposal{pose, evidence(contacts), step_ * static_cast<double>(contacts.size())};
  }

  /// Sum over the signals of -n/2 log(1 - r^2).
  static double evidence(const std::vector<Contact>& contacts) {
    struct Signal {
      double RimPoint::*value;
      double sign;  ///< of the partner, which runs the other way
    };
    double sum = 0.0;
    for (const Signal& signal : {Signal{&RimPoint::turn, -1.0}, Signal{&RimPoint::bend, 1.0},
                                 Signal{&RimPoint::twist, 1.0}, Signal{&RimPoint::thickness, 1.0}}) {
      const double r = std::clamp(correlation(contacts, signal.value, signal.sign), 0.0, 0.999);
      sum -= 0.5 * kIndependent * static_cast<double>(contacts.size()) * std::log(1.0 - r * r);
    }
    return sum;
  }

  double step_;
  double arm_;
  glm::dvec3 centre_;  ///< of B
  double diameter_;
  Prepared a_;
  Prepared b_;
};

void sort_by(std::vector<Proposal>& list, double Proposal::*value) {
  std::stable_sort(list.begin(), list.end(),
                   [value](const Proposal& p, const Proposal& q) { return p.*value > q.*value; });
}

std::vector<Proposal> distinct(const std::vector<Proposal>& list, const glm::dvec3& centre, double diameter,
                               std::size_t most) {
  std::vector<Proposal> kept;
  for (const Proposal& proposal : list) {
    if (kept.size() == most) break;
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Proposal& other) {
      return same(other.pose, proposal.pose, centre, diameter);
    });
    if (!known) kept.push_back(proposal);
  }
  return kept;
}

}  // namespace

std::vector<Proposal> propose(const match::Fragment& a, const match::Fragment& b,
                              const ProposeOptions& options, const Context& context) {
  context.report("compare rims", 0.0);
  const double step = std::max(a.facets.samples.spacing, b.facets.samples.spacing);
  std::vector<Proposal> all = Proposer(a, b, step).run(context);
  sort_by(all, &Proposal::evidence);
  const glm::dvec3 centre = mesh::centroid(b.surface);
  all = distinct(all, centre, b.diameter, kJudged);
  const match::Joint joint(a, b);
  const double t = joint.tolerance();
  parallel_for(all.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last && !context.cancelled(); ++k) {
      all[k].pose = joint.align(all[k].pose, {10.0 * t, 4.0 * t, 8, kAlignSamples});
      all[k].strength = match::strength(joint.evidence(all[k].pose, kJudgeSamples));
    }
  });
  sort_by(all, &Proposal::strength);
  all = distinct(all, centre, b.diameter, options.most);
  for (Proposal& proposal : all) proposal.pose = match::to_files(a, b, proposal.pose);
  return all;
}

}  // namespace rejoin::rims
