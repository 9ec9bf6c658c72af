#include "planted.hpp"

#include <cmath>
#include <numbers>

namespace rejoin::report {
namespace {

float wave(float x, float y) {
  return 0.05F * std::sin(4 * x + y) + 0.04F * std::cos(5 * y - x);
}

/// Turns all faces round.
void flip(mesh::Mesh& mesh) {
  for (glm::uvec3& face : mesh.faces) std::swap(face.y, face.z);
}

/// Joins the border of the upper sheet (vertices 0 ..) with that of the lower one (vertices base ..).
void add_wall(mesh::Mesh& mesh, const std::vector<std::uint32_t>& border, std::uint32_t base) {
  for (std::size_t k = 0; k < border.size(); ++k) {
    const std::uint32_t a = border[k];
    const std::uint32_t b = border[(k + 1) % border.size()];
    mesh.faces.emplace_back(a, a + base, b);
    mesh.faces.emplace_back(b, a + base, b + base);
  }
}

}  // namespace

mesh::Mesh wavy_block(int n, bool upper) {
  const int m = n / 2;
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
  mesh::Mesh mesh;
  for (const bool cut : {true, false}) {
    for (int j = 0; j <= m; ++j) {
      for (int i = 0; i <= n; ++i) {
        const float x = 2.0F * static_cast<float>(i) / static_cast<float>(n) - 1;
        const float y = static_cast<float>(j) / static_cast<float>(m) - 0.5F;
        mesh.vertices.emplace_back(x, y, cut ? wave(x, y) : upper ? 0.6F : -0.6F);
      }
    }
  }
  const std::uint32_t base = at(0, m + 1);
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      mesh.faces.emplace_back(at(i, j), at(i + 1, j), at(i, j + 1));
      mesh.faces.emplace_back(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      mesh.faces.emplace_back(base + at(i, j), base + at(i, j + 1), base + at(i + 1, j));
      mesh.faces.emplace_back(base + at(i + 1, j), base + at(i, j + 1), base + at(i + 1, j + 1));
    }
  }
  std::vector<std::uint32_t> border;  // counter-clockwise seen from above
  border.reserve(static_cast<std::size_t>(2 * (n + m)));
  for (int i = 0; i < n; ++i) border.push_back(at(i, 0));
  for (int j = 0; j < m; ++j) border.push_back(at(n, j));
  for (int i = n; i > 0; --i) border.push_back(at(i, m));
  for (int j = m; j > 0; --j) border.push_back(at(0, j));
  add_wall(mesh, border, base);
  if (upper) flip(mesh);
  return mesh;
}

Planted planted_pair(int n) {
  const auto prepared = [](std::string path, mesh::Mesh surface) {
    match::Fragment fragment;
    fragment.path = std::move(path);
    fragment.surface = fragment.coarse = std::move(surface);
    fragment.diameter = mesh::diameter(fragment.surface);
    fragment.resolution = mesh::resolution(fragment.surface);
    return fragment;
  };
  Planted planted;
  planted.pose = {axis_rotation(glm::normalize(glm::dvec3(1, -2, 0.5)), 1.1), {3, -1, 2}};
  mesh::Mesh b = wavy_block(n, true);
  const Rigid back = inverse(planted.pose);
  for (glm::vec3& vertex : b.vertices) vertex = glm::vec3(back(glm::dvec3(vertex)));
  planted.a = prepared("dir/lower.ply", wavy_block(n, false));
  planted.b = prepared("dir/upper.ply", std::move(b));
  return planted;
}

mesh::Mesh ball(float radius, int rings) {
  const float pi = std::numbers::pi_v<float>;
  mesh::Mesh mesh;
  mesh.vertices.emplace_back(0, 0, radius);
  for (int j = 1; j < rings; ++j) {
    for (int i = 0; i < 2 * rings; ++i) {
      const float tilt = pi * static_cast<float>(j) / static_cast<float>(rings);
      const float turn = pi * static_cast<float>(i) / static_cast<float>(rings);
      mesh.vertices.emplace_back(radius * std::sin(tilt) * std::cos(turn),
                                 radius * std::sin(tilt) * std::sin(turn), radius * std::cos(tilt));
    }
  }
  mesh.vertices.emplace_back(0, 0, -radius);
  const auto around = static_cast<std::uint32_t>(2 * rings);
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t next = (i + 1) % around;
    mesh.faces.emplace_back(0, 1 + i, 1 + next);
    mesh.faces.emplace_back(last, last - around + next, last - around + i);
    for (std::uint32_t j = 0; j + 2 < static_cast<std::uint32_t>(rings); ++j) {
      const std::uint32_t row = 1 + j * around;
      mesh.faces.emplace_back(row + i, row + around + i, row + next);
      mesh.faces.emplace_back(row + next, row + around + i, row + around + next);
    }
  }
  return mesh;
}

}  // namespace rejoin::report
