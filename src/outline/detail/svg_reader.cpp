#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>

#include "core/error.hpp"
#include "outline/detail/readers.hpp"
#include "outline/detail/svg_path.hpp"
#include "outline/outline.hpp"
#include "outline/polygon.hpp"

namespace rejoin::outline::detail {
namespace {

using Polygon = std::vector<glm::dvec2>;

constexpr int kDeepest = 200;  ///< groups in groups

/// One function of a transform attribute.
glm::dmat3 transform_of(const std::string& name, std::vector<double> v) {
  glm::dmat3 m(1.0);
  const auto number = [&](std::size_t i, double other) { return i < v.size() ? v[i] : other; };
  if (name == "matrix" && v.size() == 6) m = {{v[0], v[1], 0}, {v[2], v[3], 0}, {v[4], v[5], 1}};
  if (name == "translate") m[2] = {number(0, 0), number(1, 0), 1};
  if (name == "scale") m = {{number(0, 1), 0, 0}, {0, number(1, number(0, 1)), 0}, {0, 0, 1}};
  if (name == "skewX") m[1][0] = std::tan(number(0, 0) * M_PI / 180.0);
  if (name == "skewY") m[0][1] = std::tan(number(0, 0) * M_PI / 180.0);
  if (name == "rotate") {
    const double angle = number(0, 0) * M_PI / 180.0;
    const glm::dvec2 centre(number(1, 0), number(2, 0));
    const glm::dmat2 turn(std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle));
    m = {glm::dvec3(turn[0], 0), glm::dvec3(turn[1], 0), glm::dvec3(centre - turn * centre, 1)};
  }
  return m;
}

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path) {}

  void read(const pugi::xml_node& node, const glm::dmat3& above, int depth) {
    const std::string name = local_name(node);
    if (name == "defs" || name == "symbol" || name == "clipPath" || name == "mask") return;
    if (depth > kDeepest) throw InputError(path_, "groups lie too deep in each other", kMend);
    const glm::dmat3 here = above * transform(node.attribute("transform").value());
    if (name == "path") add(path_polygons(node), here);
    if (name == "polygon" || name == "polyline") add({listed_points(node)}, here);
    if (name == "rect") add({rectangle(node)}, here);
    for (const pugi::xml_node& child : node.children()) read(child, here, depth + 1);
  }

  std::vector<Polygon> polygons;

  static constexpr const char* kMend = "draw the outlines as closed paths or polygons";

 private:
  static std::string local_name(const pugi::xml_node& node) {
    const std::string name = node.name();
    return name.substr(name.find(':') == std::string::npos ? 0 : name.find(':') + 1);
  }

  glm::dmat3 transform(std::string_view text) const {
    glm::dmat3 result(1.0);
    while (text.find('(') != std::string_view::npos) {
      const std::size_t open = text.find('(');
      const std::size_t shut = text.find(')', open);
      const auto numbers =
          parse_numbers(text.substr(open + 1, shut == std::string_view::npos ? shut : shut - open - 1));
      if (shut == std::string_view::npos || !numbers) throw InputError(path_, "a transform is broken", kMend);
      std::string name;
      for (const char c : text.substr(0, open)) {
        if (std::isalpha(static_cast<unsigned char>(c)) != 0) name += c;
      }
      result = result * transform_of(name, *numbers);
      text.remove_prefix(shut + 1);
    }
    return result;
  }

  std::vector<Polygon> path_polygons(const pugi::xml_node& node) const {
    std::string problem;
    auto found = flatten_path(node.attribute("d").value(), problem);
    if (!found) throw InputError(path_, problem, kMend);
    return std::move(*found);
  }

  Polygon listed_points(const pugi::xml_node& node) const {
    const auto numbers = parse_numbers(node.attribute("points").value());
    if (!numbers) throw InputError(path_, "the points of a polygon are broken", kMend);
    Polygon polygon;
    polygon.reserve(numbers->size() / 2);
    for (std::size_t i = 0; i + 1 < numbers->size(); i += 2)
      polygon.emplace_back((*numbers)[i], (*numbers)[i + 1]);
    return polygon;
  }

  static Polygon rectangle(const pugi::xml_node& node) {
    const glm::dvec2 at(node.attribute("x").as_double(), node.attribute("y").as_double());
    const glm::dvec2 size(node.attribute("width").as_double(), node.attribute("height").as_double());
    return {at, {at.x + size.x, at.y}, at + size, {at.x, at.y + size.y}};
  }

  void add(std::vector<Polygon> found, const glm::dmat3& transform) {
    for (Polygon& polygon : found) {
      if (polygon.size() < 3) continue;
      for (glm::dvec2& p : polygon) p = glm::dvec2(transform * glm::dvec3(p, 1.0));
      require_usual_points(polygon, fmt::format("{}, shape {}", path_, polygons.size() + 1));
      polygons.push_back(std::move(polygon));
    }
  }

  const std::string& path_;
};

}  // namespace

std::vector<Rings> nest(const std::vector<Polygon>& polygons) {
  std::vector<std::size_t> order(polygons.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::vector<double> areas(polygons.size());
  for (std::size_t i = 0; i < order.size(); ++i) areas[i] = std::abs(signed_area(polygons[i]));
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return areas[a] > areas[b]; });
  std::vector<Rings> pieces;
  std::vector<std::size_t> piece_of(polygons.size(), 0);
  std::vector<std::size_t> depth(polygons.size(), 0);
  for (std::size_t k = 0; k < order.size(); ++k) {
    std::size_t parent = order[k];
    for (std::size_t other = 0; other < k; ++other) {  // the last one around it is the smallest
      if (contains(polygons[order[other]], polygons[order[k]][0])) parent = order[other];
    }
    const bool hole = parent != order[k] && depth[parent] % 2 == 0;
    depth[order[k]] = parent == order[k] ? 0 : depth[parent] + 1;
    piece_of[order[k]] = hole ? piece_of[parent] : pieces.size();
    if (hole) {
      pieces[piece_of[parent]].rings.push_back(polygons[order[k]]);
    } else {
      pieces.push_back({{polygons[order[k]]}, fmt::format("shape {}", order[k] + 1)});
    }
  }
  return pieces;
}

std::vector<Rings> read_svg(const std::string& path, const std::string& text) {
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
  if (!parsed) {
    throw InputError(path, fmt::format("is no SVG: {} at byte {}", parsed.description(), parsed.offset),
                     "save it again");
  }
  Reader reader(path);
  reader.read(document.document_element(), glm::dmat3(1.0), 0);
  if (reader.polygons.empty()) throw InputError(path, "holds no closed shape", Reader::kMend);
  return nest(reader.polygons);
}

}  // namespace rejoin::outline::detail
