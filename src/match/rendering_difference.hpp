/// Two renderings of the same view, pixel by pixel, and what makes them differ.
#pragma once

#include <array>
#include <string>
#include <utility>

#include "zbuffer/depth_map.hpp"
#include "zbuffer/error.hpp"

namespace rejoin::match {

/// What a difference between two renderings comes from.
enum class PixelKind {
  Silhouette,  ///< a neighbour is background, or only one of the renderings covers the pixel
  /// the surface rises by more than kSteepSlope: a shift of a thousandth of a pixel is seen in the depth
  Steep,
  Interior,  ///< neither: what is left is rounding, or a real difference of the surfaces
};
inline constexpr std::size_t kPixelKinds = 3;
inline constexpr double kSteepSlope = 2.5;

/// One kind of pixel in a comparison of two renderings of both fragments.
struct KindShare {
  long pixels = 0;        ///< of both fragments' maps
  double depth_mean = 0;  ///< mean |depth difference| where both cover the pixel, mesh units
  double depth_max = 0;
  double depth_share = 0;  ///< of the sum of |depth difference| over all kinds, 0 .. 1
  double error_share = 0;  ///< of the sum of |change of the slope difference| over the joint's pixels, 0 .. 1
};

/// Two renderings of the same view.
struct RenderingDifference {
  std::string first;  ///< "raster, 10,000 faces"
  std::string second;
  zbuffer::DepthMap depth_a;  ///< first - second, mesh units; background unless both cover the pixel
  zbuffer::DepthMap depth_b;  ///< likewise, as rendered (not mirrored)
  zbuffer::DepthMap
      error;  ///< slope difference of the first - that of the second; background unless in both overlaps
  long only_first = 0;  ///< pixels of both fragments' maps that only the first covers
  long only_second = 0;
  zbuffer::PairScore score_first;
  zbuffer::PairScore score_second;
  std::array<KindShare, kPixelKinds> kinds;  ///< by PixelKind
};

/// The difference of two renderings of one view, pixel by pixel.
/// \param first, second  depth maps of A and B, as rendered, all of the same shape
/// \throws InputError the shapes differ
RenderingDifference rendering_difference(const std::pair<zbuffer::DepthMap, zbuffer::DepthMap>& first,
                                         const std::pair<zbuffer::DepthMap, zbuffer::DepthMap>& second,
                                         double view_side);

}  // namespace rejoin::match
