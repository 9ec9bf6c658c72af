#include "outline/extract.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <opencv2/imgproc.hpp>

#include "core/error.hpp"
#include "core/words.hpp"
#include "outline/detail/contour.hpp"
#include "outline/detail/coverage.hpp"
#include "outline/detail/necks.hpp"
#include "outline/detail/threads.hpp"
#include "outline/detail/torn_core.hpp"
#include "outline/polygon.hpp"
#include "picture/image_file.hpp"

namespace rejoin::outline {
namespace {

/// Shorter contours are specks.
constexpr std::size_t kLeastPoints = 12;
/// A contour this far outside the outermost pixels' centres runs along the picture's border, pixels.
constexpr double kBorderBand = 0.25;
/// How much of a piece's border may run along the picture's border before the piece counts as cut, pixels.
constexpr double kMostOnBorder = 12.0;
// A rectangle that takes more than this share of the picture's width and height is hardly a piece, and fills this share of its box.
constexpr double kLeastBed = 0.85;
constexpr double kRectangle = 0.97;
// More pieces than this of which the largest takes less than this share of the picture, and fewer pixels, are hardly pieces.
constexpr std::size_t kMany = 20;
constexpr double kSmall = 0.01;
constexpr double kLargestLetter = 250.0 * 250.0;
// They are print if they lie on paper: what is this much farther from the background than its frame is, on the mean of many pixels,
// and has this many times their area.
constexpr double kPaperBlur = 4.0;
constexpr double kFaint = 0.02;
constexpr double kPaperArea = 2.5;
/// Colours are taken this far inside, so that the background does not bleed in, pixels.
constexpr double kColourDepth = 3.0;
// A border is an edge where this share of what it rises by over the wide reach it rises by over the narrow one, in pixels to
// either side; but for print a piece has hardly anything else.
constexpr double kNarrowReach = 3.0;
constexpr double kWideReach = 9.0;
constexpr float kLeastEdge = 0.45F;
constexpr double kMostBlurred = 0.3;
/// The border's direction at a point is that from this many points before to as many after.
constexpr std::size_t kDirectionReach = 4;

/// A field without soft edges has a staircase border; this takes the short steps off (pixels, standard deviation).
constexpr double kStaircaseBlur = 0.7;
/// Contours that follow the pixels' steps by more have one, pixels.
constexpr double kStaircase = 0.15;
/// A place that lies anywhere in a pixel is so far from its middle (1 / sqrt(12), rms).  A lens hides the steps of a border that was
/// turned as black and white, but leaves the long ones of shallow slopes as they are.
constexpr double kHardRaster = 0.29;

/// What is left out as dust may be none if it covers this many pixels and this share of what would not be dust.
constexpr double kLargestSpeck = 400.0;
constexpr double kDoubtfulDust = 0.1;
/// A hole with no more of the piece between it and the outside is a bay whose mouth closed in the picture, pixels.
constexpr double kMouth = 4.0;
/// A line around paper covers at most this share of what it encloses, and is at most this wide, pixels.
constexpr double kLineArea = 0.2;
constexpr double kLineWidth = 12.0;
/// A piece that is so many times as wide as its neck may be two.
constexpr double kDoubtfulNeck = 4.0;

using Polygon = std::vector<glm::dvec2>;

double length_on_border(const Polygon& polygon, const cv::Mat& image) {
  double length = 0.0;
  const glm::dvec2 last(image.cols - 1, image.rows - 1);
  const auto at_border = [&](const glm::dvec2& p) {
    return p.x < -kBorderBand || p.y < -kBorderBand || p.x > last.x + kBorderBand ||
           p.y > last.y + kBorderBand;
  };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 next = polygon[(i + 1) % polygon.size()];
    if (at_border(polygon[i]) && at_border(next)) length += glm::distance(polygon[i], next);
  }
  return length;
}

/// Colour of a pixel position, red green blue, linear between pixels.
glm::dvec3 colour_at(const cv::Mat& image, const glm::dvec2& point) {
  const double x = std::clamp(point.x, 0.0, image.cols - 1.0);
  const double y = std::clamp(point.y, 0.0, image.rows - 1.0);
  const int column = std::min(static_cast<int>(x), std::max(image.cols - 2, 0));
  const int row = std::min(static_cast<int>(y), std::max(image.rows - 2, 0));
  glm::dvec3 sum(0.0);
  for (int k = 0; k < 4; ++k) {
    const int c = std::min(column + (k & 1), image.cols - 1);
    const int r = std::min(row + (k >> 1), image.rows - 1);
    const auto* pixel = image.ptr<float>(r) + static_cast<std::ptrdiff_t>(c) * image.channels();
    const double weight = (1.0 - std::abs(x - c)) * (1.0 - std::abs(y - r));
    sum += weight * glm::dvec3(pixel[2], pixel[1], pixel[0]);
  }
  return sum;
}

/// The direction into the piece at each point of its border; zero where the border turns back on itself.
Polygon inward_directions(const Polygon& polygon) {
  Polygon directions;
  directions.reserve(polygon.size());
  const std::size_t count = polygon.size();
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 chord =
        polygon[(i + kDirectionReach) % count] - polygon[(i + count - kDirectionReach) % count];
    const double length = glm::length(chord);
    directions.push_back(length > 0.0 ? glm::dvec2(-chord.y, chord.x) / length : glm::dvec2(0.0));
  }
  return directions;
}

std::vector<glm::dvec3> border_colours(const Polygon& polygon, const cv::Mat& image) {
  const Polygon inward = inward_directions(polygon);
  std::vector<glm::dvec3> colours;
  colours.reserve(polygon.size());
  for (std::size_t i = 0; i < polygon.size(); ++i)
    colours.push_back(colour_at(image, polygon[i] + kColourDepth * inward[i]));
  return colours;
}

/// Whether much of the border is no edge but a slow change, as of light.
bool is_blurred(const Polygon& polygon, const cv::Mat& distance) {
  const Polygon inward = inward_directions(polygon);
  const auto at = [&](const glm::dvec2& p) {
    const cv::Point pixel(static_cast<int>(std::lround(p.x)), static_cast<int>(std::lround(p.y)));
    return cv::Rect({0, 0}, distance.size()).contains(pixel) ? distance.at<float>(pixel) : 0.0F;
  };
  std::size_t slow = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto rise = [&](double reach) {
      return at(polygon[i] + reach * inward[i]) - at(polygon[i] - reach * inward[i]);
    };
    if (rise(kNarrowReach) < kLeastEdge * rise(kWideReach)) ++slow;
  }
  return static_cast<double>(slow) > kMostBlurred * static_cast<double>(polygon.size());
}

/// Pieces and holes by the sign of their area, largest first; equal ones by place.
struct Loops {
  std::vector<Polygon> outer;
  std::vector<Polygon> holes;
};

Loops sort_loops(std::vector<Polygon> all) {
  std::vector<std::pair<double, Polygon>> sized;
  sized.reserve(all.size());
  for (Polygon& polygon : all) {
    const double area = signed_area(polygon);
    sized.emplace_back(area, std::move(polygon));
  }
  std::stable_sort(sized.begin(), sized.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.first) > std::abs(b.first); });
  Loops loops;
  for (auto& [area, polygon] : sized) (area > 0.0 ? loops.outer : loops.holes).push_back(std::move(polygon));
  return loops;
}

/// The first that is smaller than an area.
/// \param polygons  largest first
std::vector<Polygon>::iterator first_below(double area, std::vector<Polygon>& polygons) {
  return std::ranges::find_if(polygons, [&](const Polygon& p) { return std::abs(signed_area(p)) < area; });
}

/// Gives each hole to the smallest piece around it.
void assign_holes(std::vector<Polygon>& holes, std::vector<Outline>& pieces) {
  for (Polygon& hole : holes) {
    for (auto piece = pieces.rbegin(); piece != pieces.rend(); ++piece) {
      if (!contains(piece->points, hole[0])) continue;
      piece->holes.push_back(std::move(hole));
      break;
    }
  }
}

/// Corners of the box around a piece, left above and right below.
std::pair<glm::dvec2, glm::dvec2> box_of(const Polygon& polygon) {
  std::pair box(polygon[0], polygon[0]);
  for (const glm::dvec2& p : polygon) box = {glm::min(box.first, p), glm::max(box.second, p)};
  return box;
}

/// Where a user finds a piece that has no name.
std::string place_of(const Polygon& polygon) {
  const auto [low, high] = box_of(polygon);
  return fmt::format("{:.0f} x {:.0f} pixels at x {:.0f}, y {:.0f}", high.x - low.x, high.y - low.y,
                     std::ceil(std::max(low.x, 0.0)), std::ceil(std::max(low.y, 0.0)));
}

/// Whether a piece is a rectangle that runs along the picture's border: mostly the page or the scanner's bed, within a dark frame.
bool is_bed(const Polygon& polygon, const cv::Mat& image) {
  const auto [low, high] = box_of(polygon);
  const glm::dvec2 share = (high - low) / glm::dvec2(image.cols, image.rows);
  return std::min(share.x, share.y) > kLeastBed &&
         signed_area(polygon) > kRectangle * (high.x - low.x) * (high.y - low.y);
}

double mean_of_frame(const cv::Mat& image) {
  const int right = image.cols - 1;
  const int below = image.rows - 1;
  return 0.25 * (cv::mean(image.row(0))[0] + cv::mean(image.row(below))[0] + cv::mean(image.col(0))[0] +
                 cv::mean(image.col(right))[0]);
}

/// Whether most pieces lie on something much larger than they are all together that hardly differs from the background.
bool lie_on_paper(const std::vector<Polygon>& pieces, const cv::Mat& distance) {
  cv::Mat soft;
  cv::GaussianBlur(distance, soft, cv::Size(), kPaperBlur, kPaperBlur, cv::BORDER_REPLICATE);
  cv::Mat labels;
  cv::Mat stats;
  cv::Mat centres;
  const int count =
      cv::connectedComponentsWithStats(soft > mean_of_frame(soft) + kFaint, labels, stats, centres);
  std::vector<std::size_t> held(static_cast<std::size_t>(count), 0);
  double area = 0.0;
  for (const Polygon& piece : pieces) {
    area += signed_area(piece);
    const cv::Point place(static_cast<int>(std::clamp(piece[0].x, 0.0, labels.cols - 1.0)),
                          static_cast<int>(std::clamp(piece[0].y, 0.0, labels.rows - 1.0)));
    ++held[static_cast<std::size_t>(labels.at<int>(place))];
  }
  for (int i = 1; i < count; ++i) {
    if (2 * held[static_cast<std::size_t>(i)] > pieces.size() &&
        stats.at<int>(i, cv::CC_STAT_AREA) > kPaperArea * area)
      return true;
  }
  return false;
}

/// \throws InputError what was found is print, as its paper has nearly the background's colour
void require_no_print(const std::vector<Polygon>& pieces, const cv::Mat& distance, const std::string& path) {
  const bool small = signed_area(pieces[0]) < kSmall * static_cast<double>(distance.total());
  if (pieces.size() <= kMany || !small || !lie_on_paper(pieces, distance)) return;
  throw InputError(
      path,
      fmt::format("{} small pieces on a large one that hardly differs from the background: they look like "
                  "print, and their paper cannot be told from what lies behind it",
                  pieces.size()),
      "take the picture again before another colour");
}

/// What may have been taken for a piece in front of the background.
/// \param outer  largest first   \param distance  detail::Coverage::distance
void doubt_background(const std::vector<Polygon>& outer, const cv::Mat& distance,
                      std::vector<std::string>& notes) {
  if (std::any_of(outer.begin(), outer.end(), [&](const Polygon& p) { return is_blurred(p, distance); }))
    notes.emplace_back(
        "the outline is blurred, so look whether it is the piece's or that of light on the background");
  const double letter = std::min(kLargestLetter, kSmall * static_cast<double>(distance.total()));
  if (outer.size() > kMany && signed_area(outer[0]) < letter) {
    notes.push_back(fmt::format(
        "{} pieces, all small: if these are letters or specks, the background is too like the piece",
        outer.size()));
  }
  if (is_bed(outer[0], distance)) {
    notes.emplace_back(
        "the largest piece is a rectangle along the picture's border: if that is the page or the scanner's "
        "bed, cut "
        "the frame around it off");
  }
}

/// Leaves out the pieces that the picture's border cuts, unless none is whole.
void judge_cut_pieces(std::vector<Polygon>& outer, const cv::Mat& image, std::vector<std::string>& notes) {
  const auto cut = [&](const Polygon& polygon) { return length_on_border(polygon, image) > kMostOnBorder; };
  const auto whole = static_cast<std::size_t>(
      std::count_if(outer.begin(), outer.end(), [&](const Polygon& p) { return !cut(p); }));
  if (whole == outer.size()) return;
  if (whole == 0) {
    notes.emplace_back("the piece touches the picture's border and is taken as ending there");
    return;
  }
  std::string which;
  for (const Polygon& polygon : outer)
    if (cut(polygon)) which += (which.empty() ? "" : "; ") + place_of(polygon);
  const std::size_t count = outer.size() - whole;
  notes.push_back(fmt::format("{} of {} pieces {} the picture's border and {} left out ({})", count,
                              outer.size(), count == 1 ? "touches" : "touch", count == 1 ? "is" : "are",
                              which));
  outer.erase(std::remove_if(outer.begin(), outer.end(), cut), outer.end());
}

/// Tells where pieces seem to touch, and parts them there if that is asked for.
/// \param largest  area of the largest piece, pixels   \param field  Coverage::field
/// \return whether some were parted
bool part_touching(cv::Mat& field, double largest, const ExtractOptions& options,
                   std::vector<std::string>& notes) {
  constexpr std::size_t kNamed = 3;
  std::vector<detail::Neck> necks =
      detail::necks(field >= 0.5, std::max(kLargestSpeck, options.dust / 100.0 * largest));
  if (!options.part_touching)
    std::erase_if(necks, [](const detail::Neck& neck) { return neck.wider < kDoubtfulNeck; });
  if (necks.empty()) return false;
  std::string where;
  for (std::size_t k = 0; k < std::min(necks.size(), kNamed); ++k) {
    where += fmt::format("{}{:.0f} pixels wide at x {}, y {}", k > 0 ? "; " : "", necks[k].width,
                         necks[k].place.x, necks[k].place.y);
  }
  if (necks.size() > kNamed) where += fmt::format("; {} more", necks.size() - kNamed);
  notes.push_back(fmt::format(
      "{} where pieces seem to touch ({}): {}", counted(necks.size(), "place"), where,
      options.part_touching ? "they are parted there" : "they are read as one, --part-touching parts them"));
  if (!options.part_touching) return false;
  for (const detail::Neck& neck : necks)
    for (const cv::Rect& cell : neck.cut) field(cell & cv::Rect({0, 0}, field.size())) = 0.0F;
  return true;
}

/// Whether a hole is a bay whose mouth closed in the picture, so that what lay in it once is missing there.
bool is_closed_bay(const Polygon& hole, const std::vector<Polygon>& outer) {
  const auto box = box_of(hole);
  const auto in_reach = [&](const glm::dvec2& p) {
    return glm::all(glm::greaterThan(p, box.first - kMouth)) &&
           glm::all(glm::lessThan(p, box.second + kMouth));
  };
  for (const Polygon& polygon : outer) {
    for (const glm::dvec2& p : polygon) {
      if (!in_reach(p)) continue;
      if (std::ranges::any_of(hole, [&](const glm::dvec2& q) { return glm::distance(p, q) < kMouth; }))
        return true;
    }
  }
  return false;
}

/// Whether a piece is a line around what is inside it, as of a tracing.
bool is_drawn(const Outline& piece) {
  const double whole = signed_area(piece.points);
  double line = whole;
  double length = perimeter(piece.points);
  for (const Polygon& hole : piece.holes) {
    line += signed_area(hole);
    length += perimeter(hole);
  }
  return line < kLineArea * whole && line < 0.5 * kLineWidth * length;
}

/// Takes what drawn lines enclose for the pieces if most are such, without what is drawn on them, and tells it.
void fill_drawn(std::vector<Outline>& pieces, std::vector<std::string>& notes) {
  const auto drawn = static_cast<std::size_t>(std::ranges::count_if(pieces, is_drawn));
  if (2 * drawn <= pieces.size()) return;
  std::vector<Outline> filled;
  std::vector<std::size_t> lines;  // of these
  for (Outline& piece : pieces) {  // largest first
    const auto encloses = [&](std::size_t k) { return contains(filled[k].points, piece.points[0]); };
    if (std::ranges::any_of(lines, encloses)) continue;
    if (is_drawn(piece)) {
      piece.holes.clear();
      lines.push_back(filled.size());
    }
    filled.push_back(std::move(piece));
  }
  pieces = std::move(filled);
  notes.push_back(fmt::format("{} drawn with a line: what it encloses is taken for the piece",
                              drawn == 1 ? "1 piece is" : fmt::format("{} pieces are", drawn)));
}

/// Takes hairs and loose threads off the pieces, and tells it.
void drop_threads(cv::Mat& field, std::vector<std::string>& notes) {
  const std::vector<detail::Thread> threads = detail::take_off_threads(field);
  if (threads.empty()) return;
  const bool one = threads.size() == 1;
  notes.push_back(fmt::format(
      "{} as of {} out of pieces and {} left out, the longest {:.0f} pixels long at x {}, y {}: "
      "--keep-threads keeps {}",
      counted(threads.size(), "narrow strip"),
      one ? "a hair, thread or line of the background runs" : "hairs, threads or lines of the background run",
      one ? "is" : "are", threads[0].length, threads[0].place.x, threads[0].place.y, one ? "it" : "them"));
}

/// Takes torn paper's white core off the pieces, and tells it.
/// \return whether there is any
bool drop_core(const cv::Mat& image, cv::Mat& field, std::vector<std::string>& notes) {
  const std::vector<cv::Rect> pieces = detail::take_off_core(image, field);
  if (pieces.empty()) return false;
  const cv::Rect& first = pieces[0];
  notes.push_back(
      fmt::format("a white rim along the border of {} ({} x {} pixels at x {}, y {}{}) is left out, as the "
                  "core of printed paper that shows "
                  "along tears: --keep-core keeps it",
                  counted(pieces.size(), "piece"), first.width, first.height, first.x, first.y,
                  pieces.size() > 1 ? fmt::format(", and {} more", pieces.size() - 1) : ""));
  return true;
}

/// Leaves out what is dust beside the largest piece, and tells if it may be none.
/// \param percent  of the largest's area
void drop_dust(Loops& loops, double percent, std::vector<std::string>& notes) {
  const double least = percent / 100.0 * signed_area(loops.outer[0]);
  const auto small = first_below(least, loops.holes);
  const auto specks_from = first_below(std::min(least, kLargestSpeck), loops.holes);
  const auto no_bays = std::stable_partition(
      small, specks_from, [&](const Polygon& hole) { return is_closed_bay(hole, loops.outer); });
  loops.holes.erase(no_bays, loops.holes.end());
  const auto dust = first_below(least, loops.outer);
  const auto specks = first_below(std::max(kLargestSpeck, kDoubtfulDust * least), loops.outer);
  if (dust < specks) {
    const auto count = static_cast<std::size_t>(specks - dust);
    notes.push_back(fmt::format(
        "{} with less than {:.3g} % of the largest's area {} taken for dust, the largest {}: --dust "
        "says how much is",
        counted(count, "piece"), percent, count == 1 ? "is" : "are", place_of(*dust)));
  }
  loops.outer.erase(dust, loops.outer.end());
}

}  // namespace

Extraction extract(const std::string& path, const ExtractOptions& options) {
  Extraction result;
  cv::Mat image = picture::load_image(path, options.max_pixels, &result.notes);
  detail::Coverage coverage = detail::coverage(image, path);
  const bool core = !options.keep_core && drop_core(image, coverage.field, result.notes);
  if (!options.keep_threads) drop_threads(coverage.field, result.notes);
  std::vector<Polygon> all = detail::contours(coverage.field, 0.5F, kLeastPoints);
  const bool hard = detail::raster_of(all) > kStaircase;
  if (hard) {
    // A padded blur, so that a piece at the picture's border is not drawn inwards.
    cv::GaussianBlur(coverage.field, coverage.field, cv::Size(), kStaircaseBlur, kStaircaseBlur,
                     cv::BORDER_REPLICATE);
    all = detail::contours(coverage.field, 0.5F, kLeastPoints);
  }
  Loops loops = sort_loops(std::move(all));
  if (loops.outer.empty()) {
    throw InputError(path, "no piece: what stands out is smaller than a few pixels", "scan with more pixels");
  }
  if (part_touching(coverage.field, signed_area(loops.outer[0]), options, result.notes))
    loops = sort_loops(detail::contours(coverage.field, 0.5F, kLeastPoints));
  std::move(coverage.notes.begin(), coverage.notes.end(), std::back_inserter(result.notes));
  drop_dust(loops, options.dust, result.notes);
  if (!coverage.distance.empty()) require_no_print(loops.outer, coverage.distance, path);
  judge_cut_pieces(loops.outer, image, result.notes);
  if (!coverage.distance.empty() && !core) doubt_background(loops.outer, coverage.distance, result.notes);
  result.pieces.reserve(loops.outer.size());
  for (Polygon& polygon : loops.outer) {
    Outline outline;
    outline.colour = border_colours(polygon, image);
    outline.points = std::move(polygon);
    outline.of_pixels = true;
    if (hard) outline.raster = kHardRaster;
    result.pieces.push_back(std::move(outline));
  }
  assign_holes(loops.holes, result.pieces);
  fill_drawn(result.pieces, result.notes);
  return result;
}

}  // namespace rejoin::outline
