#include "zbuffer/benchmark.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <tuple>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"
#include "core/rigid.hpp"

namespace rejoin::zbuffer {
namespace {

using Clock = std::chrono::steady_clock;

/// What stays the same while one row after the other is measured.
struct Workload {
  const mesh::Mesh& a;
  const mesh::Mesh& b;
  std::vector<ViewPair> poses;
};

/// A row that is still to be measured.
struct Plan {
  Backend backend;
  int resolution;
  int threads;
};

glm::mat3 random_rotation(Random& random) {
  const glm::dvec3 axis(random.normal(), random.normal(), random.normal());
  const double real = random.normal();  // a normal quaternion is uniform over the rotations
  return glm::mat3(axis_rotation(glm::normalize(axis), 2.0 * std::atan2(glm::length(axis), real)));
}

std::vector<ViewPair> random_poses(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<ViewPair> poses(count);
  for (ViewPair& pose : poses) {
    pose.rotation_a = random_rotation(random);
    pose.rotation_b = random_rotation(random);
  }
  return poses;
}

bool is_gl(Backend backend) {
  return backend == Backend::Gpu || backend == Backend::OsMesa;
}

std::vector<Backend> chosen_backends(const BenchmarkOptions& options) {
  std::vector<Backend> backends;
  for (const BackendInfo& info : list_backends()) {
    const bool wanted = options.backends.empty()
                            ? info.backend != Backend::Reference
                            : std::ranges::find(options.backends, info.backend) != options.backends.end();
    if (info.available && wanted) backends.push_back(info.backend);
  }
  return backends;
}

std::vector<Plan> plans_of(const BenchmarkOptions& options) {
  std::vector<int> threads = options.threads;
  if (threads.empty()) threads = {1, thread_count()};
  std::ranges::sort(threads);
  threads.erase(std::unique(threads.begin(), threads.end()), threads.end());
  std::vector<Plan> plans;
  for (const Backend backend : chosen_backends(options)) {
    for (const int resolution : options.resolutions) {
      for (const int count : threads) {
        if (!is_gl(backend) || count == threads.back()) plans.push_back({backend, resolution, count});
      }
    }
  }
  return plans;
}

/// Poses a second; batches grow until one takes a tenth of the time, so that a call's overhead counts little.
double measure(Scorer& scorer, const Workload& work, double seconds, const Context& context) {
  std::vector<PairScore> scores(work.poses.size());
  std::size_t batch = 4;
  scorer.score({work.poses.data(), batch}, {scores.data(), batch});
  const auto start = Clock::now();
  std::size_t done = 0;
  double passed = 0;
  while (passed < seconds && !context.cancelled()) {
    const double before = passed;
    scorer.score({work.poses.data(), batch}, {scores.data(), batch});
    done += batch;
    passed = std::chrono::duration<double>(Clock::now() - start).count();
    if (passed - before < seconds / 10) batch = std::min(2 * batch, work.poses.size());
  }
  return passed > 0 ? static_cast<double>(done) / passed : 0;
}

/// Corner (i, j) of a k x k grid on face 0 .. 5 of the cube -k .. k.
glm::ivec3 cube_corner(int face, int i, int j, int k) {
  const int u = 2 * i - k;
  const int v = 2 * j - k;
  const std::array<glm::ivec3, 6> corners = {
      {{k, u, v}, {-k, v, u}, {v, k, u}, {u, -k, v}, {u, v, k}, {v, u, -k}}};
  return corners[static_cast<std::size_t>(face)];
}

/// Triangulated surface of the cube -1 .. 1, all faces counter-clockwise from outside.
mesh::Mesh cube(int k) {
  mesh::Mesh m;
  std::map<std::tuple<int, int, int>, unsigned> known;
  const auto vertex = [&](int face, int i, int j) {
    const glm::ivec3 c = cube_corner(face, i, j, k);
    const auto [place, fresh] = known.try_emplace({c.x, c.y, c.z}, static_cast<unsigned>(m.vertices.size()));
    if (fresh) m.vertices.push_back(glm::vec3(c) / static_cast<float>(k));
    return place->second;
  };
  for (int face = 0; face < 6; ++face) {
    for (int j = 0; j < k; ++j) {
      for (int i = 0; i < k; ++i) {
        const unsigned p = vertex(face, i, j);
        const unsigned q = vertex(face, i + 1, j + 1);
        m.faces.emplace_back(p, vertex(face, i + 1, j), q);
        m.faces.emplace_back(p, q, vertex(face, i, j + 1));
      }
    }
  }
  return m;
}

}  // namespace

mesh::Mesh bumpy_sphere(std::size_t faces, std::uint64_t seed) {
  const double quads = std::max(1.0, static_cast<double>(faces) / 12.0);
  mesh::Mesh m = cube(static_cast<int>(std::lround(std::sqrt(quads))));
  Random random(seed, 1);
  std::array<glm::vec3, 8> along;
  for (glm::vec3& wave : along) wave = glm::vec3(random.normal(), random.normal(), random.normal());
  for (glm::vec3& v : m.vertices) {
    const auto bend = [](float x) {
      return std::tan(x * 0.785398F);
    };  // makes the cells of the sphere about equal
    v = glm::normalize(glm::vec3(bend(v.x), bend(v.y), bend(v.z)));
    float radius = 1.0F;
    for (std::size_t k = 0; k < along.size(); ++k) {
      const float frequency = 2.0F + 2.0F * static_cast<float>(k);
      radius += 0.15F / frequency * std::sin(frequency * glm::dot(along[k], v));
    }
    v *= radius;
  }
  return m;
}

std::vector<BenchmarkRow> benchmark(const BenchmarkOptions& options, const Context& context) {
  const mesh::Mesh made_a = options.a == nullptr ? bumpy_sphere(options.faces, 1) : mesh::Mesh{};
  const mesh::Mesh made_b = options.b == nullptr ? bumpy_sphere(options.faces, 2) : mesh::Mesh{};
  const Workload work{options.a == nullptr ? made_a : *options.a, options.b == nullptr ? made_b : *options.b,
                      random_poses(1024, options.seed)};
  const std::vector<Plan> plans = plans_of(options);
  std::vector<BenchmarkRow> rows;
  for (std::size_t k = 0; k < plans.size() && !context.cancelled(); ++k) {
    context.report("bench", static_cast<double>(k) / static_cast<double>(plans.size()));
    const ThreadLimit limit(plans[k].threads);
    try {
      const auto scorer = make_scorer(plans[k].backend, work.a, work.b, {.resolution = plans[k].resolution});
      const double rate = measure(*scorer, work, options.seconds_per_row, context);
      rows.push_back({plans[k].backend, scorer->renderer(), plans[k].resolution,
                      (work.a.faces.size() + work.b.faces.size()) / 2, plans[k].threads, rate});
    } catch (const BackendError&) {
      continue;  // a backend that cannot draw here has no speed
    }
  }
  return rows;
}

}  // namespace rejoin::zbuffer
