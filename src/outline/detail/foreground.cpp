#include "outline/detail/foreground.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "core/median.hpp"
#include "core/parallel.hpp"

namespace rejoin::outline::detail {
namespace {

/// Light weaker than this share of the brightest is not made up for further.
constexpr float kLeastLight = 0.1F;
/// Pixels are looked at with their neighbours, which takes noise away (standard deviation, pixels).
constexpr double kBlur = 1.0;

// What is farther from the background than all of these is no background: a colour that nobody sees, what the frame varies by, and
// what a JPEG leaves beside an edge.
constexpr double kLeastDistance = 0.04;
constexpr double kNoiseFactor = 4.0;
constexpr double kRinging = 0.06;

/// A darker background has no shadows that matter, 0..1.
constexpr float kShadowsFall = 0.25F;
/// A shadow leaves at least this share of the light,
constexpr float kDarkestShadow = 0.35F;
/// in equal parts of each channel to within this,
constexpr float kSameHue = 0.12F;
/// where a channel that is weaker than this share of the strongest counts as if it were that, for its noise does,
constexpr float kWeak = 0.5F;
/// and changes by less than this from pixel to pixel.
constexpr float kSoft = 0.075F;
/// A pixel of the frame is background if it is this much nearer to it than one of the next few inwards; print narrower than kPrintStroke
/// pixels is none.
constexpr float kOutside = 0.4F;
constexpr int kInwards = 4;
constexpr int kPrintStroke = 9;

// Paper before a lighter background darkens it, too.  It is told from shadows by its hue: where it is even (as between print; it changes by
// less from pixel to pixel), at least this light, and this far off the background's hue, one hue has this share of all that shadows may
// be, and is twice as common as that half-way to the background's.
constexpr float kEven = 0.02F;
constexpr float kLightPaper = 0.75F;
constexpr float kLeastHue = 0.02F;
constexpr double kPaperShare = 0.2;
constexpr float kHueBin = 0.005F;
constexpr int kNoHue = 24;  // the bin in the middle
constexpr int kHueBins = 2 * kNoHue + 1;

/// A shadow reaches at most this many times as far as this share of shadows does,
constexpr double kFarther = 1.5;
constexpr double kMostEnd = 0.75;
/// and discs in it have a radius of at most this share of that, and of the largest piece's size: by a made scan each, with 0.1 knobs of a grey
/// jigsaw are lost, and by the former alone shadows of a white plate are pieces, as most of its border is lit from the side and has none.
constexpr double kWideShade = 0.5;
constexpr double kShadeOfPiece = 0.06;

/// Print on paper before a light background leaves less than this share of the light.  Between it and lighter paper a seam has the
/// background's own light: what is this near to both, pixels, where no more than kMouth pixels are open.
constexpr float kInk = 0.7F;
constexpr int kSeam = 4;
constexpr int kMouth = 11;

/// What is lighter by less in every channel may be in a shadow: beside a border JPEG has the hues of both sides mixed.
constexpr float kNoLighter = 0.03F;

/// If taking shadows off leaves less than this share of the foreground, they were none.
constexpr double kLeastLeft = 0.5;

void for_rows(const cv::Mat& image, const std::function<void(int)>& row) {
  parallel_for(static_cast<std::size_t>(image.rows), 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t y = first; y < last; ++y) row(static_cast<int>(y));
  });
}

/// Change of the distance from pixel to pixel; not for the outermost.
float steepness(const cv::Mat& distance, int x, int y) {
  const float across = 0.5F * (distance.at<float>(y, x + 1) - distance.at<float>(y, x - 1));
  const float down = 0.5F * (distance.at<float>(y + 1, x) - distance.at<float>(y - 1, x));
  return std::sqrt(across * across + down * down);
}

/// Shares of the background's light that a pixel has left, by channel, as their mean and what each is off it, as a share of it.  Weak channels: see kWeak.
struct Shade {
  float light = 0.0F;
  cv::Vec3f hue;
};

/// \return nothing if no shadow is like that
std::optional<Shade> shade_of(const cv::Vec3f& pixel, const cv::Vec3f& behind) {
  const float least = kWeak * std::max({behind[0], behind[1], behind[2]});
  if (least <= 0.0F) return {};
  const float share = std::max(0.0F, pixel.dot(behind) / behind.dot(behind));
  cv::Vec3f left;
  for (int c = 0; c < 3; ++c) left[c] = share + (pixel[c] - share * behind[c]) / std::max(behind[c], least);
  const float low = std::min({left[0], left[1], left[2]});
  const float high = std::max({left[0], left[1], left[2]});
  if (low <= kDarkestShadow || high >= 1.0F || high - low >= kSameHue) return {};
  const float light = (left[0] + left[1] + left[2]) / 3.0F;
  return Shade{light, left / light - cv::Vec3f::all(1.0F)};
}

/// The hue of paper that is as light as a shadow may be, as Shade has it; nothing if there is none.
/// \param distance  of each pixel   \param least  what is nearer is background
std::optional<cv::Vec3f> hue_of_paper(const Background& background, const cv::Mat& image,
                                      const cv::Mat& distance, double least) {
  cv::Mat counts = cv::Mat::zeros(kHueBins, kHueBins, CV_32F);  // by red and blue
  const auto bin = [](float hue) { return cvRound(hue / kHueBin) + kNoHue; };
  double all = 0.0;
  for (int y = 1; y + 1 < image.rows; ++y) {
    for (int x = 1; x + 1 < image.cols; ++x) {
      if (distance.at<float>(y, x) < least || steepness(distance, x, y) >= kEven) continue;
      const std::optional<Shade> shade = shade_of(image.at<cv::Vec3f>(y, x), background.colour(x, y));
      if (!shade) continue;
      ++all;
      const cv::Point place(bin(shade->hue[0]), bin(shade->hue[2]));
      if (shade->light > kLightPaper && cv::Rect({0, 0}, counts.size()).contains(place))
        ++counts.at<float>(place);
    }
  }
  cv::boxFilter(counts, counts, CV_32F, {3, 3}, {-1, -1}, false, cv::BORDER_CONSTANT);
  cv::Mat coloured = counts.clone();
  cv::circle(coloured, {kNoHue, kNoHue}, cvFloor(kLeastHue / kHueBin), 0.0, cv::FILLED);
  double most = 0.0;
  cv::Point mode;
  cv::minMaxLoc(coloured, nullptr, &most, nullptr, &mode);
  const cv::Point between((mode.x + kNoHue) / 2, (mode.y + kNoHue) / 2);
  if (most <= kPaperShare * all || most < 2.0 * counts.at<float>(between)) return {};
  const float blue = kHueBin * static_cast<float>(mode.x - kNoHue);
  const float red = kHueBin * static_cast<float>(mode.y - kNoHue);
  return cv::Vec3f(blue, -blue - red, red);
}

bool is_nearer_to(const cv::Vec3f& hue, const Shade& shade) {
  return shade.hue.dot(hue) > 0.5F * hue.dot(hue);
}

/// Whether shadows on it matter.
bool shows_shadows(const Background& background) {
  const cv::Vec3f& brightest = background.brightest();
  return brightest[0] + brightest[1] + brightest[2] >= 3.0F * kShadowsFall;
}

/// Darker places of the background's own hue where nothing ends.
/// \param paper  hue_of_paper
cv::Mat shades(const Background& background, const cv::Mat& image, const cv::Mat& distance,
               const std::optional<cv::Vec3f>& paper) {
  cv::Mat result = cv::Mat::zeros(image.size(), CV_8U);
  if (!shows_shadows(background)) return result;
  for_rows(image, [&](int y) {
    if (y == 0 || y + 1 == image.rows) return;
    for (int x = 1; x + 1 < image.cols; ++x) {
      if (steepness(distance, x, y) >= kSoft) continue;
      const std::optional<Shade> shade = shade_of(image.at<cv::Vec3f>(y, x), background.colour(x, y));
      if (shade && !(paper && is_nearer_to(*paper, *shade))) result.at<uchar>(y, x) = 255;
    }
  });
  const cv::Mat block = cv::getStructuringElement(cv::MORPH_RECT, {5, 5});
  cv::morphologyEx(result, result, cv::MORPH_OPEN,
                   block);  // no leaks through a pixel or two of a piece's border
  return result;
}

/// The root of the largest part's area, pixels.
double largest_size(const cv::Mat& mask) {
  cv::Mat labels;
  cv::Mat stats;
  cv::Mat centres;
  const int count = cv::connectedComponentsWithStats(mask, labels, stats, centres);
  int most = 0;
  for (int k = 1; k < count; ++k) most = std::max(most, stats.at<int>(k, cv::CC_STAT_AREA));
  return std::sqrt(most);
}

/// How far what is shaded lies from bare background by a way through shade alone, pixels: steps to four and to eight neighbours take turns.
cv::Mat way_through(const cv::Mat& shaded, const cv::Mat& bare) {
  constexpr std::array<std::pair<int, int>, 8> kBeside{
      {{0, 1}, {1, 0}, {0, -1}, {-1, 0}, {1, 1}, {1, -1}, {-1, -1}, {-1, 1}}};
  cv::Mat way(shaded.size(), CV_32F, cv::Scalar(0.0));
  const cv::Rect frame({0, 0}, shaded.size());
  cv::Mat rim;
  cv::dilate(shaded, rim, cv::Mat());
  std::vector<cv::Point> front;
  cv::findNonZero(rim & bare, front);
  for (int steps = 1; !front.empty(); ++steps) {
    std::vector<cv::Point> next;
    for (const cv::Point& from : front) {
      for (std::size_t k = 0; k < (steps % 2 == 0 ? 8U : 4U); ++k) {
        const cv::Point to(from.x + kBeside[k].first, from.y + kBeside[k].second);
        if (!frame.contains(to) || shaded.at<uchar>(to) == 0 || way.at<float>(to) != 0.0F) continue;
        way.at<float>(to) = static_cast<float>(steps);
        next.push_back(to);
      }
    }
    front = std::move(next);
  }
  return way;
}

/// How far from bare background shadows reach where they end at pieces, most of them.
double reach_of_shadows(const cv::Mat& shaded, const cv::Mat& lit, const cv::Mat& reach) {
  cv::Mat ends;
  cv::dilate(lit, ends, cv::Mat());
  ends &= shaded;
  std::vector<float> distances;
  for (int y = 0; y < shaded.rows; ++y)
    for (int x = 0; x < shaded.cols; ++x)
      if (ends.at<uchar>(y, x) != 0) distances.push_back(reach.at<float>(y, x));
  return distances.empty() ? 0.0 : static_cast<double>(quantile(distances, kMostEnd));
}

/// What counts as shaded, but lies farther from bare background than shadows do in this picture, is wide and goes on in what is lit: the
/// inside of a piece of the background's hue.  Between near pieces all may be shaded, far along the gap, but that is narrow.
cv::Mat hue_of_background(const cv::Mat& shaded, const cv::Mat& lit, const cv::Mat& bare) {
  if (cv::countNonZero(shaded) == 0) return shaded;
  cv::Mat reach = way_through(shaded, bare);
  const double farther = kFarther * reach_of_shadows(shaded, lit, reach);
  cv::Mat beyond = shaded & (reach > farther);
  reach.release();  // of large pictures gigabytes
  if (cv::countNonZero(beyond) == 0) return beyond;
  const double widest = std::max(kWideShade * farther, kShadeOfPiece * largest_size(lit));
  cv::Mat width;
  cv::distanceTransform(shaded, width, cv::DIST_L2, cv::DIST_MASK_5);
  return touching(touching(beyond, width > widest), lit);
}

/// What has no more light than the background in any channel.
cv::Mat darker(const Background& background, const cv::Mat& image) {
  cv::Mat result = cv::Mat::zeros(image.size(), CV_8U);
  for_rows(image, [&](int y) {
    for (int x = 0; x < image.cols; ++x) {
      const cv::Vec3f lighter = image.at<cv::Vec3f>(y, x) - background.colour(x, y);
      if (std::max({lighter[0], lighter[1], lighter[2]}) < kNoLighter) result.at<uchar>(y, x) = 255;
    }
  });
  return result;
}

/// What the frame usually is off the background, of those pixels that are no piece.
double noise_of(const cv::Mat& distance, double most) {
  std::vector<float> values;
  for (const cv::Point& place : frame_of(distance.size()))
    if (distance.at<float>(place) < most) values.push_back(distance.at<float>(place));
  return median(values);
}

/// \param strip  distances of the outermost row and the next few inwards
/// \return 255 where the row belongs to a piece
cv::Mat pieces_in_row(const cv::Mat& strip) {
  cv::Mat most;
  cv::reduce(strip.rowRange(1, strip.rows), most, 0, cv::REDUCE_MAX);
  cv::Mat piece = strip.row(0) >= kOutside * most;
  cv::morphologyEx(piece, piece, cv::MORPH_CLOSE,
                   cv::getStructuringElement(cv::MORPH_RECT, {kPrintStroke, 1}));
  return piece;
}

cv::Mat grown(const cv::Mat& mask, int radius) {
  cv::Mat result;
  cv::dilate(mask, result, cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius + 1, 2 * radius + 1}));
  return result;
}

/// Seams of the background's light between print and lighter paper, 255: where a border cuts print, it would run around each letter.
cv::Mat seams_of_print(const Background& background, const cv::Mat& image, const cv::Mat& lit) {
  cv::Mat ink = cv::Mat::zeros(image.size(), CV_8U);
  if (!shows_shadows(background)) return ink;
  cv::Mat paper = ink.clone();
  for_rows(image, [&](int y) {
    for (int x = 0; x < image.cols; ++x) {
      const cv::Vec3f behind = background.colour(x, y);
      const auto& pixel = image.at<cv::Vec3f>(y, x);
      const auto is_below = [&](float share) {
        return pixel[0] < share * behind[0] && pixel[1] < share * behind[1] && pixel[2] < share * behind[2];
      };
      if (is_below(kInk)) ink.at<uchar>(y, x) = 255;
      const cv::Vec3f lighter = pixel - behind;
      if (lit.at<uchar>(y, x) != 0 && lighter[0] + lighter[1] + lighter[2] > 0.0F)
        paper.at<uchar>(y, x) = 255;
    }
  });
  cv::Mat closed;
  cv::morphologyEx(lit, closed, cv::MORPH_CLOSE,
                   cv::getStructuringElement(cv::MORPH_ELLIPSE, {kMouth, kMouth}));
  return closed & grown(ink, kSeam) & grown(paper, kSeam) & ~lit;
}

}  // namespace

cv::Mat touching(const cv::Mat& soft, const cv::Mat& bare) {
  cv::Mat labels;
  const int count = cv::connectedComponents(soft, labels, 4, CV_32S);
  cv::Mat wide;
  cv::dilate(bare, wide, cv::getStructuringElement(cv::MORPH_RECT, {5, 5}));
  std::vector<char> touches(static_cast<std::size_t>(count), 0);
  for (int y = 0; y < soft.rows; ++y)
    for (int x = 0; x < soft.cols; ++x)
      if (wide.at<uchar>(y, x) != 0) touches[static_cast<std::size_t>(labels.at<int>(y, x))] = 1;
  cv::Mat result = cv::Mat::zeros(soft.size(), CV_8U);
  for (int y = 0; y < soft.rows; ++y)
    for (int x = 0; x < soft.cols; ++x)
      if (soft.at<uchar>(y, x) != 0 && touches[static_cast<std::size_t>(labels.at<int>(y, x))] != 0)
        result.at<uchar>(y, x) = 255;
  return result;
}

cv::Mat distance_from(const Background& background, const cv::Mat& image) {
  const cv::Vec3f brightest = background.brightest();
  cv::Mat distance(image.size(), CV_32F);
  for_rows(image, [&](int y) {
    for (int x = 0; x < image.cols; ++x) {
      const cv::Vec3f behind = background.colour(x, y);
      const auto& pixel = image.at<cv::Vec3f>(y, x);
      float sum = 0.0F;
      for (int c = 0; c < 3; ++c) {
        const float lit =
            background.plain() ? 1.0F : brightest[c] / std::max(behind[c], kLeastLight * brightest[c]);
        const float d = (pixel[c] - behind[c]) * lit;
        sum += d * d;
      }
      distance.at<float>(y, x) = std::sqrt(sum);
    }
  });
  return distance;
}

Foreground foreground(const Background& background, const cv::Mat& image, double contrast, double most) {
  cv::Mat smooth;
  cv::GaussianBlur(image, smooth, cv::Size(), kBlur, kBlur, cv::BORDER_REPLICATE);
  const cv::Mat distance = distance_from(background, smooth);
  const double noise = std::max(kLeastDistance, kNoiseFactor * noise_of(distance, most));
  const std::optional<cv::Vec3f> paper = hue_of_paper(background, smooth, distance, noise);
  const double least = std::min(most, paper ? noise : std::max(noise, kRinging * contrast));
  const cv::Mat bare = distance < least;
  const cv::Mat shaded = touching(shades(background, smooth, distance, paper), bare);
  const cv::Mat all = ~bare;
  const cv::Mat dim = darker(background, smooth);
  cv::Mat lit = all & ~shaded;
  lit |= seams_of_print(background, smooth, lit);
  if (!paper && cv::countNonZero(lit) < kLeastLeft * cv::countNonZero(all))
    return {all, cv::Mat::zeros(all.size(), CV_8U), dim};
  lit |= hue_of_background(shaded, lit, bare);
  return {lit, shaded & ~lit, dim};
}

void clear_frame(const cv::Mat& distance, cv::Mat& mask) {
  const int rows = distance.rows;
  const int columns = distance.cols;
  if (std::min(rows, columns) <= kInwards) return;
  cv::Mat strip;
  mask.row(0) &= pieces_in_row(distance.rowRange(0, kInwards + 1));
  cv::flip(distance.rowRange(rows - kInwards - 1, rows), strip, 0);
  mask.row(rows - 1) &= pieces_in_row(strip);
  cv::transpose(distance.colRange(0, kInwards + 1), strip);
  mask.col(0) &= pieces_in_row(strip).t();
  cv::transpose(distance.colRange(columns - kInwards - 1, columns), strip);
  cv::flip(strip, strip, 0);
  mask.col(columns - 1) &= pieces_in_row(strip).t();
}

}  // namespace rejoin::outline::detail
