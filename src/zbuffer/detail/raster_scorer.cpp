#include "zbuffer/detail/backends.hpp"
#include "zbuffer/detail/map_scorer.hpp"
#include "zbuffer/detail/raster_kernel.hpp"

namespace rejoin::zbuffer::detail {
namespace {

/// Our own rasteriser, made for triangles of a few pixels.
class RasterScorer final : public MapScorer {
 public:
  RasterScorer(const mesh::Mesh& a, const mesh::Mesh& b, const ViewOptions& options)
      : MapScorer(options), a_(soup_of(a)), b_(soup_of(b)) {}

  Backend backend() const override { return Backend::Raster; }
  std::string renderer() const override { return raster_renderer(); }

 protected:
  void render(Side side, const Projection& projection, std::span<float> depth) const override {
    draw_soup(side == Side::A ? a_ : b_, projection,
              {depth.data(), options().resolution, options().resolution});
  }

 private:
  TriangleSoup a_;
  TriangleSoup b_;
};

}  // namespace

std::string raster_renderer() {
  return "raster " + instruction_set();
}

std::unique_ptr<Scorer> make_raster(const mesh::Mesh& a, const mesh::Mesh& b, const ViewOptions& options) {
  return std::make_unique<RasterScorer>(a, b, options);
}

}  // namespace rejoin::zbuffer::detail
