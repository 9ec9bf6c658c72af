#include "report/match_pictures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "core/error.hpp"
#include "core/files.hpp"
#include "mesh/load.hpp"
#include "planted.hpp"
#include "report/colour_scale.hpp"
#include "report/joint.hpp"
#include "report/joint_panels.hpp"
#include "report/match_sheet.hpp"
#include "report/section.hpp"

namespace rejoin::report {
namespace {

/// A folder that goes when the test ends.
class Folder {
 public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "rejoin-report-XXXXXX").string();
    path_ = mkdtemp(pattern.data());
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

match::Result result_with(const Rigid& pose) {
  match::Result result;
  match::Candidate candidate;
  candidate.pose = pose;
  candidate.score = 0.8;
  result.candidates.push_back(candidate);
  result.verdict = match::Verdict::Join;
  return result;
}

/// The pose with B lifted off the cut.
Rigid lifted(const Planted& pair, double height) {
  return Rigid{glm::dmat3(1.0), {0, 0, height}} * pair.pose;
}

TEST(Joint, FindsTheAxesOfTheCut) {
  const Planted pair = planted_pair();
  const Joint joint = make_joint(pair.a.surface, pair.b.surface, pair.pose, glm::dvec3(0.0), 0.02);
  EXPECT_GT(joint.normal.z, 0.99);           // from A up to B
  EXPECT_GT(std::abs(joint.along.x), 0.98);  // the block is 2 long and 1 wide
  EXPECT_NEAR(joint.length, 2, 0.1);
  EXPECT_NEAR(joint.width, 1, 0.1);
  EXPECT_NEAR(joint.contact.gap_median, 0, 1e-6);
  EXPECT_NEAR(glm::dot(glm::cross(joint.normal, joint.along), joint.across), 1, 1e-9);
}

TEST(Joint, KeepsAKnownGapAndMarksWhatDoesNotTouch) {
  const Planted pair = planted_pair();
  const Joint joint = make_joint(pair.a.surface, pair.b.surface, lifted(pair, 0.03), glm::dvec3(0.0), 0.02);
  // The cut rises by up to 0.4, so the nearest point lies up to 7 % nearer than straight above.
  EXPECT_NEAR(joint.contact.gap_median, 0.029, 0.0015);
  EXPECT_EQ(joint.contact.penetration, 0);
  std::size_t lower_face = joint.a.vertices.size() - 1;
  EXPECT_TRUE(std::isnan(joint.gap_a[lower_face]));
  EXPECT_GE(joint.reach, joint.scale);
}

TEST(Joint, ChipsLeaveTheColoursOfTheRestAlone) {
  Planted pair = planted_pair();
  const Rigid pose = lifted(pair, 0.005);
  const auto scale = [&] {
    return make_joint(pair.a.surface, pair.b.surface, pose, glm::dvec3(0.0), 0.02).scale;
  };
  const double whole = scale();
  const glm::vec3 up = glm::transpose(pose.rotation) * glm::dvec3(0, 0, 0.05);
  for (glm::vec3& vertex : pair.b.surface.vertices) {
    const glm::dvec3 at = pose(pair.b.surface.origin + glm::dvec3(vertex));
    if (at.x > 0.5 && at.z < 0.2) vertex += up;  // a quarter of the broken face
  }
  EXPECT_EQ(scale(), whole);
  EXPECT_LT(whole, 0.05);
}

TEST(Joint, WithoutContactLooksFromOneFragmentToTheOther) {
  const Planted pair = planted_pair(20);
  const Joint joint = make_joint(pair.a.surface, pair.b.surface, lifted(pair, 5), glm::dvec3(0.0), 0.02);
  EXPECT_EQ(joint.contact.area, 0);
  EXPECT_GT(joint.normal.z, 0.99);
}

TEST(GapColours, TellOverlapTouchGapAndNothingApart) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Colour> colours = gap_colours({-1.0F, 0.0F, 1.0F, none, -9.0F}, 1.0);
  EXPECT_GT(colours[0].r, colours[0].b + 50);  // overlap: red
  EXPECT_GT(colours[2].b, colours[2].r + 50);  // apart: blue
  EXPECT_GT(colours[1].g, 230);                // touching: pale
  EXPECT_EQ(colours[3], kNoContact);
  EXPECT_EQ(colours[4], colours[0]);  // beyond the scale: the strongest
}

TEST(Section, OfABallIsACircle) {
  const mesh::Mesh sphere = ball(1, 64);
  const auto lines = section(sphere, Rigid{}, {{0, 0, 0.6}, {1, 0, 0}, {0, 1, 0}});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].front(), lines[0].back());
  for (const glm::dvec2& p : lines[0]) EXPECT_NEAR(glm::length(p), 0.8, 1e-3);
}

TEST(Section, OfAnOpenMeshIsAnOpenLine) {
  mesh::Mesh strip;
  strip.vertices = {{0, 0, -1}, {1, 0, -1}, {2, 0, -1}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}};
  strip.faces = {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {2, 5, 4}};
  const auto lines = section(strip, Rigid{}, {{0, 0, 0.1}, {1, 0, 0}, {0, 1, 0}});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NEAR(std::abs(lines[0].front().x - lines[0].back().x), 2, 1e-6);
}

TEST(Section, SlitsOfASurfaceAreClosedAndHolesAreNot) {
  const mesh::Mesh sphere = ball(1, 400);  // a face is 0.013 wide where it is cut, the cut 1.6
  const auto lines_without = [&](auto left_out) {
    mesh::Mesh rest = sphere;
    std::erase_if(rest.faces, [&](const glm::uvec3& f) {
      return left_out((rest.vertices[f.x] + rest.vertices[f.y] + rest.vertices[f.z]) / 3.0F);
    });
    EXPECT_LT(rest.faces.size(), sphere.faces.size());
    return section(rest, Rigid{}, {{0, 0, 0.6}, {1, 0, 0}, {0, 1, 0}});
  };
  const auto slit = lines_without(
      [](const glm::vec3& p) { return std::abs(p.z - 0.6F) < 0.02F && p.y > 0 && std::abs(p.x) < 0.004F; });
  ASSERT_EQ(slit.size(), 1U);
  EXPECT_EQ(slit[0].front(), slit[0].back());
  const auto hole = lines_without([](const glm::vec3& p) { return p.x > 0.7F; });
  ASSERT_EQ(hole.size(), 1U);
  EXPECT_NE(hole[0].front(), hole[0].back());
}

// The bar and its number stand on paper: of a block cut lengthwise the drawing fills the panel from side to side.
TEST(Section, LeavesRoomForTheScaleBar) {
  const Planted pair = planted_pair(24);
  const Joint joint = make_joint(pair.a.surface, pair.b.surface, pair.pose, glm::dvec3(0.0), 0.02);
  const Image image = draw_section(joint, 300, 240);
  const auto is_grey = [](Colour c) { return std::abs(c.r - c.g) < 16 && std::abs(c.g - c.b) < 16; };
  bool drawn = false;
  for (int x = 0; x < image.width; ++x) {
    for (int y = 0; y < image.height; ++y) {
      const bool grey = is_grey(image.at(x, y));
      drawn = drawn || !grey;
      EXPECT_TRUE(grey || y < 194) << x << ", " << y;
    }
  }
  EXPECT_TRUE(drawn);
}

TEST(MatchOutputs, PicturesTellTheFiguresOfTheCandidate) {
  match::Candidate candidate;
  candidate.error = {0.0545, 6.97, 6.98, 0.95, 613, 0.0513, 0.002};
  EXPECT_EQ(
      figures_line({"a", "b", match::Verdict::Join, candidate, "raster"}),
      "gap median 0.0513   penetration 0.002   contact area 613   whole fragments: slope difference 6.97 "
      "(ray cast 6.98), depth error 0.0545, map overlap 95 %   backend raster");
  const std::string note = difference_note(candidate.error, true);
  EXPECT_NE(note.find("mean 6.97"), std::string::npos) << note;
  EXPECT_NE(note.find("depth error 0.0545"), std::string::npos) << note;
}

TEST(MatchOutputs, AreWholeAndReadable) {
  const Folder folder;
  const Planted pair = planted_pair(24);
  const auto files =
      write_match_outputs(folder.path() / "deep" / "er", pair.a, pair.b, result_with(pair.pose), {64});
  EXPECT_EQ(files.size(), 7U);
  for (const auto& file : files) EXPECT_GT(std::filesystem::file_size(file), 500U) << file;
  const cv::Mat sheet = cv::imread((folder.path() / "deep/er/match.png").string());
  EXPECT_EQ(sheet.cols, 2000);
  EXPECT_EQ(sheet.rows, 1300);
  for (const char* name : {"depth_a.png", "depth_b.png", "depth_difference.png"}) {
    EXPECT_FALSE(cv::imread((folder.path() / "deep/er" / name).string()).empty()) << name;
  }
  const cv::Mat difference = cv::imread((folder.path() / "deep/er/depth_difference.png").string());
  const auto middle = difference.at<cv::Vec3b>(64 + (difference.rows - 64) / 2, (difference.cols - 130) / 2);
  EXPECT_LT(cv::norm(middle), 60) << "slopes agree at the planted pose, so the joint's middle is dark";
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path() / "deep/er"))
    ++count;
  EXPECT_EQ(count, files.size());  // nothing half-written is left behind
  const mesh::Mesh joined = mesh::load(folder.path() / "deep/er/joined.ply").mesh;
  EXPECT_NEAR(mesh::diameter(joined), std::sqrt(4 + 1 + 1.44), 0.03);  // both halves make the box again
  ASSERT_EQ(joined.colours.size(), joined.vertices.size());
  EXPECT_NE(joined.colours.front(), joined.colours.back());
}

TEST(MatchOutputs, ModelsKeepTheColoursOfAScanAndTintOneWithout) {
  const Folder folder;
  Planted pair = planted_pair(10);
  const glm::u8vec3 clay(150, 90, 60);
  pair.b.surface.colours.assign(pair.b.surface.vertices.size(), clay);
  write_match_outputs(folder.path(), pair.a, pair.b, result_with(pair.pose), {32});
  for (const char* name : {"joined.ply", "joined.glb"}) {
    const mesh::Mesh joined = mesh::load(folder.path() / name).mesh;
    ASSERT_EQ(joined.colours.size(), joined.vertices.size()) << name;
    EXPECT_EQ(std::ranges::count(joined.colours, clay), pair.b.surface.vertices.size()) << name;
  }
}

TEST(MatchOutputs, WithoutACandidateOnlyTheSearchIsShown) {
  const Folder folder;
  const Planted pair = planted_pair(10);
  const auto earlier = write_match_outputs(folder.path(), pair.a, pair.b, result_with(lifted(pair, 4)), {32});
  std::ofstream(folder.path() / "notes.txt") << "the user's own";
  const auto files = write_match_outputs(folder.path(), pair.a, pair.b, match::Result{});
  ASSERT_EQ(files.size(), 1U);
  EXPECT_EQ(files[0].filename(), "convergence.svg");
  for (const auto& file : earlier)
    EXPECT_EQ(std::filesystem::exists(file), file == files[0]) << file << " would be taken for this match's";
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "notes.txt"));
}

TEST(MatchOutputs, FragmentsThatDoNotTouchAreDrawnToo) {
  const Folder folder;
  const Planted pair = planted_pair(10);
  const auto files = write_match_outputs(folder.path(), pair.a, pair.b, result_with(lifted(pair, 4)), {32});
  EXPECT_EQ(files.size(), 7U);
}

TEST(MatchOutputs, FolderThatIsAFileIsAnIoErrorThatNamesIt) {
  const Folder folder;
  const auto path = folder.path() / "taken";
  std::ofstream(path) << "x";
  const Planted pair = planted_pair(10);
  try {
    write_match_outputs(path / "out", pair.a, pair.b, match::Result{});
    FAIL() << "nothing thrown";
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("taken/out"), std::string::npos) << error.what();
  }
}

TEST(WriteFile, LeavesNothingBehindWhenTheTargetIsAFolder) {
  const Folder folder;
  std::filesystem::create_directories(folder.path() / "x.png" / "inside");
  EXPECT_THROW(write_file(folder.path() / "x.png", "bytes"), IoError);
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++count;
  EXPECT_EQ(count, 1U);
}

}  // namespace
}  // namespace rejoin::report
