#include <algorithm>

#include "zbuffer/detail/backends.hpp"
#include "zbuffer/detail/map_scorer.hpp"

namespace rejoin::zbuffer::detail {
namespace {

/// Draws with draw_reference.
class ReferenceScorer final : public MapScorer {
 public:
  ReferenceScorer(const mesh::Mesh& a, const mesh::Mesh& b, const ViewOptions& options)
      : MapScorer(options), a_(a), b_(b) {}

  Backend backend() const override { return Backend::Reference; }
  std::string renderer() const override { return reference_renderer(); }

 protected:
  void render(Side side, const Projection& projection, std::span<float> depth) const override {
    const mesh::Mesh& mesh = side == Side::A ? a_ : b_;
    std::vector<glm::vec3> points;
    points.reserve(mesh.vertices.size());
    for (const glm::vec3& vertex : mesh.vertices) points.push_back(projection(vertex));
    DepthMap map(options().resolution, options().resolution);
    draw_reference(points, mesh.faces, map);
    std::ranges::copy(map.depth, depth.begin());
  }

 private:
  mesh::Mesh a_;
  mesh::Mesh b_;
};

}  // namespace

std::string reference_renderer() {
  return "every pixel against every triangle";
}

std::unique_ptr<Scorer> make_reference(const mesh::Mesh& a, const mesh::Mesh& b, const ViewOptions& options) {
  return std::make_unique<ReferenceScorer>(a, b, options);
}

}  // namespace rejoin::zbuffer::detail
