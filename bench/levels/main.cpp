// What the number of faces is worth: the slope difference at the true poses of the joins of sets with known poses, drawn with levels of detail,
// against that of the scans with all their faces.  Markdown on stdout.
//   levels SET...
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core/error.hpp"
#include "fragment_set.hpp"
#include "match/compare.hpp"
#include "mesh/surface.hpp"

namespace rejoin::bench {
namespace {

constexpr std::array<std::size_t, 6> kFaces{1'000, 2'500, 5'000, 10'000, 20'000, 40'000};
constexpr std::array kResolutions{64, 128, 256};

/// e_d of a pose; infinite where nothing overlaps.
double error_at(const mesh::Mesh& a, const mesh::Mesh& b, const match::PoseView& view, int resolution) {
  zbuffer::ViewOptions options{.resolution = resolution, .view_side = view.view_side};
  options.centre_a = glm::vec3(view.centres.a - a.origin);
  options.centre_b = glm::vec3(view.centres.b - b.origin);
  const std::array<zbuffer::ViewPair, 1> views{view.facing.view};
  std::array<zbuffer::PairScore, 1> scores;
  zbuffer::make_scorer(zbuffer::Backend::Raster, a, b, options)->score(views, scores);
  return static_cast<double>(scores[0].error);
}

mesh::Mesh level_of(const mesh::Mesh& surface, std::size_t faces) {
  return surface.faces.size() > faces ? mesh::simplify(surface, faces) : surface;
}

/// Per cent of the error with all faces, by which that of every level differs: of every join.
class Table {
 public:
  void add(const match::Fragment& a, const match::Fragment& b, const Rigid& pose) {
    const match::PoseView view = match::view_of_pose(a, b, pose);
    std::array<double, kResolutions.size()> whole{};
    for (std::size_t r = 0; r < kResolutions.size(); ++r)
      whole[r] = error_at(a.surface, b.surface, view, kResolutions[r]);
    for (std::size_t f = 0; f < kFaces.size(); ++f) {
      const mesh::Mesh level_a = level_of(a.surface, kFaces[f]);
      const mesh::Mesh level_b = level_of(b.surface, kFaces[f]);
      for (std::size_t r = 0; r < kResolutions.size(); ++r) {
        const double off = std::abs(error_at(level_a, level_b, view, kResolutions[r]) / whole[r] - 1.0);
        if (std::isfinite(off)) off_[f][r].push_back(100.0 * off);
      }
    }
  }

  void print(const std::string& name) {
    for (std::size_t f = 0; f < kFaces.size(); ++f) {
      fmt::print("| {} | {} |", name, kFaces[f]);
      for (std::vector<double>& list : off_[f]) {
        std::sort(list.begin(), list.end());
        fmt::print(" {:.1f}, {:.1f} |", list.empty() ? NAN : list[list.size() / 2],
                   list.empty() ? NAN : list.back());
      }
      fmt::print("\n");
    }
  }

 private:
  std::array<std::array<std::vector<double>, kResolutions.size()>, kFaces.size()> off_;
};

void run(const std::string& folder) {
  const FragmentSet set = read_set(folder);
  Shelf shelf(set);
  Table table;
  for (const Join& join : set.joins)
    table.add(shelf.get(join.a), shelf.get(join.b),
              inverse(set.to_world.at(join.a)) * set.to_world.at(join.b));
  table.print(set.name);
}

}  // namespace
}  // namespace rejoin::bench

int main(int count, char** arguments) {
  fmt::print(
      "| set | faces | 64 x 64: median, most % | 128 x 128 | 256 x 256 |\n| --- | ---: | ---: | ---: | ---: "
      "|\n");
  try {
    for (int k = 1; k < count; ++k) rejoin::bench::run(arguments[k]);
  } catch (const rejoin::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
