#include "report/detail/soup.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"

namespace rejoin::report::detail {
namespace {

const float kCreaseCosine = std::cos(glm::radians(50.0F));

glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& otherwise) {
  const float length = glm::length(v);
  return length > 0 ? v / length : otherwise;
}

/// Area-weighted vertex normals, in the mesh's own axes.
std::vector<glm::vec3> smooth_normals(const mesh::Mesh& mesh) {
  std::vector<glm::vec3> result(mesh.vertices.size(), glm::vec3(0.0F));
  for (const glm::uvec3& face : mesh.faces) {
    const glm::vec3& a = mesh.vertices[face.x];
    const glm::vec3 normal = glm::cross(mesh.vertices[face.y] - a, mesh.vertices[face.z] - a);
    for (int k = 0; k < 3; ++k) result[face[k]] += normal;
  }
  for (glm::vec3& normal : result) normal = unit_or(normal, {0, 0, 1});
  return result;
}

/// Middle of the box of everything, common frame.
glm::dvec3 middle_of(const std::vector<Body>& bodies) {
  glm::dvec3 low(std::numeric_limits<double>::infinity());
  glm::dvec3 high = -low;
  for (const Body& body : bodies) {
    for (const glm::vec3& vertex : body.mesh->vertices) {
      const glm::dvec3 p = body.pose(body.mesh->origin + glm::dvec3(vertex));
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  }
  return (low + high) / 2.0;
}

void append(const Body& body, Soup& soup) {
  const mesh::Mesh& mesh = *body.mesh;
  const auto base = static_cast<std::uint32_t>(soup.vertices.size());
  const glm::dvec3 offset = body.pose(mesh.origin) - soup.centre;
  for (const glm::vec3& vertex : mesh.vertices) {
    const glm::dvec3 p = body.pose.rotation * glm::dvec3(vertex) + offset;
    soup.vertices.emplace_back(p);
    soup.radius = std::max(soup.radius, glm::length(p));
  }
  for (const glm::vec3& normal : smooth_normals(mesh)) {
    soup.normals.emplace_back(body.pose.rotation * glm::dvec3(normal));
  }
  for (const glm::uvec3& face : mesh.faces) soup.faces.push_back(face + base);
  if (body.vertex_colours.size() == mesh.vertices.size()) {
    soup.vertex_colours.insert(soup.vertex_colours.end(), body.vertex_colours.begin(),
                               body.vertex_colours.end());
  } else {
    soup.vertex_colours.resize(soup.vertices.size(), body.colour);
  }
  const bool by_face = body.face_colours.size() == mesh.faces.size();
  soup.has_face_colour.push_back(by_face ? 1 : 0);
  if (by_face) {
    soup.face_colours.resize(soup.first_face.back());
    soup.face_colours.insert(soup.face_colours.end(), body.face_colours.begin(), body.face_colours.end());
  }
  soup.first_face.push_back(static_cast<std::uint32_t>(soup.faces.size()));
}

std::array<float, 256> linear_table() {
  std::array<float, 256> table{};
  for (int k = 0; k < 256; ++k) table[k] = to_linear(static_cast<float>(k) / 255.0F);
  return table;
}

glm::vec3 linear(Colour colour) {
  static const std::array<float, 256> table = linear_table();
  return {table[colour.r], table[colour.g], table[colour.b]};
}

}  // namespace

float to_linear(float srgb) {
  return srgb <= 0.04045F ? srgb / 12.92F : std::pow((srgb + 0.055F) / 1.055F, 2.4F);
}

float to_srgb(float linear) {
  const float x = std::clamp(linear, 0.0F, 1.0F);
  return x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.0F / 2.4F) - 0.055F;
}

int Soup::body_of(std::uint32_t face) const {
  const auto after = std::upper_bound(first_face.begin(), first_face.end(), face);
  return static_cast<int>(after - first_face.begin()) - 1;
}

Soup make_soup(const std::vector<Body>& bodies) {
  for (const Body& body : bodies) {
    if (body.mesh->faces.empty())
      throw InputError("picture", "a body has no faces", "make a surface of the cloud first");
  }
  Soup soup;
  soup.first_face.push_back(0);
  if (!bodies.empty()) soup.centre = middle_of(bodies);
  for (const Body& body : bodies) append(body, soup);
  return soup;
}

ShadingPoint shading_point(const Soup& soup, std::uint32_t face, float u, float v) {
  const glm::uvec3 corners = soup.faces[face];
  const glm::vec3 weight(1 - u - v, u, v);
  const glm::vec3& a = soup.vertices[corners.x];
  ShadingPoint point{};
  point.flat = unit_or(glm::cross(soup.vertices[corners.y] - a, soup.vertices[corners.z] - a),
                       soup.normals[corners.x]);
  const int body = soup.body_of(face);
  if (soup.has_face_colour[body] != 0) point.albedo = linear(soup.face_colours[face]);
  for (int k = 0; k < 3; ++k) {
    const glm::vec3& normal = soup.normals[corners[k]];
    point.normal += weight[k] * (glm::dot(normal, point.flat) < kCreaseCosine ? point.flat : normal);
    if (soup.has_face_colour[body] == 0) point.albedo += weight[k] * linear(soup.vertex_colours[corners[k]]);
  }
  point.normal = unit_or(point.normal, point.flat);
  return point;
}

}  // namespace rejoin::report::detail
