// Bad files: one line that names the file, the place and the mend; never a crash, never half a mesh.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.hpp"
#include "core/random.hpp"
#include "mesh/load.hpp"
#include "mesh/save.hpp"
#include "shapes.hpp"

namespace rejoin::mesh {
namespace {

using test::raw;
using test::TemporaryFolder;

enum class Kind { Input, Io };

/// Loads and checks the error: its kind, that it is one line, names the file and holds the given words.
void expect_error(const std::filesystem::path& path, Kind kind, const std::string& words) {
  SCOPED_TRACE(path);
  try {
    load(path);
    FAIL() << "loaded";
  } catch (const Error& error) {
    const std::string text = error.what();
    SCOPED_TRACE(text);
    EXPECT_EQ(dynamic_cast<const IoError*>(&error) != nullptr, kind == Kind::Io);
    EXPECT_EQ(text.find('\n'), std::string::npos);
    EXPECT_EQ(text.find(path.string()), 0U);
    EXPECT_NE(text.find(words), std::string::npos);
    EXPECT_NE(text.find("; "), std::string::npos) << "no mend";
  }
}

class Malformed : public testing::Test {
 protected:
  void expect(const std::string& name, const std::string& bytes, Kind kind, const std::string& words) {
    expect_error(folder_.write(name, bytes), kind, words);
  }
  TemporaryFolder folder_;
};

const std::string kVertexHeader = "property float x\nproperty float y\nproperty float z\n";
const std::string kFaceHeader = "property list uchar int vertex_indices\nend_header\n";

std::string ply(const std::string& format, std::size_t vertices, std::size_t faces) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(vertices) + "\n" + kVertexHeader +
         "element face " + std::to_string(faces) + "\n" + kFaceHeader;
}

TEST_F(Malformed, EmptyFile) {
  for (const char* name : {"a.ply", "a.obj", "a.stl", "a.off", "a.glb", "a.gltf", "a.drc", "a.xyz"}) {
    expect(name, "", Kind::Input, "is empty");
  }
}

TEST_F(Malformed, TextThatIsNotAMesh) {
  const std::string text = "Dear colleague,\nthe scans are in the other folder.\n";
  expect("a.ply", text, Kind::Input, "is not a PLY file");
  expect("a.obj", text, Kind::Input, "line 1: unexpected \"Dear\"");
  expect("b.obj", "# a scene without a mesh\no empty\n", Kind::Input, "has no vertices");
  expect("a.stl", text, Kind::Input, "is not an STL file");
  expect("a.off", text, Kind::Input, "is not a three-dimensional OFF file");
  expect("a.glb", text, Kind::Input, "is not a glTF file");
  expect("a.gltf", text, Kind::Input, "is not a glTF file");
  expect("a.drc", text, Kind::Input, "is not Draco data");
}

TEST_F(Malformed, FilesUnderAnotherKindsName) {
  expect("a.obj", ply("ascii", 3, 1), Kind::Input, "holds a PLY file, not what its name says; name it .ply");
  expect("a.ply", "glTF and more", Kind::Input, "holds a GLB file");
  expect("b.obj", "\x89PNG\r\n\x1a\n", Kind::Input, "holds a PNG picture");
  expect("b.ply", "<!DOCTYPE html><title>Not found</title>", Kind::Input, "holds a web page");
  expect("c.ply", "one line that does not end", Kind::Input, "is not a PLY file");
}

TEST_F(Malformed, UnknownExtensionAndMissingFileAndFolder) {
  expect("a.abc", "0 0 0\n", Kind::Input, "unknown extension .abc");
  expect("sherd.jpeg", "\xff\xd8", Kind::Input, "flat pieces are matched by rejoin outline");
  expect("scan", "0 0 0\n", Kind::Input, "no file name extension");
  expect_error(folder_ / "missing.ply", Kind::Io, "cannot be opened");
  expect_error(folder_ / "missing/a.ply", Kind::Io, "cannot be opened");
  std::filesystem::create_directory(folder_ / "folder.ply");
  expect_error(folder_ / "folder.ply", Kind::Io, "is a folder");
  expect_error(folder_ / "", Kind::Io, "is a folder");
}

TEST_F(Malformed, HeadersThatPromiseMoreThanTheFileHolds) {
  expect("a.ply", ply("binary_little_endian", 3, 1000000000) + std::string(36, '\0'), Kind::Io,
         "promises 1000000000 face");
  expect("b.ply", ply("binary_little_endian", 2000000000, 1) + std::string(36, '\0'), Kind::Io,
         "promises 2000000000 vertex");
  expect("c.ply", ply("ascii", 3, 1000000000) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", Kind::Io,
         "promises 1000000000 face");
  expect("d.ply", ply("ascii", 1, 18446744073709551615ULL) + "0 0 0\n", Kind::Io,
         "promises 18446744073709551615 face");
  expect("a.off", "OFF\n2000000000 1 0\n0 0 0\n", Kind::Io, "promises 2000000000 vertices");
  expect("a.stl", std::string(80, ' ') + raw(std::uint32_t{1000000000}) + std::string(100, '\0'), Kind::Io,
         "promises 1000000000 triangles but the file ends after 2");
}

TEST_F(Malformed, ListLongerThanTheFile) {
  const std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex 3\n" + kVertexHeader +
                             "element face 1\nproperty list uint int vertex_indices\nend_header\n";
  const std::string points = raw(glm::vec3(0, 0, 0)) + raw(glm::vec3(1, 0, 0)) + raw(glm::vec3(0, 1, 0));
  expect("a.ply", header + points + raw(std::uint32_t{4000000000U}), Kind::Io, "ends in face 0 of the 1");
}

TEST_F(Malformed, BinaryPlySentAsText) {
  save(folder_ / "sphere.ply", test::icosphere(1, 4));
  std::string bytes = test::read_bytes(folder_ / "sphere.ply");
  for (std::size_t k = bytes.find('\n'); k != std::string::npos; k = bytes.find('\n', k + 2))
    bytes.insert(k, 1, '\r');
  expect("a.ply", bytes, Kind::Input, "is damaged by a transfer as text");
}

TEST_F(Malformed, PlyHeaders) {
  expect("a.ply", "ply\nformat ascii 1.0\nelement vertex three\n", Kind::Input, "line 3");
  expect("b.ply", "ply\nformat utf8 1.0\nend_header\n", Kind::Input, "unknown format");
  expect("c.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty long x\nend_header\n", Kind::Input,
         "unknown type \"long\"");
  expect("d.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n", Kind::Input,
         "before end_header");
  expect("e.ply", "ply\nend_header\n", Kind::Input, "no format");
  expect("f.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n", Kind::Input,
         "no x, y, z");
  expect("g.ply",
         "ply\nformat ascii 1.0\nelement vertex 1\n" + kVertexHeader +
             "element face 1\nproperty int a\nend_header\n0 0 0\n1\n",
         Kind::Input, "no list of vertex indices");
  expect("h.ply", ply("ascii", 0, 0), Kind::Input, "has no vertices");
  std::string mac = ply("ascii", 3, 1) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  std::ranges::replace(mac, '\n', '\r');
  expect("i.ply", mac, Kind::Input, "lines of its PLY header end with CR alone");
}

TEST_F(Malformed, PlyElementsThatComeTwice) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 3\n" + kVertexHeader;
  const std::string list = "property list uchar int vertex_indices\n";
  const std::string normals = "property float nx\nproperty float ny\nproperty float nz\n";
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  expect("a.ply",
         head + "element vertex 1\n" + kVertexHeader + normals + "element face 1\n" + list + "end_header\n" +
             points + "0 0 1 0 0 1\n3 0 1 2\n",
         Kind::Input, "PLY header line 7: a second element \"vertex\"; ");
  expect("b.ply",
         head + "element face 1\n" + list + "element face 1\n" + list + "end_header\n" + points +
             "3 0 1 2\n3 0 2 1\n",
         Kind::Input, "PLY header line 9: a second element \"face\"; ");
}

TEST_F(Malformed, NumbersThatAreNone) {
  expect("a.ply", ply("ascii", 3, 1) + "0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n", Kind::Input,
         "vertex 1: \"zero\" is not a number");
  expect("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1,5 0\nf 1 2 3\n", Kind::Input,
         "line 3: \"1,5\" is not a number; export the scan with points as decimal marks");
  expect("b.ply", ply("ascii", 3, 1) + "0 0 0\n1,5 0 0\n0 1 0\n3 0 1 2\n", Kind::Input,
         "vertex 1: \"1,5\" is not a number; export the scan with points as decimal marks");
  expect("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1\nf 1 2 3\n", Kind::Input, "line 3: three numbers expected");
  expect("c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 x\n", Kind::Input, "line 4: \"x\" is not a vertex index");
  expect("d.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", Kind::Input, "line 4: a face of 2 corners");
  expect("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 ? 0\n3 0 1 2\n", Kind::Input, "line 5: \"?\" is not a number");
  expect("a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 q\n", Kind::Input,
         "line 5: \"q\" is not a number");
}

TEST_F(Malformed, CoordinatesThatAreNotFinite) {
  expect("a.ply", ply("ascii", 3, 1) + "0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n", Kind::Input,
         "vertex 2 is not a finite point");
  expect("b.ply",
         ply("binary_little_endian", 3, 1) + raw(glm::vec3(0, 0, 0)) + raw(glm::vec3(1, INFINITY, 0)) +
             raw(glm::vec3(0, 1, 0)) + "\3" + raw(glm::ivec3(0, 1, 2)),
         Kind::Input, "vertex 1 is not a finite point (1, inf, 0)");
  expect("a.obj", "v 0 0 0\nv 1 0 -inf\nv 0 1 0\nf 1 2 3\n", Kind::Input, "vertex 1 is not a finite point");
  expect("b.obj", "v 0 0 0\nv 1 0 1e300\nv 0 1 0\nf 1 2 3\n", Kind::Input,
         "vertex 1 is not a finite point within 1e+12 (1, 0, 1e+300)");
  expect("c.obj", "v 0 0 0\nv 1 0 1e400\nv 0 1 0\nf 1 2 3\n", Kind::Input,
         "vertex 1 is not a finite point (1, 0, inf)");
  expect("c.ply", ply("ascii", 3, 1) + "0 0 0\n1 0 -1e400\n0 1 0\n3 0 1 2\n", Kind::Input,
         "vertex 1 is not a finite point (1, 0, -inf)");
}

TEST_F(Malformed, FewPointsThatAreNotFiniteAreLeftOutWithTheirFaces) {
  const auto expect_warning = [](const Loaded& loaded, const std::string& words) {
    ASSERT_EQ(loaded.warnings.size(), 1U);
    EXPECT_NE(loaded.warnings[0].find(words), std::string::npos) << loaded.warnings[0];
  };
  Mesh sphere = test::icosphere(1, 3);
  const std::size_t faces = sphere.faces.size();
  const std::size_t vertices = sphere.vertices.size();
  sphere.vertices.emplace_back(NAN, 0, 0);
  save(folder_ / "unused.ply", sphere);
  const Loaded unused = load(folder_ / "unused.ply");
  EXPECT_EQ(unused.mesh.faces.size(), faces);
  EXPECT_EQ(unused.mesh.vertices.size(), vertices);
  expect_warning(unused, "left out 1 of 643 vertices that are not finite, which no face uses");
  sphere.vertices[100].y = INFINITY;
  save(folder_ / "used.ply", sphere);
  const Loaded used = load(folder_ / "used.ply");
  EXPECT_EQ(used.mesh.faces.size(), faces - 6);
  expect_warning(used, "left out 2 of 643 vertices that are not finite, with 6 of 1280 faces");

  Mesh cloud = test::sphere_cloud(1, 0.1F, 6);
  const std::size_t points = cloud.vertices.size();
  for (const std::size_t k : {3U, 50U, 51U}) cloud.vertices[k].x = NAN;
  save(folder_ / "cloud.ply", cloud);
  const Loaded part = load(folder_ / "cloud.ply");
  EXPECT_EQ(part.mesh.vertices.size(), points - 3);
  ASSERT_FALSE(part.warnings.empty());
  EXPECT_NE(part.warnings[0].find("left out 3 of " + std::to_string(points) + " points"), std::string::npos)
      << part.warnings[0];
}

TEST_F(Malformed, SizesWhoseAreasNoFloatHolds) {
  const auto triangle = [](const std::string& edge) {
    return "v 0 0 0\nv " + edge + " 0 0\nv 0 " + edge + " 0\nf 1 2 3\n";
  };
  expect("a.obj", triangle("1e11"), Kind::Input, "is 1.41e+11 across");
  expect("b.obj", triangle("1e-10"), Kind::Input, "is 1.41e-10 across");
  EXPECT_EQ(load(folder_.write("c.obj", triangle("1e8"))).mesh.faces.size(), 1U);
  EXPECT_EQ(load(folder_.write("d.obj", triangle("1e-5"))).mesh.faces.size(), 1U);
  EXPECT_EQ(load(folder_.write("e.obj", triangle("1") + "v 1e-400 2 0\nf 1 2 4\n")).mesh.faces.size(), 2U);
}

TEST_F(Malformed, NeedlesOfNextToNoArea) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1e-30 0\nv 0 0 1e-30\n";
  expect("a.obj", points + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n", Kind::Input,
         "is 1 across, but its faces have an area of only 1.71e-30");
}

TEST_F(Malformed, ColoursThatAreNoNumbersAreBlack) {
  const std::string off = "COFF\n3 1 0\n0 0 0 nan 0.5 7\n1 0 0 nan 0.5 7\n0 1 0 nan 0.5 7\n3 0 1 2\n";
  EXPECT_EQ(load(folder_.write("a.off", off)).mesh.colours.at(0), glm::u8vec3(0, 128, 255));
}

TEST_F(Malformed, IndicesOutOfRange) {
  const std::string beyond = "99999999999999999999";  // no integer holds it
  expect("c.ply", ply("ascii", 3, 1) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 " + beyond + "\n", Kind::Input,
         "face 0 refers to a vertex");
  expect("b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 " + beyond + "\n", Kind::Input,
         "face 0 refers to a vertex");
  expect("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 " + beyond + "\n", Kind::Input, "refers to a vertex");
  expect("c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -" + beyond + "\n", Kind::Input, "refers to a vertex");
  expect("a.ply", ply("ascii", 3, 2) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 3\n", Kind::Input,
         "face 1 refers to a vertex that does not exist");
  expect("b.ply", ply("ascii", 3, 1) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", Kind::Input,
         "face 0 refers to a vertex");
  expect("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\n", Kind::Input,
         "line 5: a face refers to a vertex that does not exist (there are 3)");
  expect("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n", Kind::Input, "line 4: a face refers to a vertex");
  expect("c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", Kind::Input, "line 4: a face refers to a vertex");
  expect("c.ply",
         "ply\nformat ascii 1.0\nelement vertex 3\n" + kVertexHeader +
             "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 "
             "0 1 3\n",
         Kind::Input, "face 0 refers to a vertex");
  expect("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", Kind::Input, "face 0 refers to a vertex");
}

// Behind a vertex that is skipped, faces would take wrong ones.
TEST_F(Malformed, WordsOfNoMeaningInAnObjFile) {
  expect("a.obj", "v 0 0 0\nV 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n", Kind::Input, "line 2: unexpected \"V\"");
}

TEST_F(Malformed, TextInUtf16) {
  expect("a.obj", std::string("\xFF\xFEv\0 \0", 6), Kind::Input, "is text in UTF-16; save it as UTF-8");
  expect("a.off", std::string("\xFE\xFF\0O\0F", 6), Kind::Input, "is text in UTF-16; save it as UTF-8");
}

TEST_F(Malformed, TextOfPoints) {
  expect("a.xyz", "Dear colleague,\nthe scans are elsewhere.\n", Kind::Input,
         "line 2: \"the\" is not a number");
  expect("b.xyz", "0 0 0\n1 0 0 5\n", Kind::Input, "line 2: 4 numbers, where lines before have 3");
  expect("c.xyz", "0 0\n1 0\n", Kind::Input, "line 1: three numbers expected, 2 found");
  expect("d.pts", "4\n0 0 0\n1 0 0\n0 1 0\n", Kind::Io,
         "its first line promises 4 points but the file ends after 3");
  expect("e.pts", "3\n", Kind::Io, "its first line promises 3 points but the file ends after 0");
  expect("f.xyz", "# nothing\n", Kind::Input, "has no vertices");
  for (const char* decimal_commas : {"0,5 1,5 2,5\n0,5 1,5 2\n", "0,5;1,5;2,5\n0,5;1,5;2\n"})
    expect("h.xyz", decimal_commas, Kind::Input, "export the scan with points as decimal marks");
  expect("g.xyz", "0 0 nan\n1 0 nan\n0 1 0\n", Kind::Input, "vertex 0 is not a finite point");
}

TEST_F(Malformed, NoArea) {
  expect("a.ply", ply("ascii", 3, 1) + "0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n", Kind::Input,
         "none of its 1 faces has an area");
  expect("b.ply", ply("ascii", 3, 1) + "0 0 0\n1 0 0\n0 1 0\n2 0 1\n", Kind::Input,
         "none of its 1 faces has three corners");
  expect("c.ply", ply("ascii", 4, 0) + "0 0 0\n1 1 1\n2 2 2\n5 5 5\n", Kind::Input,
         "its 4 distinct points span no area");
  expect("a.obj", "v 1 2 3\nv 1 2 3\nv 1 2 3\n", Kind::Input, "its 1 distinct points span no area");
}

TEST_F(Malformed, StripsWithoutCorners) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 3\n" + kVertexHeader;
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  expect("a.ply", head + "element tristrips 1000000000000000000\nend_header\n" + points, Kind::Input,
         "its tristrips elements have no list of vertex indices");
  expect("b.ply",
         head + "element tristrips 1\nproperty list int int corners\nend_header\n" + points + "3 0 1 2\n",
         Kind::Input, "its tristrips elements have no list of vertex indices");
}

TEST_F(Malformed, Gltf) {
  const std::string asset = R"({"asset":{"version":"2.0"},)";
  expect("a.gltf", R"({"buffers":[]})", Kind::Input, "not a valid glTF file");
  expect("b.gltf", asset + R"("extensionsRequired":["EXT_meshopt_compression"]})", Kind::Input,
         "requires the glTF extension EXT_meshopt_compression");
  expect("c.gltf", asset + R"("buffers":[{"byteLength":12,"uri":"gone.bin"}]})", Kind::Io, "gone.bin");
  expect("d.gltf", asset + R"("scenes":[{"nodes":[0]}],"nodes":[{"children":[0]}]})", Kind::Input,
         "two parents");
  expect("e.gltf", asset + R"("scenes":[{"nodes":[3]}],"nodes":[{}]})", Kind::Input, "node 3 does not exist");
  expect("f.gltf", asset + R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":1}]})", Kind::Input,
         "mesh 1 does not exist");
  expect("g.gltf", asset + R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})", Kind::Input,
         "accessor 0 does not exist");
  std::string chain = asset + R"("scenes":[{"nodes":[0]}],"nodes":[)";
  for (int node = 1; node < 100000; ++node) chain += R"({"children":[)" + std::to_string(node) + "]},";
  expect("l.gltf", chain + "{}]}", Kind::Input, "lies deeper than 1000 nodes");
  expect("m.gltf", asset + R"("extras":)" + std::string(1000000, '[') + std::string(1000000, ']') + "}",
         Kind::Input, "nested deeper than 200");
  expect("n.gltf", asset + R"("extras":"\"\\\")" + std::string(1000, '[') + "\"}", Kind::Input,
         "has no vertices");
  ASSERT_EQ(mkfifo((folder_ / "pipe.bin").c_str(), 0600), 0);
  expect("o.gltf", asset + R"("buffers":[{"byteLength":12,"uri":"pipe.bin"}]})", Kind::Io,
         "pipe.bin : is a folder, pipe or device");
  const std::string mesh =
      asset + R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
              R"("buffers":[{"byteLength":4,"uri":"data:application/octet-stream;base64,AAAAAA=="}],)";
  expect(
      "h.gltf",
      mesh +
          R"("bufferViews":[{"buffer":0,"byteLength":4}],"accessors":[{"bufferView":0,"componentType":5126,"count":1000000000,"type":"VEC3"}]})",
      Kind::Input, "promises 1000000000 values but its bufferView holds 0");
  expect(
      "i.gltf",
      mesh +
          R"("bufferViews":[{"buffer":0,"byteOffset":2,"byteLength":4}],"accessors":[{"bufferView":0,"componentType":5126,"count":1,"type":"VEC3"}]})",
      Kind::Input, "reaches beyond its buffer of 4 bytes");
  expect(
      "j.gltf",
      asset +
          R"("meshes":[{"primitives":[{"attributes":{},"extensions":{"KHR_draco_mesh_compression":7}}]}]})",
      Kind::Input, "glTF");
  expect("k.glb", "glTF" + raw(std::uint32_t{2}) + raw(std::uint32_t{1000}) + std::string(20, '\0'), Kind::Io,
         "promises 1000 bytes");
}

/// A mesh in all formats that can be cut or damaged.
std::vector<std::filesystem::path> samples(const TemporaryFolder& folder) {
  Mesh mesh = test::icosphere(1, 1);
  compute_normals(mesh);
  std::vector<std::filesystem::path> paths;
  for (const char* name : {"whole.ply", "whole.glb", "whole.drc", "whole.obj"}) {
    save(folder / name, mesh);
    paths.push_back(folder / name);
  }
  std::string off =
      "OFF\n" + std::to_string(mesh.vertices.size()) + " " + std::to_string(mesh.faces.size()) + " 0\n";
  for (const glm::vec3& v : mesh.vertices)
    off += std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + "\n";
  for (const glm::uvec3& f : mesh.faces)
    off += "3 " + std::to_string(f.x) + " " + std::to_string(f.y) + " " + std::to_string(f.z) + "\n";
  paths.push_back(folder.write("whole.off", off));
  std::string stl(80, ' ');
  stl += raw(static_cast<std::uint32_t>(mesh.faces.size()));
  for (const glm::uvec3& f : mesh.faces) {
    stl += raw(glm::vec3(0)) + raw(mesh.vertices[f.x]) + raw(mesh.vertices[f.y]) + raw(mesh.vertices[f.z]) +
           "ab";
  }
  paths.push_back(folder.write("whole.stl", stl));
  return paths;
}

TEST_F(Malformed, TruncatedFilesAreRefusedWhereverTheyEnd) {
  for (const std::filesystem::path& path : samples(folder_)) {
    if (path.extension() == ".obj") continue;  // OBJ states no counts: half of it is a smaller mesh
    SCOPED_TRACE(path);
    const std::string bytes = test::read_bytes(path);
    for (std::size_t parts = 1; parts < 60; ++parts) {
      // The last two bytes of a text may only be the end of its last number.
      const std::size_t length = std::min(bytes.size() * parts / 60, bytes.size() - 3);
      const auto cut = folder_.write("cut" + path.extension().string(), bytes.substr(0, length));
      EXPECT_THROW(load(cut), Error) << length << " of " << bytes.size();
    }
  }
}

TEST_F(Malformed, RandomDamageEndsInAMeshOrAnError) {
  // A damaged file may still be a mesh; it must never crash, hang, or throw anything but our errors.
  for (const std::filesystem::path& path : samples(folder_)) {
    const std::string bytes = test::read_bytes(path);
    for (std::uint64_t seed = 0; seed < 150; ++seed) {
      SCOPED_TRACE(path.string() + " seed " + std::to_string(seed));
      Random random(seed);
      std::string damaged = bytes;
      // The start holds most of what can mislead a reader.
      const std::size_t reach = seed % 2 == 0 ? std::min<std::size_t>(400, bytes.size()) : bytes.size();
      for (int i = 0; i < 3; ++i) {
        damaged[random.below(static_cast<std::uint32_t>(reach))] = static_cast<char>(random.below(256));
      }
      const auto file = folder_.write("damaged" + path.extension().string(), damaged);
      try {
        const Loaded loaded = load(file);
        for (const glm::uvec3& face : loaded.mesh.faces) {
          ASSERT_LT(std::max({face.x, face.y, face.z}), loaded.mesh.vertices.size());
        }
      } catch (const Error& error) {
        EXPECT_EQ(std::strchr(error.what(), '\n'), nullptr);
      }
    }
  }
}

}  // namespace
}  // namespace rejoin::mesh
