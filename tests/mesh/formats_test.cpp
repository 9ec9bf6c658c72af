// What goes out comes back, in every format; and files written by others are understood.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/error.hpp"
#include "mesh/load.hpp"
#include "mesh/save.hpp"
#include "shapes.hpp"

namespace rejoin::mesh {
namespace {

using test::raw;
using test::TemporaryFolder;

glm::dvec3 in_file(const Mesh& mesh, std::size_t vertex) {
  return mesh.origin + glm::dvec3(mesh.vertices[vertex]);
}

/// Largest distance from a vertex of `a` to the nearest one of `b`.
double furthest(const Mesh& a, const Mesh& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.vertices.size(); ++i) {
    double nearest = 1e300;
    for (std::size_t k = 0; k < b.vertices.size(); ++k) {
      nearest = std::min(nearest, glm::distance(in_file(a, i), in_file(b, k)));
    }
    worst = std::max(worst, nearest);
  }
  return worst;
}

Mesh coloured_sphere() {
  Mesh mesh = test::icosphere(1, 2);
  compute_normals(mesh);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) mesh.colours.emplace_back(i, 255 - i, 5 * i % 256);
  return mesh;
}

class RoundTrip : public testing::TestWithParam<const char*> {
 protected:
  bool is_draco() const { return std::string(GetParam()) == ".drc"; }

  Loaded through_file(const Mesh& mesh) {
    const auto path = folder_ / (std::string("a") + GetParam());
    save(path, mesh);
    return load(path);
  }

  TemporaryFolder folder_;
};

TEST_P(RoundTrip, KeepsAClosedMeshWithNormalsAndColours) {
  const Mesh mesh = coloured_sphere();
  const Loaded loaded = through_file(mesh);
  EXPECT_TRUE(loaded.warnings.empty());
  EXPECT_EQ(loaded.mesh.faces.size(), mesh.faces.size());
  EXPECT_EQ(loaded.mesh.vertices.size(), mesh.vertices.size());
  // Draco quantises to 2^-20 of the box.
  EXPECT_LE(furthest(loaded.mesh, mesh), is_draco() ? 4e-6 : 1e-7);
  EXPECT_NEAR(test::volume(loaded.mesh), test::volume(mesh), 1e-5);
  ASSERT_EQ(loaded.mesh.normals.size(), loaded.mesh.vertices.size());
  ASSERT_EQ(loaded.mesh.colours.size(), loaded.mesh.vertices.size());
  for (std::size_t i = 0; i < loaded.mesh.vertices.size(); ++i) {
    EXPECT_GT(glm::dot(loaded.mesh.normals[i], loaded.mesh.vertices[i]), 0.999F);
  }
  // Vertices may come back in another order (Draco): compare the colours as sets.
  const auto less = [](const glm::u8vec3& a, const glm::u8vec3& b) {
    return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
  };
  std::vector<glm::u8vec3> found = loaded.mesh.colours;
  std::vector<glm::u8vec3> expected = mesh.colours;
  std::sort(found.begin(), found.end(), less);
  std::sort(expected.begin(), expected.end(), less);
  EXPECT_EQ(found, expected);
}

TEST_P(RoundTrip, KeepsAnOpenMesh) {
  Mesh mesh = test::box({1, 2, 3}, 4);
  mesh.faces.resize(mesh.faces.size() / 2);
  const test::Edges before = test::count_edges(mesh);
  ASSERT_GT(before.open, 0U);
  const test::Edges after = test::count_edges(through_file(mesh).mesh);
  EXPECT_EQ(after.open, before.open);
  EXPECT_EQ(after.total, before.total);
}

TEST_P(RoundTrip, KeepsAllFacesOfANonManifoldMesh) {
  // Three sheets on one edge, two boxes that touch in one vertex.
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}};
  mesh.faces = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
  const Mesh cube = test::box({1, 1, 1}, 1);
  for (const float shift : {5.0F, 6.0F}) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const glm::vec3& vertex : cube.vertices) mesh.vertices.push_back(vertex + glm::vec3(shift));
    for (const glm::uvec3& face : cube.faces) mesh.faces.push_back(face + glm::uvec3(first));
  }
  const Loaded loaded = through_file(mesh);
  EXPECT_EQ(loaded.mesh.faces.size(), mesh.faces.size());
  EXPECT_EQ(loaded.mesh.vertices.size(), mesh.vertices.size() - 1);
  EXPECT_NEAR(surface_area(loaded.mesh), surface_area(mesh), 1e-4);
  EXPECT_EQ(test::count_edges(loaded.mesh).non_manifold, 1U);
}

TEST_P(RoundTrip, KeepsAnOrientedCloud) {
  Mesh cloud = test::sphere_cloud(2, 0.3F, 1);
  const Loaded loaded = through_file(cloud);
  EXPECT_TRUE(loaded.mesh.is_cloud());
  EXPECT_TRUE(loaded.warnings.empty());
  ASSERT_EQ(loaded.mesh.vertices.size(), cloud.vertices.size());
  EXPECT_LE(furthest(loaded.mesh, cloud), is_draco() ? 1e-5 : 1e-7);
  for (std::size_t i = 0; i < loaded.mesh.vertices.size(); ++i) {
    EXPECT_GT(glm::dot(loaded.mesh.normals[i], loaded.mesh.vertices[i]), 1.99F);
  }
}

TEST_P(RoundTrip, KeepsDetailFarFromTheOrigin) {
  Mesh mesh = test::icosphere(0.05F, 3);  // 5 cm in national grid coordinates
  mesh.origin = {1234567.25, 5234567.5, 321.0};
  const Loaded loaded = through_file(mesh);
  EXPECT_EQ(loaded.mesh.vertices.size(), mesh.vertices.size());
  EXPECT_EQ(loaded.mesh.faces.size(), mesh.faces.size());
  // Doubles hold 1e-9 at five million; as floats the sphere would fall together to steps of half a metre.
  EXPECT_LE(furthest(loaded.mesh, mesh), 4e-9);
}

INSTANTIATE_TEST_SUITE_P(Formats, RoundTrip, testing::Values(".ply", ".obj", ".glb", ".drc"),
                         [](const auto& param) { return std::string(param.param + 1); });

TEST(Save, SceneGlbPlacesEveryPart) {
  const TemporaryFolder folder;
  const Mesh sphere = test::icosphere(1, 2);
  Mesh cube = test::box({2, 2, 2}, 1);
  cube.origin = {3, 0, 0};
  const Rigid pose{axis_rotation({0, 0, 1}, 1.5707963267948966), {0, 0, 10}};
  for (const char* name : {"scene.glb", "scene.ply", "scene.obj", "scene.drc"}) {
    SCOPED_TRACE(name);
    save_scene(folder / name, {{"a", &sphere, Rigid{}}, {"b", &cube, pose}});
    const Mesh loaded = load(folder / name).mesh;
    EXPECT_EQ(loaded.faces.size(), sphere.faces.size() + cube.faces.size());
    const Box box = bounds(loaded);
    const glm::dvec3 high = loaded.origin + glm::dvec3(box.high);
    EXPECT_NEAR(high.y, 4, 1e-4);  // the cube's centre turns from (3, 0, 0) to (0, 3, 0)
    EXPECT_NEAR(high.z, 11, 1e-4);
  }
  EXPECT_NE(test::read_bytes(folder / "scene.glb").find("\"name\":\"b\""), std::string::npos);
}

// Viewers place nodes by floats: at grid coordinates the two would be up to half a unit apart.
TEST(Save, SceneGlbFarFromTheOriginComesThere) {
  const TemporaryFolder folder;
  const Mesh sphere = test::icosphere(1, 2);
  const glm::dvec3 far(5.4e6, 4.5e6, 120);
  save_scene(folder / "a.glb", {{"a", &sphere, {glm::dmat3(1.0), far}},
                                {"b", &sphere, {glm::dmat3(1.0), far + glm::dvec3(3, 0, 0)}}});
  const Mesh loaded = load(folder / "a.glb").mesh;
  const Box box = bounds(loaded);
  EXPECT_EQ(loaded.origin, glm::dvec3(0.0));
  EXPECT_NEAR(box.low.x, -1, 1e-6);
  EXPECT_NEAR(box.high.x, 4, 1e-6);
}

TEST(Scene, NameThatIsNoUtf8LeavesAValidGlb) {
  const test::TemporaryFolder folder;
  const Mesh cube = test::box({2, 2, 2}, 1);
  save_scene(folder / "a.glb", {{"Gef\xe4\xdf", &cube, Rigid{}}});
  EXPECT_EQ(load(folder / "a.glb").mesh.faces.size(), cube.faces.size());
}

TEST(Scene, LargerThanAGlbHoldsIsRefused) {
  const test::TemporaryFolder folder;
  Mesh cloud;
  cloud.vertices.resize(1000000);
  const std::vector<Placed> parts(400, {"a", &cloud, Rigid{}});  // 4.8 GB
  EXPECT_THROW(save_scene(folder / "a.glb", parts), IoError);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.glb"));
}

TEST(Save, LeavesNothingBehindWhenItCannotWrite) {
  const TemporaryFolder folder;
  const Mesh mesh = test::box({1, 1, 1}, 1);
  EXPECT_THROW(save(folder / "missing/a.ply", mesh), IoError);
  EXPECT_THROW(save(folder / "a.stl", mesh), InputError);
  save(folder / "b.PLY", mesh);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / ""), {}), 1);
}

TEST(Ply, ReadsTextWithOtherPropertiesPolygonsAndFacesFirst) {
  const TemporaryFolder folder;
  const auto path = folder.write(
      "a.ply",
      "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nobj_info x\r\n"
      "element face 2\r\nproperty uchar quality\r\nproperty list uchar uint vertex_index\r\n"
      "element vertex 5\r\nproperty double x\r\nproperty double y\r\nproperty float confidence\r\n"
      "property double z\r\nproperty uchar red\r\nproperty uchar green\r\nproperty uchar blue\r\n"
      "element edge 1\r\nproperty list int float w\r\nend_header\r\n"
      "7 4 0 1 2 3\r\n9 3 1 4 2\r\n"
      "0 0 0.5 0 1 2 3\r\n1 0 0.5 0 4 5 6\r\n1 +1 0.5 0 7 8 9\r\n0 1e0 0.5 0 10 11 12\r\n2 0 0.5 0 13 14 "
      "15\r\n"
      "2 1 2");
  const Mesh mesh = load(path).mesh;
  EXPECT_EQ(mesh.faces.size(), 3U);
  EXPECT_NEAR(surface_area(mesh), 1.5, 1e-6);
  ASSERT_EQ(mesh.colours.size(), 5U);
  EXPECT_EQ(mesh.colours[4], glm::u8vec3(13, 14, 15));
  for (const glm::vec3& normal : face_normals(mesh)) EXPECT_GT(normal.z, 0.99F);
}

TEST(Ply, ReadsTextBehindAByteOrderMark) {
  const TemporaryFolder folder;
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(load(folder.write("a.ply", "\xEF\xBB\xBF" + text)).mesh.vertices.size(), 3U);
}

TEST(Ply, ReadsBigEndian) {
  const TemporaryFolder folder;
  const auto reversed = [](std::string bytes) {
    std::reverse(bytes.begin(), bytes.end());
    return bytes;
  };
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\nproperty double y\nproperty "
      "float z\n"
      "element face 1\nproperty list ushort int vertex_indices\nend_header\n";
  for (const glm::vec3 p : {glm::vec3(0, 0, 5), glm::vec3(3, 0, 5), glm::vec3(0, 4, 5)}) {
    bytes += reversed(raw(p.x)) + reversed(raw(static_cast<double>(p.y))) + reversed(raw(p.z));
  }
  bytes += reversed(raw(std::uint16_t{3}));
  for (const std::int32_t corner : {0, 1, 2}) bytes += reversed(raw(corner));
  const Mesh mesh = load(folder.write("a.ply", bytes)).mesh;
  EXPECT_EQ(mesh.faces.size(), 1U);
  EXPECT_NEAR(surface_area(mesh), 6, 1e-6);
}

TEST(Ply, ReadsStripsOfTriangles) {
  const TemporaryFolder folder;
  const auto path = folder.write(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 4 -1 4 3 2\n");
  const Mesh mesh = load(path).mesh;  // a folded strip's last triangle is the third one's other side
  double up = 0;
  double down = 0;
  for (const glm::uvec3& face : mesh.faces) {
    const glm::vec3& a = mesh.vertices[face.x];
    const float z = 0.5F * glm::cross(mesh.vertices[face.y] - a, mesh.vertices[face.z] - a).z;
    (z > 0 ? up : down) += z;
  }
  EXPECT_EQ(up, 1.5);
  EXPECT_EQ(down, -0.5);
}

TEST(Ply, CutsAConcavePolygonAlongItsInside) {
  const TemporaryFolder folder;
  // An L of area 3: a fan from its first corner would cover area outside of it.
  const auto path = folder.write(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "2 1 0\n1 1 0\n1 2 0\n0 2 0\n0 0 0\n2 0 0\n6 0 1 2 3 4 5\n");
  const Mesh mesh = load(path).mesh;
  EXPECT_EQ(mesh.faces.size(), 4U);
  EXPECT_NEAR(surface_area(mesh), 3, 1e-6);
  for (const glm::vec3& normal : face_normals(mesh)) EXPECT_GT(normal.z, 0.99F);
}

TEST(Obj, ReadsNegativeIndicesNormalsColoursAndContinuedLines) {
  const TemporaryFolder folder;
  const auto path =
      folder.write("a.OBJ",
                   "# scanner\nmtllib a.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 1 1 1\n"
                   "vt 0 0\nvn 0 0 2\no thing\ns off\nf -4//1 -3//1 \\\n -2//1 -1//1\n");
  const Loaded loaded = load(path);
  EXPECT_EQ(loaded.format, "obj");
  EXPECT_EQ(loaded.mesh.faces.size(), 2U);
  EXPECT_NEAR(surface_area(loaded.mesh), 1, 1e-6);
  ASSERT_EQ(loaded.mesh.normals.size(), 4U);
  EXPECT_EQ(loaded.mesh.normals[2], glm::vec3(0, 0, 1));
  ASSERT_EQ(loaded.mesh.colours.size(), 4U);
  EXPECT_EQ(loaded.mesh.colours[1], glm::u8vec3(0, 255, 0));
}

TEST(Obj, TakesColoursThatAreWrittenAsBytes) {
  const TemporaryFolder folder;
  const Loaded loaded = load(
      folder.write("a.obj", "v 0 0 0 120 60 30\nv 1 0 0 0 255 0\nv 1 1 0 1 1 1\nv 0 1 0 9 9 9\nf 1 2 3 4\n"));
  ASSERT_EQ(loaded.mesh.colours.size(), 4U);
  EXPECT_EQ(loaded.mesh.colours[0], glm::u8vec3(120, 60, 30));
  EXPECT_EQ(loaded.mesh.colours[2], glm::u8vec3(1, 1, 1));
}

TEST(Ply, TakesRealColoursFromNoughtToOneAndUpTo255) {
  const TemporaryFolder folder;
  const auto colour = [&](const char* written) {
    return load(
               folder.write("a.ply", fmt::format("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                                 "property float y\nproperty float z\nproperty float red\n"
                                                 "property float green\nproperty float blue\nelement face 1\n"
                                                 "property list uchar int vertex_indices\nend_header\n"
                                                 "0 0 0 {0}\n1 0 0 {0}\n0 1 0 {0}\n3 0 1 2\n",
                                                 written)))
        .mesh.colours.at(0);
  };
  EXPECT_EQ(colour("1 0.4 0"), glm::u8vec3(255, 102, 0));
  EXPECT_EQ(colour("255 102 0"), glm::u8vec3(255, 102, 0));
}

TEST(Off, CommentsMayFollowNumbersWithoutABlank) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.off", "OFF\n3 1 0# counts\n0 0 0#a\n1 0 0\n0 1 0\n3 0 1 2# face\n");
  EXPECT_EQ(load(path).mesh.faces.size(), 1U);
}

TEST(Off, ReadsCountsOnTheFirstLineCommentsAndColours) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.off",
                                 "COFF 4 2 0\n# corners\n0 0 0 255 0 0 255\n\n1 0 0 0.0 1.0 0.0 1.0\n1 1 0 0 "
                                 "0 255 255\n0 1 0 9 8 7 255\n"
                                 "3 0 1 2 255 0 0\n3  0 2 3\n");
  const Mesh mesh = load(path).mesh;
  EXPECT_EQ(mesh.faces.size(), 2U);
  EXPECT_NEAR(surface_area(mesh), 1, 1e-6);
  ASSERT_EQ(mesh.colours.size(), 4U);
  EXPECT_EQ(mesh.colours[1], glm::u8vec3(0, 255, 0));
  EXPECT_EQ(mesh.colours[3], glm::u8vec3(9, 8, 7));
}

std::string binary_stl(const Mesh& mesh, const std::string& header) {
  std::string bytes = header;
  bytes.resize(80, ' ');
  bytes += raw(static_cast<std::uint32_t>(mesh.faces.size()));
  for (const glm::uvec3& face : mesh.faces) {
    bytes += raw(glm::vec3(0.0F));
    for (int k = 0; k < 3; ++k) bytes += raw(mesh.vertices[face[k]]);
    bytes += raw(std::uint16_t{0});
  }
  return bytes;
}

TEST(Stl, WeldsTheRepeatedVerticesOfABinaryFileEvenIfItStartsWithSolid) {
  const TemporaryFolder folder;
  const Mesh sphere = test::icosphere(3, 3);
  for (const char* header : {"made by a scanner", "solid made by a scanner"}) {
    const Mesh mesh = load(folder.write("a.stl", binary_stl(sphere, header))).mesh;
    EXPECT_EQ(mesh.vertices.size(), sphere.vertices.size());
    EXPECT_EQ(mesh.faces.size(), sphere.faces.size());
    EXPECT_EQ(test::count_edges(mesh).open, 0U);
    EXPECT_NEAR(test::volume(mesh), test::volume(sphere), 1e-3);
  }
}

const std::string kTextStl =
    "solid a name\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n"
    "  endloop\n endfacet\n facet normal 0 0 1\n  outer loop\n   vertex 1 0 0\n   vertex 1 1 0\n"
    "   vertex 0 1 0\n  endloop\n endfacet\nendsolid a name\n";

std::string in_capitals(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c; });
  return text;
}

/// With each line end as `end`.
std::string with_line_ends(const std::string& text, const std::string& end) {
  std::string result;
  for (const char c : text) c == '\n' ? result += end : result += c;
  return result;
}

TEST(Stl, ReadsText) {
  const TemporaryFolder folder;
  for (const std::string& text :
       {kTextStl, "\xEF\xBB\xBF" + kTextStl, "\n  " + kTextStl, in_capitals(kTextStl),
        with_line_ends(kTextStl, "\r"), with_line_ends(kTextStl, "\r\n")}) {
    SCOPED_TRACE(text);
    const Mesh mesh = load(folder.write("a.stl", text)).mesh;
    EXPECT_EQ(mesh.vertices.size(), 4U);
    EXPECT_NEAR(surface_area(mesh), 1, 1e-6);
  }
}

TEST(Obj, ReadsTextOfAnySystem) {
  const TemporaryFolder folder;
  const std::string text = "v 0 0 0\nv 1 0 0\nv 1 2 0\nf 1 2 3\n";
  for (const std::string& written :
       {"\xEF\xBB\xBF" + text, with_line_ends(text, "\r"), with_line_ends(text, "\r\n")}) {
    SCOPED_TRACE(written);
    EXPECT_NEAR(surface_area(load(folder.write("a.obj", written)).mesh), 1, 1e-6);
  }
  // Errors count lines as editors do.
  try {
    load(folder.write("a.obj", with_line_ends(text + "f 1 2 9\n", "\r\n")));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("line 5:"), std::string::npos) << error.what();
  }
}

TEST(Obj, ThatEndsWithinALineAndHasVerticesWithoutFacesMayBeCutShort) {
  const TemporaryFolder folder;
  const std::string text = "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2";
  const std::string rest = "\nf 1 2 4\nf 2 3 4\nf 1 4 3";
  for (const std::string& whole : {text + rest, text + rest + "\n# by hand", text + "\n"})
    EXPECT_TRUE(load(folder.write("a.obj", whole)).warnings.empty()) << whole;
  const Loaded cut = load(folder.write("a.obj", text));
  ASSERT_EQ(cut.warnings.size(), 1U);
  EXPECT_NE(cut.warnings[0].find("a line and has no faces at 1 of 4"), std::string::npos) << cut.warnings[0];
}

TEST(Gltf, DecodesDracoPrimitives) {
  const TemporaryFolder folder;
  Mesh sphere = test::icosphere(1, 3);
  compute_normals(sphere);
  save(folder / "a.drc", sphere);
  const std::string data = test::read_bytes(folder / "a.drc");
  const std::string json =
      R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_draco_mesh_compression"],)"
      R"("extensionsRequired":["KHR_draco_mesh_compression"],"scene":0,"scenes":[{"nodes":[0]}],)"
      R"("nodes":[{"children":[1],"scale":[-2,2,2]},{"mesh":0,"translation":[10,0,0]}],)"
      R"("images":[{"uri":"missing.png"}],"buffers":[{"byteLength":)" +
      std::to_string(data.size()) + R"(,"uri":"data:application/octet-stream;base64,)" + test::base64(data) +
      R"("}],"bufferViews":[{"buffer":0,"byteLength":)" + std::to_string(data.size()) +
      R"(}],"accessors":[{"componentType":5126,"count":642,"type":"VEC3"},{"componentType":5123,"count":3840,"type":"SCALAR"}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"extensions":)"
      R"({"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0,"NORMAL":1}}}}]}]})";
  const Mesh mesh = load(folder.write("a.gltf", json)).mesh;
  EXPECT_EQ(mesh.faces.size(), sphere.faces.size());
  const Box box = bounds(mesh);
  EXPECT_NEAR(mesh.origin.x + (box.low.x + box.high.x) / 2, -20, 1e-3);
  // The mirroring scale must not turn the surface inside out.
  EXPECT_NEAR(test::volume(mesh), 8 * test::volume(sphere), 1e-2);
  ASSERT_FALSE(mesh.normals.empty());
  const glm::dvec3 centre = glm::dvec3(-20, 0, 0) - mesh.origin;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    EXPECT_GT(glm::dot(glm::dvec3(mesh.normals[i]), glm::dvec3(mesh.vertices[i]) - centre), 1.99);
  }
}

TEST(Gltf, ReadsStripsFansQuantisedPositionsAndBuffersBesideIt) {
  const TemporaryFolder folder;
  std::string data;
  for (const std::uint16_t value : {0, 0, 0, 0, 65535, 0, 0, 0, 0, 65535, 0, 0, 65535, 65535, 0, 0})
    data += raw(value);
  for (const std::uint8_t index : {0, 1, 2, 3, 0, 1, 3, 2}) data += raw(index);
  folder.write("my buffer.bin", data);
  const std::string primitive = R"("attributes":{"POSITION":0})";
  const std::string json =
      R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_mesh_quantization"],)"
      R"("buffers":[{"byteLength":40,"uri":"my%20buffer.bin"}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":32,"byteStride":8},{"buffer":0,"byteOffset":32,"byteLength":8}],)"
      R"("accessors":[{"bufferView":0,"componentType":5123,"normalized":true,"count":4,"type":"VEC3"},)"
      R"({"bufferView":1,"componentType":5121,"count":4,"type":"SCALAR"},)"
      R"({"bufferView":1,"byteOffset":4,"componentType":5121,"count":4,"type":"SCALAR"}],)"
      R"("meshes":[{"primitives":[{)" +
      primitive + R"(,"indices":1,"mode":5},{)" + primitive +
      R"(,"mode":1}]},)"
      R"({"primitives":[{)" +
      primitive +
      R"(,"indices":2,"mode":6}]}],)"
      R"("nodes":[{"mesh":0},{"mesh":1,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,5,1]}],"scenes":[{"nodes":[0,1]}]})";
  const Mesh mesh = load(folder.write("a.gltf", json)).mesh;
  EXPECT_EQ(mesh.faces.size(), 4U);
  EXPECT_NEAR(surface_area(mesh), 2, 1e-6);
  for (const glm::vec3& normal : face_normals(mesh)) EXPECT_GT(normal.z, 0.99F);
}

}  // namespace
}  // namespace rejoin::mesh
