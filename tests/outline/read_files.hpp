/// Files to read pieces from, in a folder that goes with the test.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.hpp"
#include "outline/read.hpp"

namespace rejoin::outline::testing {

class ReadFiles : public ::testing::Test {
 protected:
  ReadFiles() {
    folder_ = std::filesystem::temp_directory_path() / ("rejoin-read-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~ReadFiles() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::string path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }

  void expect_refusal(const std::string& name, const std::string& text, const std::string& reason) const {
    const std::string path = write(name, text);
    try {
      read_pieces(path);
      FAIL() << name;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find(path), 0U) << error.what();
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  }

  std::filesystem::path folder_;
};

inline double only_area(const PieceSet& set) {
  EXPECT_EQ(set.pieces.size(), 1U);
  return set.pieces.empty() ? 0.0 : signed_area(set.pieces[0].outline.points);
}

}  // namespace rejoin::outline::testing
