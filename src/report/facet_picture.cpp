#include "report/facet_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/canvas.hpp"
#include "report/renderer.hpp"

namespace rejoin::report {
namespace {

constexpr int kPanel = 480;
constexpr int kTop = 64;
constexpr int kLook = 160;           // pixels a side of the view that finds where the numbers go
constexpr double kNumbered = 0.004;  // share of the view from which a facet is numbered

struct View {
  glm::dvec3 back;
  glm::dvec3 up;
};

constexpr double kLift = 0.3;  // the eye is a little above, so that edges between faces can be seen

std::array<View, 6> six_sides() {
  const glm::dvec3 x(1, 0, 0);
  const glm::dvec3 y(0, 1, 0);
  const glm::dvec3 z(0, 0, 1);
  return {{{glm::normalize(z + kLift * y), y},
           {glm::normalize(x + kLift * y), y},
           {glm::normalize(y + kLift * x), -z},
           {glm::normalize(-z + kLift * y), y},
           {glm::normalize(-x + kLift * y), y},
           {glm::normalize(-y - kLift * x), z}}};
}

/// Writes each facet's number in the middle of what is seen of it.
void draw_numbers(Image& image, const Visibility& seen, const std::vector<int>& facet_of_face,
                  const mesh::Segmentation& facets, int left, int top) {
  struct Sum {
    double x = 0;
    double y = 0;
    int count = 0;
  };
  std::vector<Sum> sums(facets.facets.size());
  for (int y = 0; y < seen.height; ++y) {
    for (int x = 0; x < seen.width; ++x) {
      const auto pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(seen.width) + static_cast<std::size_t>(x);
      const int facet = seen.body[pixel] < 0 ? -1 : facet_of_face[seen.face[pixel]];
      if (facet < 0) continue;
      Sum& sum = sums[static_cast<std::size_t>(facet)];
      sum.x += x;
      sum.y += y;
      ++sum.count;
    }
  }
  const double scale = static_cast<double>(kPanel) / kLook;
  for (std::size_t f = 0; f < sums.size(); ++f) {
    if (sums[f].count < kNumbered * kLook * kLook) continue;
    draw_text(image, left + scale * sums[f].x / sums[f].count, top + scale * sums[f].y / sums[f].count + 6,
              std::to_string(f), {12, kInk, Align::Middle, true});
  }
}

}  // namespace

Colour facet_colour(int number, const mesh::Segmentation& facets) {
  if (number < 0) return {60, 60, 60};
  if (!facets.facets[static_cast<std::size_t>(number)].fracture) return {190, 190, 190};
  const double hue =
      std::fmod(number * 0.618033988749895, 1.0) * 6.0;  // the golden ratio keeps neighbours apart
  const auto channel = [hue](double offset) {
    const double k = std::fmod(offset + hue, 6.0);
    return static_cast<std::uint8_t>(255.0 * (0.95 - 0.8 * std::clamp(std::min(k, 4.0 - k), 0.0, 1.0)));
  };
  return {channel(5.0), channel(3.0), channel(1.0)};
}

Image facet_picture(const mesh::Mesh& surface, const mesh::Segmentation& facets, const std::string& title) {
  const std::vector<int> facet_of_face = mesh::facet_of_faces(facets, surface);
  Body body;
  body.mesh = &surface;
  body.face_colours.reserve(facet_of_face.size());
  for (const int facet : facet_of_face) body.face_colours.push_back(facet_colour(facet, facets));
  const std::vector<Body> bodies{body};
  const Scene scene(bodies);
  Image image(3 * kPanel, kTop + 2 * kPanel, kPaper);
  draw_text(image, 16, 28, fitted(title, {15, kInk, Align::Left, true}, 3 * kPanel - 32),
            {15, kInk, Align::Left, true});
  const auto fractures = std::count_if(facets.facets.begin(), facets.facets.end(),
                                       [](const mesh::Facet& facet) { return facet.fracture; });
  draw_text(image, 16, 52,
            fmt::format("{} fracture facets in colour, original surface grey; {}", fractures,
                        facets.wall_thickness > 0
                            ? fmt::format("wall {} thick", short_number(facets.wall_thickness))
                            : std::string("solid")),
            {12, kFaint, Align::Left, false});
  RenderOptions options;
  options.width = options.height = kPanel;
  options.relief = 0.8;
  int panel = 0;
  for (const View& view : six_sides()) {
    const int left = (panel % 3) * kPanel;
    const int top = kTop + (panel / 3) * kPanel;
    const Camera camera = scene.overview(view.back, view.up);
    paste(image, scene.render(camera, options), left, top);
    draw_numbers(image, scene.look(camera, kLook, kLook), facet_of_face, facets, left, top);
    ++panel;
  }
  return image;
}

}  // namespace rejoin::report
