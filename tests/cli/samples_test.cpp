/// The sample fragments of meshes/, found with default settings, and from their rims.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/json_values.hpp"
#include "core/random.hpp"
#include "mesh/load.hpp"
#include "run_program.hpp"

namespace rejoin::cli::testing {
namespace {

using nlohmann::ordered_json;

struct Sample {
  const char* name;
  const char* a;
  const char* b;
  std::vector<std::string> options;
};

void PrintTo(const Sample& sample, std::ostream* out) {
  *out << sample.name;
}

class SampleTest : public ::testing::TestWithParam<Sample> {};

Rigid pose_in(const std::string& path) {
  const auto pose = rigid_from_json(ordered_json::parse(read_file(path))["pose"]);
  EXPECT_TRUE(pose.has_value()) << path;
  return pose.value_or(Rigid());
}

/// Mean distance by which a pose puts the vertices wrong.
double mean_distance(const mesh::Mesh& mesh, const Rigid& pose, const Rigid& truth) {
  double sum = 0;
  for (const glm::vec3& vertex : mesh.vertices) {
    const glm::dvec3 point = mesh.origin + glm::dvec3(vertex);
    sum += glm::distance(pose(point), truth(point));
  }
  return sum / static_cast<double>(mesh.vertices.size());
}

// The limits by which the project counts a joint as found: 5 degrees, and 2 % of the diameter (here of B, the stricter).
TEST_P(SampleTest, IsFound) {
  const std::string folder = std::string(REJOIN_SOURCE_DIR "/meshes/") + GetParam().name + "/";
  const std::string path_b = folder + GetParam().b;
  const TemporaryFolder temporary;
  std::vector<std::string> arguments{"match", folder + GetParam().a, path_b, "--json",
                                     temporary / "match.json"};
  arguments.insert(arguments.end(), GetParam().options.begin(), GetParam().options.end());
  const Finished finished = run(arguments);
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const Rigid pose = pose_in(temporary / "match.json");
  const Rigid truth = pose_in(folder + "truth.json");
  const mesh::Mesh b = mesh::load(path_b).mesh;
  EXPECT_LT(glm::degrees(angle_between(pose, truth)), 5.0);
  EXPECT_LT(mean_distance(b, pose, truth), 0.02 * mesh::diameter(b));
}

INSTANTIATE_TEST_SUITE_P(Meshes, SampleTest,
                         ::testing::Values(Sample{"block", "a.drc", "b.drc", {}},
                                           Sample{"bowl", "a.drc", "b.drc", {}},
                                           Sample{"bowl", "a.drc", "b.drc", {"--propose", "rims"}},
                                           Sample{"pot", "a.ply", "b.ply", {}}),
                         [](const auto& info) {
                           return info.param.name + std::string(info.param.options.empty() ? "" : "_by_rims");
                         });

/// Writes about one in so many of a scan's points, without normals.
void write_thinned(const std::string& scan, double every, const std::string& cloud) {
  const mesh::Mesh mesh = mesh::load(scan).mesh;
  Random random(1);
  std::string text;
  for (const glm::vec3& vertex : mesh.vertices) {
    if (random.uniform() * every >= 1) continue;
    const glm::dvec3 p = mesh.origin + glm::dvec3(vertex);
    for (const double number : {p.x, p.y, p.z}) text += std::to_string(number) + " ";
    text += "\n";
  }
  write_file(cloud, text);
}

// Its wall is 6 thick: points 6.5 apart on both sides of it are mixed up, those 4 apart are not, and those 1.3 apart suffice.
TEST(Thinned, CloudWhoseSurfacesAreMisjudgedIsToldByFacetsAndMatch) {
  const TemporaryFolder folder;
  const std::string scan = REJOIN_SOURCE_DIR "/meshes/bowl/a.drc";
  const std::string cloud = folder / "cloud.xyz";
  write_thinned(scan, 3, cloud);
  EXPECT_EQ(run({"facets", cloud}).err.find("too far apart"), std::string::npos);
  write_thinned(scan, 27, cloud);
  const std::string coarse = run({"facets", cloud}).err;
  EXPECT_EQ(coarse.find("too far apart"), std::string::npos) << coarse;
  const std::string told = "edges across the wall (";
  const std::size_t wall = coarse.find(told);
  ASSERT_NE(wall, std::string::npos) << coarse;
  EXPECT_NEAR(std::stod(coarse.substr(wall + told.size())), 6.0, 0.3);
  write_thinned(scan, 80, cloud);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"facets", cloud}, {"match", cloud, scan, "--near", folder / "near.txt"}}) {
    write_file(folder / "near.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    const Finished finished = run(command);
    EXPECT_NE(finished.err.find("cloud.xyz: its points are too far apart"), std::string::npos)
        << finished.err;
  }
}

}  // namespace
}  // namespace rejoin::cli::testing
