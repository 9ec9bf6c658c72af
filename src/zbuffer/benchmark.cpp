#include "zbuffer/benchmark.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <map>
#include <span>
#include <tuple>
#include <utility>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"
#include "core/rigid.hpp"
#include "zbuffer/gl/gl_scorer.hpp"

namespace rejoin::zbuffer {
namespace {

using Clock = std::chrono::steady_clock;

struct Workload {
  const mesh::Mesh& a;
  const mesh::Mesh& b;
  std::span<const ViewPair> poses;
};

/// A row that is still to be measured.
struct Plan {
  Backend backend;
  gl::Path path;  ///< of GL
  std::size_t faces;
  int resolution;
  int threads;
  std::size_t batch;
};

glm::mat3 random_rotation(Random& random) {
  const glm::dvec3 axis(random.normal(), random.normal(), random.normal());
  const double real = random.normal();  // a normal quaternion is uniform over the rotations
  return glm::mat3(axis_rotation(glm::normalize(axis), 2.0 * std::atan2(glm::length(axis), real)));
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

std::vector<int> chosen_threads(const BenchmarkOptions& options) {
  std::vector<int> threads = options.threads;
  if (threads.empty()) threads = {1, thread_count()};
  std::ranges::sort(threads);
  threads.erase(std::unique(threads.begin(), threads.end()), threads.end());
  return threads;
}

std::vector<Plan> plans_of(const BenchmarkOptions& options) {
  const std::vector<int> threads = chosen_threads(options);
  const auto batches = options.batches.empty() ? std::vector<std::size_t>{0} : options.batches;
  const bool own_mesh = options.a != nullptr && options.b != nullptr;
  const auto faces = own_mesh ? std::vector<std::size_t>{0} : options.faces;
  std::vector<Plan> plans;
  const auto add = [&](const Plan& plan) {
    for (const std::size_t batch : batches) {
      plans.push_back(plan);
      plans.back().batch = batch;
    }
  };
  for (const Backend backend : chosen_backends(options)) {
    for (const std::size_t count : faces) {
      for (const int resolution : options.resolutions) {
        if (is_gl(backend)) {
          for (const gl::Path path : {gl::Path::Compute, gl::Path::Pipeline}) {
            add({backend, path, count, resolution, threads.back(), 0});
          }
          continue;
        }
        for (const int used : threads) add({backend, gl::Path::Auto, count, resolution, used, 0});
      }
    }
  }
  return plans;
}

std::string way_of(const Plan& plan) {
  if (!is_gl(plan.backend)) return {};
  return plan.path == gl::Path::Pipeline ? "pipeline" : "compute";
}

std::unique_ptr<Scorer> scorer_of(const Plan& plan, const Workload& work) {
  const ViewOptions view{.resolution = plan.resolution};
  if (!is_gl(plan.backend)) return make_scorer(plan.backend, work.a, work.b, view);
  return gl::make_gl_scorer(gl::shared_engine(plan.backend), plan.backend, work.a, work.b, view, plan.path);
}

struct Rates {
  double a_second = 0;
  double a_cpu_second = 0;
};

/// Without a fixed batch, batches grow until one takes a tenth of the time, so that a call's overhead counts
/// little.
Rates measure(Scorer& scorer, const Workload& work, const Plan& plan, double seconds,
              const Context& context) {
  std::vector<PairScore> scores(work.poses.size());
  std::size_t next = 0;
  const auto score = [&](std::size_t count) {
    // Other poses at every call: a scorer may keep the maps of the last ones.
    if (next + count > work.poses.size()) next = 0;
    scorer.score(work.poses.subspan(next, count), std::span(scores).first(count));
    next += count;
  };
  constexpr std::size_t kFew = 4;
  std::size_t batch = plan.batch > 0 ? plan.batch : kFew;
  score(std::min(batch, kFew));
  const auto start = Clock::now();
  const std::clock_t cpu_start = std::clock();
  std::size_t done = 0;
  double passed = 0;
  while (passed < seconds && !context.cancelled()) {
    const double before = passed;
    score(batch);
    done += batch;
    passed = std::chrono::duration<double>(Clock::now() - start).count();
    if (plan.batch == 0 && passed - before < seconds / 10) batch = std::min(2 * batch, work.poses.size() / 4);
  }
  const double cpu = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
  const auto rate = [done](double time) { return time > 0 ? static_cast<double>(done) / time : 0.0; };
  return {rate(passed), rate(cpu)};
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

std::vector<ViewPair> random_poses(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<ViewPair> poses(count);
  for (ViewPair& pose : poses) {
    pose.rotation_a = random_rotation(random);
    pose.rotation_b = random_rotation(random);
  }
  return poses;
}

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
  std::size_t most = 4096;
  for (const std::size_t batch : options.batches) most = std::max(most, batch);
  const std::vector<ViewPair> poses = random_poses(most, options.seed);
  const std::vector<Plan> plans = plans_of(options);
  mesh::Mesh made_a;
  mesh::Mesh made_b;
  std::size_t made = 0;
  std::vector<BenchmarkRow> rows;
  for (std::size_t k = 0; k < plans.size() && !context.cancelled(); ++k) {
    const Plan& plan = plans[k];
    context.report("bench", static_cast<double>(k) / static_cast<double>(plans.size()));
    if (plan.faces != made) {
      made_a = bumpy_sphere(plan.faces, 1);
      made_b = bumpy_sphere(plan.faces, 2);
      made = plan.faces;
    }
    const Workload work{options.a == nullptr ? made_a : *options.a,
                        options.b == nullptr ? made_b : *options.b, poses};
    const ThreadLimit limit(plan.threads);
    try {
      const auto scorer = scorer_of(plan, work);
      const Rates rates = measure(*scorer, work, plan, options.seconds_per_row, context);
      if (context.cancelled()) break;  // too little was measured
      rows.push_back({plan.backend, way_of(plan), scorer->renderer(), plan.resolution,
                      (work.a.faces.size() + work.b.faces.size()) / 2, plan.threads, plan.batch,
                      rates.a_second, rates.a_cpu_second});
    } catch (const BackendError&) {
      continue;  // a backend that cannot draw here has no speed
    }
  }
  return rows;
}

namespace {

struct Contender {
  std::string name;
  Backend backend;
  std::string way;
  int threads;
};

/// 0 if not measured.
double rate_of(const std::vector<BenchmarkRow>& rows, const Contender& who, const BenchmarkRow& like) {
  for (const BenchmarkRow& row : rows) {
    if (row.backend == who.backend && row.way == who.way && row.threads == who.threads && row.batch == 0 &&
        row.resolution == like.resolution && row.faces == like.faces) {
      return row.evaluations_per_second;
    }
  }
  return 0;
}

}  // namespace

std::vector<BenchmarkRatio> ratios_of(const std::vector<BenchmarkRow>& rows) {
  int all = 1;
  for (const BenchmarkRow& row : rows) all = std::max(all, row.threads);
  const Contender one{"raster, 1 thread", Backend::Raster, "", 1};
  const Contender many{"raster, " + std::to_string(all) + " threads", Backend::Raster, "", all};
  std::vector<std::pair<Contender, Contender>> questions{
      {one, {"raycast, 1 thread", Backend::RayCast, "", 1}}};
  if (all > 1) questions.emplace_back(many, one);
  for (const Backend backend : {Backend::OsMesa, Backend::Gpu}) {
    for (const char* way : {"pipeline", "compute"}) {
      questions.push_back({many, {std::string(name_of(backend)) + " " + way, backend, way, all}});
    }
  }
  std::vector<BenchmarkRatio> ratios;
  for (const auto& [of, to] : questions) {
    for (const BenchmarkRow& row : rows) {
      const bool is_to = row.backend == to.backend && row.way == to.way && row.threads == to.threads;
      const double rate = is_to && row.batch == 0 ? rate_of(rows, of, row) : 0;
      if (rate <= 0 || row.evaluations_per_second <= 0) continue;
      ratios.push_back({of.name, to.name, row.resolution, row.faces, rate / row.evaluations_per_second});
    }
  }
  return ratios;
}

}  // namespace rejoin::zbuffer
