#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "core/files.hpp"
#include "shapes.hpp"
#include "zbuffer/gl/gl_backend.hpp"
#include "zbuffer/gl/path_choice.hpp"

namespace rejoin::zbuffer::gl {
namespace {

namespace fs = std::filesystem;

constexpr int kResolution = 32;

/// A variable of the environment for as long as it lives.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    const char* before = std::getenv(name);
    if (before != nullptr) before_ = before;
    set(value);
  }
  ~Variable() { set(before_ ? before_->c_str() : nullptr); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  void set(const char* value) const {
    if (value != nullptr) {
      setenv(name_, value, 1);
    } else {
      unsetenv(name_);
    }
  }
  const char* name_;
  std::optional<std::string> before_;
};

class PathChoice : public testing::Test {
 protected:
  void SetUp() override {
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = fs::path(testing::TempDir()) / ("rejoin_path_choice_" + name);
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    file_ = folder_ / "rejoin" / "opengl-ways";
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string content() const {
    std::ifstream in(file_);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
  }

  fs::path folder_;
  fs::path file_;
};

TEST_F(PathChoice, PlantedChoiceIsBelieved) {
  const auto engine = shared_engine(Backend::OsMesa);
  for (const Path planted : {Path::Pipeline, Path::Compute}) {
    remember_path(file_, choice_key(*engine, kResolution), planted);
    const std::string before = content();
    EXPECT_EQ(faster_path(engine, Backend::OsMesa, kResolution, file_), planted);
    EXPECT_EQ(content(), before);
  }
}

TEST_F(PathChoice, DamagedFileIsMeasuredAnewAndMended) {
  const auto engine = shared_engine(Backend::OsMesa);
  const ChoiceKey key = choice_key(*engine, kResolution);
  fs::create_directories(file_.parent_path());
  write_file(file_, "pipeline\t32\nnonsense\n\tpipe\t\t\t" + std::string(100, '\0'));
  EXPECT_FALSE(remembered_path(file_, key));
  const Path path = faster_path(engine, Backend::OsMesa, kResolution, file_);
  EXPECT_TRUE(path == Path::Compute || path == Path::Pipeline);
  EXPECT_EQ(remembered_path(file_, key), path);
  EXPECT_EQ(content().find("nonsense"), std::string::npos);
}

TEST_F(PathChoice, FolderThatCannotBeMadeDoesNoHarm) {
  write_file(folder_ / "rejoin", "a file where the folder should be");
  const auto engine = shared_engine(Backend::OsMesa);
  const Path path = faster_path(engine, Backend::OsMesa, kResolution, file_);
  EXPECT_TRUE(path == Path::Compute || path == Path::Pipeline);
  EXPECT_FALSE(fs::exists(file_));
  EXPECT_NO_THROW(remember_path({}, choice_key(*engine, kResolution), path));  // neither variable is set
}

TEST_F(PathChoice, EachRendererDriverAndResolutionHasItsOwnChoice) {
  const ChoiceKey one{"Chip\tA\n", "4.6 driver 1", 128};
  remember_path(file_, one, Path::Pipeline);
  for (const ChoiceKey& other :
       {ChoiceKey{"Chip B", "4.6 driver 1", 128}, ChoiceKey{"Chip\tA\n", "4.6 driver 2", 128},
        ChoiceKey{"Chip\tA\n", "4.6 driver 1", 64}}) {
    EXPECT_FALSE(remembered_path(file_, other));
    remember_path(file_, other, Path::Compute);
    EXPECT_EQ(remembered_path(file_, other), Path::Compute);
  }
  EXPECT_EQ(remembered_path(file_, one), Path::Pipeline);
  remember_path(file_, one, Path::Compute);
  EXPECT_EQ(remembered_path(file_, one), Path::Compute);
}

TEST_F(PathChoice, FileLiesInTheUsersCacheFolder) {
  const Variable home("HOME", "/home/someone");
  {
    const Variable cache("XDG_CACHE_HOME", "/var/cache/mine");
    EXPECT_EQ(choices_file(), "/var/cache/mine/rejoin/opengl-ways");
  }
  for (const char* unusable : {"", "not/absolute"}) {
    const Variable cache("XDG_CACHE_HOME", unusable);
    EXPECT_EQ(choices_file(), "/home/someone/.cache/rejoin/opengl-ways");
  }
  const Variable cache("XDG_CACHE_HOME", nullptr);
  const Variable none("HOME", nullptr);
  EXPECT_TRUE(choices_file().empty());
}

TEST_F(PathChoice, SoftwareIsNotMeasured) {
  const Variable cache("XDG_CACHE_HOME", folder_.c_str());
  const auto engine = shared_engine(Backend::OsMesa);
  remember_path(choices_file(), choice_key(*engine, kResolution), Path::Pipeline);
  EXPECT_EQ(preferred_path(engine, Backend::OsMesa, kResolution), Path::Auto);
}

}  // namespace
}  // namespace rejoin::zbuffer::gl
