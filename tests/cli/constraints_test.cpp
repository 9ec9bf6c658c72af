/// The file of rejoin assemble --constraints, good and hostile.
#include "cli/assemble_constraints.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cli/pose_file.hpp"
#include "core/error.hpp"
#include "core/random.hpp"
#include "run_program.hpp"

namespace rejoin::cli::testing {
namespace {

const std::vector<std::string> kNames{"a.ply", "b \"x\".ply", "c.ply"};

AskedConstraints read_all(const std::string& content) {
  const TemporaryFolder folder;
  const std::string path = folder / "wishes.json";
  write_file(path, content);
  return read_constraints(open_constraints(path), kNames,
                          {{"copy.ply", "is the same scan as a.ply, which stands for both"}});
}

assembly::Constraints read(const std::string& content) {
  return read_all(content).constraints;
}

TEST(ReadConstraints, FindsPairsAndPosesByName) {
  const assembly::Constraints constraints =
      read(R"({"must_join": [["c.ply", "a.ply"]], "must_not_join": [["a.ply", "b \"x\".ply"]],
               "poses": {"c.ply": [[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]}})");
  ASSERT_EQ(constraints.must_join.size(), 1U);
  EXPECT_EQ(constraints.must_join[0], (std::pair<std::size_t, std::size_t>(0, 2)));
  ASSERT_EQ(constraints.must_not_join.size(), 1U);
  EXPECT_EQ(constraints.must_not_join[0], (std::pair<std::size_t, std::size_t>(0, 1)));
  ASSERT_EQ(constraints.pinned.size(), 1U);
  EXPECT_EQ(constraints.pinned[0].first, 2U);
  EXPECT_EQ(constraints.pinned[0].second({1, 0, 0}), glm::dvec3(5, 7, 7));
}

TEST(ReadConstraints, TakesAPoseFromTheFileOfAMatrixBesideThem) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "cloudcompare");
  write_file(folder / "cloudcompare/c.txt", "0 -1 0 5\n1 0 0 6\n0 0 1 7\n0 0 0 1\n");
  write_file(folder / "wishes.json", R"({"poses": {"c.ply": "cloudcompare/c.txt"}})");
  const assembly::Constraints constraints =
      read_constraints(open_constraints(folder / "wishes.json"), kNames).constraints;
  ASSERT_EQ(constraints.pinned.size(), 1U);
  EXPECT_EQ(constraints.pinned[0].first, 2U);
  EXPECT_EQ(constraints.pinned[0].second({1, 0, 0}), glm::dvec3(5, 7, 7));
  const auto expect_refused = [&](const std::string& says) {
    try {
      read_constraints(open_constraints(folder / "wishes.json"), kNames);
      FAIL() << says;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
    }
  };
  write_file(folder / "cloudcompare/c.txt", "0 -1 0 5\n1 0 0 6\n0 0 1 7\n");
  expect_refused("c.txt: is neither JSON nor a matrix");
  write_file(folder / "cloudcompare/c.txt", "2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n");
  expect_refused("c.txt: is no rotation: products of its columns are 3 off");
  std::filesystem::remove(folder / "cloudcompare/c.txt");
  expect_refused("c.txt: cannot be");
}

TEST(ReadPose, MayHaveCommasAndComments) {
  const TemporaryFolder folder;
  write_file(folder / "m.csv", "# B to A, 7\n0,-1,0,5\n1, 0, 0, 6  # mm\n0 0 1 7\n0,0,0,1");
  EXPECT_EQ(read_pose(folder / "m.csv")({1, 0, 0}), glm::dvec3(5, 7, 7));
}

TEST(ReadPose, WithDecimalCommasTellsToWritePoints) {
  const TemporaryFolder folder;
  for (const char* rows :
       {"0,5 0 0 1,5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "# B to A\n1;0;0;-1,5e2\n0;1;0;0\n0;0;1;0\n0;0;0;1,0\n",
        "1,0 0,0 0,0 0,0\n0,0 1,0 0,0 0,0\n0,0 0,0 1,0 0,0\n0,0 0,0 0,0 1,0\n"}) {
    write_file(folder / "m.txt", rows);
    try {
      read_pose(folder / "m.txt");
      FAIL() << rows;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("m.txt: has decimal commas; write its numbers with points"),
                std::string::npos)
          << error.what();
    }
  }
}

TEST(ReadPose, MayBeginWithAByteOrderMark) {
  const TemporaryFolder folder;
  write_file(folder / "m.txt", "\xEF\xBB\xBF\x30 -1 0 5\n1 0 0 6\n0 0 1 7\n0 0 0 1\n");
  EXPECT_EQ(read_pose(folder / "m.txt")({1, 0, 0}), glm::dvec3(5, 7, 7));
  write_file(folder / "m.json",
             "\xEF\xBB\xBF{\"pose\": [[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]}");
  EXPECT_EQ(read_pose(folder / "m.json")({1, 0, 0}), glm::dvec3(5, 7, 7));
}

TEST(ReadPose, MayHaveThreeDecimals) {
  const TemporaryFolder folder;
  Random random(5);
  for (int trial = 0; trial < 100; ++trial) {
    const Rigid truth{
        axis_rotation(glm::normalize(glm::dvec3(random.normal(), random.normal(), 1)), random.uniform(-3, 3)),
        glm::dvec3(0.0)};
    std::string text;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) text += fmt::format("{:.3f} ", truth.rotation[column][row]);
      text += "7\n";
    }
    write_file(folder / "m.txt", text + "0 0 0 1\n");
    const Rigid read = read_pose(folder / "m.txt");
    EXPECT_LT(angle_between(read, truth), 0.002) << text;  // entries are off by up to 0.0005
    EXPECT_TRUE(is_rotation(read.rotation)) << text;
  }
}

TEST(ReadPose, OfAMatchIsTurnedRoundByItsPathsWhereNamesAreTheSame) {
  const TemporaryFolder folder;
  const std::string file = folder / "match.json";
  std::string doubt;
  const auto shift = [&](const std::string& told_a, const std::string& told_b, const std::string& a,
                         const std::string& b) {
    write_file(file, fmt::format(R"({{"a": {{"path": "{}"}}, "b": {{"path": "{}"}},
        "pose": [[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}})",
                                 told_a, told_b));
    doubt.clear();
    return read_pose(file, a, b, doubt).translation.x;
  };
  const std::string one = folder / "one/model.drc";
  const std::string two = folder / "two/model.drc";
  EXPECT_EQ(shift(one, two, one, two), 5);
  EXPECT_EQ(shift(one, two, two, one), -5);
  EXPECT_EQ(shift(one, two, folder / "two/../one/model.drc", two), 5);
  EXPECT_EQ(shift(one, two, two, folder / "two/../one/model.drc"), -5);
  // Told from another folder, or moved since.
  EXPECT_EQ(shift("one/model.drc", "two/model.drc", one, two), 5);
  EXPECT_EQ(shift("one/model.drc", "two/model.drc", two, one), -5);
  EXPECT_EQ(shift(one, two, "/elsewhere/two/model.drc", "/elsewhere/model.drc"), -5);
  // Names alone, of which one that is not the same tells enough.
  EXPECT_EQ(shift("x/a.ply", "x/b.ply", "y/a.ply", "z/b.ply"), 5);
  EXPECT_EQ(shift("x/a.ply", "x/b.ply", "y/b.ply", "z/a.ply"), -5);
  EXPECT_EQ(doubt, "");
  EXPECT_EQ(shift("x/c.ply", "x/d.ply", "y/b.ply", "z/a.ply"), 5) << "of others, as a rough pose may be";
  EXPECT_EQ(doubt, file + ": is the pose of x/c.ply and x/d.ply; is it of these two?");
  try {
    shift(one, two, "/elsewhere/three/model.drc", "/elsewhere/four/model.drc");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("match.json: does not tell which model.drc is A"),
              std::string::npos)
        << error.what();
  }
}

TEST(ReadPose, OfAnAssemblyTellsWhatIsNeeded) {
  const TemporaryFolder folder;
  write_file(folder / "assembly.json", R"({"schema": "rejoin.assembly/1", "fragments": {}})");
  try {
    read_pose(folder / "assembly.json");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("assembly.json: is an assembly"), std::string::npos)
        << error.what();
    EXPECT_NE(std::string(error.what()).find("inverse of A's pose times B's"), std::string::npos)
        << error.what();
  }
}

TEST(ReadConstraints, AnEmptyObjectAsksForNothing) {
  const assembly::Constraints constraints = read("{}");
  EXPECT_TRUE(constraints.must_join.empty() && constraints.must_not_join.empty() &&
              constraints.pinned.empty());
}

TEST(ReadConstraints, LeavesOutWhatNamesAFragmentThatCannotBeUsedAndTellsIt) {
  const AskedConstraints asked = read_all(R"({"must_join": [["a.ply", "copy.ply"], ["a.ply", "c.ply"]],
                   "poses": {"copy.ply": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}})");
  ASSERT_EQ(asked.constraints.must_join.size(), 1U);
  EXPECT_EQ(asked.constraints.must_join[0], (std::pair<std::size_t, std::size_t>(0, 2)));
  EXPECT_TRUE(asked.constraints.pinned.empty());
  EXPECT_EQ(asked.named.must_join, (NamedConstraints::Pairs{{"a.ply", "copy.ply"}, {"a.ply", "c.ply"}}));
  ASSERT_EQ(asked.named.poses.size(), 1U);
  EXPECT_EQ(asked.named.poses[0].first, "copy.ply");
  ASSERT_EQ(asked.left_out.size(), 2U);
  for (const char* part : {"wishes.json: \"must_join\"[0]", "copy.ply", "same scan as a.ply"})
    EXPECT_NE(asked.left_out[0].find(part), std::string::npos) << asked.left_out[0];
  EXPECT_NE(asked.left_out[1].find("\"poses\".\"copy.ply\""), std::string::npos) << asked.left_out[1];
}

TEST(ReadConstraints, CopiesAreTheFragmentsThatStandForThem) {
  const TemporaryFolder folder;
  const auto read_with_copy = [&](const std::string& content) {
    write_file(folder / "wishes.json", content);
    return read_constraints(open_constraints(folder / "wishes.json"), kNames,
                            {{"copy.ply", "is the same scan"}, {"bad.ply", "is no mesh"}},
                            {{"copy.ply", "a.ply"}, {"copy of bad.ply", "bad.ply"}});
  };
  const AskedConstraints asked = read_with_copy(
      R"({"must_join": [["copy.ply", "c.ply"]], "must_not_join": [["copy of bad.ply", "c.ply"]],
          "poses": {"copy.ply": [[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]}})");
  ASSERT_EQ(asked.constraints.must_join.size(), 1U);
  EXPECT_EQ(asked.constraints.must_join[0], (std::pair<std::size_t, std::size_t>(0, 2)));
  ASSERT_EQ(asked.constraints.pinned.size(), 1U);
  EXPECT_EQ(asked.constraints.pinned[0].first, 0U);
  ASSERT_EQ(asked.left_out.size(), 1U);
  EXPECT_NE(asked.left_out[0].find("\"bad.ply\" can have no place (is no mesh)"), std::string::npos)
      << asked.left_out[0];
  EXPECT_THROW(read_with_copy(R"({"must_join": [["copy.ply", "a.ply"]]})"), InputError);
  const std::string pose = "[[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]";
  const AskedConstraints twice =
      read_with_copy(R"({"poses": {"copy.ply": )" + pose + R"(, "a.ply": )" + pose + "}}");
  EXPECT_EQ(twice.constraints.pinned.size(), 1U) << "one fragment has one place";
  EXPECT_EQ(twice.named.poses.size(), 2U);
  try {
    read_with_copy(R"({"poses": {"a.ply": )" + pose +
                   R"(, "copy.ply": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}})");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("gives a.ply and copy.ply different poses"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(
      read_with_copy(R"({"must_join": [["copy.ply", "c.ply"]], "must_not_join": [["c.ply", "a.ply"]]})"),
      InputError);
}

struct Hostile {
  const char* name;
  const char* content;
  const char* says;  ///< part of the message
};

/// What GoogleTest and CTest show for the case.
void PrintTo(const Hostile& value, std::ostream* out) {
  *out << value.name;
}

class HostileConstraints : public ::testing::TestWithParam<Hostile> {};

TEST_P(HostileConstraints, AreRefusedWithFileAndPlace) {
  try {
    read(GetParam().content);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("wishes.json"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(GetParam().says), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Files, HostileConstraints,
    ::testing::Values(
        Hostile{"Empty", "", "no JSON"}, Hostile{"CutShort", R"({"must_join": [["a.ply")", "no JSON"},
        Hostile{"MissingComma", "{\n \"must_join\": [\n  [\"ä.ply\" \"c.ply\"]]}",
                "no JSON (line 3, column 18)"},
        Hostile{"NameWithoutItsEnding", R"({"must_join": [["c", "a.ply"]]})",
                "no fragment \"c\" (\"c.ply\"?)"},
        Hostile{"List", "[]", "no JSON object"}, Hostile{"Number", "7", "no JSON object"},
        Hostile{"UnknownKey", R"({"mustjoin": []})", "knows no \"mustjoin\""},
        Hostile{"PairsAreText", R"({"must_join": "a.ply"})", "no list of pairs"},
        Hostile{"PairOfThree", R"({"must_join": [["a.ply", "c.ply", "a.ply"]]})",
                "\"must_join\"[0] is no pair"},
        Hostile{"NameIsANumber", R"({"must_join": [["a.ply", 3]]})", "\"must_join\"[0] is no name"},
        Hostile{"Stranger", R"({"must_not_join": [["a.ply", "c.ply"], ["a.ply", "z.ply"]]})",
                "\"must_not_join\"[1]: there is no fragment \"z.ply\""},
        Hostile{"WithItself", R"({"must_join": [["a.ply", "a.ply"]]})", "same fragment twice"},
        Hostile{"Both", R"({"must_join": [["a.ply", "c.ply"]], "must_not_join": [["c.ply", "a.ply"]]})",
                "must and must not join"},
        Hostile{"BothOfACopy",
                R"({"must_join": [["a.ply", "copy.ply"]], "must_not_join": [["copy.ply", "a.ply"]]})",
                "must and must not join"},
        Hostile{"CopyWithItself", R"({"must_join": [["copy.ply", "copy.ply"]]})", "same fragment twice"},
        Hostile{"PoseGivenTwice",
                R"({"poses": {"a.ply": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], )"
                R"("a.ply": [[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}})",
                "gives \"a.ply\" twice"},
        Hostile{"PosesAreAList", R"({"poses": []})", "no object of names"},
        Hostile{"PoseOfThreeRows", R"({"poses": {"a.ply": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]}})",
                "\"poses\".\"a.ply\" is no 4 x 4 matrix"},
        Hostile{"MirroringPose",
                R"({"poses": {"a.ply": [[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}})",
                "\"poses\".\"a.ply\" is no rotation, as it mirrors"},
        Hostile{"PoseThatScales",
                R"({"poses": {"a.ply": [[1.01, 0, 0, 0], [0, 1.01, 0, 0], [0, 0, 1.01, 0], [0, 0, 0, 1]]}})",
                "are 0.02 off"},
        Hostile{"ShiftThatNoScanNeeds",
                R"({"poses": {"a.ply": [[1, 0, 0, 0], [0, 1, 0, -1e20], [0, 0, 1, 0], [0, 0, 0, 1]]}})",
                "shifts by more than 1e13"},
        Hostile{"HugeNumber",
                R"({"poses": {"a.ply": [[1e999, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}})",
                "wishes.json: is no JSON (a number is beyond"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(ReadConstraints, AMissingFileIsAnIoError) {
  EXPECT_THROW(open_constraints("/nowhere/wishes.json"), IoError);
}

}  // namespace
}  // namespace rejoin::cli::testing
