#include "zbuffer/gl/path_choice.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <map>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/files.hpp"
#include "zbuffer/benchmark.hpp"

namespace rejoin::zbuffer::gl {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kFaces = 10000;
constexpr std::size_t kWarmUp = 16;  // poses: programs are compiled, buffers made
constexpr std::size_t kMostPoses = 8192;
constexpr int kRounds = 2;
constexpr std::chrono::milliseconds kLongEnough(20);

/// One line of the file: the way, the resolution, renderer and version, with tabs between.
std::string line_of(const ChoiceKey& key, std::string_view way) {
  const auto plain = [](std::string text) {
    std::ranges::replace_if(
        text, [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
    return text;
  };
  return std::string(way) + "\t" + std::to_string(key.resolution) + "\t" + plain(key.renderer) + "\t" +
         plain(key.version);
}

struct Entry {
  Path path;
  std::string key;  ///< what follows the way
};

std::optional<Entry> entry_of(const std::string& line) {
  for (const auto& [way, path] :
       {std::pair("compute\t", Path::Compute), std::pair("pipeline\t", Path::Pipeline)}) {
    const std::string_view start(way);
    if (line.starts_with(start) && std::ranges::count(line, '\t') == 3)
      return Entry{path, line.substr(start.size())};
  }
  return std::nullopt;
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::vector<std::string> lines;
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return lines;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string key_text(const ChoiceKey& key) {
  return line_of(key, "").substr(1);
}

/// Poses a second, in the largest batch that was needed to see it.
double speed_of(Scorer& scorer, const std::vector<ViewPair>& poses) {
  std::vector<PairScore> scores(poses.size());
  for (std::size_t count = kWarmUp;; count = std::min(2 * count, poses.size())) {
    const auto start = Clock::now();
    scorer.score(std::span(poses).first(count), std::span(scores).first(count));
    const auto spent = Clock::now() - start;
    if (spent >= kLongEnough || count == poses.size()) {
      return static_cast<double>(count) / std::chrono::duration<double>(spent).count();
    }
  }
}

Path measured_path(const std::shared_ptr<Engine>& engine, Backend backend, int resolution) {
  const mesh::Mesh a = bumpy_sphere(kFaces, 1);
  const mesh::Mesh b = bumpy_sphere(kFaces, 2);
  const std::vector<ViewPair> poses = random_poses(kMostPoses, 1);
  const std::array<Path, 2> paths = {Path::Compute, Path::Pipeline};
  std::array<std::unique_ptr<Scorer>, 2> scorers;
  std::string why_not;
  for (std::size_t k = 0; k < paths.size(); ++k) {
    try {
      scorers[k] = make_gl_scorer(engine, backend, a, b, {.resolution = resolution}, paths[k]);
      std::vector<PairScore> scores(kWarmUp);
      scorers[k]->score(std::span(poses).first(kWarmUp), scores);
    } catch (const BackendError& error) {
      scorers[k].reset();
      why_not = error.what();
    }
  }
  if (!scorers[0] && !scorers[1]) throw BackendError(engine->context().subject(), "cannot draw: " + why_not);
  std::array<double, 2> speeds{};
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t k = 0; k < paths.size(); ++k) {
      if (scorers[k]) speeds[k] = std::max(speeds[k], speed_of(*scorers[k], poses));
    }
  }
  return speeds[1] > speeds[0] ? Path::Pipeline : Path::Compute;
}

}  // namespace

ChoiceKey choice_key(const Engine& engine, int resolution) {
  return {engine.context().renderer(), engine.context().version(), resolution};
}

fs::path choices_file() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  fs::path folder = cache != nullptr ? cache : "";
  if (!folder.is_absolute()) {  // the specification says to ignore such ones
    const char* home = std::getenv("HOME");
    folder = home != nullptr && *home != '\0' ? fs::path(home) / ".cache" : fs::path();
  }
  return folder.empty() ? folder : folder / "rejoin" / "opengl-ways";
}

std::optional<Path> remembered_path(const fs::path& file, const ChoiceKey& key) {
  const std::string wanted = key_text(key);
  for (const std::string& line : lines_of(file)) {
    const auto entry = entry_of(line);
    if (entry && entry->key == wanted) return entry->path;
  }
  return std::nullopt;
}

void remember_path(const fs::path& file, const ChoiceKey& key, Path path) {
  if (file.empty()) return;
  const std::string own = key_text(key);
  std::string content;
  for (const std::string& line : lines_of(file)) {
    const auto entry = entry_of(line);
    if (entry && entry->key != own) content += line + "\n";
  }
  content += line_of(key, path == Path::Pipeline ? "pipeline" : "compute") + "\n";
  try {
    std::error_code ignored;
    fs::create_directories(file.parent_path(), ignored);
    write_file(file, content);
  } catch (const IoError&) {
    // A cache is worth no message: the choice holds for this process.
  }
}

Path faster_path(const std::shared_ptr<Engine>& engine, Backend backend, int resolution,
                 const fs::path& file) {
  const ChoiceKey key = choice_key(*engine, resolution);
  if (const auto known = remembered_path(file, key)) return *known;
  const Path path = measured_path(engine, backend, resolution);
  remember_path(file, key, path);
  return path;
}

Path preferred_path(const std::shared_ptr<Engine>& engine, Backend backend, int resolution) {
  if (engine->limits().software) return Path::Auto;
  static std::mutex guard;
  static std::map<std::string, Path> found;
  const std::lock_guard lock(guard);
  const std::string key = key_text(choice_key(*engine, resolution));
  auto place = found.find(key);
  if (place == found.end())
    place = found.emplace(key, faster_path(engine, backend, resolution, choices_file())).first;
  return place->second == Path::Pipeline ? Path::Pipeline : Path::Auto;
}

}  // namespace rejoin::zbuffer::gl
