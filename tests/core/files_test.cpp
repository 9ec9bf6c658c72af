#include "core/files.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "core/error.hpp"

namespace rejoin {
namespace {
namespace fs = std::filesystem;

class Files : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "rejoin-files-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::ptrdiff_t entries() const { return std::distance(fs::directory_iterator(folder_), {}); }

  fs::path folder_;
};

TEST_F(Files, ReadFileGivesEveryByteOfFilesAndPipes) {
  const std::string bytes("a\0b\r\n", 5);
  write_file(folder_ / "x", bytes);
  write_file(folder_ / "empty", "");
  EXPECT_EQ(read_file(folder_ / "x"), bytes);
  EXPECT_EQ(read_file(folder_ / "empty"), "");
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(pipe, std::ios::binary) << bytes; });
  EXPECT_EQ(read_file(pipe), bytes);
  writer.join();
}

TEST_F(Files, MissingFileIsToldWithTheSystemsReason) {
  try {
    static_cast<void>(read_file(folder_ / "no.png"));
    FAIL() << "a missing file was read";
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("no.png: cannot be opened (No such file or directory)"),
              std::string::npos)
        << error.what();
  }
  EXPECT_THROW(static_cast<void>(read_file(folder_)), IoError);
}

TEST_F(Files, WrittenFileHoldsTheBytesAndLeavesNothingBeside) {
  const std::string bytes("a\0b\r\n", 5);
  write_file(folder_ / "x", "an older and longer content");
  write_file(folder_ / "x", bytes);
  EXPECT_EQ(read(folder_ / "x"), bytes);
  EXPECT_EQ(entries(), 1);
}

TEST_F(Files, FileThatIsWrittenAnewKeepsItsMode) {
  for (const mode_t mode : {0640U, 0604U}) {
    write_file(folder_ / "x", "old");
    ASSERT_EQ(chmod((folder_ / "x").c_str(), mode), 0);
    write_file(folder_ / "x", "new");
    struct stat now = {};
    ASSERT_EQ(stat((folder_ / "x").c_str(), &now), 0);
    EXPECT_EQ(now.st_mode & 07777U, mode);
    EXPECT_EQ(read(folder_ / "x"), "new");
  }
}

TEST_F(Files, LinkStaysAndWhatItLeadsToIsWritten) {
  fs::create_directory(folder_ / "disk");
  write_file(folder_ / "disk" / "x", "old");
  fs::create_symlink("disk/x", folder_ / "link");
  fs::create_symlink("link", folder_ / "link to link");
  require_writable_file(folder_ / "link to link");
  write_file(folder_ / "link to link", "new");
  EXPECT_EQ(read(folder_ / "disk" / "x"), "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link to link") && fs::is_symlink(folder_ / "link"));
  fs::remove(folder_ / "disk" / "x");
  write_file(folder_ / "link", "made anew");
  EXPECT_EQ(read(folder_ / "disk" / "x"), "made anew");
}

TEST_F(Files, ReplacedFileKeepsItsModeAndItsLink) {
  fs::create_directory(folder_ / "disk");
  write_file(folder_ / "disk" / "x", "old");
  ASSERT_EQ(chmod((folder_ / "disk" / "x").c_str(), 0604), 0);
  fs::create_symlink("disk/x", folder_ / "link");
  write_file(folder_ / "made", "new");
  replace_file(folder_ / "made", folder_ / "link");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(read(folder_ / "disk" / "x"), "new");
  write_file(folder_ / "made", "newer");
  replace_file(folder_ / "made", folder_ / "disk" / "x");
  EXPECT_EQ(read(folder_ / "disk" / "x"), "newer");
  struct stat now = {};
  ASSERT_EQ(stat((folder_ / "disk" / "x").c_str(), &now), 0);
  EXPECT_EQ(now.st_mode & 07777U, 0604U);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "disk"), {}), 1);
}

TEST_F(Files, OpenFileUnderTheSystemsNameIsWrittenToAndNotReplaced) {
  write_file(folder_ / "log", "");
  const int log = open((folder_ / "log").c_str(), O_RDWR | O_CLOEXEC);
  write_file("/dev/fd/" + std::to_string(log), "lines");
  std::string lines(8, ' ');
  lines.resize(static_cast<std::size_t>(std::max<ssize_t>(0, pread(log, lines.data(), lines.size(), 0))));
  close(log);
  EXPECT_EQ(lines, "lines");
}

TEST_F(Files, RefusedFileLeavesNothing) {
  EXPECT_THROW(write_file(folder_ / "no" / "x", "bytes"), IoError);
  fs::create_directories(folder_ / "taken" / "inside");
  EXPECT_THROW(write_file(folder_ / "taken", "bytes"), IoError);
  EXPECT_THROW(require_writable_file(folder_ / "taken"), IoError);
  EXPECT_EQ(entries(), 1);
}

TEST_F(Files, FullDeviceIsAnErrorThatNamesIt) {
  try {
    write_file("/dev/full", std::string(1U << 16U, 'x'));
    FAIL() << "a full device took the bytes";
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("/dev/full"), std::string::npos);
  }
}

TEST_F(Files, ThreadsThatWriteTheSameFileLeaveOneWholeContent) {
  std::vector<std::thread> writers;
  writers.reserve(4);
  for (char c = 'a'; c < 'e'; ++c) {
    writers.emplace_back([this, c] {
      for (int k = 0; k < 50; ++k) write_file(folder_ / "x", std::string(10000, c));
    });
  }
  for (std::thread& writer : writers) writer.join();
  const std::string text = read(folder_ / "x");
  EXPECT_EQ(text, std::string(10000, text.at(0)));
  EXPECT_EQ(entries(), 1);
}

TEST_F(Files, RequiredFolderIsMadeWithItsParents) {
  require_writable_folder(folder_ / "a" / "b");
  EXPECT_TRUE(fs::is_directory(folder_ / "a" / "b"));
  EXPECT_TRUE(fs::is_empty(folder_ / "a" / "b"));
  write_file(folder_ / "file", "x");
  EXPECT_THROW(require_writable_folder(folder_ / "file"), IoError);
}

TEST_F(Files, FailedWriterLeavesTheOldFileAndNothingElse) {
  const fs::path file = folder_ / "table.csv";
  write_file(file, "old");
  EXPECT_THROW(write_file(file,
                          [](std::ostream& out) {
                            out << "half of the new";
                            throw StoreError("run.sqlite", "is damaged", "restore it");
                          }),
               StoreError);
  EXPECT_EQ(read(file), "old");
  EXPECT_EQ(entries(), 1);
}

}  // namespace
}  // namespace rejoin
