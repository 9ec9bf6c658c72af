/// The sherds of a vessel as if each had been scanned from outside only: the walls' other side is missing.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/glm.hpp>

#include "core/error.hpp"
#include "fragment_set.hpp"
#include "mesh/load.hpp"
#include "mesh/point_index.hpp"
#include "mesh/save.hpp"

namespace rejoin::bench {
namespace {

namespace fs = std::filesystem;

constexpr double kOutwards = 0.5;  // cosine: outer walls look within 60 degrees of the way from the middle
constexpr float kInwards = -0.5F;  // cosine: what looks within 60 degrees against the outer wall is missing

glm::dvec3 place_of(const mesh::Mesh& scan, const Rigid& to_world) {
  return to_world(scan.origin + mesh::centroid(scan));
}

/// Drops what looks against the nearest outer wall.
/// \param middle  of the object, file coordinates
void keep_outside(mesh::Mesh& scan, const glm::dvec3& middle) {
  const auto normals = mesh::face_normals(scan);
  const auto place = [&](std::size_t f) {
    const glm::uvec3 face = scan.faces[f];
    return (scan.vertices[face.x] + scan.vertices[face.y] + scan.vertices[face.z]) / 3.0F;
  };
  std::vector<glm::vec3> outer;
  std::vector<glm::vec3> outwards;
  for (std::size_t f = 0; f < scan.faces.size(); ++f) {
    const glm::dvec3 from_middle = glm::normalize(scan.origin + glm::dvec3(place(f)) - middle);
    if (glm::dot(glm::dvec3(normals[f]), from_middle) < kOutwards) continue;
    outer.push_back(place(f));
    outwards.push_back(normals[f]);
  }
  const mesh::PointIndex index(outer);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t f = 0; f < scan.faces.size(); ++f) {
    const auto nearest = index.nearest(place(f));
    if (!nearest || glm::dot(normals[f], outwards[nearest->first]) > kInwards) kept.push_back(f);
  }
  scan = mesh::submesh(scan, kept);
}

void write(const FragmentSet& set, const fs::path& out) {
  glm::dvec3 low(1e300);
  glm::dvec3 high(-1e300);
  for (const auto& [name, to_world] : set.to_world) {
    const glm::dvec3 place = place_of(mesh::load(set.folder / name).mesh, to_world);
    low = glm::min(low, place);
    high = glm::max(high, place);
  }
  const glm::dvec3 middle = 0.5 * (low + high);
  fs::create_directories(out);
  fs::copy_file(set.folder / "truth.json", out / "truth.json", fs::copy_options::overwrite_existing);
  for (const auto& [name, to_world] : set.to_world) {
    mesh::Mesh scan = mesh::load(set.folder / name).mesh;
    if (scan.is_cloud()) throw InputError(set.folder / name, "is a cloud", "take a set of meshes");
    keep_outside(scan, inverse(to_world)(middle));
    mesh::save(out / name, scan);
  }
}

}  // namespace
}  // namespace rejoin::bench

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: one_sided SET OUT\n");
    return 2;
  }
  try {
    rejoin::bench::write(rejoin::bench::read_set(argv[1]), argv[2]);
  } catch (const rejoin::Error& error) {
    fmt::print(stderr, "one_sided: {}\n", error.what());
    return 1;
  }
  return 0;
}
