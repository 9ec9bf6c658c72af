/// What pictures of flat pieces have in common.
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/matx.hpp>
#include <string>

#include "outline/outline.hpp"

namespace rejoin::outline::detail {

/// Whether the piece was read from a picture, which can be read again.
bool is_picture(const Piece& piece);

/// The picture's colours, CV_32FC3, blue green red.  What is transparent has the mean of what is opaque within `reach` pixels, so
/// that resampling mixes nothing into a piece that is not seen.
/// \throws IoError, InputError  it cannot be read again
cv::Mat colours_of(const Piece& piece, int reach);

/// The same with white where the picture is transparent.
cv::Mat colours_on_white(const Piece& piece);

/// The picture last asked for: the pieces of a scan follow each other, and a large one takes seconds to read.
class LastPicture {
 public:
  /// As colours_of(); holds until the next call.
  const cv::Mat& colours(const Piece& piece, int reach);
  /// As colours_on_white(); holds until the next call.
  const cv::Mat& on_white(const Piece& piece);

 private:
  static constexpr int kOnWhite = -1;

  const cv::Mat& read(const Piece& piece, int reach);

  std::string path_;
  int reach_ = kOnWhite;
  cv::Mat colours_;
};

/// Colours at their places in a picture of this size, 8 bits.  Pictures with a side of more than 16,384 pixels are made smaller first, as
/// OpenCV's own function takes none above 32,767.
/// \param motion  from places in `colours` to those in the result
/// \param border  of OpenCV's cv::BorderTypes: what lies outside; a constant is white
cv::Mat resampled(const cv::Mat& colours, cv::Matx23d motion, const cv::Size& size, int border);

/// At most 32 letters that the font has, cut in the middle: names of pictures differ at their ends.
std::string short_name(const std::string& full);

/// With the program's mark, see core/png_mark.hpp.  \throws IoError  it cannot be written
void write_png(const std::filesystem::path& path, const cv::Mat& image);

}  // namespace rejoin::outline::detail
