/// Outputs that would take what is there already, and places that are made for them.
#include <SQLiteCpp/Database.h>
#include <gtest/gtest.h>

#include <sys/stat.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "planted_files.hpp"
#include "store/run.hpp"

namespace rejoin::cli::testing {
namespace {
namespace fs = std::filesystem;

/// A run of two scans and no pairs, which nothing needs to be matched for.
class Outputs : public ::testing::Test, protected PlantedFiles {
 protected:
  Outputs() {
    fs::create_directories(run_ + "/fragments");
    store::Run made = store::Run::write(run_);
    store::Fragment scan;
    std::vector<store::Fragment> scans;
    for (const std::string& path : {a, b}) {
      scan.path = path;
      scan.name = fs::path(path).filename().string();
      scan.hash = std::to_string(std::hash<std::string>()(scan.name));
      scans.push_back(scan);
    }
    made.begin({}, scans);
    for (const char* name : {"/pairs.csv", "/assembly.json", "/fragments/x.drc"})
      write_file(run_ + name, "precious");
  }

  static void expect_refused(const std::vector<std::string>& command, const std::string& output,
                             const std::string& reason) {
    const std::string before = read_file(output);
    const Finished finished = run(command);
    EXPECT_EQ(finished.exit_code, 2) << finished.err;
    EXPECT_NE(finished.err.find(output + ": " + reason), std::string::npos) << finished.err;
    EXPECT_TRUE(is_one_line(finished.err)) << finished.err;
    EXPECT_EQ(read_file(output), before) << output;
  }

  const std::string run_ = folder / "run";
};

/// An OBJ of cubes whose edges are 1 long, at some x.
std::string boxes(const std::vector<double>& places) {
  std::string text;
  for (std::size_t k = 0; k < places.size(); ++k) {
    for (int corner = 0; corner < 8; ++corner)
      text += "v " + std::to_string(places[k] + (corner & 1)) + " " + std::to_string(corner >> 1 & 1) + " " +
              std::to_string(corner >> 2) + "\n";
    for (const auto& face : {"0 2 3", "0 3 1", "4 5 7", "4 7 6", "0 1 5", "0 5 4", "2 6 7", "2 7 3", "0 4 6",
                             "0 6 2", "1 3 7", "1 7 5"}) {
      text += "f";
      for (const int at : {0, 2, 4})
        text += " " + std::to_string(8 * k + 1 + static_cast<std::size_t>(face[at] - '0'));
      text += "\n";
    }
  }
  return text;
}

TEST_F(Outputs, NoPageOrAssemblyReplacesAFileOfTheRunOrAScan) {
  for (const char* name : {"/run.sqlite", "/pairs.csv", "/assembly.json", "/fragments/x.drc"})
    expect_refused({"report", run_, "--out", run_ + name}, run_ + name, "belongs to the run");
  for (const char* name : {"/run.sqlite", "/pairs.csv", "/fragments/x.drc"})
    expect_refused({"assemble", run_, "--json", run_ + name}, run_ + name, "belongs to the run");
  expect_refused({"report", run_ + "/run.sqlite", "--out", a}, a, "is read too");
  expect_refused({"assemble", run_, "--json", b}, b, "is read too");
}

TEST_F(Outputs, JsonMayLieInTheFolderThatIsMadeForTheRest) {
  const std::string scan = folder / "missing.ply";  // ends the command once its outputs have a place
  for (const std::vector<std::string>& command : {std::vector<std::string>{"match", a, scan},
                                                  {"compare", a, scan, "--pose", scan},
                                                  {"assemble", run_}}) {
    const std::string out = folder / command[0];
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"--out", out, "--json", out + "/result.json"});
    const Finished finished = run(arguments);
    EXPECT_EQ(finished.err.find("result.json: cannot be written"), std::string::npos) << finished.err;
    EXPECT_TRUE(fs::is_directory(out)) << finished.err;
  }
}

TEST_F(Outputs, JsonUnderTheNameOfAnotherOutputIsRefused) {
  const std::string missing = folder / "missing.ply";
  const std::string piece = folder / "piece.csv";
  const std::string out = folder / "out";
  const std::vector<std::pair<std::vector<std::string>, const char*>> cases{
      {{"match", a, missing}, "/match.png"},
      {{"match", a, missing}, "/./joined.ply"},
      {{"compare", a, missing, "--pose", missing}, "/compare.png"},
      {{"assemble", run_}, "/assembled.png"},
      {{"outline", "match", piece, folder / "other.csv"}, "/joined.png"},
      {{"outline", "assemble", folder / ""}, "/pieces.png"},
      {{"outline", "assemble", folder / ""}, "/object_1.png"}};
  for (const auto& [command, name] : cases) {
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"--out", out, "--json", out + name});
    const Finished finished = run(arguments);
    EXPECT_EQ(finished.exit_code, 2) << name << ": " << finished.err;
    EXPECT_NE(finished.err.find(out + name + ": is written by --out, too"), std::string::npos)
        << finished.err;
    EXPECT_TRUE(is_one_line(finished.err)) << finished.err;
    EXPECT_FALSE(fs::exists(out)) << name;
  }
}

TEST_F(Outputs, FolderThatWasMadeForNothingGoesAgain) {
  const std::string open = folder / "open.obj";
  write_file(open, "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 9 9 1\nv 5 20 1\nf 1 2 3\nf 2 4 3\nf 3 4 5\n");
  const std::string out = folder / "out";
  for (const char* command : {"shatter", "split"}) {
    fs::remove_all(out);
    const std::string scan = std::string(command) == "split" ? folder / "missing.ply" : open;
    EXPECT_EQ(run({command, scan, "--out", out}).exit_code, 1) << command;
    EXPECT_FALSE(fs::exists(out)) << command;
    fs::create_directory(out);
    EXPECT_EQ(run({command, scan, "--out", out}).exit_code, 1) << command;
    EXPECT_TRUE(fs::exists(out)) << "it was there";
  }
}

TEST_F(Outputs, AssembleReplacesModelsOfAnAssemblyAlone) {
  const fs::path scans = folder / "boxes";
  fs::create_directory(scans);
  write_file(scans / "a.obj", boxes({0.0}));
  write_file(scans / "b.obj", boxes({9.0}));
  const std::string wishes = folder / "wishes.json";
  write_file(wishes, R"({"poses": {"a.obj": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}})");
  const std::string scan = scans / "assembled.ply";
  write_file(scan, "precious");
  const Finished refused = run({"assemble", scans, "--out", scans, "--constraints", wishes});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("assembled.ply: is of no earlier rejoin assemble"), std::string::npos)
      << refused.err;
  EXPECT_TRUE(is_one_line(refused.err)) << refused.err;
  EXPECT_EQ(read_file(scan), "precious");
  fs::create_directory(scans / "cloudcompare");
  write_file(scans / "cloudcompare/a.obj.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  const Finished again = run({"assemble", scans, "--out", scans, "--constraints", wishes});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(read_file(scan), "precious");
}

/// What the program tells that may write no file of more than `blocks` * 512 bytes, and fails by it.
std::string told_of_limit(int blocks, const std::string& arguments) {
  const std::string command =
      "ulimit -f " + std::to_string(blocks) + "; exec " REJOIN_PROGRAM " " + arguments + " --quiet 2>&1";
  FILE* program = popen(command.c_str(), "r");
  if (program == nullptr) throw std::runtime_error("no shell");
  std::string told;
  for (int c = fgetc(program); c != EOF; c = fgetc(program)) told += static_cast<char>(c);
  const int status = pclose(program);
  EXPECT_TRUE(WIFEXITED(status)) << "ended by a signal";
  EXPECT_EQ(WEXITSTATUS(status), 1);
  return told;
}

// Its picture alone is too large.
TEST_F(Outputs, OutputsOfOptionsInAFolderOfPiecesGoAsWell) {
  write_file(folder / "two.obj", boxes({0.0, 9.0}));
  const std::string pieces = folder / "two";
  fs::create_directory(pieces);
  const std::string arguments = "split " + (folder / "two.obj") + " --table no --out " + pieces + " --json " +
                                pieces + "/two.json --png " + pieces + "/two.png";
  EXPECT_NE(told_of_limit(16, arguments).find("two.png"), std::string::npos);
  EXPECT_TRUE(fs::is_empty(pieces));
}

TEST_F(Outputs, FolderOfPiecesThatWereNotAllWrittenIsEmptyAgain) {
  const std::string pieces = folder / "pieces";
  const std::string arguments = "shatter " + a + " --pieces 101 --spacing 5 --out " + pieces;
  EXPECT_NE(told_of_limit(20, arguments).find("truth.json: cannot be written"), std::string::npos);
  EXPECT_FALSE(fs::exists(pieces));
  fs::create_directory(pieces);
  told_of_limit(20, arguments);
  EXPECT_TRUE(fs::is_empty(pieces));
}

TEST_F(Outputs, WhatTheUserPutIntoTheFolderMeanwhileStaysWhereTheCommandFails) {
  const std::string open = folder / "open.obj";
  const std::string pieces = folder / "pieces";
  ASSERT_EQ(mkfifo(open.c_str(), 0600), 0);
  Running shatter({"shatter", open, "--out", pieces});
  std::ofstream pipe(open);  // waits for the program to read, which has the folder by then
  write_file(pieces + "/notes.txt", "precious");
  pipe << "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 9 9 1\nv 5 20 1\nf 1 2 3\nf 2 4 3\nf 3 4 5\n";
  pipe.close();
  EXPECT_EQ(shatter.finish().exit_code, 1);
  EXPECT_EQ(read_file(pieces + "/notes.txt"), "precious");
}

TEST_F(Outputs, FolderThatAnotherCommandWritesIsRefusedBeforeAnyWork) {
  const std::string out = folder / "out";
  const std::string slow = folder / "slow.ply";
  ASSERT_EQ(mkfifo(slow.c_str(), 0600), 0);
  Running match({"match", slow, b, "--out", out});
  std::ofstream pipe(slow);  // waits for the program to read, which holds the folder by then
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"match", a, b, "--out", out}, {"assemble", run_, "--out", out}}) {
    const Finished refused = run(command);
    EXPECT_EQ(refused.exit_code, 1) << refused.err;
    EXPECT_NE(refused.err.find(out + ": is written by another rejoin"), std::string::npos) << refused.err;
    EXPECT_TRUE(is_one_line(refused.err)) << refused.err;
  }
  pipe.close();
  match.finish();
  const Finished later = run({"match", folder / "missing.ply", b, "--out", out});
  EXPECT_NE(later.err.find("missing.ply"), std::string::npos) << later.err;
}

// The whole is held by a writer, so that the new one waits beside it.
TEST_F(Outputs, MergeThatIsEndedLeavesNoPart) {
  const std::string whole = folder / "whole";
  ASSERT_EQ(run({"merge", run_, "--out", whole}).exit_code, 0);
  SQLite::Database held(whole + "/run.sqlite", SQLite::OPEN_READWRITE);
  held.exec("BEGIN IMMEDIATE");
  Running merge({"merge", run_, "--out", whole});
  const std::string part = whole + "/merge.part";
  for (int waited = 0; !fs::exists(part) && waited < 60000; ++waited)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ASSERT_TRUE(fs::exists(part));
  merge.interrupt();
  EXPECT_EQ(merge.finish().exit_code, 130);
  EXPECT_FALSE(fs::exists(part));
}

TEST_F(Outputs, WhatIsLargerThanTheUserMayWriteIsToldAndLeavesNothing) {
  const std::string colours = folder / "colours.ply";
  const std::string told = told_of_limit(1, "facets " + a + " --ply " + colours);
  EXPECT_NE(told.find(colours), std::string::npos) << told;
  for (const auto& file : fs::directory_iterator(folder / "."))
    EXPECT_EQ(file.path().filename().string().find("colours"), std::string::npos) << file.path();
}

TEST_F(Outputs, FragmentsAreInOrderByName) {
  const std::string pieces = folder / "pieces";
  ASSERT_EQ(run({"shatter", a, "--pieces", "101", "--spacing", "5", "--out", pieces, "--quiet"}).exit_code,
            0);
  EXPECT_TRUE(fs::exists(pieces + "/fragment_000.ply"));
  EXPECT_TRUE(fs::exists(pieces + "/fragment_100.ply"));
  EXPECT_NE(read_file(pieces + "/truth.json").find("fragment_007.ply"), std::string::npos);
}

}  // namespace
}  // namespace rejoin::cli::testing
