#include "zbuffer/detail/backends.hpp"
#include "zbuffer/detail/fixed_triangle.hpp"
#include "zbuffer/detail/map_scorer.hpp"

namespace rejoin::zbuffer::detail {
namespace {

/// Our own rasteriser.
class RasterScorer final : public MapScorer {
 public:
  RasterScorer(const mesh::Mesh& a, const mesh::Mesh& b, const ViewOptions& options)
      : MapScorer(options), a_(a), b_(b) {}

  Backend backend() const override { return Backend::Raster; }
  std::string renderer() const override { return raster_renderer(); }

 protected:
  void render(Side side, const Projection& projection, std::span<float> depth) const override {
    const mesh::Mesh& mesh = side == Side::A ? a_ : b_;
    const Canvas canvas{depth.data(), options().resolution, options().resolution};
    for (const glm::uvec3& face : mesh.faces) {
      const auto triangle = snap(projection(mesh.vertices[face.x]), projection(mesh.vertices[face.y]),
                                 projection(mesh.vertices[face.z]));
      if (triangle) fill(*triangle, canvas);
    }
  }

 private:
  mesh::Mesh a_;
  mesh::Mesh b_;
};

}  // namespace

std::string raster_renderer() {
  return "raster";
}

std::unique_ptr<Scorer> make_raster(const mesh::Mesh& a, const mesh::Mesh& b, const ViewOptions& options) {
  return std::make_unique<RasterScorer>(a, b, options);
}

}  // namespace rejoin::zbuffer::detail
