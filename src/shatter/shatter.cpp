#include "shatter/shatter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>

#include "core/components.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"
#include "mesh/point_index.hpp"
#include "mesh/ray_scene.hpp"
#include "shatter/chip_count.hpp"
#include "shatter/closed_holes.hpp"
#include "shatter/cracks.hpp"
#include "shatter/sites.hpp"
#include "shatter/surface_nets.hpp"

namespace rejoin::shatter {
namespace {

constexpr std::size_t kSamples = 20000;
constexpr double kTriesInside = 4e6;
constexpr double kWarpWave = 0.3;         // coarsest bend of a break, share of the diameter
constexpr double kWarpAmplitude = 0.025;  // at roughness 1
constexpr double kFar = 8.0;              // spacings
constexpr double kRayStep = 1e-6;         // of the diameter, past a surface that a ray has met
constexpr double kLeastContact = 20.0;    // squared spacings; less is no joint
constexpr double kRoughChip = 1.3;        // radii of a chip that its roughness makes it reach, about

/// Where a chip came off: a rough ball.
struct Chip {
  glm::dvec3 centre;
  double radius;
};

std::uint64_t edge_key(std::uint32_t from, std::uint32_t to) {
  return (static_cast<std::uint64_t>(from) << 32U) | to;
}

void require_closed(const std::string& name, const mesh::Mesh& mesh) {
  std::vector<std::uint64_t> edges;
  std::vector<std::uint64_t> back;
  edges.reserve(3 * mesh.faces.size());
  back.reserve(3 * mesh.faces.size());
  for (const glm::uvec3& face : mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      edges.push_back(edge_key(face[k], face[(k + 1) % 3]));
      back.push_back(edge_key(face[(k + 1) % 3], face[k]));
    }
  }
  std::sort(edges.begin(), edges.end());
  std::sort(back.begin(), back.end());
  if (!edges.empty() && edges == back) return;
  throw InputError(name, "its surface is not closed, so it has no inside to break", "close its holes first");
}

/// One thread builds: then the tree never depends on the machine.
mesh::RayScene make_scene(const mesh::Mesh& object) {
  const ThreadLimit one(1);
  return mesh::RayScene(object);
}

/// The object, how it is divided and what was worn off.
class Breaker {
 public:
  /// Of no use if the context was cancelled meanwhile.
  Breaker(const std::string& name, const mesh::Mesh& object, const Options& options, const Context& context)
      : object_(object), options_(options), scene_(make_scene(object)), diameter_(mesh::diameter(object)) {
    const Noise warp{options.seed, kWarpWave * diameter_, options.roughness * kWarpAmplitude * diameter_,
                     1.5 * spacing()};
    const mesh::Samples samples = mesh::sample_surface(object, kSamples);
    division_ = options.cracks ? cracks(samples, warp, context) : cells(samples, warp, context);
    if (context.cancelled()) return;
    if (!division_)
      throw InputError(name, fmt::format("no cut into {} pieces was found", options.pieces),
                       "ask for fewer pieces");
    wear_ = {options.seed + 77, 0.05 * diameter_, 0.5, 0.01 * diameter_};
    choose_chips(samples);
  }

  double diameter() const { return diameter_; }
  double spacing() const { return options_.spacing * diameter_; }

  /// Below 0 inside piece k.
  double field(const glm::dvec3& point, std::size_t k) const {
    const Walls walls = division_->walls(point, k);
    if (walls.nearest > kFar * spacing()) return walls.nearest;  // the object's surface makes no difference
    const double surface = signed_distance(point);
    double result = rounded(surface, walls, worn_radius(point));
    for (const Chip& chip : chips_[k]) {
      const double distance = glm::distance(point, chip.centre);
      if (distance > 2.0 * chip.radius + spacing()) {
        result = std::max(result, chip.radius - distance);
      } else {
        result = std::max(result, chip.radius * (1.0 + 0.3 * wear_.value(point)) - distance);
      }
    }
    return result;
  }

  /// The piece behind a point of piece k's surface if it lies on a break, else -1.
  int behind(const glm::dvec3& point, std::size_t k) const {
    const Walls walls = division_->walls(point, k);
    return std::abs(walls.nearest) < std::abs(signed_distance(point)) ? walls.behind : -1;
  }

  glm::dvec3 middle() const {
    const mesh::Box box = mesh::bounds(object_);
    return object_.origin + 0.5 * glm::dvec3(box.low + box.high);
  }

 private:
  std::unique_ptr<const Division> cells(const mesh::Samples& samples, const Noise& warp,
                                        const Context& context) const {
    auto cells = choose_cells(samples, object_.origin, static_cast<std::size_t>(options_.pieces), warp,
                              options_.seed, context);
    return cells ? std::make_unique<const Cells>(std::move(*cells)) : nullptr;
  }

  std::unique_ptr<const Division> cracks(const mesh::Samples& samples, const Noise& warp,
                                         const Context& context) const {
    auto cracks = choose_cracks(inside(context), samples, object_.origin,
                                static_cast<std::size_t>(options_.pieces), warp, options_.seed, context);
    return cracks ? std::make_unique<const Cracks>(std::move(*cracks)) : nullptr;
  }

  Inside inside(const Context& context) const {
    const mesh::Box box = mesh::bounds(object_);
    const glm::dvec3 size(box.high - box.low);
    Random random(options_.seed, 13);
    Inside inside;
    double tries = 0.0;
    for (; tries < kTriesInside && inside.points.size() < kSamples; ++tries) {
      if (context.cancelled()) return {};
      const glm::vec3 point =
          box.low + glm::vec3(size * glm::dvec3(random.uniform(), random.uniform(), random.uniform()));
      if (is_inside(point)) inside.points.push_back(point);
    }
    inside.spacing = std::cbrt(size.x * size.y * size.z / tries);
    return inside;
  }

  double signed_distance(const glm::dvec3& point) const {
    const glm::vec3 at(point - object_.origin);
    auto hit = scene_.nearest(at, static_cast<float>(6.0 * spacing()));  // short searches are quick
    if (!hit) hit = scene_.nearest(at, static_cast<float>(16.0 * diameter_));
    if (!hit) return diameter_;
    return (is_inside(at) ? -1.0 : 1.0) * static_cast<double>(hit->distance);
  }

  /// By what rays meet on their way out: a nearest feature's normal may tell the wrong side of rough surfaces,
  /// the more often the farther the point is.
  bool is_inside(const glm::vec3& at) const {
    static const std::array<glm::vec3, 3> kDirections{glm::normalize(glm::vec3(0.31F, 0.87F, 0.39F)),
                                                      glm::normalize(glm::vec3(-0.77F, 0.29F, 0.57F)),
                                                      glm::normalize(glm::vec3(0.53F, -0.43F, -0.73F))};
    int votes = 0;  // a ray may slip through between two faces
    for (const glm::vec3& direction : kDirections) votes += layers_around(at, direction) > 0 ? 1 : 0;
    return 2 * votes > static_cast<int>(kDirections.size());
  }

  /// Surfaces that a ray leaves, less those that it enters.
  int layers_around(const glm::vec3& at, const glm::vec3& direction) const {
    const auto step = static_cast<float>(kRayStep * diameter_);
    const auto far = static_cast<float>(16.0 * diameter_);
    int layers = 0;
    float near = 0.0F;
    while (const auto hit = scene_.first_hit(at, direction, near, far)) {
      const glm::uvec3 face = object_.faces[hit->face];
      const glm::vec3& corner = object_.vertices[face.x];
      const glm::vec3 normal =
          glm::cross(object_.vertices[face.y] - corner, object_.vertices[face.z] - corner);
      layers += glm::dot(normal, direction) > 0.0F ? 1 : -1;
      near = hit->distance + step;
    }
    return layers;
  }

  double worn_radius(const glm::dvec3& point) const {
    if (options_.erosion <= 0.0) return 0.0;
    return options_.erosion * diameter_ * std::clamp(1.0 + wear_.value(point), 0.3, 2.0);
  }

  /// The three surfaces' common inside with edges and corners rounded to a radius.
  static double rounded(double surface, const Walls& walls, double radius) {
    const double sharp = std::max(surface, walls.nearest);
    if (!(radius > 0.0)) return sharp;
    double squares = 0.0;
    for (const double distance : {surface, walls.nearest, walls.second}) {
      const double over = std::max(0.0, radius + distance);
      squares += over * over;
    }
    return std::min(sharp, -radius) + std::sqrt(squares);
  }

  /// Chips come off where a break meets the object's surface.
  void choose_chips(const mesh::Samples& samples) {
    std::vector<std::vector<glm::dvec3>> rims(division_->pieces());
    for (const glm::vec3& sample : samples.points) {
      const glm::dvec3 point = object_.origin + glm::dvec3(sample);
      const std::size_t cell = division_->piece_of(point);
      if (division_->walls(point, cell).nearest > -2.0 * samples.spacing) rims[cell].push_back(point);
    }
    Random random(options_.seed, 12);
    chips_.resize(division_->pieces());
    for (std::size_t k = 0; k < rims.size(); ++k) {
      const int count = chip_count(options_.chips, random);
      for (int c = 0; c < count && !rims[k].empty(); ++c) {
        const glm::dvec3 at = rims[k][random.below(static_cast<std::uint32_t>(rims[k].size()))];
        chips_[k].push_back({at, options_.chip_size * diameter_ * random.uniform(0.3, 1.0)});
      }
    }
  }

  const mesh::Mesh& object_;
  const Options& options_;
  mesh::RayScene scene_;
  double diameter_;
  std::unique_ptr<const Division> division_;
  Noise wear_;
  std::vector<std::vector<Chip>> chips_;  ///< one list a piece
};

glm::dmat3 random_rotation(Random& random) {
  glm::dvec3 axis(random.normal(), random.normal(), random.normal());
  const double length = glm::length(axis);
  axis = length > 1e-9 ? axis / length : glm::dvec3(0, 0, 1);
  const glm::dmat3 tilt = rotation_between({0, 0, 1}, axis);
  return tilt * axis_rotation({0, 0, 1}, random.uniform(0.0, 6.283185307179586));
}

/// Six times the volume that faces enclose with the origin.
double six_volumes(const mesh::Mesh& mesh, const glm::uvec3& face) {
  const glm::dvec3 a(mesh.vertices[face.x]);
  return glm::dot(a, glm::cross(glm::dvec3(mesh.vertices[face.y]), glm::dvec3(mesh.vertices[face.z])));
}

struct LargestPart {
  mesh::Mesh mesh;
  double volume = 0;
  double lost = 0;  ///< volume of the others
};

/// The connected part with the most faces.
LargestPart largest_part(const mesh::Mesh& mesh) {
  Components components(mesh.vertices.size());
  for (const glm::uvec3& face : mesh.faces) {
    components.unite(face.x, face.y);
    components.unite(face.y, face.z);
  }
  std::map<std::uint32_t, std::pair<std::size_t, double>> parts;  // faces and six volumes
  for (const glm::uvec3& face : mesh.faces) {
    auto& [faces, volumes] = parts[components.of(face.x)];
    ++faces;
    volumes += six_volumes(mesh, face);
  }
  const auto largest = std::max_element(parts.begin(), parts.end(), [](const auto& a, const auto& b) {
    return a.second.first < b.second.first;
  });
  LargestPart result;
  for (auto part = parts.begin(); part != parts.end(); ++part)
    (part == largest ? result.volume : result.lost) += std::max(0.0, part->second.second) / 6.0;
  std::vector<std::uint32_t> kept;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    if (components.of(mesh.faces[f].x) == largest->first) kept.push_back(f);
  }
  result.mesh = mesh::submesh(mesh, kept);
  return result;
}

/// One piece's side of its break towards another.
struct Side {
  std::vector<glm::vec3> middles;  ///< of its faces, relative to the object's middle
  std::vector<double> areas;
};

/// By the piece and the other one.
using Sides = std::map<std::pair<std::size_t, std::size_t>, Side>;

/// The sides of piece k, still in the object's frame.
void add_sides(const Breaker& breaker, const mesh::Mesh& piece, std::size_t k, Sides& sides) {
  for (const glm::uvec3& face : piece.faces) {
    const glm::dvec3 a(piece.vertices[face.x]);
    const glm::dvec3 b(piece.vertices[face.y]);
    const glm::dvec3 c(piece.vertices[face.z]);
    const glm::dvec3 middle = (a + b + c) / 3.0;
    const int other = breaker.behind(piece.origin + middle, k);
    if (other < 0) continue;
    Side& side = sides[{k, static_cast<std::size_t>(other)}];
    side.middles.emplace_back(piece.origin + middle - breaker.middle());
    side.areas.push_back(0.5 * glm::length(glm::cross(b - a, c - a)));
  }
}

/// Area of a side whose other side is still there, not in a part that was lost.
double area_opposite(const Side& side, const Side& other, double reach) {
  const mesh::PointIndex index(other.middles);
  double area = 0.0;
  for (std::size_t f = 0; f < side.middles.size(); ++f) {
    if (index.nearest_within(side.middles[f], static_cast<float>(reach))) area += side.areas[f];
  }
  return area;
}

std::vector<Contact> contacts_of(const Sides& sides, double reach, double least) {
  std::vector<Contact> contacts;
  for (const auto& [pair, side] : sides) {
    const auto other = sides.find({pair.second, pair.first});
    if (pair.first > pair.second || other == sides.end()) continue;
    const double area =
        0.5 * (area_opposite(side, other->second, reach) + area_opposite(other->second, side, reach));
    if (area >= least) contacts.push_back({pair.first, pair.second, area});
  }
  return contacts;
}

/// How far two sides of a break lie apart where most was worn off both, or chips came off.
double widest_gap(const Options& options, double diameter) {
  const double chip = options.chips > 0.0 ? options.chip_size : 0.0;
  return diameter * (3.0 * options.spacing + 2.0 * (2.0 * options.erosion + kRoughChip * chip));
}

/// How far points of a scan lie off the surface, mesh units.
struct Deviation {
  double noise = 0;  ///< of every point by itself, the standard deviation
  Noise correlated;  ///< of what near points share
};

Deviation deviation_of(const Options& options, double diameter, std::uint64_t seed) {
  constexpr double kOctave = 0.27;  // standard deviation of an octave of amplitude 1
  const double wavelength = options.wavelength * diameter;
  return {options.noise * diameter,
          {.seed = seed,
           .wavelength = wavelength,
           .amplitude = options.correlated * diameter / kOctave,
           .finest = 0.9 * wavelength}};
}

/// Whether vertices of piece k, in the object's frame, lie on its breaks.
std::vector<std::uint8_t> on_breaks(const Breaker& breaker, const mesh::Mesh& piece, std::size_t k) {
  std::vector<std::uint8_t> result(piece.vertices.size());
  std::transform(piece.vertices.begin(), piece.vertices.end(), result.begin(), [&](const glm::vec3& v) {
    return breaker.behind(piece.origin + glm::dvec3(v), k) >= 0 ? std::uint8_t{1} : std::uint8_t{0};
  });
  return result;
}

/// Moves a piece to a pose of its own and adds the scanner's noise.
Piece scanned(mesh::Mesh piece, const Deviation& deviation, double reach, Random& random) {
  mesh::compute_normals(piece);
  Rigid away{random_rotation(random), {}};
  for (int k = 0; k < 3; ++k) away.translation[k] = random.uniform(-reach, reach);
  piece.origin = away(piece.origin);
  for (std::size_t v = 0; v < piece.vertices.size(); ++v) {
    const glm::dvec3 point(piece.vertices[v]);
    const double off = deviation.noise * random.normal() + deviation.correlated.value(point);
    piece.vertices[v] = glm::vec3(away.rotation * (point + off * glm::dvec3(piece.normals[v])));
  }
  piece.normals.clear();
  return {std::move(piece), inverse(away)};
}

}  // namespace

Shattered shatter(const std::string& name, const mesh::Mesh& object, const Options& options,
                  const Context& context) {
  require_closed(name, object);
  context.report("shatter", 0.0);
  const Breaker breaker(name, object, options, context);
  if (context.cancelled()) return {{}, {}, 0.0, 0.0, true};
  Shattered result;
  result.diameter = breaker.diameter();
  Sides sides;
  double volume = 0.0;
  double lost = 0.0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(options.pieces); ++k) {
    Random random(options.seed, 1000 + k);
    const Grid grid{random_rotation(random), breaker.middle(), 1.1 * breaker.diameter(), breaker.spacing()};
    const Field field = [&breaker, k](const glm::dvec3& point) { return breaker.field(point, k); };
    const mesh::Mesh whole = surface_nets(field, grid, context);
    if (context.cancelled()) return {{}, {}, 0.0, 0.0, true};
    if (whole.faces.empty())
      throw InputError(name, fmt::format("piece {} is smaller than the grid", k),
                       "ask for fewer pieces or a finer grid");
    const LargestPart piece = largest_part(whole);
    volume += piece.volume + piece.lost;
    lost += piece.lost;
    add_sides(breaker, piece.mesh, k, sides);
    const Deviation deviation = deviation_of(options, breaker.diameter(), options.seed + 1000 + k);
    result.pieces.push_back(scanned(piece.mesh, deviation, breaker.diameter(), random));
    if (options.closed > 0.0) {
      close_holes(result.pieces.back().scan, on_breaks(breaker, piece.mesh, k), options.closed,
                  options.hole_size * breaker.diameter(), random);
    }
    context.report("shatter", static_cast<double>(k + 1) / options.pieces);
  }
  result.lost = volume > 0.0 ? lost / volume : 0.0;
  result.contacts = contacts_of(sides, widest_gap(options, breaker.diameter()),
                                kLeastContact * breaker.spacing() * breaker.spacing());
  return result;
}

}  // namespace rejoin::shatter
