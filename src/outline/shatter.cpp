#include "outline/shatter.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"
#include "core/version.hpp"
#include "outline/detail/breaking.hpp"
#include "outline/detail/clip.hpp"
#include "outline/scan.hpp"

namespace rejoin::outline {
namespace {

using detail::LinedPolygon;

constexpr double kMmPerInch = 25.4;
constexpr double kMargin = 3.0;  // around a scan, pixels
constexpr double kLeastArea = 400.0;

/// Streams of random numbers, so that one part's draws do not move another's.
constexpr std::uint64_t kBreakStream = 1000003;
constexpr std::uint64_t kScanStream = 2000003;

bool within(double value, double low, double high) {
  return value >= low && value <= high;  // false for NaN
}

void check(const ShatterOptions& options) {
  if (!within(options.objects, 1, 10000))
    throw InputError("shatter", fmt::format("{} objects", options.objects), "give 1 to 10000");
  if (!within(options.pieces, options.objects, 100000)) {
    throw InputError("shatter", fmt::format("{} pieces of {} objects", options.pieces, options.objects),
                     "give at least one piece an object and at most 100000");
  }
  if (!within(options.resolution, 10, 2400))
    throw InputError("shatter", fmt::format("resolution {}", options.resolution), "give 10 to 2400");
  if (!within(options.wear, 0, 20))
    throw InputError("shatter", fmt::format("wear of {} pixels", options.wear), "give 0 to 20");
  if (!within(options.noise, 0, 3))
    throw InputError("shatter", fmt::format("noise of {} pixels", options.noise), "give 0 to 3");
}

/// Angles and radii at random between two extremes.  Edges are as long as a break's steps and turn as sharply, so that
/// an old border does not look different from a break.
std::vector<glm::dvec2> random_shape(double unit, Random& random) {
  constexpr double kMeanStep = 0.125;  // radians: 0.6 units at a radius of 4.8
  std::vector<double> angles;
  double turn = 0.0;
  while (turn < 2.0 * M_PI) {
    angles.push_back(turn);
    turn += kMeanStep * random.uniform(0.5, 1.5);
  }
  std::vector<glm::dvec2> points;
  points.reserve(angles.size());
  for (const double angle : angles) {
    const double radius = unit * random.uniform(4.4, 5.2);
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return points;
}

std::vector<glm::dvec2> random_tile(double pixels_per_mm, Random& random) {
  const double width = pixels_per_mm * random.uniform(100.0, 150.0);
  const double height = pixels_per_mm * random.uniform(100.0, 150.0);
  return {{0.0, 0.0}, {width, 0.0}, {width, height}, {0.0, height}};
}

detail::BreakOptions break_options(const ShatterOptions& options) {
  detail::BreakOptions breaks;
  if (options.kind == ObjectKind::Shape) {
    breaks.step_low = 0.3 * options.resolution;
    breaks.step_high = 0.9 * options.resolution;
    breaks.spread_rad = 1.05;
  } else {
    const double pixels_per_mm = options.resolution / kMmPerInch;
    breaks.step_low = 2.0 * pixels_per_mm;
    breaks.step_high = 8.0 * pixels_per_mm;
    breaks.spread_rad = 0.6;
    breaks.roughness = 0.12;
  }
  return breaks;
}

/// The parts of one object, in its own frame.
std::vector<LinedPolygon> break_object(const ShatterOptions& options, std::size_t object,
                                       std::size_t pieces) {
  Random random(options.seed, kBreakStream + 2 * object);
  const std::vector<glm::dvec2> border = options.kind == ObjectKind::Shape
                                             ? random_shape(options.resolution, random)
                                             : random_tile(options.resolution / kMmPerInch, random);
  detail::Breaker breaker(break_options(options), Random(options.seed, kBreakStream + 2 * object + 1));
  std::vector<LinedPolygon> parts{breaker.whole(border)};
  std::vector<double> areas{signed_area(border)};
  while (parts.size() < pieces) {
    const auto at = static_cast<std::size_t>(std::max_element(areas.begin(), areas.end()) - areas.begin());
    auto halves = areas[at] > 4.0 * kLeastArea ? breaker.split(parts[at]) : std::nullopt;
    if (!halves) {
      throw InputError("shatter",
                       fmt::format("{} pieces of one object are too small for the resolution", pieces),
                       "ask for fewer pieces or a higher resolution");
    }
    areas[at] = signed_area(detail::points_of(halves->first));
    areas.push_back(signed_area(detail::points_of(halves->second)));
    parts[at] = std::move(halves->first);
    parts.push_back(std::move(halves->second));
  }
  return parts;
}

/// A disc's border.
detail::Polygon disc(const glm::dvec2& centre, double radius) {
  constexpr int kCorners = 16;
  detail::Polygon polygon;
  polygon.reserve(kCorners);
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * M_PI * i / kCorners;
    polygon.push_back(centre + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

/// Worn off all around, more at corners that stick out, with bites here and there.
std::vector<glm::dvec2> worn(const std::vector<glm::dvec2>& border, double wear, Random& random) {
  if (wear <= 0.0) return border;
  // Shrinking by more and growing again rounds what sticks out.
  const detail::Region shrunk = detail::offset({border}, -1.5 * wear, 0.05);
  const detail::Region rounded = detail::offset(shrunk, 0.5 * wear, 0.05);
  const std::vector<double> lengths = arc_lengths(border);
  detail::Region bites;
  double at = random.uniform(0.0, 100.0 * wear);
  while (at < lengths.back()) {
    bites.push_back(disc(point_at(border, lengths, at), wear * random.uniform(1.5, 4.0)));
    at += random.uniform(20.0, 180.0) * wear;
  }
  return detail::largest(detail::subtract(rounded, bites));
}

/// Names, wears, places and scans one piece.
ShatteredPiece scan(const std::vector<glm::dvec2>& part, const ShatterOptions& options, std::size_t number) {
  Random random(options.seed, kScanStream + number);
  const std::vector<glm::dvec2> border = worn(part, options.wear, random);
  if (signed_area(border) < kLeastArea) {
    throw InputError("shatter", "a piece is too small for the resolution or the wear",
                     "ask for fewer pieces, less wear or a higher resolution");
  }
  Planar pose;
  pose.angle_rad = options.turn ? random.uniform(0.0, 2.0 * M_PI) : 0.0;
  pose.flipped = options.flip && random.below(2) == 1;
  ShatteredPiece result;
  result.border.reserve(border.size());
  glm::dvec2 low(1e300);
  for (const glm::dvec2& p : border) {
    result.border.push_back(pose(p));
    low = glm::min(low, result.border.back());
  }
  const double x = random.uniform();
  const double y = random.uniform();
  pose.translation = kMargin + glm::dvec2(x, y) - low;
  for (glm::dvec2& p : result.border) p += pose.translation;
  if (pose.flipped) std::reverse(result.border.begin(), result.border.end());
  result.to_object = inverse(pose);
  result.piece.name = fmt::format("piece_{:03}", number);
  result.piece.outline.points = options.scan == ScanKind::Pixels
                                    ? edge_pixels(result.border)
                                    : sample_border(result.border, options.noise, random);
  return result;
}

/// 0..1, smooth over a few millimetres: the pattern on the objects' faces.
double pattern(const glm::dvec2& at, double scale) {
  const glm::dvec2 p = at / scale;
  return 0.5 + 0.25 * std::sin(p.x + 1.7 * std::sin(0.6 * p.y)) +
         0.25 * std::sin(1.3 * p.y + 1.1 * std::sin(0.7 * p.x));
}

}  // namespace

Shattered shatter(const ShatterOptions& options, const Context& context) {
  check(options);
  const auto objects = static_cast<std::size_t>(options.objects);
  const auto pieces = static_cast<std::size_t>(options.pieces);
  std::vector<std::vector<LinedPolygon>> parts(objects);
  parallel_for(objects, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last && !context.cancelled(); ++k)
      parts[k] = break_object(options, k, pieces / objects + (k < pieces % objects ? 1 : 0));
  });
  Shattered result;
  const bool tiles = options.kind == ObjectKind::Tile;
  result.unit = tiles ? "mm" : "px";
  result.pixel_size = tiles ? kMmPerInch / options.resolution : 1.0;
  // In the common frame the objects lie side by side.
  const double spacing = tiles ? 200.0 / result.pixel_size : 12.0 * options.resolution;
  std::vector<std::vector<glm::dvec2>> borders;
  borders.reserve(pieces);
  for (std::size_t k = 0; k < objects; ++k) {
    for (const detail::SharedLength& join : detail::shared_lengths(parts[k]))
      result.joins.push_back({borders.size() + join.a, borders.size() + join.b, join.length});
    for (const LinedPolygon& part : parts[k]) {
      borders.push_back(detail::points_of(part));
      for (glm::dvec2& p : borders.back()) p.x += spacing * static_cast<double>(k);
      result.pieces.emplace_back().object = k;
    }
  }
  parallel_for(borders.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last && !context.cancelled(); ++n) {
      const std::size_t object = result.pieces[n].object;
      result.pieces[n] = scan(borders[n], options, n);
      result.pieces[n].object = object;
    }
  });
  return result;
}

std::vector<std::uint8_t> picture_png(const ShatteredPiece& piece, const ShatterOptions& options) {
  Random random(options.seed, 3 * kScanStream + piece.object);
  glm::dvec2 high(0.0);
  for (const glm::dvec2& p : piece.border) high = glm::max(high, p);
  const int width = static_cast<int>(std::ceil(high.x + kMargin)) + 1;
  const int height = static_cast<int>(std::ceil(high.y + kMargin)) + 1;
  std::vector<glm::dvec2> border = piece.border;
  if (options.noise > 0.0) border = piece.piece.outline.points;
  const std::vector<float> coverage = pixel_coverage(border, width, height);
  const glm::dvec3 dark(random.uniform(60, 120), random.uniform(60, 120), random.uniform(60, 120));
  const glm::dvec3 light(random.uniform(140, 230), random.uniform(140, 230), random.uniform(140, 230));
  cv::Mat image(height, width, CV_8UC4);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double shade = pattern(piece.to_object({x, y}), 0.25 * options.resolution);
      const glm::dvec3 colour = glm::mix(dark, light, shade);
      const double alpha = coverage[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                    static_cast<std::size_t>(x)];
      image.at<cv::Vec4b>(y, x) = {static_cast<std::uint8_t>(colour.z), static_cast<std::uint8_t>(colour.y),
                                   static_cast<std::uint8_t>(colour.x),
                                   static_cast<std::uint8_t>(std::lround(255.0 * std::min(1.0, alpha)))};
    }
  }
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", image, bytes);
  return bytes;
}

std::string truth_json(const Shattered& shattered, const ShatterOptions& options, const std::string& ending) {
  using nlohmann::ordered_json;
  ordered_json fragments = ordered_json::object();
  for (const ShatteredPiece& piece : shattered.pieces) {
    const glm::dmat3 m = matrix(piece.to_object);
    const double s = shattered.pixel_size;
    ordered_json rows = ordered_json::array();
    for (int row = 0; row < 2; ++row) rows.push_back({s * m[0][row], s * m[1][row], s * m[2][row]});
    rows.push_back({0.0, 0.0, 1.0});
    fragments[piece.piece.name + ending] = {{"to_world", rows}, {"object", piece.object}};
  }
  ordered_json joins = ordered_json::array();
  for (const TrueJoin& join : shattered.joins) {
    joins.push_back({shattered.pieces[join.a].piece.name + ending,
                     shattered.pieces[join.b].piece.name + ending, shattered.pixel_size * join.length});
  }
  ordered_json truth = {{"unit", shattered.unit}, {"seed", options.seed}};
  if (options.kind == ObjectKind::Tile) truth["dpi"] = options.resolution;
  truth["wear"] = options.wear;
  truth["noise"] = options.noise;
  truth["version"] = kVersion;
  truth["fragments"] = std::move(fragments);
  truth["joins"] = std::move(joins);
  return truth.dump(1) + "\n";
}

}  // namespace rejoin::outline
