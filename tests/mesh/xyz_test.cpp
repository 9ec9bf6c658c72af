// Clouds as text.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "core/error.hpp"
#include "mesh/load.hpp"
#include "shapes.hpp"

namespace rejoin::mesh {
namespace {

using test::TemporaryFolder;

TEST(Xyz, ReadsPointsWithNormalsAndColoursWhereverTheyStand) {
  const TemporaryFolder folder;
  Mesh sphere = test::sphere_cloud(1, 0.3F, 5);
  const auto row = [](const auto& v) { return fmt::format("{} {} {} ", v.x, v.y, v.z); };
  const auto text = [&](bool colours_first, const std::string& head, const std::string& extra) {
    std::string result = head;
    for (std::size_t i = 0; i < sphere.vertices.size(); ++i) {
      const std::string colour = row(glm::u8vec3(10, i % 200, 250));
      const std::string normal = row(sphere.normals[i]);
      result +=
          row(2.0F * sphere.vertices[i]) + extra + (colours_first ? colour + normal : normal + colour) + "\n";
    }
    return result;
  };
  for (const std::string& content :
       {text(false, "", ""), text(true, "//X Y Z R G B Nx Ny Nz\n", ""),
        text(false, "# made by a scanner\nx y z i nx ny nz r g b\r\n", "-17.5 ")}) {
    SCOPED_TRACE(content.substr(0, 200));
    const Loaded loaded = load(folder.write("a.xyz", content));
    EXPECT_EQ(loaded.format, "xyz");
    EXPECT_TRUE(loaded.mesh.is_cloud());
    EXPECT_TRUE(loaded.warnings.empty());
    ASSERT_EQ(loaded.mesh.vertices.size(), sphere.vertices.size());
    ASSERT_EQ(loaded.mesh.colours.size(), sphere.vertices.size());
    for (std::size_t i = 0; i < sphere.vertices.size(); ++i) {
      EXPECT_LT(glm::distance(loaded.mesh.vertices[i], 2.0F * sphere.vertices[i]), 1e-6F);
      EXPECT_LT(glm::distance(loaded.mesh.normals[i], sphere.normals[i]), 1e-5F);
      EXPECT_EQ(loaded.mesh.colours[i], glm::u8vec3(10, i % 200, 250));
    }
  }
}

TEST(Xyz, ReadsTablesWithCommasSemicolonsAndTabs) {
  const TemporaryFolder folder;
  const Mesh sphere = test::sphere_cloud(1, 0.3F, 5);
  for (const std::string separator : {",", ", ", ";", " ; ", "\t"}) {
    std::string text = fmt::format("x{0}y{0}z{0}nx{0}ny{0}nz\n", separator);
    for (std::size_t i = 0; i < sphere.vertices.size(); ++i) {
      const glm::vec3& p = sphere.vertices[i];
      const glm::vec3& n = sphere.normals[i];
      text += fmt::format("{1}{0}{2}{0}{3}{0}{4}{0}{5}{0}{6}\n", separator, p.x, p.y, p.z, n.x, n.y, n.z);
    }
    const Loaded loaded = load(folder.write("a.xyz", text));
    EXPECT_TRUE(loaded.warnings.empty()) << separator;
    ASSERT_EQ(loaded.mesh.vertices.size(), sphere.vertices.size()) << separator;
    EXPECT_EQ(loaded.mesh.vertices[7], sphere.vertices[7]) << separator;
    EXPECT_LT(glm::distance(loaded.mesh.normals[7], sphere.normals[7]), 1e-5F) << separator;
  }
}

TEST(Xyz, ReadsTheCountOfAPtsFileAndItsColoursBehindTheIntensity) {
  const TemporaryFolder folder;
  const Mesh sphere = test::sphere_cloud(1, 0.1F, 6);
  std::string text = std::to_string(sphere.vertices.size()) + "\n";
  for (const glm::vec3& p : sphere.vertices) text += fmt::format("{} {} {} 17 1 2 3\n", p.x, p.y, p.z);
  const Loaded loaded = load(folder.write("a.pts", text));
  ASSERT_EQ(loaded.mesh.vertices.size(), sphere.vertices.size());
  EXPECT_EQ(loaded.mesh.colours[7], glm::u8vec3(1, 2, 3));
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_NE(loaded.warnings[0].find("no normals"), std::string::npos) << loaded.warnings[0];
}

TEST(Xyz, TakesAFirstLineForNamesOnlyWhereItHasWords) {
  const TemporaryFolder folder;
  std::string points;
  for (const glm::vec3& p : test::sphere_cloud(1, 0.1F, 6).vertices)
    points += fmt::format("{} {} {}\n", p.x, p.y, p.z);
  const std::size_t count = load(folder.write("a.xyz", points)).mesh.vertices.size();
  for (const char* names :
       {"# 1 2 3", "// 1 2 3", "//X Y Z", "x y z", "\"X\" \"Y\" \"Z\"", "[m] [m] [m]", "东 北 高"})
    EXPECT_EQ(load(folder.write("a.xyz", fmt::format("{}\n{}", names, points))).mesh.vertices.size(), count)
        << names;
  for (const char* garbled : {"-2,71;1,2;3,4", "0.1o 0.2 0.3", "--1 0.2 0.3", "1..5 2 3", ", 1 2 3"}) {
    try {
      load(folder.write("a.xyz", fmt::format("{}\n{}", garbled, points)));
      ADD_FAILURE() << garbled;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("line 1"), std::string::npos) << error.what();
    }
  }
}

/// The points of a sphere, without the last line end.
std::string rows(const char* format) {
  std::string text;
  for (const glm::vec3& p : test::sphere_cloud(1, 0.1F, 6).vertices)
    text += fmt::format(fmt::runtime(format), 10 * p.x, 10 * p.y, 10 * p.z);
  text.pop_back();
  return text;
}

TEST(Xyz, ThatEndsWithinANumberMayBeCutShort) {
  const TemporaryFolder folder;
  for (const char* format : {"{:.6f} {:.6f} {:.6f}\n", "{:.6e},{:.6e},{:.6e}\n"}) {
    const std::string whole = rows(format);
    for (const char* end : {"", "\n", "\r\n", "\n# by hand"})
      EXPECT_EQ(load(folder.write("a.xyz", whole + end)).warnings.size(), 1U) << format << " normals alone";
    for (const std::size_t missing : {1, 4}) {
      const Loaded cut = load(folder.write("a.xyz", whole.substr(0, whole.size() - missing)));
      ASSERT_EQ(cut.warnings.size(), 2U) << format << missing;
      EXPECT_NE(cut.warnings[0].find("a.xyz: ends within a line"), std::string::npos) << cut.warnings[0];
    }
    const std::size_t second = whole.find_last_of(" ,");
    EXPECT_THROW(load(folder.write("a.xyz", whole.substr(0, second))), InputError);
  }
  // The last of these numbers is one of many with few digits, and whole ones say nothing.
  EXPECT_EQ(load(folder.write("a.xyz", rows("{:.2} {:.3} {:.1}\n"))).warnings.size(), 1U);
  EXPECT_EQ(load(folder.write("a.xyz", rows("{:.0f} {:.3f} {:.0f}\n"))).warnings.size(), 1U);
}

}  // namespace
}  // namespace rejoin::mesh
