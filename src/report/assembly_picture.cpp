#include "report/assembly_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/words.hpp"
#include "report/canvas.hpp"
#include "report/renderer.hpp"

namespace rejoin::report {
namespace {

constexpr int kView = 480;  // pixels across a view
constexpr int kViews = 4;
constexpr int kLegend = 300;  // width of the names
constexpr int kTitle = 40;
constexpr int kLine = 22;
constexpr std::size_t kMostGroups = 4;

using Row = std::vector<std::size_t>;  // of fragments

/// Groups by size, largest first; of equal size, the lower number first.
std::vector<Row> rows_of(const std::vector<PlacedFragment>& fragments) {
  std::map<int, Row> groups;
  for (std::size_t k = 0; k < fragments.size(); ++k) groups[fragments[k].group].push_back(k);
  std::vector<Row> rows;
  rows.reserve(groups.size());
  for (auto& [group, row] : groups) rows.push_back(std::move(row));
  std::stable_sort(rows.begin(), rows.end(), [](const Row& x, const Row& y) { return x.size() > y.size(); });
  if (rows.size() > kMostGroups) rows.resize(kMostGroups);
  return rows;
}

void draw_names(Image& image, const std::vector<PlacedFragment>& fragments, const Row& row, int top) {
  const int x = kViews * kView + 16;
  const auto room = static_cast<std::size_t>((kView - kLine) / kLine);
  TextStyle style;
  style.height = 11;
  for (std::size_t k = 0; k < row.size(); ++k) {
    const int y = top + kLine * (static_cast<int>(k) + 1);
    if (k + 1 >= room && row.size() > room) {
      draw_text(image, x, y, fmt::format("and {} more", row.size() - k), style);
      return;
    }
    fill(image, {x, y - 11, 14, 12}, fragments[row[k]].colour);
    draw_text(image, x + 22, y, fitted(fragments[row[k]].name, style, kLegend - 50), style);
  }
}

void draw_row(Image& image, const std::vector<PlacedFragment>& fragments, const Row& row, int top) {
  std::vector<Body> bodies;
  for (const std::size_t k : row) {
    Body body;
    body.mesh = fragments[k].mesh;
    body.pose = fragments[k].pose;
    body.colour = fragments[k].colour;
    bodies.push_back(body);
  }
  const Scene scene(bodies);
  RenderOptions options;
  options.width = kView;
  options.height = kView;
  const double s = std::sqrt(0.5);
  const glm::dvec3 backs[kViews] = {{s, 0.5, 0.5}, {-s, 0.5, -0.5}, {0, -1, 0}, {0, 0, 1}};
  for (int v = 0; v < kViews; ++v) {
    const glm::dvec3 up = v == 2 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
    const Camera camera = fit_camera(bodies, glm::normalize(backs[v]), up, 1.0);
    paste(image, scene.render(camera, options), v * kView, top);
  }
  draw_names(image, fragments, row, top);
}

}  // namespace

Image assembly_picture(const std::vector<PlacedFragment>& fragments) {
  const std::vector<Row> rows = rows_of(fragments);
  Image image(kViews * kView + kLegend, kTitle + static_cast<int>(rows.size()) * kView, kPaper);
  TextStyle title;
  title.bold = true;
  draw_text(image, 16, 28, counted(fragments.size(), "fragment") + " assembled", title);
  for (std::size_t r = 0; r < rows.size(); ++r)
    draw_row(image, fragments, rows[r], kTitle + static_cast<int>(r) * kView);
  return image;
}

void write_assembly_picture(const std::filesystem::path& path, const std::vector<PlacedFragment>& fragments) {
  write_png(path, assembly_picture(fragments));
}

}  // namespace rejoin::report
