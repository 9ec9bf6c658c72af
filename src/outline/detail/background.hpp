/// What lies behind the pieces of a picture without transparency.
#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace rejoin::outline::detail {

/// The outermost pixels of a picture, each once.
std::vector<cv::Point> frame_of(const cv::Size& size);

/// A background of one colour, or of one that changes slowly over the picture, as under a lamp that stands aside.
class Background {
 public:
  /// The colour that the frame (the outermost pixels) has most.  Where more of the picture follows a smooth surface over
  /// the place than has that colour, the surface, fitted to all that follows it.
  /// \param image  CV_32FC3, 0..1
  explicit Background(const cv::Mat& image);

  cv::Vec3f colour(int x, int y) const;

  /// Whether the colour is the same all over.
  bool plain() const { return plain_; }

  /// The colour at the place of the frame where the three channels' mean is largest.
  const cv::Vec3f& brightest() const { return brightest_; }

  /// The smallest mean of the three channels along the frame, as a share of the largest; 1 if plain.
  double darkest() const { return darkest_; }

 private:
  static constexpr std::size_t kTerms = 7;  // 1, x, y, x x, x y, y y, (x x + y y)^2 as a lens darkens
  using Terms = std::array<float, kTerms>;

  Terms terms(int x, int y) const;
  void fit(const cv::Mat& image, const std::vector<cv::Point>& places);
  void find_extremes(const std::vector<cv::Point>& frame);

  cv::Size size_;
  std::array<Terms, 3> factors_{};  ///< of each channel; places run from -1 to 1
  bool plain_ = true;
  cv::Vec3f brightest_;
  double darkest_ = 1.0;
};

}  // namespace rejoin::outline::detail
