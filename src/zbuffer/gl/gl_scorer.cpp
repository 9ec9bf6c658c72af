#include "zbuffer/gl/gl_scorer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/error.hpp"
#include "zbuffer/detail/outward.hpp"
#include "zbuffer/detail/view.hpp"
#include "zbuffer/gl/drawing.hpp"

namespace rejoin::zbuffer::gl {
namespace {

Surface surface_of(const mesh::Mesh& mesh) {
  detail::SidedFaces faces = detail::sided_faces(mesh);
  const std::size_t front_only = faces.front_only.size();
  faces.front_only.insert(faces.front_only.end(), faces.both.begin(), faces.both.end());
  return {mesh.vertices, std::move(faces.front_only), front_only};
}

Placement placement(const detail::Projection& projection) {
  const auto row = [&](int r) {
    return glm::vec4(projection.linear[0][r], projection.linear[1][r], projection.linear[2][r],
                     projection.offset[r]);
  };
  return {row(0), row(1), row(2)};
}

PairScore score_of(const Record& record, double view_side) {
  PairScore score;
  score.overlap = static_cast<int>(record.overlap);
  score.covered_a = static_cast<int>(record.covered_a);
  score.covered_b = static_cast<int>(record.covered_b);
  if (record.overlap > 0) score.error = static_cast<float>(record.sum / (record.overlap * view_side));
  return score;
}

class GlScorer : public Scorer {
 public:
  GlScorer(std::shared_ptr<Engine> engine, Backend backend, const mesh::Mesh& a, const mesh::Mesh& b,
           const ViewOptions& options, Path path)
      : engine_(std::move(engine)),
        backend_(backend),
        options_(options),
        surfaces_{surface_of(a), surface_of(b)} {
    const Engine::Session session(*engine_);
    const Limits& limits = engine_->limits();
    const bool compute = suits_compute(limits, surfaces_[0], surfaces_[1], options_.resolution);
    if (path == Path::Compute && !compute) {
      throw BackendError(engine_->context().subject(), "the driver cannot compute so many faces or pixels",
                         "choose fewer, or let the fixed pipeline draw");
    }
    if (path == Path::Pipeline || (path == Path::Auto && !compute)) {
      drawing_ = make_pipeline_drawing(*engine_, surfaces_[0], surfaces_[1], options_.resolution);
    } else {
      drawing_ = make_compute_drawing(*engine_, surfaces_[0], surfaces_[1], options_.resolution);
    }
  }

  ~GlScorer() override {
    try {
      const Engine::Session session(*engine_);
      drawing_.reset();
      second_.reset();
    } catch (const BackendError&) {
      // The context is gone and its objects with it.
    }
  }

  void score(std::span<const ViewPair> poses, std::span<PairScore> scores) override {
    if (poses.size() != scores.size()) {
      throw InputError("scores", "there are " + std::to_string(scores.size()) + " places for " +
                                     std::to_string(poses.size()) + " poses");
    }
    std::vector<PairPlacement> placements(poses.size());
    std::transform(poses.begin(), poses.end(), placements.begin(),
                   [&](const ViewPair& pose) { return place(pose); });
    std::vector<Record> records(poses.size());
    {
      const Engine::Session session(*engine_);
      drawing_->score(placements, records);
      finish(placements, records);
    }
    std::transform(records.begin(), records.end(), scores.begin(),
                   [&](const Record& record) { return score_of(record, options_.view_side); });
  }

  std::pair<DepthMap, DepthMap> depth_maps(const ViewPair& pose) override {
    const Engine::Session session(*engine_);
    auto depths = drawing_->depths(place(pose));
    if (!depths) depths = second().depths(place(pose));
    std::pair<DepthMap, DepthMap> maps{DepthMap(options_.resolution, options_.resolution),
                                       DepthMap(options_.resolution, options_.resolution)};
    std::tie(maps.first.depth, maps.second.depth) = std::move(depths.value());
    return maps;
  }

  Backend backend() const override { return backend_; }
  std::string renderer() const override { return engine_->context().renderer(); }

 private:
  PairPlacement place(const ViewPair& pose) const {
    return {placement(detail::projection_a(pose, options_)), placement(detail::projection_b(pose, options_))};
  }

  /// Scores again what the first drawing could not finish.  Which poses these are depends on nothing but the
  /// pose.
  void finish(const std::vector<PairPlacement>& placements, std::vector<Record>& records) {
    std::vector<std::size_t> open;
    std::vector<PairPlacement> again;
    for (std::size_t k = 0; k < records.size(); ++k) {
      if (records[k].overlap != kUnfinished) continue;
      open.push_back(k);
      again.push_back(placements[k]);
    }
    if (open.empty()) return;
    std::vector<Record> finished(open.size());
    second().score(again, finished);
    for (std::size_t k = 0; k < open.size(); ++k) records[open[k]] = finished[k];
  }

  Drawing& second() {
    if (!second_) second_ = make_pipeline_drawing(*engine_, surfaces_[0], surfaces_[1], options_.resolution);
    return *second_;
  }

  std::shared_ptr<Engine> engine_;
  Backend backend_;
  ViewOptions options_;
  std::array<Surface, 2> surfaces_;  ///< a and b
  std::unique_ptr<Drawing> drawing_;
  std::unique_ptr<Drawing> second_;  ///< made when first needed
};

}  // namespace

std::unique_ptr<Scorer> make_gl_scorer(std::shared_ptr<Engine> engine, Backend backend, const mesh::Mesh& a,
                                       const mesh::Mesh& b, const ViewOptions& options, Path path) {
  return std::make_unique<GlScorer>(std::move(engine), backend, a, b, detail::completed(a, b, options), path);
}

}  // namespace rejoin::zbuffer::gl
