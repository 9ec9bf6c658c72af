// Colours that scans have from pictures.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "mesh/load.hpp"
#include "mesh/save.hpp"
#include "shapes.hpp"

namespace rejoin::mesh {
namespace {

using test::raw;

const glm::u8vec3 kRed(200, 10, 20);
const glm::u8vec3 kGreen(10, 200, 20);
const glm::u8vec3 kBlue(10, 20, 200);
const glm::u8vec3 kGrey(90, 90, 90);
const glm::u8vec3 kWhite(255);

/// Two by two pixels: red, green / blue, grey.
std::string four_colours() {
  const auto bgr = [](const glm::u8vec3& c) { return cv::Vec3b(c.b, c.g, c.r); };
  const cv::Mat image = (cv::Mat_<cv::Vec3b>(2, 2) << bgr(kRed), bgr(kGreen), bgr(kBlue), bgr(kGrey));
  std::vector<unsigned char> bytes;
  cv::imencode(".png", image, bytes);
  return {bytes.begin(), bytes.end()};
}

/// The colour of the vertex at a place.
glm::u8vec3 colour_at(const Mesh& mesh, const glm::vec3& place) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (glm::distance(glm::vec3(mesh.origin) + mesh.vertices[i], place) < 1e-6F) return mesh.colours.at(i);
  throw std::logic_error("no vertex there");
}

class ObjTexture : public testing::Test {
 protected:
  /// A square, of which the lower right half has the material "skin stone"; the corner (0, 1) has none.
  Loaded read(const std::string& vertex_colour = "",
              const std::string& libraries = "mtllib my scan.mtl\n") const {
    std::string text = libraries;
    for (const char* place : {"0 0 0", "1 0 0", "1 1 0", "0 1 0"})
      text += fmt::format("v {}{}\n", place, vertex_colour);
    text += "vt 0.25 0.25\nvt 0.75 0.25 0\nvt -0.25 1.75\nvt odd\n";
    return load(
        folder_.write("a.obj", text + "usemtl  skin stone \nf 1/1 2/-3/ 3/3/9\nusemtl bare\nf 1/1 3/4 4\n"));
  }

  void write_material(const std::string& picture) const {
    folder_.write("my scan.mtl",
                  "newmtl bare\nKd 1 0 0\nnewmtl skin stone\nmap_Ka other.png\nmap_Kd " + picture + "\n");
  }

  test::TemporaryFolder folder_;
};

TEST_F(ObjTexture, GivesVerticesTheColourOfTheirPlaceWhichIsCountedFromBelow) {
  write_material("my skin.png");
  folder_.write("my skin.png", four_colours());
  const Loaded loaded = read();
  EXPECT_TRUE(loaded.warnings.empty()) << loaded.warnings.front();
  EXPECT_EQ(colour_at(loaded.mesh, {0, 0, 0}), kBlue);
  EXPECT_EQ(colour_at(loaded.mesh, {1, 0, 0}), kGrey);
  EXPECT_EQ(colour_at(loaded.mesh, {1, 1, 0}), kGreen) << "the picture repeats itself";
  EXPECT_EQ(colour_at(loaded.mesh, {0, 1, 0}), kWhite);
}

TEST_F(ObjTexture, NumberSignsInNamesStartNoComment) {
  folder_.write("skin#1.png", four_colours());
  folder_.write("a.mtl",
                "# all of them\nnewmtl part_#1 # painted\nmap_Kd skin#1.png\nnewmtl part_#2\nKd 0 0 1\n");
  const Loaded loaded =
      load(folder_.write("a.obj",
                         "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 5 1 0\nvt 0.25 0.25\n"
                         "usemtl part_#1\nf 1/1 2/1 3/1\nusemtl part_#2\nf 4/1 5/1 6/1\n"));
  EXPECT_EQ(colour_at(loaded.mesh, {0, 0, 0}), kBlue);
  EXPECT_EQ(colour_at(loaded.mesh, {5, 0, 0}), kWhite);
}

TEST_F(ObjTexture, IsFoundWhereTheFileWasMovedAndBehindOptions) {
  std::filesystem::create_directory(folder_ / "maps");
  folder_.write("maps/skin.png", four_colours());
  for (const char* picture : {"maps\\skin.png", "-s 1 1 1 -clamp on maps/skin.png"}) {
    write_material(picture);
    EXPECT_EQ(colour_at(read().mesh, {0, 0, 0}), kBlue) << picture;
  }
  folder_.write("skin.png", four_colours());
  write_material("C:\\Users\\Me\\Scans\\skin.png");
  EXPECT_EQ(colour_at(read("", "mtllib ./my scan.mtl\n").mesh, {0, 0, 0}), kBlue);
}

TEST_F(ObjTexture, GivesWayToColoursOfTheVertices) {
  write_material("skin.png");
  folder_.write("skin.png", four_colours());
  EXPECT_EQ(colour_at(read(" 1 0 1").mesh, {0, 0, 0}), glm::u8vec3(255, 0, 255));
}

TEST_F(ObjTexture, ThatCannotBeReadIsToldAndTheShapeLoads) {
  const auto expect_note = [&](const std::string& words) {
    const Loaded loaded = read();
    EXPECT_EQ(loaded.mesh.faces.size(), 2U);
    EXPECT_TRUE(loaded.mesh.colours.empty());
    ASSERT_EQ(loaded.warnings.size(), 1U) << words;
    EXPECT_NE(loaded.warnings[0].find(words), std::string::npos) << loaded.warnings[0];
    EXPECT_EQ(loaded.warnings[0].find((folder_ / "a.obj").string() + ": "), 0U) << loaded.warnings[0];
  };
  expect_note("my scan.mtl, which are not beside it");
  write_material("missing.png");
  expect_note("missing.png: cannot be");
  write_material("notes.png");
  folder_.write("notes.png", "Dear diary");
  expect_note("notes.png: is no PNG");
  write_material("pipe.png");
  ASSERT_EQ(mkfifo((folder_ / "pipe.png").c_str(), 0600), 0);
  expect_note("pipe.png: is a folder, pipe or device");
  folder_.write("my scan.mtl", "\xFF\xFEm");
  expect_note("my scan.mtl: is text in UTF-16");
  folder_.write("my scan.mtl", "newmtl skin stone\nmap_Kd\nmap_Kd -s 1 1\nmap_Kd -\n");
  const Loaded none = read();
  EXPECT_TRUE(none.mesh.colours.empty());
}

/// What a glTF file says besides its geometry, and where it has its picture.
struct Gltf {
  std::string image = R"({"bufferView":3})";
  std::string texture = R"({"source":0})";
  std::string material = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})";
  std::string attributes = R"("TEXCOORD_0":1)";
  std::string more = {};
};

class GltfTexture : public testing::Test {
 protected:
  /// A square with places on a picture at (0.25, 0.25), (0.75, 0.25), (0.75, 0.75), (0.25, 0.75), and colours of half the light.
  Loaded read(const Gltf& gltf) const {
    std::string data;
    for (const float value : {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) data += raw(value);
    for (const float value : {0.25F, 0.25F, 0.75F, 0.25F, 0.75F, 0.75F, 0.25F, 0.75F}) data += raw(value);
    for (int k = 0; k < 12; ++k) data += raw(0.5F);
    const std::string picture = four_colours();
    folder_.write("my data.bin", data + picture);
    const std::string json = fmt::format(
        R"({{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{},"uri":"my%20data.bin"}}],)"
        R"("bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":32}},)"
        R"({{"buffer":0,"byteOffset":80,"byteLength":48}},{{"buffer":0,"byteOffset":128,"byteLength":{}}}],)"
        R"("accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}},)"
        R"({{"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"}},)"
        R"({{"bufferView":2,"componentType":5126,"count":4,"type":"VEC3"}}],)"
        R"("images":[{}],"textures":[{}],"materials":[{{}},{}],{})"
        R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,{}}},"material":1,"mode":6}}]}}]}})",
        data.size() + picture.size(), picture.size(), gltf.image, gltf.texture, gltf.material, gltf.more,
        gltf.attributes);
    return load(folder_.write("a.gltf", json));
  }

  void expect_colours(const Gltf& gltf, const std::array<glm::u8vec3, 4>& wanted) const {
    const Loaded loaded = read(gltf);
    EXPECT_TRUE(loaded.warnings.empty()) << loaded.warnings.front();
    ASSERT_EQ(loaded.mesh.colours.size(), 4U);
    EXPECT_EQ(colour_at(loaded.mesh, {0, 0, 0}), wanted[0]);
    EXPECT_EQ(colour_at(loaded.mesh, {1, 0, 0}), wanted[1]);
    EXPECT_EQ(colour_at(loaded.mesh, {1, 1, 0}), wanted[2]);
    EXPECT_EQ(colour_at(loaded.mesh, {0, 1, 0}), wanted[3]);
  }

  test::TemporaryFolder folder_;
};

TEST_F(GltfTexture, LiesInTheFileBesideItOrInItsText) {
  const std::array<glm::u8vec3, 4> as_it_is{kRed, kGreen, kGrey, kBlue};
  expect_colours({}, as_it_is);
  folder_.write("my skin.png", four_colours());
  expect_colours({R"({"uri":"my%20skin.png"})"}, as_it_is);
  expect_colours({R"({"uri":"data:image/png;base64,)" + test::base64(four_colours()) + "\"}"}, as_it_is);
}

TEST_F(GltfTexture, TakesPlacesAndChangesThatTheMaterialAsksFor) {
  Gltf gltf;
  gltf.attributes = R"("TEXCOORD_1":1)";
  gltf.material = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1}}})";
  expect_colours(gltf, {kRed, kGreen, kGrey, kBlue});
  gltf.more = R"("extensionsRequired":["KHR_texture_transform"],)";
  gltf.material = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":)"
                  R"({"KHR_texture_transform":{"texCoord":1,"offset":[0.5,0],"scale":[1,0.5]}}}}})";
  expect_colours(gltf, {kGreen, kRed, kRed, kGreen});
  // A quarter turn takes (u, v) to (v, -u).
  gltf.material = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":)"
                  R"({"KHR_texture_transform":{"texCoord":1,"rotation":1.5707963267948966}}}}})";
  expect_colours(gltf, {kBlue, kRed, kGreen, kGrey});
  gltf.material =
      R"({"extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseTexture":{"index":0,"texCoord":1}}}})";
  expect_colours(gltf, {kRed, kGreen, kGrey, kBlue});
}

TEST_F(GltfTexture, IsMultipliedByColoursOfVerticesAndMaterialInLinearLight) {
  Gltf gltf;
  gltf.attributes += R"(,"COLOR_0":2)";
  gltf.material = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"baseColorFactor":[1,0,1,1]}})";
  // Half the light is stored as 188 in sRGB, which is 0.503 of it: 200 becomes 147, 90 64, 20 12 and 10 5.
  expect_colours(
      gltf, {glm::u8vec3(147, 0, 12), glm::u8vec3(5, 0, 12), glm::u8vec3(64, 0, 64), glm::u8vec3(5, 0, 147)});
}

TEST_F(GltfTexture, ThatCannotBeReadIsToldAndTheShapeLoads) {
  const auto expect_note = [&](const Gltf& gltf, const std::string& words) {
    const Loaded loaded = read(gltf);
    EXPECT_EQ(loaded.mesh.faces.size(), 2U);
    EXPECT_TRUE(loaded.mesh.colours.empty());
    ASSERT_EQ(loaded.warnings.size(), 1U) << words;
    EXPECT_NE(loaded.warnings[0].find(words), std::string::npos) << loaded.warnings[0];
  };
  expect_note({R"({"uri":"missing.png"})"}, "missing.png: cannot be");
  ASSERT_EQ(mkfifo((folder_ / "pipe.png").c_str(), 0600), 0);
  expect_note({R"({"uri":"pipe.png"})"}, "pipe.png: is a folder, pipe or device");
  expect_note({R"({"bufferView":7})"}, "bufferView 7 does not exist");
  expect_note({R"({"uri":"data:image/png;base64,????"})"}, "image 0");
  expect_note({R"({"bufferView":1})"}, "image 0: is no PNG");
  Gltf web;
  web.texture = R"({"extensions":{"EXT_texture_webp":{"source":0}}})";
  web.more = R"("extensionsRequired":["EXT_texture_webp"],)";
  web.image = R"({"bufferView":0})";
  expect_note(web, "image 0: is no PNG");
}

// A triangle that Draco's own encoder has packed: attribute 0 has the points, 1 the places on a picture.  (This program cannot
// link the encoder itself: Debian's libdraco would put a tinygltf of its own in the place of the real one.)
constexpr const char* kDracoTriangle =
    "RFJBQ08CAgEBAAAAAwEBAQAAAQf/AREBAQAC/wAAAAAAAQAJAwAAAAEDCQIAAQAAAIA/AAAAAAAAAAAAAIA/"
    "AACAPwAAAAAAAAAAAAAAAAAAAAAAAEA/AACAPgAAQD8AAEA/AACAPgAAgD4=";

TEST(GltfDraco, PartsHaveTexturesToo) {
  const test::TemporaryFolder folder;
  folder.write("skin.png", four_colours());
  const std::string json = fmt::format(
      R"({{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{0},"uri":"data:application/octet-stream;base64,{1}"}}],)"
      R"("bufferViews":[{{"buffer":0,"byteLength":{0}}}],"accessors":[{{"componentType":5126,"count":3,"type":"VEC3"}}],)"
      R"("images":[{{"uri":"skin.png"}}],"textures":[{{"source":0}}],)"
      R"("materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"material":0,"extensions":)"
      R"({{"KHR_draco_mesh_compression":{{"bufferView":0,"attributes":{{"POSITION":0,"TEXCOORD_0":1}}}}}}}}]}}]}})",
      107, kDracoTriangle);
  const Mesh mesh = load(folder.write("a.gltf", json)).mesh;
  ASSERT_EQ(mesh.colours.size(), 3U);
  EXPECT_EQ(colour_at(mesh, {0, 0, 0}), kRed);
  EXPECT_EQ(colour_at(mesh, {1, 0, 0}), kGreen);
  EXPECT_EQ(colour_at(mesh, {1, 1, 0}), kGrey);
}

TEST_F(GltfTexture, ThatIsOddlyToldIsNone) {
  for (const char* material : {"5", R"({"pbrMetallicRoughness":[]})",
                               R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":-4}}})",
                               R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":"0"}}})",
                               R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":8}}})"}) {
    Gltf gltf;
    gltf.material = material;
    EXPECT_TRUE(read(gltf).mesh.colours.empty()) << material;
  }
}

}  // namespace
}  // namespace rejoin::mesh
