/// Surfaces whose depth maps are known, and poses to see them in.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/random.hpp"
#include "mesh/mesh.hpp"
#include "zbuffer/scorer.hpp"

namespace rejoin::zbuffer::test {

/// Sphere about the origin, 20 * 4^level faces.
mesh::Mesh icosphere(float radius, int level);

/// What a scan looks like: an icosphere with bumps of several sizes and noise on every vertex, diameter
/// about 2.
mesh::Mesh bumpy_sphere(int level, std::uint64_t seed);

/// Square -half .. half in x and y with z = height(x, y), cut into cells x cells x 2 faces.
mesh::Mesh height_field(float half, int cells, const std::function<float(float, float)>& height);

/// Level halves of a square: z = -rise for x < 0, +rise for x > 0, no wall between them.
mesh::Mesh step(float half, float rise);

/// The mesh after a half turn about Y: as the counterpart of itself it stands before (p).
mesh::Mesh turned_round(mesh::Mesh mesh);

/// The mesh with every face wound the other way.
mesh::Mesh inside_out(mesh::Mesh mesh);

mesh::Mesh moved(mesh::Mesh mesh, const glm::vec3& by);

/// Both in one mesh, a's faces first.
mesh::Mesh together(mesh::Mesh a, const mesh::Mesh& b);

/// Uniform over all rotations (a random unit quaternion).
glm::mat3 random_rotation(Random& random);

/// Rotations anywhere, shifts up to +-0.1.
std::vector<ViewPair> random_poses(int count, std::uint64_t seed);

glm::mat3 about_x(double angle_rad);
glm::mat3 about_y(double angle_rad);

}  // namespace rejoin::zbuffer::test
