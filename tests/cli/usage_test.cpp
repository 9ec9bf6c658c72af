/// Wrong use, help and version.
#include <gtest/gtest.h>

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <sstream>

#include "core/version.hpp"
#include "run_program.hpp"

namespace rejoin::cli::testing {
namespace {

struct WrongUse {
  const char* name;
  std::vector<std::string> arguments;
  const char* says;  ///< what the message must contain
};

/// What GoogleTest and CTest show for the case.
void PrintTo(const WrongUse& value, std::ostream* out) {
  *out << value.name;
}

TEST(CommandLine, ResultsThatADiskHadNoRoomForAreNoSuccess) {
  const TemporaryFolder folder;
  const std::string errors = folder / "errors";
  for (const std::string arguments : {"info", "--version", "match --help"}) {
    const int status = std::system((REJOIN_PROGRAM " " + arguments + " > /dev/full 2> " + errors).c_str());
    EXPECT_EQ(WEXITSTATUS(status), 1) << arguments;
    EXPECT_NE(read_file(errors).find("standard output: cannot be written"), std::string::npos) << arguments;
  }
}

TEST(CommandLine, LongNamesOfPiecesAreToldAsAnyOthers) {
  const Finished finished = run({"outline", "match", std::string(100000, 'x') + "#2", "b.csv"});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.err.find("xxx: "), std::string::npos) << finished.err.substr(0, 200);
  EXPECT_TRUE(is_one_line(finished.err)) << finished.err.substr(0, 200);
}

TEST(CommandLine, OutputsThatWouldTakeWhatIsReadAreRefused) {
  const TemporaryFolder folder;
  const std::string scan = folder / "scan.ply";
  const std::string other = folder / "other.ply";
  const std::string piece = folder / "piece.csv";
  const std::string truth = folder / "truth.json";
  const std::string joined = folder / "joined.ply";
  for (const std::string& file : {scan, other, piece, truth, joined}) write_file(file, "precious");
  std::filesystem::create_directory(folder / "elsewhere");
  const std::string link = folder / "elsewhere/link.json";
  std::filesystem::create_symlink(scan, link);
  const std::vector<std::vector<std::string>> commands{
      {"match", scan, other, "--json", other},
      {"match", scan, other, "--near", truth, "--json", truth},
      {"match", joined, folder / "missing.ply", "--out", folder / "."},
      {"facets", scan, "--ply", folder / "./scan.ply"},
      {"assemble", folder / "elsewhere", "--layout", truth, "--json", truth},
      {"assemble", folder / ".", "--json", other},
      {"assemble", folder / ".", "--json", link},
      {"outline", "match", piece, other, "--json", piece},
      {"outline", "assemble", folder / "", "--json", piece},
      {"outline", "calibrate", folder / "", "--json", truth},
      {"outline", "match", piece, other, "--calibration", truth, "--json", truth}};
  for (const auto& command : commands) {
    const Finished finished = run(command);
    EXPECT_EQ(finished.exit_code, 2) << command[0];
    EXPECT_NE(finished.err.find("is read too and would be lost"), std::string::npos) << finished.err;
  }
  for (const std::string& file : {scan, other, piece, truth, joined})
    EXPECT_EQ(read_file(file), "precious") << file;
}

class WrongUseTest : public ::testing::TestWithParam<WrongUse> {};

TEST_P(WrongUseTest, IsOneLineOnStderrAndExitsWithTwo) {
  const Finished finished = run(GetParam().arguments);
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_EQ(finished.out, "");
  EXPECT_TRUE(is_one_line(finished.err)) << finished.err;
  EXPECT_NE(finished.err.find(GetParam().says), std::string::npos) << finished.err;
}

// The files need not exist: wrong use is found before any file is touched.
INSTANTIATE_TEST_SUITE_P(
    CommandLine, WrongUseTest,
    ::testing::Values(
        WrongUse{"NoCommand", {}, "--help"},
        WrongUse{"UnknownCommand", {"glue", "a.ply"}, "'glue' is no command; there are match, compare"},
        WrongUse{"UnknownOutlineCommand",
                 {"outline", "mtch", "a.png", "b.png"},
                 "'mtch' is no command; there are calibrate, match"},
        WrongUse{"HelpOfAnUnknownCommand", {"glue", "--help"}, "'glue' is no command"},
        WrongUse{"HelpOfAnUnknownOutlineCommand", {"outline", "mtch", "--help"}, "'mtch' is no command"},
        WrongUse{"NoOutlineCommand", {"outline"}, "no command"},
        WrongUse{"OutputWithoutAName", {"batch", "scans", "--out", ""}, "--out: has no name"},
        WrongUse{"FolderOfPiecesWithoutAName", {"outline", "shatter", ""}, "DIR: has no name"},
        WrongUse{"FolderOfPiecesNamedLikeAFile",
                 {"outline", "shatter", "x.png"},
                 "x.png: has the name of a file, but DIR takes a folder"},
        WrongUse{"EmptyShard", {"batch", "scans", "--out", "run", "--shard", ""}, "--shard: '' is no part"},
        WrongUse{"FolderNamedLikeAFile",
                 {"assemble", "scans", "--out", "poses.json"},
                 "poses.json: has the name of a file, but --out takes a folder"},
        WrongUse{"FirstOfTwoUnknownOptions",
                 {"match", "a.ply", "--sed", "3", "--colour"},
                 "--sed is no option of rejoin match"},
        WrongUse{"UnknownOption", {"match", "a.ply", "b.ply", "--colour"}, "--colour"},
        WrongUse{"JsonTwice",
                 {"match", "a.ply", "b.ply", "--json", "x", "--json", "y"},
                 "rejoin: --json is given twice; see rejoin match --help"},
        WrongUse{"LongWord", {"match", "a.ply", "b.ply", "--seed", std::string(100000, 'x')}, "xxx"},
        WrongUse{"NoFragments", {"match"}, "A is required"},
        WrongUse{"OneFragment", {"match", "a.ply"}, "B is required"},
        WrongUse{"ThreeFragments",
                 {"match", "a.ply", "b.ply", "c.ply"},
                 "'c.ply' is one argument more than rejoin match takes (rejoin batch matches all"},
        WrongUse{"ScansInPlaceOfTheirFolder",
                 {"batch", "a.ply", "b.ply", "--out", "run"},
                 "'b.ply' is one argument more than rejoin batch takes (name the folder of the scans)"},
        WrongUse{"SameFragmentTwice", {"match", "a.ply", "a.ply"}, "same file"},
        WrongUse{"DirectionOfLengthZero", {"match", "a.ply", "b.ply", "--direction-a", "0,0,0"}, "length 0"},
        WrongUse{
            "DirectionOfTwoNumbers", {"match", "a.ply", "b.ply", "--direction-b", "1,0"}, "--direction-b"},
        WrongUse{"DirectionNotFinite", {"match", "a.ply", "b.ply", "--direction-a", "1,nan,0"}, "1,nan,0"},
        WrongUse{"NegativeTolerance", {"match", "a.ply", "b.ply", "--tolerance", "-1"}, "0 to 45"},
        WrongUse{"LargeTolerance", {"match", "a.ply", "b.ply", "--tolerance", "46"}, "0 to 45"},
        WrongUse{"ToleranceNotANumber", {"match", "a.ply", "b.ply", "--tolerance", "nan"}, "0 to 45"},
        WrongUse{"SmallResolution", {"match", "a.ply", "b.ply", "--resolution", "7"}, "8 to 2048"},
        WrongUse{"LargeResolution", {"match", "a.ply", "b.ply", "--resolution", "4096"}, "8 to 2048"},
        WrongUse{"NoChains", {"match", "a.ply", "b.ply", "--chains", "0"}, "1 to 256"},
        WrongUse{"NegativeThreads", {"match", "a.ply", "b.ply", "--threads", "-2"}, "--threads"},
        WrongUse{"ThreadsInWords", {"info", "--threads", "two"}, "'two' is no whole number from 0 to 1024"},
        WrongUse{"UnknownBackend", {"match", "a.ply", "b.ply", "--backend", "voodoo"}, "raster"},
        WrongUse{"UnknownSearch",
                 {"match", "a.ply", "b.ply", "--search", "luck"},
                 "--search: 'luck' is none of sweep|esa"},
        WrongUse{"RimsByAnnealing",
                 {"match", "a.ply", "b.ply", "--propose", "rims", "--search", "esa"},
                 "--search"},
        WrongUse{
            "RimsWithFacets", {"match", "a.ply", "b.ply", "--propose", "rims", "--facets-a", "1"}, "facets"},
        WrongUse{"UnknownConstraint", {"match", "a.ply", "b.ply", "--constraint", "hope"}, "direction"},
        WrongUse{"HalfAMaterial", {"match", "a.ply", "b.ply", "--material-a", "0,0,1"}, "--material-b"},
        WrongUse{
            "MaterialWithoutAxes", {"match", "a.ply", "b.ply", "--constraint", "material"}, "--material-a"},
        WrongUse{"NoDirections", {"match", "a.ply", "b.ply", "--constraint", "direction"}, "--direction-a"},
        WrongUse{"DirectionWithoutConstraint",
                 {"match", "a.ply", "b.ply", "--constraint", "none", "--direction-a", "0,0,1"},
                 "--constraint none"},
        WrongUse{"MaterialWithoutConstraint",
                 {"match", "a.ply", "b.ply", "--constraint", "none", "--material-a", "0,0,1", "--material-b",
                  "0,0,1"},
                 "--constraint none"},
        WrongUse{"SeedNotANumber", {"match", "a.ply", "b.ply", "--seed", "x"}, "0 to 9223372036854775807"},
        WrongUse{"NegativeSeed", {"match", "a.ply", "b.ply", "--seed", "-1"}, "0 to 9223372036854775807"},
        WrongUse{"SeedBeyondTheDatabase",
                 {"batch", "scans", "--out", "run", "--seed", "9223372036854775808"},
                 "0 to 9223372036854775807"},
        WrongUse{"OctalSeed", {"match", "a.ply", "b.ply", "--seed", "010"}, "0 to 9223372036854775807"},
        WrongUse{"OctalChains", {"match", "a.ply", "b.ply", "--chains", "010"}, "1 to 256"},
        WrongUse{"RimsWithMaterialAndDirection",
                 {"match", "a.ply", "b.ply", "--propose", "rims", "--constraint", "material", "--material-a",
                  "0,0,1", "--material-b", "0,0,1", "--direction-a", "1,0,0"},
                 "takes no directions"},
        WrongUse{"BrokenSteps",
                 {"compare", "a.ply", "b.ply", "--pose", "p", "--steps", "1.5"},
                 "whole number from 0 to 3"},
        WrongUse{"EmptyResolution", {"match", "a.ply", "b.ply", "--resolution", ""}, "8 to 2048"},
        WrongUse{"FacetsAndDirection",
                 {"match", "a.ply", "b.ply", "--facets-b", "1", "--direction-b", "0,0,1"},
                 "--direction-b: changes nothing"},
        WrongUse{"NegativeFacet", {"match", "a.ply", "b.ply", "--facets-a", "-1"}, "--facets-a"},
        WrongUse{
            "FacetLeftOut", {"match", "a.ply", "b.ply", "--facets-a", "1,,2"}, "'1,,2' is no list of whole"},
        WrongUse{"NoFacet", {"match", "a.ply", "b.ply", "--facets-b", ""}, "--facets-b: '' is no list"},
        WrongUse{"BrokenListOfResolutions", {"bench", "--resolution", "64,"}, "'64,' is no list of whole"},
        WrongUse{"EmptyMaterial",
                 {"match", "a.ply", "b.ply", "--material-a", "", "--material-b", "0,0,1"},
                 "'' is no direction"},
        WrongUse{"EmptyScan", {"match", "a.ply", ""}, "B: is empty"},
        WrongUse{"EmptyPose", {"compare", "a.ply", "b.ply", "--pose", ""}, "--pose: is empty"},
        WrongUse{"EmptyRunAmongSeveral", {"merge", "part-1", "", "--out", "run"}, "RUN: is empty"},
        WrongUse{
            "ToleranceOfNothing", {"match", "a.ply", "b.ply", "--tolerance", "5"}, "--tolerance: has no"},
        WrongUse{"FacetsOfAnnealingWithoutConstraint",
                 {"match", "a.ply", "b.ply", "--search", "esa", "--facets-b", "1", "--constraint", "none"},
                 "--constraint none: contradicts"},
        WrongUse{"ChainsOfTheSweep",
                 {"match", "a.ply", "b.ply", "--chains", "4"},
                 "--chains: serves --search esa"},
        WrongUse{"OptionWithoutValue", {"match", "a.ply", "b.ply", "--json"}, "--json"},
        WrongUse{"CompareWithoutPose", {"compare", "a.ply", "b.ply"}, "--pose is required"},
        WrongUse{"FacetsNotPly", {"facets", "a.ply", "--ply", "a.obj"}, "--ply"},
        WrongUse{"OutlineOptionPointsToItsOwnHelp",
                 {"outline", "shatter", "pieces", "--colour"},
                 "see rejoin outline shatter --help"},
        WrongUse{"OnePieceIsNotBroken", {"outline", "shatter", "pieces", "--pieces", "1"}, "2 to 100000"},
        WrongUse{"CalibrationForAnotherMethod",
                 {"outline", "match", "a.csv", "b.csv", "--method", "lcs", "--calibration", "c.json"},
                 "serves multiscale only"},
        WrongUse{"CalibrationForAnotherAssembly",
                 {"outline", "assemble", "pieces", "--method", "emd", "--calibration", "c.json"},
                 "serves multiscale only"},
        WrongUse{"SplitWithoutFolder", {"split", "a.ply"}, "--out is required"},
        WrongUse{"SplitIntoAFile", {"split", "a.ply", "--out", "b.ply"}, "--out takes a folder"},
        WrongUse{
            "SplitCutWithoutTable", {"split", "a.ply", "--out", "o", "--cut", "1", "--table", "no"}, "--cut"},
        WrongUse{"SplitPictureNotPng", {"split", "a.ply", "--out", "o", "--png", "p.jpg"}, "--png"},
        WrongUse{"SplitTwoOutputsIntoOneFile",
                 {"split", "a.ply", "--out", "o", "--json", "p.png", "--png", "./p.png"},
                 "./p.png: is given to --json and to --png"},
        WrongUse{"BenchResolution", {"bench", "--resolution", "1"}, "--resolution"}),
    [](const auto& info) { return std::string(info.param.name); });

// What is missing then are the files.
TEST(CommandLine, ToleranceServesWhateverRestrictsPoses) {
  const std::vector<std::string> material{"--material-a", "0,0,1", "--material-b", "0,0,1"};
  const std::vector<std::string> directions{"--direction-a", "0,0,1", "--direction-b", "0,0,1"};
  for (const char* search : {"sweep", "esa"}) {
    for (const auto& more : {std::vector<std::string>{}, directions}) {
      std::vector<std::string> arguments{"match",    "a.ply", "b.ply",        "--tolerance", "5",
                                         "--search", search,  "--constraint", "material"};
      arguments.insert(arguments.end(), material.begin(), material.end());
      arguments.insert(arguments.end(), more.begin(), more.end());
      const Finished finished = run(arguments);
      EXPECT_EQ(finished.exit_code, 1) << finished.err;
      EXPECT_EQ(finished.err.find("--tolerance"), std::string::npos) << finished.err;
    }
  }
}

class HelpTest : public ::testing::TestWithParam<const char*> {};

// A terminal of 80 x 24 leaves 23 lines above the next prompt; match, with the most options, may take a few
// more.
TEST_P(HelpTest, FitsAScreen) {
  const std::string command = GetParam();
  const Finished finished = command.empty() ? run({"--help"}) : run({command, "--help"});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(finished.err, "");
  EXPECT_EQ(finished.out.rfind("Usage: rejoin", 0), 0U);
  std::istringstream lines(finished.out);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) EXPECT_LE(line.size(), 80U) << line;
  EXPECT_LE(count, 25);
}

INSTANTIATE_TEST_SUITE_P(Commands, HelpTest,
                         ::testing::Values("", "match", "compare", "facets", "assemble", "batch", "shatter",
                                           "split", "info", "bench"),
                         [](const auto& info) { return *info.param ? std::string(info.param) : "Root"; });

TEST(Help, OfACommandWithinACommandNamesTheProgram) {
  for (const char* command : {"match", "assemble", "calibrate", "shatter"}) {
    const Finished finished = run({"outline", command, "--help"});
    EXPECT_EQ(finished.out.rfind("Usage: rejoin outline " + std::string(command) + " ", 0), 0U)
        << finished.out;
  }
}

TEST(Help, OfOutlineCommandsTellsRangesOfNumbersAndDefaultsOfWords) {
  for (const char* command : {"match", "assemble", "calibrate", "shatter"}) {
    std::istringstream help(run({"outline", command, "--help"}).out);
    for (std::string line; std::getline(help, line);) {
      const bool number = std::regex_search(line, std::regex("^  --[a-z]+ (N|PX) "));
      EXPECT_TRUE(!number || std::regex_search(line, std::regex("[0-9]+ to [0-9]+"))) << line;
      const bool word = std::regex_search(line, std::regex("^  --[a-z]+ WORD "));
      EXPECT_TRUE(!word || line.back() == ')') << line;
    }
  }
}

TEST(Help, OfEveryJsonFileSaysHowItGoesToStdout) {
  const std::vector<std::vector<std::string>> commands{{"match"},
                                                       {"compare"},
                                                       {"facets"},
                                                       {"assemble"},
                                                       {"split"},
                                                       {"info"},
                                                       {"bench"},
                                                       {"outline", "match"},
                                                       {"outline", "assemble"},
                                                       {"outline", "calibrate"}};
  for (std::vector<std::string> words : commands) {
    words.emplace_back("--help");
    const std::string help = run(words).out;
    const std::size_t line = help.find("  --json FILE");
    ASSERT_NE(line, std::string::npos) << help;
    EXPECT_NE(help.substr(line, help.find('\n', line) - line).find("(-: to stdout)"), std::string::npos)
        << help;
  }
}

TEST(Help, TellsRangesOfNumbers) {
  EXPECT_NE(run({"report", "--help"}).out.find("64 to 1000000 (16000)"), std::string::npos);
  EXPECT_NE(run({"report", "--help"}).out.find("0 to 10000 (60)"), std::string::npos);
  EXPECT_NE(run({"match", "--help"}).out.find("0 to 45 (10)"), std::string::npos);
  EXPECT_NE(run({"match", "--help"}).out.find("of the random numbers (esa)"), std::string::npos);
  EXPECT_NE(run({"--help"}).out.find("0 to 1024 (0: all cores)"), std::string::npos);
}

TEST(Help, IsACommandToo) {
  const std::vector<std::vector<std::string>> commands{{}, {"match"}, {"outline"}, {"outline", "match"}};
  for (std::vector<std::string> command : commands) {
    std::vector<std::string> asked = command;
    asked.insert(asked.begin(), "help");
    command.emplace_back("--help");
    const Finished finished = run(asked);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(finished.out, run(command).out);
  }
  EXPECT_NE(run({"help", "glue"}).err.find("'glue' is no command"), std::string::npos);
}

TEST(Help, SaysWhereSeveralCanBeGiven) {
  EXPECT_NE(run({"merge", "--help"}).out.find("Usage: rejoin merge RUN... [OPTIONS]"), std::string::npos);
  EXPECT_NE(run({"assemble", "--help"}).out.find("Usage: rejoin assemble INPUT [OPTIONS]"),
            std::string::npos);
}

TEST(Version, IsTheProjectsVersionOnStdout) {
  const Finished finished = run({"--version"});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(finished.out, std::string("rejoin ") + kVersion + "\n");
}

TEST(GenerateDocs, WritesAManPageForEveryCommandAndACompletionThatBashReads) {
  const TemporaryFolder folder;
  ASSERT_EQ(run({"generate-docs", folder / "docs"}).exit_code, 0);
  for (const char* command : {"match", "compare", "facets", "assemble", "shatter", "split", "info", "bench",
                              "outline", "outline-assemble"}) {
    const std::string page = read_file(folder / ("docs/rejoin-" + std::string(command) + ".1"));
    EXPECT_NE(page.find(".SH SYNOPSIS"), std::string::npos) << command;
  }
  EXPECT_NE(read_file(folder / "docs/rejoin-match.1").find("\\-\\-direction\\-a"), std::string::npos);
  EXPECT_NE(read_file(folder / "docs/rejoin-outline.1").find("See \\fBrejoin\\-outline\\-match\\fR(1)"),
            std::string::npos);
  EXPECT_NE(read_file(folder / "docs/rejoin-outline-match.1").find("\\-\\-method"), std::string::npos);
  const std::string check = "bash -n " + (folder / "docs/rejoin.bash");
  EXPECT_EQ(std::system(check.c_str()), 0);
}

}  // namespace
}  // namespace rejoin::cli::testing
