#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <string_view>

#include "core/error.hpp"
#include "core/words.hpp"
#include "outline/detail/readers.hpp"
#include "outline/detail/svg_element.hpp"
#include "outline/detail/svg_path.hpp"
#include "outline/detail/svg_sheet.hpp"
#include "outline/outline.hpp"
#include "outline/polygon.hpp"

namespace rejoin::outline::detail {
namespace {

using Polygon = std::vector<glm::dvec2>;

constexpr int kDeepest = 200;        ///< groups in groups, and copies in copies
constexpr int kMostCopies = 20000;   ///< of elements, all that a copied group holds counted
constexpr double kPageEdge = 1e-3;   ///< of its size, by which a page's background may miss it
constexpr double kSameShape = 1e-9;  ///< of the coordinates, by which a shape that is drawn twice may differ

/// What an element takes from those around it.
struct Scope {
  glm::dmat3 to_page{1.0};
  glm::dvec2 size{0.0};  ///< of the drawing that it is in, for lengths in %
  bool displayed = true;
  bool visible = true;
  bool copied = false;
};

/// Elements whose content is not drawn where it stands.
bool is_drawn_elsewhere(std::string_view name) {
  return name == "defs" || name == "symbol" || name == "clipPath" || name == "mask" || name == "marker" ||
         name == "pattern";
}

/// The coordinates of a drawing in a drawing -> those around it; the view box is fitted into the middle, as where nothing else
/// is said.
glm::dmat3 placed_in(const ViewBox& box, const ViewBox& place) {
  const glm::dvec2 shares = (place.high - place.low) / (box.high - box.low);
  const double scale = std::min(shares.x, shares.y);
  glm::dmat3 m(scale);
  m[2] = glm::dvec3(0.5 * (place.low + place.high - scale * (box.low + box.high)), 1.0);
  return m;
}

/// Whether nothing shows of an element and all in it.
bool is_transparent(const pugi::xml_node& node) {
  const std::string opacity = property(node, "opacity");
  const auto number = parse_numbers(std::string_view(opacity).substr(0, opacity.find('%')));
  return number && number->size() == 1 && number->front() <= 0.0;
}

glm::dmat3 shift(const glm::dvec2& by) {
  glm::dmat3 m(1.0);
  m[2] = glm::dvec3(by, 1.0);
  return m;
}

bool same_polygon(const Polygon& a, const Polygon& b) {
  return std::ranges::equal(a, b, [](const glm::dvec2& p, const glm::dvec2& q) {
    return glm::distance(p, q) <= kSameShape * (std::abs(p.x) + std::abs(p.y));
  });
}

/// A number by which a same_polygon() can be found among many, and how far apart those of two may be.
struct Mark {
  double at = 0.0;
  double slack = 0.0;
};
Mark mark_of(const Polygon& polygon) {
  constexpr double kOfY = 1.4142135623730951;  // shapes in rows and columns have other numbers each
  Mark mark;
  for (const glm::dvec2& p : polygon) {
    mark.at += p.x + kOfY * p.y;
    mark.slack += 4.0 * kSameShape * (std::abs(p.x) + std::abs(p.y));  // sqrt(3) times, and rounding
  }
  return mark;
}

/// The upright rectangle around a polygon.
ViewBox box_of(const Polygon& polygon) {
  ViewBox box;
  box.low = box.high = polygon[0];
  for (const glm::dvec2& p : polygon) {
    box.low = glm::min(box.low, p);
    box.high = glm::max(box.high, p);
  }
  return box;
}

/// contains(), at little cost for points that are not even in the polygon's box.
bool is_around(const Polygon& polygon, const ViewBox& box, const glm::dvec2& point) {
  return glm::all(glm::lessThanEqual(box.low, point)) && glm::all(glm::lessThanEqual(point, box.high)) &&
         contains(polygon, point);
}

/// Whether a polygon is an upright rectangle that covers a page.
bool covers(const Polygon& polygon, const ViewBox& page) {
  const glm::dvec2 slack = kPageEdge * (page.high - page.low);
  if (slack.x <= 0.0 || slack.y <= 0.0 || polygon.size() > 5) return false;
  const auto [low, high] = box_of(polygon);
  return glm::all(glm::lessThanEqual(low, page.low + slack)) &&
         glm::all(glm::greaterThanEqual(high, page.high - slack)) &&
         std::abs(signed_area(polygon)) > (1.0 - kPageEdge) * (high.x - low.x) * (high.y - low.y);
}

/// A closed polygon of the drawing.
struct Shape {
  Polygon polygon;
  std::size_t element = 0;  ///< that draws it, perhaps with others
  bool hole = false;        ///< in what its element draws
  std::optional<std::string> doubt;
};

/// Sorts shapes into pieces with holes: a shape inside an odd number of others is a hole of the smallest of them.  Shapes lie side
/// by side if they have a stretch of border in common, and a hole and what fills it are one in the other.
/// \param separate  gets the number of holes that an element of their own draws
std::vector<Rings> nest(const std::vector<Shape>& shapes, std::size_t& separate) {
  std::vector<std::size_t> order(shapes.size());
  std::vector<double> areas;
  std::vector<glm::dvec2> inside;
  std::vector<ViewBox> boxes;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    order[i] = i;
    boxes.push_back(box_of(shapes[i].polygon));
    areas.push_back(std::abs(signed_area(shapes[i].polygon)));
    inside.push_back(inner_point(shapes[i].polygon));
  }
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return areas[a] > areas[b]; });
  std::vector<Rings> pieces;
  std::vector<std::size_t> piece_of(shapes.size(), 0);
  std::vector<std::size_t> depth(shapes.size(), 0);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t own = order[k];
    std::size_t parent = own;
    for (std::size_t other = k; parent == own && other-- > 0;) {  // the last one around it is the smallest
      if (is_around(shapes[order[other]].polygon, boxes[order[other]], inside[own])) parent = order[other];
    }
    const bool hole = parent != own && depth[parent] % 2 == 0;
    depth[own] = parent == own ? 0 : depth[parent] + 1;
    piece_of[own] = hole ? piece_of[parent] : pieces.size();
    if (hole && shapes[own].element != shapes[parent].element) ++separate;
    if (hole) {
      pieces[piece_of[parent]].rings.push_back(shapes[own].polygon);
    } else {
      pieces.push_back({{shapes[own].polygon}, fmt::format("shape {}", own + 1)});
    }
  }
  return pieces;
}

class SvgReader {
 public:
  SvgReader(const std::string& path, std::vector<std::string>& notes) : path_(path), notes_(notes) {}

  void read(const pugi::xml_node& root) {
    Scope page;
    page_ = view_box(root, page.size, path_);
    page.size = page_.high - page_.low;
    if (apply_style_sheets(root))
      unread_.insert(
          "a style sheet hides or moves shapes by selectors other than elements, classes and ids; write that "
          "into the shapes");
    read(root, page, 0);
    leave_out_background();
    if (hidden_ > 0) note(fmt::format("{} left out as hidden", counted(hidden_, "shape")));
    if (repeated_ > 0) note(fmt::format("{} drawn twice; each counts once", counted(repeated_, "shape")));
    for (const std::string& what : unread_) note(what);
    if (!shapes_.empty()) return;
    throw InputError(path_,
                     hidden_ > 0 ? "holds no closed shape that is not hidden" : "holds no closed shape",
                     unread_.empty() ? kSvgMend : *unread_.begin());
  }

  /// The pieces with their holes.
  std::vector<Rings> pieces() {
    std::size_t separate = 0;
    std::vector<Rings> result = nest(shapes_, separate);
    if (separate > 0) {
      note(fmt::format("{} drawn inside another {} taken for {} in it", counted(separate, "shape"),
                       separate == 1 ? "is" : "are", separate == 1 ? "a hole" : "holes"));
    }
    return result;
  }

 private:
  void note(const std::string& what) { notes_.push_back(path_ + ": " + what); }

  void read(const pugi::xml_node& node, Scope scope, int depth) {
    const std::string name = local_name(node);
    if (!is_drawn_elsewhere(name)) draw(node, name, scope, depth);
  }

  /// \param use  what shows the element as a copy; none: it is shown where it stands
  void draw(const pugi::xml_node& node, const std::string& name, Scope scope, int depth,
            const pugi::xml_node& use = {}) {
    if (depth > kDeepest) throw InputError(path_, "groups lie too deep in each other", kSvgMend);
    if (scope.copied && ++copies_ > kMostCopies)
      throw InputError(path_, fmt::format("has more than {} copies of elements", kMostCopies), kSvgMend);
    look_for_unread(node, name, depth);
    enter(node, scope);
    if (name == "symbol" || (name == "svg" && depth > 0)) enter_drawing(node, use, scope);
    if (name == "use") return draw_copy(node, scope, depth);
    add(polygons_of(node, scope.size, path_), scope);
    for (const pugi::xml_node& child : node.children()) read(child, scope, depth + 1);
  }

  void draw_copy(const pugi::xml_node& use, Scope scope, int depth) {
    const pugi::xml_node original = original_of(use);
    const std::string name = local_name(original);
    if (!original || (is_drawn_elsewhere(name) && name != "symbol")) {
      unread_.insert("a copy (<use>) of what is not a shape of this file is left out");
      return;
    }
    const auto x = length_of(use, "x", scope.size.x, path_);
    const auto y = length_of(use, "y", scope.size.y, path_);
    scope.to_page = scope.to_page * shift({x ? x->value : 0.0, y ? y->value : 0.0});
    scope.copied = true;
    draw(original, name, scope, depth + 1, use);
  }

  /// What a copy is of; none: nothing in this file.
  pugi::xml_node original_of(const pugi::xml_node& use) const {
    std::string_view href = use.attribute("href").value();
    if (href.empty()) href = use.attribute("xlink:href").value();
    if (!href.starts_with('#')) return {};
    return use.root().find_node([&](const pugi::xml_node& node) {
      return node.attribute("id") && href.substr(1) == node.attribute("id").value();
    });
  }

  void enter(const pugi::xml_node& node, Scope& scope) const {
    if (property(node, "display") == "none" || is_transparent(node)) scope.displayed = false;
    const std::string visibility = property(node, "visibility");
    if (!visibility.empty() && visibility != "inherit")
      scope.visible = visibility != "hidden" && visibility != "collapse";
    scope.to_page = scope.to_page * transform_of(node, path_);
  }

  /// Into the coordinates of a drawing in the drawing, whose size its copy may set.
  void enter_drawing(const pugi::xml_node& node, const pugi::xml_node& use, Scope& scope) const {
    const auto length = [&](const char* attribute, double around, double other, const pugi::xml_node& first) {
      auto given = length_of(first, attribute, around, path_);
      if (!given) given = length_of(node, attribute, around, path_);
      return given ? given->value : other;
    };
    ViewBox place;
    place.low = {length("x", scope.size.x, 0.0, node), length("y", scope.size.y, 0.0, node)};
    place.high = place.low + glm::dvec2(length("width", scope.size.x, scope.size.x, use),
                                        length("height", scope.size.y, scope.size.y, use));
    if (node.attribute("viewBox").empty()) {
      scope.to_page = scope.to_page * shift(place.low);
      scope.size = place.high - place.low;
      return;
    }
    const ViewBox box = view_box(node, scope.size, path_);
    if (glm::any(glm::lessThanEqual(glm::min(box.high - box.low, place.high - place.low), glm::dvec2(0.0))))
      throw InputError(path_, "a drawing in the drawing has no size", "give its width, height and viewBox");
    scope.to_page = scope.to_page * placed_in(box, place);
    scope.size = box.high - box.low;
  }

  void look_for_unread(const pugi::xml_node& node, const std::string& name, int depth) {
    const auto clips = [&](const char* by) {
      const std::string value = property(node, by);
      return !value.empty() && value != "none";
    };
    if (clips("clip-path") || clips("mask"))
      unread_.insert("shapes are read whole where a clip path or mask hides parts of them");
    if (!property(node, "transform-origin").empty())
      unread_.insert("transform-origin is not read; write transforms about the drawing's origin");
    const std::string_view fit = node.attribute("preserveAspectRatio").value();
    if ((name == "symbol" || (name == "svg" && depth > 0)) && !fit.empty() && fit != "xMidYMid" &&
        fit != "xMidYMid meet")
      unread_.insert("preserveAspectRatio is not read; the inner drawing is fitted into the middle");
  }

  /// \param polygons  of one element
  void add(std::vector<Polygon> polygons, const Scope& scope) {
    std::vector<std::optional<std::string>> doubts;
    for (Polygon& polygon : polygons) {
      const auto doubt = doubt_ends(polygon);
      if (polygon.size() > 1 && polygon.front() == polygon.back()) polygon.pop_back();
      if (polygon.size() >= 3) doubts.push_back(doubt);
    }
    std::erase_if(polygons, [](const Polygon& polygon) { return polygon.size() < 3; });
    if (polygons.empty()) return;
    ++elements_;
    std::vector<ViewBox> boxes(polygons.size());
    std::ranges::transform(polygons, boxes.begin(), box_of);
    std::vector<char> hole(polygons.size(), 0);
    for (std::size_t i = 0; i < polygons.size() && polygons.size() > 1; ++i) {
      const glm::dvec2 inside = inner_point(polygons[i]);
      for (std::size_t k = 0; k < polygons.size(); ++k)
        if (k != i && is_around(polygons[k], boxes[k], inside)) hole[i] = hole[i] == 0 ? 1 : 0;
    }
    for (std::size_t i = 0; i < polygons.size(); ++i)
      add({std::move(polygons[i]), elements_, hole[i] != 0, doubts[i]}, scope);
  }

  void add(Shape shape, const Scope& scope) {
    if (!scope.displayed || !scope.visible) {
      ++hidden_;
      return;
    }
    for (glm::dvec2& p : shape.polygon) p = glm::dvec2(scope.to_page * glm::dvec3(p, 1.0));
    require_usual_points(shape.polygon, fmt::format("{}, shape {}", path_, shapes_.size() + 1));
    if (is_drawn(shape)) {
      ++repeated_;
      return;
    }
    if (shape.doubt)
      notes_.push_back(fmt::format("{}, shape {}: {}", path_, shapes_.size() + 1, *shape.doubt));
    marks_.emplace(mark_of(shape.polygon).at, shapes_.size());
    shapes_.push_back(std::move(shape));
  }

  /// The hole of one shape may be another.
  bool is_drawn(const Shape& shape) const {
    const Mark mark = mark_of(shape.polygon);
    const auto end = marks_.upper_bound(mark.at + mark.slack);
    return std::any_of(marks_.lower_bound(mark.at - mark.slack), end, [&](const auto& marked) {
      const Shape& other = shapes_[marked.second];
      return shape.hole == other.hole && same_polygon(shape.polygon, other.polygon);
    });
  }

  /// A rectangle as large as the page would have all pieces as holes.
  void leave_out_background() {
    const auto first = std::stable_partition(
        shapes_.begin(), shapes_.end(), [&](const Shape& shape) { return !covers(shape.polygon, page_); });
    if (first == shapes_.end() || first == shapes_.begin()) return;
    shapes_.erase(first, shapes_.end());
    note("a rectangle that covers the page is taken for its background and left out");
  }

  const std::string& path_;
  std::vector<std::string>& notes_;
  ViewBox page_;
  std::vector<Shape> shapes_;
  std::multimap<double, std::size_t> marks_;  ///< of shapes_, by number
  std::size_t elements_ = 0;
  std::size_t hidden_ = 0;
  std::size_t repeated_ = 0;
  int copies_ = 0;
  std::set<std::string> unread_;  ///< what the drawing has and this reader does not look at
};

pugi::xml_node parse(pugi::xml_document& document, const std::string& path, const std::string& text) {
  const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
  if (!parsed) {
    throw InputError(path, fmt::format("is no SVG: {} at byte {}", parsed.description(), parsed.offset),
                     "save it again");
  }
  return document.document_element();
}

}  // namespace

std::vector<Rings> read_svg(const std::string& path, const std::string& text,
                            std::vector<std::string>& notes) {
  pugi::xml_document document;
  SvgReader reader(path, notes);
  reader.read(parse(document, path, text));
  return reader.pieces();
}

double svg_units_an_inch(const std::string& path, const std::string& text) {
  pugi::xml_document document;
  const pugi::xml_node root = parse(document, path, text);
  const auto width = length_of(root, "width", 0.0, path);
  if (!width || !width->physical || !(width->value > 0.0)) return 0.0;
  const ViewBox box = view_box(root, glm::dvec2(0.0), path);
  return kPixelsAnInch * (box.high.x - box.low.x) / width->value;
}

}  // namespace rejoin::outline::detail
