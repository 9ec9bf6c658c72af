#include "mesh/pores.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/components.hpp"
#include "core/parallel.hpp"
#include "mesh/detail/directions.hpp"
#include "mesh/ray_scene.hpp"
#include "mesh/samples.hpp"

namespace rejoin::mesh {
namespace {

constexpr std::size_t kPorePlaces = 1000;
constexpr std::size_t kPoreDirections = 32;
constexpr double kReach = 0.1;       // of the piece's size, in which directions end
constexpr float kDeep = 0.4F;        // of the directions are free, at most, deep in a pore
constexpr double kMostPores = 0.8;   // of the area is left out, at most: else it is no piece with pores
constexpr float kOpen = 0.7F;        // are free, at least, of what counts as open
constexpr double kPorous = 0.1;      // of a porous piece's area is deep
constexpr std::size_t kMouths = 12;  // of a porous piece
constexpr std::size_t kMouth = 12;   // edges around one: less may be a dent, or noise
constexpr double kDrawn = 0.65;      // of what is deep shows along one direction in the relief of a break
constexpr std::size_t kAxes = 64;    // lines along which a piece may have been drawn out, both ways
constexpr std::size_t kFacesAsked = 150;  // of a deep place, at most
constexpr float kUndercut =
    0.3F;  // cosine by which a face may look away from the direction along which it shows

/// How open places of a surface are.
class Outside {
 public:
  Outside(const Mesh& mesh, double size)
      : scene_(mesh),
        directions_(detail::half_sphere_directions(kPoreDirections)),
        reach_(static_cast<float>(kReach * size)),
        start_(0.3F * static_cast<float>(resolution(mesh))) {}

  /// Whether nothing is near in front of a place in a direction.
  bool shows(const glm::vec3& place, const glm::vec3& normal, const glm::vec3& direction) const {
    return !scene_.first_hit(place + start_ * normal, direction, 0.0F, reach_);
  }

  /// Share of the directions about a normal in which nothing is near.
  float seen_from(const glm::vec3& place, const glm::vec3& normal) const {
    const glm::mat3 frame = detail::frame_about(normal);
    const auto free = std::ranges::count_if(
        directions_, [&](const glm::vec3& direction) { return shows(place, normal, frame * direction); });
    return static_cast<float>(free) / static_cast<float>(kPoreDirections);
  }

 private:
  RayScene scene_;
  std::vector<glm::vec3> directions_;
  float reach_;
  float start_;  // over the noise of a scan
};

double deep_share(const Mesh& mesh, const Outside& outside) {
  const Samples samples = sample_surface(mesh, kPorePlaces);
  std::vector<char> deep(samples.size());
  parallel_for(samples.size(), 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      deep[i] = outside.seen_from(samples.points[i], samples.normals[i]) < kDeep ? 1 : 0;
  });
  return static_cast<double>(std::ranges::count(deep, 1)) / static_cast<double>(samples.size());
}

glm::vec3 middle_of(const Mesh& mesh, std::size_t face) {
  const auto& corners = mesh.faces[face];
  return (mesh.vertices[corners[0]] + mesh.vertices[corners[1]] + mesh.vertices[corners[2]]) / 3.0F;
}

/// Of every face, evened out over the faces around its corners.
std::vector<float> openness(const Mesh& mesh, const Outside& outside) {
  const std::vector<glm::vec3> normals = face_normals(mesh);
  std::vector<float> of_face(mesh.faces.size());
  parallel_for(of_face.size(), 256, [&](std::size_t first, std::size_t last) {
    for (std::size_t f = first; f < last; ++f) {
      of_face[f] = outside.seen_from(middle_of(mesh, f), normals[f]);
    }
  });
  std::vector<float> sums(mesh.vertices.size(), 0.0F);
  std::vector<std::uint32_t> counts(mesh.vertices.size(), 0);
  for (std::size_t f = 0; f < of_face.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      sums[mesh.faces[f][k]] += of_face[f];
      ++counts[mesh.faces[f][k]];
    }
  }
  for (std::size_t f = 0; f < of_face.size(); ++f) {
    float sum = 0.0F;
    for (int k = 0; k < 3; ++k) sum += sums[mesh.faces[f][k]] / static_cast<float>(counts[mesh.faces[f][k]]);
    of_face[f] = sum / 3.0F;
  }
  return of_face;
}

/// Borders of what is deep.
std::size_t mouths(const Mesh& mesh, const std::vector<float>& open) {
  std::vector<std::array<std::uint32_t, 3>> sides;  // both ends, and whether the face is deep
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({mesh.faces[f][k], mesh.faces[f][(k + 1) % 3]});
      sides.push_back({low, high, open[f] < kDeep ? 1U : 0U});
    }
  }
  std::ranges::sort(sides);
  Components borders(mesh.vertices.size());
  std::vector<std::uint32_t> ends;
  for (std::size_t k = 0; k + 1 < sides.size(); ++k) {
    const auto& [low, high, deep] = sides[k];
    const auto& [next_low, next_high, next_deep] = sides[k + 1];
    if (low != next_low || high != next_high || deep == next_deep) continue;
    borders.unite(low, high);
    ends.push_back(low);
  }
  std::vector<std::size_t> edges(mesh.vertices.size(), 0);
  for (const std::uint32_t end : ends) ++edges[borders.of(end)];
  return static_cast<std::size_t>(std::ranges::count_if(edges, [](std::size_t n) { return n >= kMouth; }));
}

/// The deep faces, in places that hang together.
std::vector<std::vector<std::uint32_t>> deep_places(const Mesh& mesh, const std::vector<float>& open) {
  Components joined(mesh.vertices.size());
  for (std::size_t f = 0; f < open.size(); ++f) {
    if (open[f] >= kDeep) continue;
    joined.unite(mesh.faces[f][0], mesh.faces[f][1]);
    joined.unite(mesh.faces[f][0], mesh.faces[f][2]);
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> places;
  for (std::uint32_t f = 0; f < open.size(); ++f)
    if (open[f] < kDeep) places[joined.of(mesh.faces[f][0])].push_back(f);
  std::vector<std::vector<std::uint32_t>> list;
  for (auto& [first, faces] : places)
    if (faces.size() >= kMouth) list.push_back(std::move(faces));
  return list;
}

/// Of what is deep the share that shows along one direction, another one for every place: the splinters of a break, however deep
/// the valleys between them are, were drawn out of the other piece; pores narrow towards their mouths and hide most of themselves.
double drawn_share(const Mesh& mesh, const std::vector<float>& open, const Outside& outside) {
  const std::vector<glm::vec3> normals = face_normals(mesh);
  std::vector<glm::vec3> directions = detail::half_sphere_directions(kAxes);
  for (std::size_t k = 0; k < kAxes; ++k) directions.push_back(-directions[k]);
  const std::vector<std::vector<std::uint32_t>> places = deep_places(mesh, open);
  std::vector<double> shown(places.size(), 0.0);  // faces
  parallel_for(places.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t place = first; place < last; ++place) {
      const std::vector<std::uint32_t>& faces = places[place];
      const std::size_t step = faces.size() / kFacesAsked + 1;
      std::vector<std::size_t> along(directions.size(), 0);
      std::size_t asked = 0;
      for (std::size_t k = 0; k < faces.size(); k += step) {
        ++asked;
        const glm::vec3 middle = middle_of(mesh, faces[k]);
        const glm::vec3& normal = normals[faces[k]];
        for (std::size_t d = 0; d < directions.size(); ++d) {
          if (glm::dot(directions[d], normal) > -kUndercut && outside.shows(middle, normal, directions[d]))
            ++along[d];
        }
      }
      const auto most = static_cast<double>(*std::ranges::max_element(along));
      shown[place] = most / static_cast<double>(asked) * static_cast<double>(faces.size());
    }
  });
  double sum = 0.0;
  double all = 0.0;
  for (std::size_t place = 0; place < places.size(); ++place) {
    sum += shown[place];
    all += static_cast<double>(places[place].size());
  }
  return all > 0.0 ? sum / all : 0.0;
}

}  // namespace

std::optional<Open> without_pores(const Mesh& mesh, double size) {
  const Outside outside(mesh, size);
  if (deep_share(mesh, outside) < kPorous) return std::nullopt;
  const std::vector<float> open = openness(mesh, outside);
  if (mouths(mesh, open) < kMouths || drawn_share(mesh, open, outside) >= kDrawn) return std::nullopt;
  std::vector<std::uint32_t> kept;
  for (std::uint32_t f = 0; f < open.size(); ++f)
    if (open[f] >= kOpen) kept.push_back(f);
  if (kept.empty()) return std::nullopt;
  Open left{.surface = submesh(mesh, kept)};
  left.share = 1.0 - surface_area(left.surface) / surface_area(mesh);
  if (left.share > kMostPores) return std::nullopt;
  return left;
}

}  // namespace rejoin::mesh
