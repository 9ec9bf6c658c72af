#include "shapes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/rigid.hpp"

namespace rejoin::zbuffer::test {
namespace {

mesh::Mesh icosahedron() {
  const float g = (1.0F + std::sqrt(5.0F)) / 2.0F;
  mesh::Mesh m;
  m.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  m.faces = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
             {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
             {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return m;
}

void subdivide(mesh::Mesh& m) {
  std::map<std::pair<unsigned, unsigned>, unsigned> middles;
  const auto middle = [&](unsigned p, unsigned q) {
    const auto [place, fresh] =
        middles.try_emplace(std::minmax(p, q), static_cast<unsigned>(m.vertices.size()));
    if (fresh) m.vertices.push_back(0.5F * (m.vertices[p] + m.vertices[q]));
    return place->second;
  };
  std::vector<glm::uvec3> faces;
  for (const glm::uvec3& f : m.faces) {
    const glm::uvec3 e(middle(f.x, f.y), middle(f.y, f.z), middle(f.z, f.x));
    faces.insert(faces.end(), {{f.x, e.x, e.z}, {f.y, e.y, e.x}, {f.z, e.z, e.y}, e});
  }
  m.faces = std::move(faces);
}

}  // namespace

mesh::Mesh icosphere(float radius, int level) {
  mesh::Mesh m = icosahedron();
  for (int k = 0; k < level; ++k) subdivide(m);
  for (glm::vec3& v : m.vertices) v *= radius / glm::length(v);
  return m;
}

mesh::Mesh bumpy_sphere(int level, std::uint64_t seed) {
  Random random(seed);
  struct Wave {
    glm::vec3 along;
    float phase, height;
  };
  std::vector<Wave> waves;
  for (int k = 0; k < 12; ++k) {
    const glm::vec3 along(random.normal(), random.normal(), random.normal());
    const float wave = 2.0F + static_cast<float>(k);
    waves.push_back({wave * along, static_cast<float>(random.uniform(0, 6.28)), 0.12F / wave});
  }
  mesh::Mesh m = icosphere(1.0F, level);
  for (glm::vec3& v : m.vertices) {
    float radius = 1.0F + 0.002F * static_cast<float>(random.normal());
    for (const Wave& w : waves) radius += w.height * std::sin(glm::dot(w.along, v) + w.phase);
    v *= radius;
  }
  return m;
}

mesh::Mesh height_field(float half, int cells, const std::function<float(float, float)>& height) {
  mesh::Mesh m;
  const auto coordinate = [&](int k) {
    return half * static_cast<float>(2 * k - cells) / static_cast<float>(cells);
  };
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const float x = coordinate(i);
      const float y = coordinate(j);
      m.vertices.emplace_back(x, y, height(x, y));
    }
  }
  const auto side = static_cast<unsigned>(cells + 1);
  for (unsigned j = 0; j + 1 < side; ++j) {
    for (unsigned i = 0; i + 1 < side; ++i) {
      const unsigned p = j * side + i;
      m.faces.emplace_back(p, p + 1, p + side + 1);
      m.faces.emplace_back(p, p + side + 1, p + side);
    }
  }
  return m;
}

mesh::Mesh step(float half, float rise) {
  mesh::Mesh m;
  m.vertices = {{-half, -half, -rise}, {0, -half, -rise},   {0, half, -rise},   {-half, half, -rise},
                {0, -half, rise},      {half, -half, rise}, {half, half, rise}, {0, half, rise}};
  m.faces = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  return m;
}

mesh::Mesh turned_round(mesh::Mesh mesh) {
  for (glm::vec3& v : mesh.vertices) v = {-v.x, v.y, -v.z};
  return mesh;
}

mesh::Mesh inside_out(mesh::Mesh mesh) {
  for (glm::uvec3& face : mesh.faces) std::swap(face.y, face.z);
  return mesh;
}

mesh::Mesh moved(mesh::Mesh mesh, const glm::vec3& by) {
  for (glm::vec3& vertex : mesh.vertices) vertex += by;
  return mesh;
}

mesh::Mesh together(mesh::Mesh a, const mesh::Mesh& b) {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const glm::uvec3& face : b.faces) a.faces.push_back(face + first);
  return a;
}

glm::mat3 random_rotation(Random& random) {
  glm::dvec4 q(random.normal(), random.normal(), random.normal(), random.normal());
  q /= glm::length(q);
  return glm::mat3(axis_rotation(glm::normalize(glm::dvec3(q)), 2.0 * std::acos(std::clamp(q.w, -1.0, 1.0))));
}

std::vector<ViewPair> random_poses(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<ViewPair> poses(static_cast<std::size_t>(count));
  for (ViewPair& pose : poses) {
    pose.rotation_a = random_rotation(random);
    pose.rotation_b = random_rotation(random);
    pose.shift_a = glm::vec2(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1));
  }
  return poses;
}

glm::mat3 about_x(double angle_rad) {
  return glm::mat3(axis_rotation({1, 0, 0}, angle_rad));
}
glm::mat3 about_y(double angle_rad) {
  return glm::mat3(axis_rotation({0, 1, 0}, angle_rad));
}

}  // namespace rejoin::zbuffer::test
