#include "shapes.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <stdexcept>

#include "core/random.hpp"

namespace rejoin::mesh::test {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Vertices by place, so that sides share them.
class Builder {
 public:
  std::uint32_t vertex(const glm::vec3& point) {
    const auto [found, added] =
        index_.try_emplace({point.x, point.y, point.z}, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (added) mesh.vertices.push_back(point);
    return found->second;
  }
  Mesh mesh;

 private:
  std::map<std::tuple<float, float, float>, std::uint32_t> index_;
};

}  // namespace

Mesh icosphere(float radius, int level) {
  const float t = (1.0F + std::sqrt(5.0F)) / 2.0F;
  Mesh mesh;
  mesh.vertices = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                   {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  mesh.faces = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int i = 0; i < level; ++i) {
    std::map<Edge, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, added] = middles.try_emplace({std::min(a, b), std::max(a, b)},
                                                      static_cast<std::uint32_t>(mesh.vertices.size()));
      if (added) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2.0F);
      return found->second;
    };
    std::vector<glm::uvec3> finer;
    for (const glm::uvec3& f : mesh.faces) {
      const std::uint32_t ab = middle(f.x, f.y);
      const std::uint32_t bc = middle(f.y, f.z);
      const std::uint32_t ca = middle(f.z, f.x);
      finer.insert(finer.end(), {{f.x, ab, ca}, {f.y, bc, ab}, {f.z, ca, bc}, {ab, bc, ca}});
    }
    mesh.faces = std::move(finer);
  }
  for (glm::vec3& vertex : mesh.vertices) vertex *= radius / glm::length(vertex);
  return mesh;
}

Mesh box(const glm::vec3& size, int cells) {
  Builder builder;
  const auto step = 1.0F / static_cast<float>(cells);
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-0.5F, 0.5F}) {
      for (int i = 0; i < cells; ++i) {
        for (int k = 0; k < cells; ++k) {
          const auto corner = [&](int di, int dk) {
            glm::vec3 p;
            p[axis] = side;
            p[(axis + 1) % 3] = static_cast<float>(i + di) * step - 0.5F;
            p[(axis + 2) % 3] = static_cast<float>(k + dk) * step - 0.5F;
            return builder.vertex(p * size);
          };
          glm::uvec4 quad(corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1));
          if (side < 0) std::swap(quad.y, quad.w);
          builder.mesh.faces.emplace_back(quad.x, quad.y, quad.z);
          builder.mesh.faces.emplace_back(quad.x, quad.z, quad.w);
        }
      }
    }
  }
  return builder.mesh;
}

Mesh spread(float spacing, const std::function<void(glm::vec3& point, glm::vec3& normal)>& draw) {
  using Cell = std::tuple<int, int, int>;
  std::map<Cell, std::vector<std::uint32_t>> grid;
  const auto cell_of = [&](const glm::vec3& p, int k) {
    return static_cast<int>(std::floor(p[k] / spacing));
  };
  Mesh cloud;
  const auto fits = [&](const glm::vec3& p) {
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        for (int k = -1; k <= 1; ++k) {
          const auto found = grid.find({cell_of(p, 0) + i, cell_of(p, 1) + j, cell_of(p, 2) + k});
          if (found == grid.end()) continue;
          for (const std::uint32_t other : found->second) {
            if (glm::distance(p, cloud.vertices[other]) < spacing) return false;
          }
        }
      }
    }
    return true;
  };
  for (int misses = 0; misses < 3000;) {
    glm::vec3 point;
    glm::vec3 normal;
    draw(point, normal);
    if (!fits(point)) {
      ++misses;
      continue;
    }
    misses = 0;
    grid[{cell_of(point, 0), cell_of(point, 1), cell_of(point, 2)}].push_back(
        static_cast<std::uint32_t>(cloud.vertices.size()));
    cloud.vertices.push_back(point);
    cloud.normals.push_back(normal);
  }
  return cloud;
}

Mesh box_cloud(const glm::vec3& size, float spacing, std::uint64_t seed) {
  Random random(seed);
  const glm::vec3 areas(size.y * size.z, size.z * size.x, size.x * size.y);
  return spread(spacing, [&](glm::vec3& point, glm::vec3& normal) {
    double at = random.uniform(0, areas.x + areas.y + areas.z);
    int axis = 0;
    while (axis < 2 && at >= areas[axis]) at -= areas[axis++];
    const float side = random.uniform() < 0.5 ? -1.0F : 1.0F;
    for (int k = 0; k < 3; ++k) point[k] = static_cast<float>(random.uniform(-0.5, 0.5)) * size[k];
    point[axis] = side * size[axis] / 2;
    normal = glm::vec3(0.0F);
    normal[axis] = side;
  });
}

Mesh sphere_cloud(float radius, float spacing, std::uint64_t seed) {
  Random random(seed);
  return spread(spacing, [&](glm::vec3& point, glm::vec3& normal) {
    normal = glm::normalize(glm::vec3(random.normal(), random.normal(), random.normal()));
    point = radius * normal;
  });
}

Edges count_edges(const Mesh& mesh) {
  std::map<Edge, std::size_t> directed;
  std::map<Edge, std::size_t> undirected;
  for (const glm::uvec3& face : mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = face[k];
      const std::uint32_t b = face[(k + 1) % 3];
      ++directed[{a, b}];
      ++undirected[{std::min(a, b), std::max(a, b)}];
    }
  }
  Edges edges;
  edges.total = undirected.size();
  for (const auto& [edge, count] : undirected) {
    if (count == 1) ++edges.open;
    if (count > 2) ++edges.non_manifold;
  }
  for (const auto& [edge, count] : directed) {
    if (count > 1) ++edges.against;
  }
  return edges;
}

double volume(const Mesh& mesh) {
  double sum = 0;
  for (const glm::uvec3& f : mesh.faces) {
    sum += glm::dot(glm::dvec3(mesh.vertices[f.x]),
                    glm::cross(glm::dvec3(mesh.vertices[f.y]), glm::dvec3(mesh.vertices[f.z])));
  }
  return sum / 6;
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "rejoin-mesh-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TemporaryFolder::write(const std::string& name, const std::string& bytes) const {
  std::ofstream(path_ / name, std::ios::binary) << bytes;
  return path_ / name;
}

std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = (group << 8U) | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[(group >> (18 - 6 * k)) & 63U] : '=';
  }
  return text;
}

}  // namespace rejoin::mesh::test
