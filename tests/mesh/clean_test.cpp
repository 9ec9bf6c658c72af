// What loading mends, and what it leaves alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/random.hpp"
#include "mesh/load.hpp"
#include "shapes.hpp"
#include "through_ply.hpp"

namespace rejoin::mesh {
namespace {

using test::TemporaryFolder;
using test::through_ply;

const std::string kPlyHeader = "ply\nformat ascii 1.0\n";

std::string vertices(std::size_t count, const std::string& more = "") {
  return "element vertex " + std::to_string(count) +
         "\nproperty double x\nproperty double y\nproperty double z\n" + more;
}

std::string faces(std::size_t count) {
  return "element face " + std::to_string(count) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

Loaded load_text(const std::string& name, const std::string& text) {
  const TemporaryFolder folder;
  return load(folder.write(name, text));
}

TEST(Clean, WeldsExactlyEqualVerticesOnlyWhateverTheScale) {
  // Two triangles that meet in two places, and one a millionth of its size away from them.
  for (const double scale : {1e-6, 1.0, 1e6}) {
    SCOPED_TRACE(scale);
    std::string text = kPlyHeader + vertices(9) + faces(3);
    for (const double x : {0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 1.0 + 1e-6, 2.0, 2.0}) {
      const std::size_t i = static_cast<std::size_t>(std::count(text.begin(), text.end(), '@'));
      const double y[9] = {0, 0, 1, 0, 1, 1, 0, 0, 1};
      text += std::to_string(x * scale * 1e6) + "e-6 " + std::to_string(y[i] * scale * 1e6) + "e-6 0@";
    }
    std::replace(text.begin(), text.end(), '@', '\n');
    const Loaded loaded = load_text("a.ply", text + "3 0 1 2\n3 3 5 4\n3 6 7 8\n");
    EXPECT_EQ(loaded.mesh.vertices.size(), 7U);
    EXPECT_EQ(loaded.mesh.faces.size(), 3U);
  }
}

TEST(Clean, DropsDegenerateAndDuplicateFacesAndSaysSo) {
  const Loaded loaded = load_text("a.ply", kPlyHeader + vertices(6) + faces(5) +
                                               "0 0 0\n1 0 0\n0 1 0\n2 0 0\n5 5 5\n0 0 1\n"
                                               "3 0 1 2\n3 1 2 0\n3 0 1 1\n3 0 1 3\n3 1 0 5\n");
  EXPECT_EQ(loaded.mesh.faces.size(), 2U);
  EXPECT_EQ(loaded.mesh.vertices.size(), 4U);  // neither the one on the line nor the one of no face
  ASSERT_EQ(loaded.warnings.size(), 2U);
  EXPECT_NE(loaded.warnings[0].find("dropped 2 of 5 faces that have no area"), std::string::npos);
  EXPECT_NE(loaded.warnings[1].find("dropped 1 of 5 faces that are there twice"), std::string::npos);
}

// Nearly every scan has a few: the lines would hide what matters.
TEST(Clean, SaysNothingOfAFewFacesThatWereMended) {
  constexpr int kSide = 30;
  std::string text;
  for (int v = 0; v <= kSide; ++v)
    for (int u = 0; u <= kSide; ++u) text += "v " + std::to_string(u) + " " + std::to_string(v) + " 0\n";
  for (int v = 0; v < kSide; ++v) {
    for (int u = 1; u <= kSide; ++u) {
      const int k = v * (kSide + 1) + u;
      const std::string below = std::to_string(k + 1);
      const std::string above = std::to_string(k + kSide + 1);
      text += "f " + std::to_string(k) + " " + below + " " + above + "\n";
      text += "f " + below + " " + std::to_string(k + kSide + 2) + " " + above + "\n";
    }
  }
  const Loaded loaded = load_text("a.obj", text + "f 1 2 2\n");
  EXPECT_EQ(loaded.mesh.faces.size(), 2U * kSide * kSide);
  EXPECT_TRUE(loaded.warnings.empty()) << loaded.warnings[0];
}

TEST(Clean, LoadsASingleTriangle) {
  const Loaded loaded = load_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(loaded.mesh.faces.size(), 1U);
  EXPECT_TRUE(loaded.warnings.empty());
}

TEST(Clean, TurnsFacesThatAreWoundAgainstTheirNeighbours) {
  const Mesh sphere = test::icosphere(1, 3);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Mesh mixed = sphere;
    std::size_t turned = 0;
    for (glm::uvec3& face : mixed.faces) {
      if (random.uniform() > 0.3) continue;
      std::swap(face.y, face.z);
      ++turned;
    }
    const Loaded loaded = through_ply(mixed);
    EXPECT_EQ(test::count_edges(loaded.mesh).against, 0U);
    EXPECT_NEAR(test::volume(loaded.mesh), test::volume(sphere), 1e-5);
    ASSERT_EQ(loaded.warnings.size(), 1U);
    EXPECT_NE(loaded.warnings[0].find("turned " + std::to_string(turned) + " of 1280"), std::string::npos);
  }
}

TEST(Clean, TurnsAClosedSurfaceThatIsInsideOut) {
  Mesh sphere = test::icosphere(1, 2);
  sphere.origin = {100, 0, 0};
  for (glm::uvec3& face : sphere.faces) std::swap(face.y, face.z);
  const Loaded loaded = through_ply(sphere);
  EXPECT_GT(test::volume(loaded.mesh), 3.5);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_NE(loaded.warnings[0].find("inside out"), std::string::npos);
}

/// Two spheres of radius 1 side by side, the second one inside out.
Mesh spheres_of_which_one_is_inside_out(float apart) {
  Mesh both = test::icosphere(1, 3);
  const Mesh one = both;
  const auto first = static_cast<std::uint32_t>(one.vertices.size());
  for (const glm::vec3& v : one.vertices) both.vertices.push_back(v + glm::vec3(apart, 0, 0));
  for (const glm::uvec3& face : one.faces)
    both.faces.emplace_back(first + face.x, first + face.z, first + face.y);
  return both;
}

TEST(Clean, TurnsAPartThatIsInsideOut) {
  for (const float apart : {2.1F, 1.5F}) {
    const Loaded loaded = through_ply(spheres_of_which_one_is_inside_out(apart));
    EXPECT_GT(test::volume(loaded.mesh), 8.0) << apart;
    ASSERT_EQ(loaded.warnings.size(), 1U) << apart;
    EXPECT_NE(loaded.warnings[0].find("turned 1280 of 2560 faces, of parts that were inside out"),
              std::string::npos)
        << loaded.warnings[0];
  }
}

/// The faces of a sphere of radius 1 above a height, wound so that they are seen from its inside.
Mesh inside_of_sphere(float above) {
  Mesh sphere = test::icosphere(1, 3);
  std::erase_if(sphere.faces, [&](const glm::uvec3& face) {
    return std::min({sphere.vertices[face.x].z, sphere.vertices[face.y].z, sphere.vertices[face.z].z}) <
           above;
  });
  for (glm::uvec3& face : sphere.faces) std::swap(face.y, face.z);
  std::vector<std::uint32_t> number(sphere.vertices.size(), 0);
  for (const glm::uvec3& face : sphere.faces) number[face.x] = number[face.y] = number[face.z] = 1;
  Mesh used;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] == 0) continue;
    number[i] = static_cast<std::uint32_t>(used.vertices.size());
    used.vertices.push_back(sphere.vertices[i]);
  }
  for (const glm::uvec3& face : sphere.faces)
    used.faces.emplace_back(number[face.x], number[face.y], number[face.z]);
  return used;
}

/// A tube of radius 1 about z, open at both ends, wound so that it is seen from its inside.
Mesh tube_from_inside(float length) {
  constexpr std::uint32_t kSides = 40;
  Mesh tube;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const float turn = 6.2831853F * static_cast<float>(i) / kSides;
    for (const float z : {0.0F, length}) tube.vertices.emplace_back(std::cos(turn), std::sin(turn), z);
    const std::uint32_t a = 2 * i;
    const std::uint32_t b = 2 * ((i + 1) % kSides);
    tube.faces.emplace_back(a, a + 1, b);
    tube.faces.emplace_back(a + 1, b + 1, b);
  }
  return tube;
}

TEST(Clean, KeepsTheWindingOfAWholeObjectsCavityAndOfAnOpenSurface) {
  Mesh hollow = test::icosphere(2, 2);
  Mesh hole = test::icosphere(1, 2);
  const auto first = static_cast<std::uint32_t>(hollow.vertices.size());
  for (const glm::uvec3& face : hole.faces)
    hollow.faces.push_back(glm::uvec3(face.x, face.z, face.y) + first);
  hollow.vertices.insert(hollow.vertices.end(), hole.vertices.begin(), hole.vertices.end());
  const double before = test::volume(hollow);
  EXPECT_NEAR(test::volume(through_ply(hollow, Content::Whole).mesh), before, 1e-4);

  // A vessel's inside scanned alone: its normals point into it, and it encloses a negative volume.
  for (const Mesh& inside : {inside_of_sphere(0), tube_from_inside(2)}) {
    const Loaded loaded = through_ply(inside);
    EXPECT_EQ(loaded.mesh.faces, inside.faces);
    EXPECT_TRUE(loaded.warnings.empty());
  }
}

TEST(Clean, TurnsAnOpenSurfaceOfWhichOnlyTheBackCanBeSeen) {
  Mesh sphere = inside_of_sphere(-0.9F);  // but for its lowest faces the whole sphere
  const Loaded loaded = through_ply(sphere);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_NE(loaded.warnings[0].find("inside out"), std::string::npos) << loaded.warnings[0];
  EXPECT_GT(test::volume(loaded.mesh), 3.5);
}

/// Every face with corners of its own, each up to `shift` away from its place along every axis.
Mesh loose(const Mesh& mesh, double shift) {
  Mesh soup;
  Random random(8);
  const auto some = [&] { return static_cast<float>(random.uniform(-shift, shift)); };
  for (const glm::uvec3& face : mesh.faces) {
    for (int k = 0; k < 3; ++k)
      soup.vertices.push_back(mesh.vertices[face[k]] + glm::vec3(some(), some(), some()));
    const auto v = static_cast<std::uint32_t>(soup.vertices.size());
    soup.faces.emplace_back(v - 3, v - 2, v - 1);
  }
  return soup;
}

TEST(Clean, JoinsFacesWhoseCornersDifferByRounding) {
  const Mesh sphere = test::icosphere(1, 3);  // edges of 0.14
  const Loaded loaded = through_ply(loose(sphere, 1e-5));
  EXPECT_EQ(loaded.mesh.vertices.size(), sphere.vertices.size());
  EXPECT_EQ(test::count_edges(loaded.mesh).open, 0U);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_NE(loaded.warnings[0].find("made 642 of 3840 by joining near ones"), std::string::npos)
      << loaded.warnings[0];

  const Loaded apart = through_ply(loose(sphere, 0.02));
  EXPECT_GT(apart.mesh.vertices.size(), 3800U);
  ASSERT_FALSE(apart.warnings.empty());
  EXPECT_NE(apart.warnings.back().find("hardly hang together"), std::string::npos) << apart.warnings.back();

  // Points of no face are not its corners.
  Mesh dotted = sphere;
  for (int k = 0; k < 5000; ++k) dotted.vertices.emplace_back(2, 0, 1e-4F * static_cast<float>(k));
  EXPECT_TRUE(through_ply(dotted).warnings.empty());
}

TEST(Clean, TurnsFacesThatHardlyHangTogether) {
  Mesh inverted = inside_of_sphere(-2);
  const Loaded loaded = through_ply(loose(inverted, 0.004));
  EXPECT_GT(loaded.mesh.vertices.size(), 3000U);
  EXPECT_NE(loaded.warnings.back().find("inside out"), std::string::npos) << loaded.warnings.back();
  EXPECT_GT(test::volume(loaded.mesh), 3.5);
}

TEST(Clean, DropsTheBacksOfASurfaceWithBothSides) {
  const Mesh sphere = test::icosphere(1, 3);
  Mesh both = sphere;
  for (const glm::uvec3& face : sphere.faces) both.faces.emplace_back(face.x, face.z, face.y);
  const Loaded loaded = through_ply(both);
  EXPECT_EQ(loaded.mesh.faces, sphere.faces);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_NE(loaded.warnings[0].find("dropped 1280 of 2560 faces that are the backs of others"),
            std::string::npos)
      << loaded.warnings[0];
}

TEST(Clean, LeavesAMoebiusStripAlone) {
  constexpr int kSteps = 40;
  Mesh strip;
  for (int i = 0; i < kSteps; ++i) {
    const double turn = 2 * 3.141592653589793 * i / kSteps;
    for (const double side : {-0.3, 0.3}) {
      const double radius = 1 + side * std::cos(turn / 2);
      strip.vertices.emplace_back(radius * std::cos(turn), radius * std::sin(turn),
                                  side * std::sin(turn / 2));
    }
  }
  for (std::uint32_t i = 0; i < kSteps; ++i) {
    const std::uint32_t a = 2 * i;
    const bool last = i + 1 == kSteps;
    const std::uint32_t c = last ? 1 : a + 2;
    const std::uint32_t d = last ? 0 : a + 3;
    strip.faces.emplace_back(a, c, a + 1);
    strip.faces.emplace_back(a + 1, c, d);
  }
  const Loaded loaded = through_ply(strip);
  EXPECT_EQ(loaded.mesh.faces.size(), strip.faces.size());
  EXPECT_TRUE(loaded.warnings.empty());
}

TEST(Clean, MakesNormalsOfACloudUnitLength) {
  Mesh cloud = test::sphere_cloud(1, 0.3F, 2);
  for (std::size_t i = 0; i < cloud.normals.size(); ++i)
    cloud.normals[i] *= 0.01F + 10.0F * static_cast<float>(i);
  const Loaded loaded = through_ply(cloud);
  EXPECT_TRUE(loaded.warnings.empty());
  for (std::size_t i = 0; i < loaded.mesh.normals.size(); ++i) {
    EXPECT_NEAR(glm::dot(loaded.mesh.normals[i], loaded.mesh.vertices[i]), 1, 1e-5);
  }
}

TEST(Clean, DropsPointsWithoutAUsableNormal) {
  Mesh cloud = test::sphere_cloud(1, 0.3F, 3);
  cloud.normals[5] = glm::vec3(0.0F);
  cloud.normals[7] = glm::vec3(NAN, 0, 1);
  const Loaded loaded = through_ply(cloud);
  EXPECT_EQ(loaded.mesh.vertices.size(), cloud.vertices.size() - 2);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_NE(loaded.warnings[0].find("dropped 2 of"), std::string::npos);
}

TEST(Clean, EstimatesMissingNormalsOutwardsWithAWarning) {
  // A sphere and, apart from it, a box with sharp edges.
  Mesh cloud = test::sphere_cloud(1, 0.08F, 4);
  Mesh box = test::box_cloud({2, 1, 0.6F}, 0.05F, 5);
  for (glm::vec3& vertex : box.vertices) vertex += glm::vec3(5, 0, 0);
  cloud.vertices.insert(cloud.vertices.end(), box.vertices.begin(), box.vertices.end());
  const std::vector<glm::vec3> truth = [&] {
    std::vector<glm::vec3> normals = cloud.normals;
    normals.insert(normals.end(), box.normals.begin(), box.normals.end());
    return normals;
  }();
  cloud.normals.clear();
  const Loaded loaded = through_ply(cloud);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_NE(loaded.warnings[0].find("no normals"), std::string::npos);
  ASSERT_EQ(loaded.mesh.normals.size(), truth.size());
  std::size_t close = 0;
  std::size_t inwards = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const float cosine = glm::dot(loaded.mesh.normals[i], truth[i]);
    EXPECT_NEAR(glm::length(loaded.mesh.normals[i]), 1, 1e-4);
    if (cosine > 0.9F) ++close;
    if (cosine < 0) ++inwards;
  }
  // Points whose neighbourhood folds round an edge of the box get a slanted normal.
  EXPECT_GT(close, truth.size() * 8 / 10);
  EXPECT_EQ(inwards, 0U);
}

/// Share of normals within 26 degrees of a sphere's about the origin, outwards.
double outward_share(const Mesh& cloud) {
  std::size_t outward = 0;
  for (std::size_t i = 0; i < cloud.vertices.size(); ++i)
    outward += glm::dot(cloud.normals[i], glm::normalize(cloud.vertices[i])) > 0.9F ? 1 : 0;
  return static_cast<double>(outward) / static_cast<double>(cloud.vertices.size());
}

TEST(Clean, DropsStrayPointsBeforeItEstimatesNormals) {
  const Mesh sphere = test::sphere_cloud(1, 0.06F, 9);
  Mesh cloud = sphere;
  cloud.normals.clear();
  cloud.vertices.emplace_back(0, 0, 1.4F);  // the highest point is on no surface
  for (int k = 0; k < 20; ++k)
    cloud.vertices.emplace_back(0.02F * static_cast<float>(k), 3, 0);  // dust far away
  for (int k = 0; k < 5; ++k) cloud.vertices.emplace_back(1.4F, 0, 0.01F * static_cast<float>(k));
  const Loaded loaded = through_ply(cloud);
  EXPECT_EQ(loaded.mesh.vertices, sphere.vertices);
  EXPECT_GT(outward_share(loaded.mesh), 0.99);
  ASSERT_EQ(loaded.warnings.size(), 2U);
  EXPECT_NE(loaded.warnings[1].find("dropped 26 of"), std::string::npos) << loaded.warnings[1];
}

TEST(Clean, KeepsPointsOfUnevenDensity) {
  // Half of the sphere has a ninth of the points.
  const Mesh dense = test::sphere_cloud(1, 0.04F, 10);
  Mesh cloud = test::sphere_cloud(1, 0.12F, 11);
  std::erase_if(cloud.vertices, [](const glm::vec3& p) { return p.z > 0; });
  for (const glm::vec3& p : dense.vertices) {
    if (p.z > 0) cloud.vertices.push_back(p);
  }
  cloud.normals = cloud.vertices;
  const Loaded loaded = through_ply(cloud);
  EXPECT_EQ(loaded.mesh.vertices, cloud.vertices);
  EXPECT_TRUE(loaded.warnings.empty());
}

TEST(Clean, TurnsNormalsOfACloudThatPointInwardsOrBothWays) {
  const Mesh sphere = test::sphere_cloud(1, 0.06F, 12);
  Random random(13);
  const auto check = [&](const char* warning, const auto& turns) {
    SCOPED_TRACE(warning);
    Mesh cloud = sphere;
    for (std::size_t i = 0; i < cloud.normals.size(); ++i) {
      if (turns(i)) cloud.normals[i] = -cloud.normals[i];
    }
    const Loaded loaded = through_ply(cloud);
    EXPECT_EQ(outward_share(loaded.mesh), 1.0);
    ASSERT_EQ(loaded.warnings.size(), 1U);
    EXPECT_NE(loaded.warnings[0].find(warning), std::string::npos) << loaded.warnings[0];
  };
  check("pointed inwards, turned all", [](std::size_t) { return true; });
  check("inwards and outwards", [&](std::size_t) { return random.below(2) == 0; });
  check("inwards and outwards", [&](std::size_t i) { return sphere.vertices[i].x > 0; });
}

TEST(Clean, KeepsNormalsOfACloudOfAVesselsInside) {
  Mesh inside = test::sphere_cloud(1, 0.06F, 14);
  std::erase_if(inside.vertices, [](const glm::vec3& p) { return p.z > 0.3F; });
  inside.normals.clear();
  for (const glm::vec3& p : inside.vertices) inside.normals.push_back(-p);
  const Loaded loaded = through_ply(inside);
  EXPECT_TRUE(loaded.warnings.empty());
  EXPECT_EQ(outward_share(loaded.mesh), 0.0);
}

TEST(Clean, TellsFloatsTooFarFromTheOrigin) {
  // Spheres of radius 1 with points 0.06 apart: at a million, floats have steps of 0.06; at a quarter, of 0.016.
  const auto at = [](double x) {
    Mesh sphere = test::sphere_cloud(1, 0.06F, 15);
    std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                       std::to_string(sphere.vertices.size()) +
                       "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    for (const glm::vec3& p : sphere.vertices)
      text += test::raw(static_cast<float>(x + static_cast<double>(p.x))) + test::raw(p.y) + test::raw(p.z);
    return load_text("a.ply", text).warnings;
  };
  EXPECT_EQ(at(25000).size(), 1U);  // only that there are no normals
  const std::vector<std::string> warnings = at(250000);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_NE(warnings[0].find("steps of 0.0156 so far from the origin"), std::string::npos) << warnings[0];
  EXPECT_THROW(at(4e6), InputError);
}

TEST(Clean, KeepsPrecisionBesideAPointAtZero) {
  // Some writers put points that they could not measure at zero.
  for (const bool cloud : {false, true}) {
    SCOPED_TRACE(cloud);
    Mesh sphere = test::icosphere(1, 4);
    sphere.normals = sphere.vertices;
    if (cloud) sphere.faces.clear();
    std::string text =
        kPlyHeader +
        vertices(sphere.vertices.size() + 1, "property float nx\nproperty float ny\nproperty float nz\n") +
        faces(sphere.faces.size()) + "0 0 0 0 0 1\n";
    const auto number = [](double value) { return std::to_string(value) + " "; };
    for (const glm::vec3& p : sphere.vertices) {
      text += number(4.5e6 + static_cast<double>(p.x)) + number(5.4e6 + static_cast<double>(p.y)) +
              number(static_cast<double>(p.z)) + number(p.x) + number(p.y) + number(p.z) + "\n";
    }
    for (const glm::uvec3& f : sphere.faces)
      text += "3 " + std::to_string(f.x + 1) + " " + std::to_string(f.y + 1) + " " + std::to_string(f.z + 1) +
              "\n";
    const Mesh mesh = load_text("a.ply", text).mesh;
    ASSERT_EQ(mesh.vertices.size(), sphere.vertices.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      const glm::dvec3 at = glm::dvec3(mesh.vertices[i]) + mesh.origin - glm::dvec3(4.5e6, 5.4e6, 0);
      EXPECT_LT(glm::distance(at, glm::dvec3(sphere.vertices[i])), 2e-6);
    }
  }
}

TEST(Clean, KeepsPrecisionFarFromTheOrigin) {
  // A scan of 10 cm in metres at national grid coordinates, in doubles: floats alone would leave steps of 0.5 m.
  std::string text = kPlyHeader + vertices(4) + faces(2);
  text += "4500000.00001 5400000.00002 123.4\n4500000.10001 5400000.00002 123.4\n";
  text += "4500000.10001 5400000.10002 123.4\n4500000.00001 5400000.10002 123.40005\n3 0 1 2\n3 0 2 3\n";
  const Mesh mesh = load_text("a.ply", text).mesh;
  const double x[4] = {4500000.00001, 4500000.10001, 4500000.10001, 4500000.00001};
  const double z[4] = {123.4, 123.4, 123.4, 123.40005};
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3 point = mesh.origin + glm::dvec3(mesh.vertices[i]);
    EXPECT_NEAR(point.x, x[i], 1e-8);
    EXPECT_NEAR(point.z, z[i], 1e-8);
  }
  EXPECT_NEAR(diameter(mesh), 0.1 * std::sqrt(2.0), 1e-6);
}

TEST(Clean, DropsAVertexFarFromTheRestWithItsFaces) {
  Mesh sphere = test::icosphere(1, 4);
  sphere.vertices[2000].x = 99999;
  const Loaded loaded = through_ply(sphere);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_NE(loaded.warnings[0].find("dropped 6 of 5120 faces, at a vertex far from the rest"),
            std::string::npos)
      << loaded.warnings[0];
  EXPECT_LT(diameter(loaded.mesh), 2.1);
}

// The tip of a long cone of a fan of faces: all faces would go with it.
TEST(Clean, KeepsAVertexFarFromTheRestThatManyFacesMeetAt) {
  constexpr std::uint32_t kRim = 3000;
  Mesh fan;
  for (std::uint32_t k = 0; k < kRim; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kRim;
    fan.vertices.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    fan.faces.emplace_back(k, (k + 1) % kRim, kRim);
  }
  fan.vertices.emplace_back(0.0F, 0.0F, 20.0F);
  const Mesh kept = through_ply(fan).mesh;
  EXPECT_EQ(kept.faces.size(), kRim);
  EXPECT_GT(diameter(kept), 20.0);
}

TEST(Clean, KeepsFloatsNearTheOriginAsTheyAre) {
  Mesh sphere = test::icosphere(1, 2);
  for (glm::vec3& vertex : sphere.vertices) vertex += glm::vec3(1.1F, 0.3F, 0.7F);
  const Mesh loaded = through_ply(sphere).mesh;
  EXPECT_EQ(loaded.origin, glm::dvec3(0.0));
  EXPECT_EQ(loaded.vertices, sphere.vertices);
}

}  // namespace
}  // namespace rejoin::mesh
