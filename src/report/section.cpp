#include "report/section.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <unordered_map>

#include "report/views.hpp"

namespace rejoin::report {
namespace {

/// A crossed edge of the mesh by its two vertices, smaller first.
using Edge = std::uint64_t;

Edge edge_of(std::uint32_t a, std::uint32_t b) {
  return (static_cast<Edge>(std::min(a, b)) << 32U) | std::max(a, b);
}

/// One face's piece of the cut, from edge to edge.
struct Piece {
  Edge from;
  Edge to;
};

/// The cut before it is put into order.
struct Cut {
  std::vector<Piece> pieces;
  std::unordered_map<Edge, glm::dvec2> point;
  std::unordered_map<Edge, std::array<int, 2>> pieces_at;  ///< -1: none

  void add(const Piece& piece) {
    const int index = static_cast<int>(pieces.size());
    pieces.push_back(piece);
    for (const Edge edge : {piece.from, piece.to}) {
      auto& slots = pieces_at.try_emplace(edge, std::array<int, 2>{-1, -1}).first->second;
      if (slots[0] < 0) {
        slots[0] = index;
      } else if (slots[1] < 0) {
        slots[1] = index;  // a third face at an edge starts a line of its own
      }
    }
  }
};

Cut cut(const mesh::Mesh& mesh, const Rigid& pose, const Plane& plane) {
  const glm::dvec3 normal = glm::cross(plane.right, plane.up);
  const glm::dvec3 offset = pose(mesh.origin) - plane.origin;
  std::vector<glm::dvec3> local(mesh.vertices.size());  // x, y in the plane, z above it
  for (std::size_t i = 0; i < local.size(); ++i) {
    const glm::dvec3 p = pose.rotation * glm::dvec3(mesh.vertices[i]) + offset;
    local[i] = {glm::dot(p, plane.right), glm::dot(p, plane.up), glm::dot(p, normal)};
  }
  Cut result;
  for (const glm::uvec3& face : mesh.faces) {
    std::array<Edge, 3> crossed{};
    int count = 0;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = face[k];
      const std::uint32_t b = face[(k + 1) % 3];
      if ((local[a].z < 0) == (local[b].z < 0)) continue;
      const Edge edge = edge_of(a, b);
      const double share = local[a].z / (local[a].z - local[b].z);
      result.point.try_emplace(edge, glm::mix(glm::dvec2(local[a]), glm::dvec2(local[b]), share));
      crossed[count++] = edge;
    }
    if (count == 2) result.add({crossed[0], crossed[1]});
  }
  return result;
}

/// Follows the pieces from `start`, beginning at edge `at`, until the line ends or closes.
std::vector<glm::dvec2> follow(const Cut& cut, int start, Edge at, std::vector<bool>& used) {
  std::vector<glm::dvec2> line{cut.point.at(at)};
  for (int piece = start; piece >= 0 && !used[piece];) {
    used[piece] = true;
    at = cut.pieces[piece].from == at ? cut.pieces[piece].to : cut.pieces[piece].from;
    line.push_back(cut.point.at(at));
    const auto& slots = cut.pieces_at.at(at);
    piece = slots[0] == piece ? slots[1] : slots[0];
  }
  return line;
}

/// The part of the plane that a picture shows.
struct Window {
  glm::dvec2 middle{0.0};
  double pixels = 1;  ///< a mesh unit
  int width, height;

  glm::dvec2 operator()(const glm::dvec2& p) const {
    return {width / 2.0 + (p.x - middle.x) * pixels, height / 2.0 - (p.y - middle.y) * pixels};
  }
};

void draw_lines(Image& image, const Window& window, const std::vector<std::vector<glm::dvec2>>& lines,
                Colour tint) {
  constexpr int kBits = 4;
  std::vector<std::vector<cv::Point>> closed;
  for (const auto& line : lines) {
    if (line.front() != line.back()) continue;
    closed.emplace_back();
    for (const glm::dvec2& p : line) {
      const glm::dvec2 at = window(p) * static_cast<double>(1 << kBits);
      closed.back().emplace_back(static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y)));
    }
  }
  cv::Mat pixels(image.height, image.width, CV_8UC3, image.pixels.data());
  cv::Mat inside(image.height, image.width, CV_8UC1, cv::Scalar(0));
  if (!closed.empty()) cv::fillPoly(inside, closed, 255, cv::LINE_AA, kBits);
  const Colour pale = mix(tint, Colour(255), 0.35);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      image.at(x, y) = mix(image.at(x, y), pale, 0.8 * inside.at<std::uint8_t>(y, x) / 255.0);
    }
  }
  const Colour dark = mix(tint, Colour(0), 0.5);
  for (const auto& line : lines) {
    for (std::size_t k = 0; k + 1 < line.size(); ++k)
      draw_line(image, window(line[k]), window(line[k + 1]), dark, 2);
  }
}

using Line = std::vector<glm::dvec2>;

/// Takes the line whose nearer end is within `widest` of a place off the list, turned so that this end is its first point.
Line take_near(std::vector<Line>& lines, const glm::dvec2& place, double widest) {
  const auto distance = [&](const Line& line) {
    return std::min(glm::distance(line.front(), place), glm::distance(line.back(), place));
  };
  const auto nearest = std::ranges::min_element(lines, {}, distance);
  if (nearest == lines.end() || distance(*nearest) > widest) return {};
  Line line = std::move(*nearest);
  lines.erase(nearest);
  if (glm::distance(line.back(), place) < glm::distance(line.front(), place)) std::ranges::reverse(line);
  return line;
}

/// Joins open lines over slits of the surface, which are narrower than this share of the whole cut: kept and simplified surfaces
/// have some.
void close_slits(std::vector<Line>& lines) {
  constexpr double kSlit = 0.01;
  glm::dvec2 low(std::numeric_limits<double>::infinity());
  glm::dvec2 high = -low;
  for (const Line& line : lines) {
    for (const glm::dvec2& p : line) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  }
  const double widest = kSlit * glm::distance(low, high);
  const auto first_open = std::stable_partition(lines.begin(), lines.end(),
                                                [](const Line& line) { return line.front() == line.back(); });
  std::vector<Line> open(std::make_move_iterator(first_open), std::make_move_iterator(lines.end()));
  lines.erase(first_open, lines.end());
  while (!open.empty()) {
    Line line = std::move(open.back());
    open.pop_back();
    for (int end = 0; end < 2; ++end) {
      for (Line next; !(next = take_near(open, line.back(), widest)).empty();)
        line.insert(line.end(), next.begin(), next.end());
      std::ranges::reverse(line);
    }
    if (line.size() > 2 && glm::distance(line.front(), line.back()) <= widest) line.push_back(line.front());
    lines.push_back(std::move(line));
  }
}

/// The place of the contact nearest to its middle: the middle of a bent seam lies off the surface.
glm::dvec3 contact_point(const Joint& joint) {
  glm::dvec3 best = joint.centre;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < joint.a.vertices.size(); ++i) {
    if (std::isnan(joint.gap_a[i])) continue;
    const glm::dvec3 p = joint.a.origin + glm::dvec3(joint.a.vertices[i]);
    const double distance = glm::distance(p, joint.centre);
    if (distance < least) {
      least = distance;
      best = p;
    }
  }
  return best;
}

}  // namespace

std::vector<std::vector<glm::dvec2>> section(const mesh::Mesh& mesh, const Rigid& pose, const Plane& plane) {
  const Cut pieces = cut(mesh, pose, plane);
  std::vector<bool> used(pieces.pieces.size(), false);
  std::vector<std::vector<glm::dvec2>> lines;
  for (const bool ends_only : {true, false}) {  // open lines from their ends first, then the loops
    for (std::size_t k = 0; k < used.size(); ++k) {
      for (const Edge edge : {pieces.pieces[k].from, pieces.pieces[k].to}) {
        if (used[k] || (ends_only && pieces.pieces_at.at(edge)[1] >= 0)) continue;
        lines.push_back(follow(pieces, static_cast<int>(k), edge, used));
      }
    }
  }
  close_slits(lines);
  return lines;
}

Image draw_section(const Joint& joint, int width, int height) {
  constexpr int kFoot = 46;     // pixels below the drawing, for the scale bar
  constexpr double kStrip = 3;  // longer than this times its width: a wall's edge, cut through the wall
  const bool strip = joint.length > kStrip * joint.width;
  const Plane plane{contact_point(joint), joint.normal, strip ? joint.across : joint.along};
  const double seen = strip ? 2.4 * joint.width : 1.15 * joint.length;  // from bottom to top
  const double least = 1e-3 * mesh::diameter(joint.a);
  const int shown = std::max(1, height - kFoot);
  Window window{{0, 0}, shown / std::max(seen, least), width, shown};
  if (joint.contact.area <= 0) window.pixels = width / (2.5 * std::max(mesh::diameter(joint.a), least));
  if (!strip) {
    window.middle.x = glm::dot(joint.centre - plane.origin, plane.right);
    window.middle.y = glm::dot(joint.centre - plane.origin, plane.up);
  }
  Image drawing(width, window.height, kPaper);
  draw_lines(drawing, window, section(joint.a, Rigid{}, plane), kTintA);
  draw_lines(drawing, window, section(joint.b, joint.pose, plane), kTintB);
  Image image(width, height, kPaper);
  paste(image, drawing, 0, 0);
  const double bar = round_up(width / 8.0 / window.pixels);
  const double left = 16;
  const double base = height - 16;
  draw_line(image, {left, base}, {left + bar * window.pixels, base}, kInk, 3);
  draw_text(image, left, base - 10, short_number(bar) + " mesh units", {12, kInk});
  return image;
}

}  // namespace rejoin::report
