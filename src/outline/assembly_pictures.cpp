#include "outline/assembly_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "core/png_mark.hpp"
#include "outline/contact.hpp"
#include "outline/detail/drawing.hpp"

namespace rejoin::outline {
namespace {

constexpr int kShift = 8;  // binary places of polygon corners
constexpr double kMargin = 8.0;
constexpr double kNumberSize = 0.6;  // of the pieces' numbers

/// A piece where it lies, with its number in the set.
struct Placed {
  const Piece* piece;
  Planar pose;
  std::size_t number;
};

/// The common frame -> pixels.
struct View {
  double y = 1.0;                                      ///< -1: the frame's y points up
  glm::dvec2 low{std::numeric_limits<double>::max()};  ///< of the frame as it is drawn
  double scale = 1.0;
  cv::Size size;

  glm::dvec2 drawn(const glm::dvec2& point) const { return {point.x, y * point.y}; }
  glm::dvec2 operator()(const glm::dvec2& point) const { return (drawn(point) - low) * scale + kMargin; }
};

View view_of(const std::vector<Placed>& members, const PictureOptions& options) {
  View view;
  if (std::all_of(members.begin(), members.end(), [](const Placed& placed) { return placed.piece->y_up; }))
    view.y = -1.0;
  glm::dvec2 high(-std::numeric_limits<double>::max());
  for (const auto& [piece, pose, number] : members) {
    for (const glm::dvec2& p : piece->outline.points) {
      view.low = glm::min(view.low, view.drawn(pose(p)));
      high = glm::max(high, view.drawn(pose(p)));
    }
  }
  const glm::dvec2 extent = high - view.low;
  const double longest = std::max(extent.x, extent.y);
  const bool pictures = std::all_of(members.begin(), members.end(),
                                    [](const Placed& placed) { return detail::is_picture(*placed.piece); });
  view.scale = pictures ? std::min(1.0, options.longest_side / longest) : options.drawn_side / longest;
  view.size = cv::Size(static_cast<int>(extent.x * view.scale + 2.0 * kMargin) + 1,
                       static_cast<int>(extent.y * view.scale + 2.0 * kMargin) + 1);
  return view;
}

std::vector<cv::Point> corners(const std::vector<glm::dvec2>& polygon, const Planar& pose, const View& view,
                               const cv::Point& origin) {
  std::vector<cv::Point> out;
  out.reserve(polygon.size());
  for (const glm::dvec2& p : polygon) {
    const glm::dvec2 at = (view(pose(p)) - glm::dvec2(origin.x, origin.y)) * static_cast<double>(1 << kShift);
    out.emplace_back(static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y)));
  }
  return out;
}

/// Part of the canvas that a piece covers.
cv::Rect region_of(const Piece& piece, const Planar& pose, const View& view) {
  glm::dvec2 low(std::numeric_limits<double>::max());
  glm::dvec2 high(-std::numeric_limits<double>::max());
  for (const glm::dvec2& p : piece.outline.points) {
    low = glm::min(low, view(pose(p)));
    high = glm::max(high, view(pose(p)));
  }
  const cv::Rect box(static_cast<int>(low.x) - 1, static_cast<int>(low.y) - 1,
                     static_cast<int>(high.x - low.x) + 4, static_cast<int>(high.y - low.y) + 4);
  return box & cv::Rect(cv::Point(0, 0), view.size);
}

/// Coverage 0..255 of a placed piece within its region; holes are left out.
cv::Mat mask_of(const Piece& piece, const Planar& pose, const View& view, const cv::Rect& region) {
  cv::Mat mask(region.size(), CV_8UC1, cv::Scalar(0));
  std::vector<std::vector<cv::Point>> polygons = {corners(piece.outline.points, pose, view, region.tl())};
  for (const auto& hole : piece.outline.holes) polygons.push_back(corners(hole, pose, view, region.tl()));
  cv::fillPoly(mask, polygons, cv::Scalar(255), cv::LINE_AA, kShift);
  return mask;
}

/// A colour for each piece, apart from its neighbours' numbers.
cv::Scalar colour_of(std::size_t piece) {
  const double hue = std::fmod(static_cast<double>(piece) * 0.61803398875, 1.0);
  cv::Mat hsv(1, 1, CV_8UC3, cv::Scalar(180.0 * hue, 90, 215));
  cv::cvtColor(hsv, hsv, cv::COLOR_HSV2BGR);
  const auto pixel = hsv.at<cv::Vec3b>(0, 0);
  return {static_cast<double>(pixel[0]), static_cast<double>(pixel[1]), static_cast<double>(pixel[2])};
}

/// The piece's own colours within its region, blue, green, red.
cv::Mat placed_colours(const Piece& piece, const Planar& pose, const View& view, const cv::Rect& region,
                       detail::LastPicture& source) {
  // The mask's edge reaches a pixel of the canvas beyond the border.
  const cv::Mat& colours = source.colours(piece, 2 + static_cast<int>(std::ceil(1.0 / view.scale)));
  const glm::dmat3 m = matrix(pose);
  const glm::dvec2 shift = view(glm::dvec2(m[2])) - glm::dvec2(region.x, region.y);
  const cv::Matx23d motion(view.scale * m[0][0], view.scale * m[1][0], shift.x, view.scale * m[0][1],
                           view.scale * m[1][1], shift.y);
  return detail::resampled(colours, motion, region.size(), cv::BORDER_REPLICATE);
}

/// Lays colours with a coverage over the canvas (blue, green, red, alpha).
void lay(cv::Mat canvas, const cv::Mat& colours, const cv::Mat& mask) {
  for (int y = 0; y < canvas.rows; ++y) {
    for (int x = 0; x < canvas.cols; ++x) {
      const int cover = mask.at<std::uint8_t>(y, x);
      if (cover == 0) continue;
      auto& pixel = canvas.at<cv::Vec4b>(y, x);
      const auto& colour = colours.at<cv::Vec3b>(y, x);
      const int before = pixel[3] * (255 - cover) / 255;
      const int total = cover + before;
      for (int c = 0; c < 3; ++c)
        pixel[c] = static_cast<std::uint8_t>((colour[c] * cover + pixel[c] * before) / total);
      pixel[3] = static_cast<std::uint8_t>(total);
    }
  }
}

/// Whether a file's name is that of an object's picture, or of one of joins.
bool is_numbered(const std::string& name) {
  constexpr std::string_view kEnd = ".png";
  for (const std::string_view word : {"object_", "joins_"}) {
    if (!name.starts_with(word) || !name.ends_with(kEnd) || name.size() <= word.size() + kEnd.size())
      continue;
    const std::string_view number(name.data() + word.size(), name.size() - word.size() - kEnd.size());
    if (number.find_first_not_of("0123456789") == std::string_view::npos) return true;
  }
  return false;
}

/// Takes pictures of objects away that this program wrote and are none of these.
void remove_others(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& files) {
  std::vector<std::filesystem::path> others;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (is_numbered(entry.path().filename().string()) &&
        std::find(files.begin(), files.end(), folder / entry.path().filename()) == files.end() &&
        is_marked_png_file(entry.path()))
      others.push_back(entry.path());
  }
  for (const std::filesystem::path& other : others) std::filesystem::remove(other, ignored);
}

std::vector<std::uint8_t> png_of(const cv::Mat& image) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, 6});
  return bytes;
}

cv::Mat object_picture(const std::vector<Placed>& members, const View& view, detail::LastPicture& source) {
  cv::Mat canvas(view.size, CV_8UC4, cv::Scalar(0, 0, 0, 0));
  for (const auto& [piece, pose, number] : members) {
    const cv::Rect region = region_of(*piece, pose, view);
    const cv::Mat mask = mask_of(*piece, pose, view, region);
    const cv::Mat colours = detail::is_picture(*piece) ? placed_colours(*piece, pose, view, region, source)
                                                       : cv::Mat(region.size(), CV_8UC3, colour_of(number));
    lay(canvas(region), colours, mask);
  }
  return canvas;
}

/// Draws a's border in red where it lies along b's.
void draw_boundary(cv::Mat& canvas, const Placed& a, const Placed& b, const View& view) {
  const double reach = 6.0 / view.scale;
  const DistanceField field(b.piece->outline, reach / 3.0, reach);
  const Planar a_to_b = inverse(b.pose) * a.pose;
  for (std::size_t number = 0; number <= a.piece->outline.holes.size(); ++number) {
    const std::vector<glm::dvec2>& border = border_of(a.piece->outline, number);
    for (std::size_t i = 0; i < border.size(); ++i) {
      const glm::dvec2& from = border[i];
      const glm::dvec2& to = border[(i + 1) % border.size()];
      if (std::abs(field(a_to_b(from))) > 0.9 * reach || std::abs(field(a_to_b(to))) > 0.9 * reach) continue;
      const std::vector<cv::Point> line = corners({from, to}, a.pose, view, {0, 0});
      cv::line(canvas, line[0], line[1], cv::Scalar(40, 40, 220, 255), 3, cv::LINE_AA, kShift);
    }
  }
}

/// The place of a mask that is farthest from its edge: in a bent piece its box's middle may lie outside.
cv::Point deepest(const cv::Mat& mask) {
  cv::Mat inside;
  cv::copyMakeBorder(mask > 127, inside, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::Mat depth;
  cv::distanceTransform(inside, depth, cv::DIST_L2, cv::DIST_MASK_3);
  cv::Point place;
  cv::minMaxLoc(depth, nullptr, nullptr, nullptr, &place);
  return place - cv::Point(1, 1);
}

/// Which number is which piece, in columns of this height.
cv::Mat legend(const std::vector<Placed>& members, int height) {
  constexpr int kRow = 18;
  constexpr double kSize = 0.45;
  const int rows = std::max(1, (height - kRow / 2) / kRow);
  const auto text_of = [](const Placed& placed) {
    return std::to_string(placed.number) + "  " + detail::short_name(placed.piece->name);
  };
  int width = 0;
  for (const Placed& placed : members)
    width = std::max(
        width, cv::getTextSize(text_of(placed), cv::FONT_HERSHEY_SIMPLEX, kSize, 1, nullptr).width + 24);
  const int columns = (static_cast<int>(members.size()) + rows - 1) / rows;
  cv::Mat panel(height, columns * width, CV_8UC4, cv::Scalar(255, 255, 255, 255));
  for (std::size_t k = 0; k < members.size(); ++k) {
    const int column = static_cast<int>(k) / rows;
    const int row = static_cast<int>(k) % rows;
    cv::putText(panel, text_of(members[k]), {column * width + 12, (row + 1) * kRow}, cv::FONT_HERSHEY_SIMPLEX,
                kSize, cv::Scalar(60, 60, 60, 255), 1, cv::LINE_AA);
  }
  return panel;
}

cv::Mat joins_picture(const std::vector<Placed>& members, const std::vector<AssemblyJoin>& joins,
                      const View& view) {
  cv::Mat canvas(view.size, CV_8UC4, cv::Scalar(255, 255, 255, 255));
  for (const auto& [piece, pose, number] : members) {
    const cv::Rect region = region_of(*piece, pose, view);
    const cv::Mat mask = mask_of(*piece, pose, view, region);
    const double grey = 205.0 + 8.0 * static_cast<double>(number % 4);
    lay(canvas(region), cv::Mat(region.size(), CV_8UC3, cv::Scalar(grey, grey, grey)), mask);
  }
  const auto member = [&](std::size_t number) {
    return std::find_if(members.begin(), members.end(),
                        [&](const Placed& placed) { return placed.number == number; });
  };
  for (const AssemblyJoin& join : joins) {
    const auto a = member(join.a);
    if (a != members.end()) draw_boundary(canvas, *a, *member(join.b), view);
  }
  for (const auto& [piece, pose, number] : members) {
    const cv::Rect region = region_of(*piece, pose, view);
    const std::string text = std::to_string(number);
    const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kNumberSize, 1, nullptr);
    const cv::Point middle = region.tl() + deepest(mask_of(*piece, pose, view, region));
    cv::putText(canvas, text, middle + cv::Point(-size.width / 2, size.height / 2), cv::FONT_HERSHEY_SIMPLEX,
                kNumberSize, cv::Scalar(60, 60, 60, 255), 1, cv::LINE_AA);
  }
  cv::hconcat(canvas, legend(members, canvas.rows), canvas);
  return canvas;
}

}  // namespace

std::vector<std::uint8_t> assembled_png(const std::vector<Piece>& pieces, const std::vector<Planar>& poses,
                                        const PictureOptions& options) {
  std::vector<Placed> members;
  for (std::size_t i = 0; i < pieces.size(); ++i) members.push_back({&pieces[i], poses[i], i});
  detail::LastPicture source;
  return png_of(object_picture(members, view_of(members, options), source));
}

bool has_result_name(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  return name == "pieces.png" || name == "similarity.png" || is_numbered(name);
}

std::optional<std::filesystem::path> foreign_result(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> foreign;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (entry.is_regular_file(ignored) && has_result_name(entry.path()) && !is_marked_png_file(entry.path()))
      foreign.push_back(entry.path());
  }
  if (foreign.empty()) return std::nullopt;
  return *std::min_element(foreign.begin(), foreign.end());
}

std::vector<std::filesystem::path> write_assembly_pictures(const std::filesystem::path& folder,
                                                           const std::vector<Piece>& pieces,
                                                           const Assembly& assembly,
                                                           const PictureOptions& options) {
  std::vector<std::vector<Placed>> objects;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto& [pose, group, confidence] = assembly.placements[i];
    if (group >= objects.size()) objects.resize(group + 1);
    objects[group].push_back({&pieces[i], pose, i});
  }
  std::vector<std::filesystem::path> files;
  detail::LastPicture source;
  for (std::size_t k = 0; k < objects.size() && k < options.most_objects && objects[k].size() > 1; ++k) {
    const View view = view_of(objects[k], options);
    const std::string number = std::to_string(k + 1);
    files.push_back(folder / ("object_" + number + ".png"));
    detail::write_png(files.back(), object_picture(objects[k], view, source));
    files.push_back(folder / ("joins_" + number + ".png"));
    detail::write_png(files.back(), joins_picture(objects[k], assembly.joins, view));
  }
  remove_others(folder, files);
  return files;
}

}  // namespace rejoin::outline
