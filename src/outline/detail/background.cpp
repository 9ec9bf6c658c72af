#include "outline/detail/background.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "core/median.hpp"

namespace rejoin::outline::detail {
namespace {

/// A pixel whose colour is this near to the background's follows it, 0..1 a channel.
constexpr double kFollows = 0.04;
/// A surface is worth its terms if this much more of the picture follows it than follows one colour.
constexpr double kWorthASurface = 0.05;
/// This much, if the frame is not nearer to it by that factor, as where a lens darkens the corners alone; not if it is farther by the other.
constexpr double kWorthNoNearer = 0.1;
constexpr double kNearer = 0.8;
constexpr double kFarther = 1.1;
/// Less than any noise, 0..1 a channel.
constexpr double kNoNoise = 0.002;
/// Rounds in which what follows a surface is chosen and the surface fitted to it again.
constexpr int kRounds = 12;
/// Share of the frame that a first surface is fitted to: the rest may be pieces.
constexpr double kTrusted = 0.6;
/// The picture is looked at in about this many places.
constexpr double kPlaces = 40000.0;

using Places = std::vector<cv::Point>;

Places grid_over(const cv::Size& size) {
  const int step = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(size.area()) / kPlaces)));
  Places grid;
  for (int y = step / 2; y < size.height; y += step)
    for (int x = step / 2; x < size.width; x += step) grid.emplace_back(x, y);
  return grid;
}

double distance(const cv::Mat& image, const Background& background, const cv::Point& place) {
  return cv::norm(image.at<cv::Vec3f>(place) - background.colour(place.x, place.y));
}

double share_that_follows(const cv::Mat& image, const Background& background, const Places& places) {
  const auto follows = std::count_if(places.begin(), places.end(), [&](const cv::Point& place) {
    return distance(image, background, place) < kFollows;
  });
  return static_cast<double>(follows) / static_cast<double>(places.size());
}

/// Median distance of the places' colours from the background's.
double typical_distance(const cv::Mat& image, const Background& background, const Places& places) {
  std::vector<double> distances;
  distances.reserve(places.size());
  for (const cv::Point& place : places) distances.push_back(distance(image, background, place));
  return median(distances);
}

/// The given share of places, those that follow the background best.
Places best_of(const cv::Mat& image, const Background& background, Places places, double share) {
  const auto kept = static_cast<std::ptrdiff_t>(share * static_cast<double>(places.size()));
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < places.size(); ++i)
    order.emplace_back(distance(image, background, places[i]), i);
  std::nth_element(order.begin(), order.begin() + kept, order.end());
  Places best;
  for (auto chosen = order.begin(); chosen != order.begin() + kept; ++chosen)
    best.push_back(places[chosen->second]);
  return best;
}

Places that_follow(const cv::Mat& image, const Background& background, const Places& places) {
  Places found;
  std::copy_if(places.begin(), places.end(), std::back_inserter(found),
               [&](const cv::Point& place) { return distance(image, background, place) < kFollows; });
  return found;
}

}  // namespace

Places frame_of(const cv::Size& size) {
  Places frame;
  for (int y = 0; y < size.height; ++y) {
    const bool whole_row = y == 0 || y + 1 == size.height || size.width == 1;
    for (int x = 0; x < size.width; x += whole_row ? 1 : size.width - 1) frame.emplace_back(x, y);
  }
  return frame;
}

Background::Terms Background::terms(int x, int y) const {
  const float u =
      size_.width > 1 ? 2.0F * static_cast<float>(x) / static_cast<float>(size_.width - 1) - 1.0F : 0.0F;
  const float v =
      size_.height > 1 ? 2.0F * static_cast<float>(y) / static_cast<float>(size_.height - 1) - 1.0F : 0.0F;
  const float square = u * u + v * v;
  return {1.0F, u, v, u * u, u * v, v * v, square * square};
}

cv::Vec3f Background::colour(int x, int y) const {
  if (plain_) return {factors_[0][0], factors_[1][0], factors_[2][0]};
  const Terms at = terms(x, y);
  cv::Vec3f sum(0.0F, 0.0F, 0.0F);
  for (std::size_t channel = 0; channel < 3; ++channel)
    for (std::size_t i = 0; i < kTerms; ++i) sum[static_cast<int>(channel)] += factors_[channel][i] * at[i];
  return sum;
}

void Background::find_extremes(const Places& frame) {
  double low = 0.0;
  double high = 0.0;
  for (std::size_t i = 0; i < frame.size(); ++i) {
    const cv::Vec3f there = colour(frame[i].x, frame[i].y);
    const double mean = (there[0] + there[1] + there[2]) / 3.0;
    if (i == 0 || mean < low) low = mean;
    if (i > 0 && mean <= high) continue;
    high = mean;
    brightest_ = there;
  }
  darkest_ = high > 0.0 ? std::max(0.0, low) / high : 1.0;
}

void Background::fit(const cv::Mat& image, const Places& places) {
  cv::Mat normal = cv::Mat::zeros(kTerms, kTerms, CV_64F);
  cv::Mat right = cv::Mat::zeros(kTerms, 3, CV_64F);
  for (const cv::Point& place : places) {
    const Terms at = terms(place.x, place.y);
    const auto& pixel = image.at<cv::Vec3f>(place);
    for (int i = 0; i < static_cast<int>(kTerms); ++i) {
      const double factor = at[static_cast<std::size_t>(i)];
      for (int j = 0; j < static_cast<int>(kTerms); ++j)
        normal.at<double>(i, j) += factor * at[static_cast<std::size_t>(j)];
      for (int channel = 0; channel < 3; ++channel) right.at<double>(i, channel) += factor * pixel[channel];
    }
  }
  cv::Mat solved;
  cv::solve(normal, right, solved, cv::DECOMP_SVD);
  for (int channel = 0; channel < 3; ++channel)
    for (int i = 0; i < static_cast<int>(kTerms); ++i)
      factors_[static_cast<std::size_t>(channel)][static_cast<std::size_t>(i)] =
          static_cast<float>(solved.at<double>(i, channel));
}

Background::Background(const cv::Mat& image) : size_(image.size()) {
  const Places frame = frame_of(size_);
  for (int channel = 0; channel < 3; ++channel) {
    std::vector<float> values;
    values.reserve(frame.size());
    for (const cv::Point& place : frame) values.push_back(image.at<cv::Vec3f>(place)[channel]);
    factors_[static_cast<std::size_t>(channel)][0] = median(values);
  }
  find_extremes(frame);
  Places all = grid_over(size_);
  all.insert(all.end(), frame.begin(), frame.end());
  const double of_one_colour = share_that_follows(image, *this, all);
  if (of_one_colour + kWorthASurface > 1.0) return;

  Background surface = *this;
  surface.plain_ = false;
  surface.fit(image, frame);
  for (int round = 0; round < kRounds; ++round) surface.fit(image, best_of(image, surface, frame, kTrusted));
  for (int round = 0; round < kRounds; ++round) {
    const Places following = that_follow(image, surface, all);
    if (following.size() < kTerms) return;
    surface.fit(image, following);
  }
  if (share_that_follows(image, surface, frame) < kTrusted * share_that_follows(image, *this, frame))
    return;  // it has grown into the pieces
  // Between a background of one colour and pale pieces on it, a surface follows both, but the frame no better.
  // Where the frame has one colour without any noise it is as bright as the scanner can tell, and says nothing of the light.
  const double of_plain = typical_distance(image, *this, frame);
  const double of_surface = typical_distance(image, surface, frame);
  const bool clipped = of_plain < kNoNoise;
  if (!clipped && of_surface > kFarther * of_plain) return;
  const double worth = clipped || of_surface < kNearer * of_plain ? kWorthASurface : kWorthNoNearer;
  if (share_that_follows(image, surface, all) < of_one_colour + worth) return;
  surface.find_extremes(frame);
  *this = surface;
}

}  // namespace rejoin::outline::detail
