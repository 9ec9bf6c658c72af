#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.hpp"
#include "core/words.hpp"
#include "mesh/detail/cloud_normals.hpp"
#include "mesh/detail/enclosed.hpp"
#include "mesh/detail/orient.hpp"
#include "mesh/detail/point_box.hpp"
#include "mesh/detail/soup.hpp"
#include "mesh/detail/specks.hpp"
#include "mesh/detail/triangulate.hpp"
#include "mesh/detail/unusable_points.hpp"
#include "mesh/detail/weld.hpp"

namespace rejoin::mesh::detail {
namespace {

void check_corners(const Soup& soup, const std::string& name) {
  std::size_t at = 0;
  for (std::size_t face = 0; face < soup.sizes.size(); ++face) {
    for (std::uint32_t k = 0; k < soup.sizes[face]; ++k, ++at) {
      if (soup.corners[at] < soup.points.size()) continue;
      throw InputError(name,
                       fmt::format("face {} refers to a vertex that does not exist (there are {})", face,
                                   soup.points.size()),
                       "export the scan again");
    }
  }
}

/// Areas are computed with floats: fourth powers of an edge must neither overflow one nor vanish in it.
void require_usual_size(const Mesh& mesh, const std::string& name) {
  constexpr double kSmallest = 1e-6;
  constexpr double kLargest = 1e9;
  const Box box = bounds(mesh);
  const double size = glm::distance(glm::dvec3(box.low), glm::dvec3(box.high));
  if (size >= kSmallest && size <= kLargest) return;
  throw InputError(name, fmt::format("is {:.3g} across", size),
                   "remove vertices far from the rest, or export it in a usual unit such as millimetres");
}

/// Samples of a surface lie in a grid whose cells follow from its area: a needle would need more of them than can be counted.
void require_area(const Mesh& mesh, const std::string& name) {
  constexpr double kLeast = 1e-10;  // of the size, squared; scans have a thousandth and more
  const Box box = bounds(mesh);
  const double size = glm::distance(glm::dvec3(box.low), glm::dvec3(box.high));
  const double area = surface_area(mesh);
  if (area >= kLeast * size * size) return;
  throw InputError(
      name, fmt::format("is {:.3g} across, but its faces have an area of only {:.3g} in all", size, area),
      "remove parts far from the rest, or export the scan again");
}

/// Floats have wide steps far from the origin: tells where they come near the distance of the points, refuses where they exceed it.
void check_steps(const Soup& soup, const PointBox& box, const std::string& name,
                 std::vector<std::string>& warnings) {
  constexpr double kTold = 0.1;
  const auto is_float = [](const glm::dvec3& p) { return glm::dvec3(glm::vec3(p)) == p; };
  if (!std::all_of(soup.points.begin(), soup.points.end(), is_float)) return;
  const glm::dvec3 furthest = glm::max(glm::abs(box.low), glm::abs(box.high));
  const auto largest = static_cast<float>(std::max({furthest.x, furthest.y, furthest.z}));
  const double step = static_cast<double>(std::nextafter(largest, 2 * largest) - largest);
  const double apart = box.size() / std::sqrt(static_cast<double>(soup.points.size()));
  if (!(apart > 0) || step <= kTold * apart) return;
  const std::string what = fmt::format(
      "its coordinates are floats, which have steps of {:.3g} so far from the origin, and its points lie "
      "some {:.3g} apart",
      step, apart);
  const std::string mend = "move the scan near the origin before it is exported, or export it with doubles";
  if (step > apart) throw InputError(name, what, mend);
  warnings.push_back(fmt::format("{}: {}; {}", name, what, mend));
}

/// The point that coordinates are stored relative to: zero for a scan near the origin, so that its floats
/// stay as they are, else the box's centre on a coarse binary grid, so that subtracting it from float
/// coordinates is exact.
glm::dvec3 choose_origin(const PointBox& box) {
  const double size = box.size();
  const glm::dvec3 furthest = glm::max(glm::abs(box.low), glm::abs(box.high));
  if (size <= 0 || std::max({furthest.x, furthest.y, furthest.z}) <= 4 * size) return glm::dvec3(0.0);
  const double grid = std::exp2(std::floor(std::log2(size)));
  return glm::round((box.low + box.high) / (2 * grid)) * grid;
}

Mesh to_mesh(const Soup& soup, const PointBox& box) {
  Mesh mesh;
  mesh.origin = choose_origin(box);
  mesh.vertices.reserve(soup.points.size());
  for (const glm::dvec3& point : soup.points) mesh.vertices.emplace_back(point - mesh.origin);
  mesh.normals = soup.normals;
  mesh.colours = soup.colours;
  mesh.faces = triangulate(soup);
  return mesh;
}

bool is_usable(const glm::vec3& normal) {
  const double length = glm::length(glm::dvec3(normal));
  return length > 0 && std::isfinite(length);
}

/// Makes normals unit length; false if one is zero or not finite.
bool normalize_all(std::vector<glm::vec3>& normals) {
  bool good = true;
  for (glm::vec3& normal : normals) {
    if (is_usable(normal)) {
      normal = glm::vec3(glm::normalize(glm::dvec3(normal)));
    } else {
      good = false;
    }
  }
  return good;
}

/// Joins the faces of a mesh whose corners differ by rounding.
void weld_loose(Loaded& loaded, const std::string& name) {
  constexpr std::size_t kFew = 16;  // faces, of which none need to touch
  Mesh& mesh = loaded.mesh;
  if (mesh.faces.size() < kFew || !is_loose(mesh)) return;
  const std::size_t before = mesh.vertices.size();
  weld_near(mesh);
  if (mesh.vertices.size() < before) {
    loaded.warnings.push_back(
        fmt::format("{}: its faces hardly shared vertices, made {} of {} by joining near ones", name,
                    mesh.vertices.size(), before));
  }
  if (is_loose(mesh)) {
    loaded.warnings.push_back(name +
                              ": its faces hardly hang together, so that breaks cannot be told (merge close "
                              "vertices in the scanning software)");
  }
}

/// Whether mended faces are more than nearly every scan has.
bool are_worth_telling(std::size_t mended, std::size_t faces) {
  constexpr double kFewFaces = 1e-3;
  return kFewFaces * static_cast<double>(faces) < static_cast<double>(mended);
}

void clean_faces(Loaded& loaded, const std::string& name, Content content) {
  Mesh& mesh = loaded.mesh;
  const std::size_t before = mesh.faces.size();
  const Dropped dropped = drop_useless_faces(mesh);
  if (mesh.faces.empty()) {
    throw InputError(name, fmt::format("none of its {} faces has an area", before), "export the scan again");
  }
  if (2 * dropped.degenerate > before) {
    throw InputError(name, fmt::format("{} of its {} faces have no area", dropped.degenerate, before),
                     "export the scan again, with more digits if its coordinates are large");
  }
  if (are_worth_telling(dropped.degenerate, before)) {
    loaded.warnings.push_back(
        fmt::format("{}: dropped {} of {} faces that have no area", name, dropped.degenerate, before));
  }
  if (are_worth_telling(dropped.duplicate, before)) {
    loaded.warnings.push_back(
        fmt::format("{}: dropped {} of {} faces that are there twice", name, dropped.duplicate, before));
  }
  const Specks specks = content != Content::Several ? drop_specks(mesh) : Specks{};
  if (specks.parts > 0) {
    loaded.warnings.push_back(
        fmt::format("{}: dropped {} of {} faces, in {} off the rest (remove specks in the scanning "
                    "software)",
                    name, specks.faces, before, counted(specks.parts, "small part")));
  }
  const Enclosed enclosed = content == Content::OnePiece ? drop_enclosed(mesh) : Enclosed{};
  if (enclosed.parts > 0) {
    loaded.warnings.push_back(
        fmt::format("{}: dropped {} of {} faces, in {} inside it, which no other piece can touch", name,
                    enclosed.faces, before, counted(enclosed.parts, "part")));
  }
  drop_unused_vertices(mesh);
  if (const Spikes spikes = drop_spikes(mesh); spikes.vertices > 0) {
    loaded.warnings.push_back(fmt::format(
        "{}: dropped {} of {} faces, at {} far from the rest (mend the coordinates, or remove it in "
        "the scanning software)",
        name, spikes.faces, before,
        spikes.vertices == 1 ? "a vertex" : std::to_string(spikes.vertices) + " vertices"));
  }
  if (const std::size_t backs = drop_backs(mesh); backs > 0) {
    loaded.warnings.push_back(
        fmt::format("{}: dropped {} of {} faces that are the backs of others", name, backs, before));
  }
  require_usual_size(mesh, name);
  require_area(mesh, name);
  const Turned turned = orient_faces(mesh);
  if (are_worth_telling(turned.inconsistent, before)) {
    loaded.warnings.push_back(
        fmt::format("{}: turned {} of {} faces that were wound against their neighbours", name,
                    turned.inconsistent, before));
  }
  if (turned.inside_out) loaded.warnings.push_back(fmt::format("{}: was inside out, turned all faces", name));
  if (turned.of_parts > 0) {
    loaded.warnings.push_back(fmt::format("{}: turned {} of {} faces, of parts that were inside out", name,
                                          turned.of_parts, before));
  }
  if (!mesh.normals.empty() && !normalize_all(mesh.normals)) compute_normals(mesh);
}

/// Whether all points lie on one line.
bool is_line(const std::vector<glm::vec3>& points) {
  const glm::dvec3 start(points.front());
  glm::dvec3 along(0.0);
  for (const glm::vec3& point : points) {
    const glm::dvec3 step = glm::dvec3(point) - start;
    if (glm::dot(step, step) > glm::dot(along, along)) along = step;
  }
  const double limit = 1e-6 * glm::dot(along, along);
  return std::all_of(points.begin(), points.end(), [&](const glm::vec3& point) {
    return glm::length(glm::cross(glm::dvec3(point) - start, along)) <= limit;
  });
}

/// Drops the points whose normal is zero or not finite; returns how many.
std::size_t drop_without_normal(Mesh& mesh) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!is_usable(mesh.normals[i])) continue;
    mesh.vertices[kept] = mesh.vertices[i];
    mesh.normals[kept] = mesh.normals[i];
    if (!mesh.colours.empty()) mesh.colours[kept] = mesh.colours[i];
    ++kept;
  }
  const std::size_t dropped = mesh.vertices.size() - kept;
  mesh.vertices.resize(kept);
  mesh.normals.resize(kept);
  if (!mesh.colours.empty()) mesh.colours.resize(kept);
  return dropped;
}

/// Drops normals that most points have none of, or the few points without one.
void require_normals_of_all_or_none(Loaded& loaded, const std::string& name) {
  Mesh& mesh = loaded.mesh;
  const std::size_t count = mesh.vertices.size();
  const auto usable = std::count_if(mesh.normals.begin(), mesh.normals.end(), is_usable);
  if (2 * static_cast<std::size_t>(usable) < count) {
    mesh.normals.clear();
  } else if (const std::size_t dropped = drop_without_normal(mesh); dropped > 0) {
    loaded.warnings.push_back(
        fmt::format("{}: dropped {} of {} points without a usable normal", name, dropped, count));
  }
  normalize_all(mesh.normals);
}

void require_spread(const Mesh& cloud, const std::string& name, std::size_t count) {
  if (is_line(cloud.vertices)) {
    throw InputError(name, fmt::format("its {} distinct points span no area", count),
                     "export the scan again");
  }
  require_usual_size(cloud, name);
}

/// Drops strays, and makes or turns normals.
void clean_piece(Loaded& loaded, const std::string& name, std::size_t count) {
  Mesh& mesh = loaded.mesh;
  std::optional<CloudNeighbours> neighbours(mesh.vertices);
  if (const std::size_t strays = drop_stray_points(mesh, neighbours->near()); strays > 0) {
    neighbours.emplace(mesh.vertices);
    loaded.warnings.push_back(
        fmt::format("{}: dropped {} of {} points that lie apart from the rest (remove strays in the scanning "
                    "software)",
                    name, strays, count));
  }
  require_spread(mesh, name, count);
  if (mesh.normals.empty()) {
    mesh.normals = estimate_normals(mesh.vertices, neighbours->near());
    normalize_all(mesh.normals);
    return;
  }
  switch (check_normals(mesh, *neighbours)) {
    case NormalsFound::Good:
      break;
    case NormalsFound::InsideOut:
      loaded.warnings.push_back(name + ": its normals pointed inwards, turned all of them");
      break;
    case NormalsFound::Mixed:
      loaded.warnings.push_back(name +
                                ": its normals pointed inwards and outwards, turned them to agree (export "
                                "oriented normals for a surer result)");
      break;
  }
}

void clean_cloud(Loaded& loaded, const std::string& name, Content content) {
  const std::size_t count = loaded.mesh.vertices.size();
  require_normals_of_all_or_none(loaded, name);
  if (content == Content::Several) return require_spread(loaded.mesh, name, count);
  if (loaded.mesh.normals.empty()) {
    loaded.warnings.push_back(
        name + ": the points have no normals, estimated them (export normals for a surer result)");
  }
  clean_piece(loaded, name, count);
}

}  // namespace

Loaded clean(Soup soup, const std::string& name, Weld which, Content content) {
  if (soup.points.empty()) throw InputError(name, "has no vertices", "export the scan again");
  check_corners(soup, name);
  Loaded loaded;
  leave_out_unusable_points(soup, name, loaded.warnings);
  for (const std::string& note : soup.notes) loaded.warnings.push_back(fmt::format("{}: {}", name, note));
  const PointBox box = box_of_piece(soup.points);
  check_steps(soup, box, name, loaded.warnings);
  loaded.mesh = to_mesh(soup, box);
  const bool cloud = soup.sizes.empty();
  if (!cloud && loaded.mesh.faces.empty()) {
    throw InputError(name, fmt::format("none of its {} faces has three corners", soup.sizes.size()),
                     "export the scan again");
  }
  weld(loaded.mesh, which);
  if (!cloud) weld_loose(loaded, name);
  if (cloud) {
    clean_cloud(loaded, name, content);
  } else {
    clean_faces(loaded, name, content);
  }
  return loaded;
}

}  // namespace rejoin::mesh::detail
