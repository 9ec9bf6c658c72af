#include "report/renderer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "planted.hpp"
#include "report/detail/soup.hpp"

namespace rejoin::report {
namespace {

constexpr Colour kWhite{255, 255, 255};

RenderOptions small(int width, int height) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.background = kWhite;
  return options;
}

Camera looking_down(double half_height) {
  return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, half_height, 0};
}

TEST(Renderer, BallCoversThePixelsOfItsDisc) {
  const mesh::Mesh sphere = ball(1, 48);
  const Scene scene({{&sphere, Rigid{}, {0, 0, 0}, {}, {}}});
  RenderOptions options = small(200, 200);
  options.relief = 0;  // flat black on white: brightness counts coverage
  const Image image = scene.render(looking_down(1.25), options);
  double covered = 0;
  for (const Colour& pixel : image.pixels)
    covered += 1 - detail::to_linear(static_cast<float>(pixel.r) / 255.0F);
  const double radius = 200 / 2.5;
  // The polygon of 96 sides has 0.07 % less area than the disc.
  EXPECT_NEAR(covered, std::numbers::pi * radius * radius, 0.002 * covered);
}

TEST(Renderer, BallIsLitFromTheUpperLeft) {
  const mesh::Mesh sphere = ball(1, 48);
  const Image image =
      Scene({{&sphere, Rigid{}, {200, 200, 200}, {}, {}}}).render(looking_down(1.25), small(120, 120));
  const int upper_left = image.at(40, 35).g;
  const int lower_right = image.at(85, 90).g;
  EXPECT_GT(upper_left, lower_right + 30);
  EXPECT_GT(lower_right, 20);  // the fill light and the sky reach there
}

TEST(Renderer, HalfTurnOfABallChangesNothing) {
  const mesh::Mesh sphere = ball(1, 48);
  const RenderOptions options = small(80, 80);
  const Image before =
      Scene({{&sphere, Rigid{}, {200, 180, 160}, {}, {}}}).render(looking_down(1.25), options);
  const Rigid half{axis_rotation({0, 0, 1}, std::numbers::pi), {0, 0, 0}};
  const Image after = Scene({{&sphere, half, {200, 180, 160}, {}, {}}}).render(looking_down(1.25), options);
  int worst = 0;
  for (std::size_t k = 0; k < before.pixels.size(); ++k) {
    worst = std::max(worst, std::abs(int{before.pixels[k].g} - int{after.pixels[k].g}));
  }
  EXPECT_LE(worst, 12);  // a pixel of the rim that another sample of the four covers
}

TEST(Renderer, FlatColourIsTheColourOfTheVertices) {
  mesh::Mesh square;
  square.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  square.faces = {{0, 1, 2}, {0, 2, 3}};
  RenderOptions options = small(8, 8);
  options.relief = 0;
  const Colour colour{37, 150, 201};
  const Body body{&square, Rigid{}, {0, 0, 0}, std::vector<Colour>(4, colour), {}};
  EXPECT_EQ(Scene({body}).render(looking_down(0.5), options).at(4, 4), colour);
  const Body by_face{&square, Rigid{}, {0, 0, 0}, {}, {{255, 0, 0}, {0, 0, 255}}};
  const Image image = Scene({by_face}).render(looking_down(0.5), options);
  EXPECT_EQ(image.at(6, 6), Colour(255, 0, 0));  // below the diagonal
  EXPECT_EQ(image.at(1, 1), Colour(0, 0, 255));
}

TEST(Renderer, CornerBetweenWallsIsDarkerThanTheOpenFloor) {
  mesh::Mesh room;  // a floor and a wall that meet at y = 0
  room.vertices = {{-2, 0, 0}, {2, 0, 0}, {2, -4, 0}, {-2, -4, 0}, {-2, 0, 3}, {2, 0, 3}};
  room.faces = {{0, 3, 2}, {0, 2, 1}, {0, 1, 5}, {0, 5, 4}};
  const Image image = Scene({{&room, Rigid{}, {200, 200, 200}, {}, {}}})
                          .render({{0, -1.5, 0}, {1, 0, 0}, {0, 1, 0}, 1.5, 0}, small(60, 60));
  EXPECT_LT(image.at(30, 2).g, image.at(30, 45).g - 15);
}

TEST(Renderer, SameBytesOnOneAndOnThreeThreads) {
  const Planted pair = planted_pair(20);
  const auto draw = [&](int threads) {
    const ThreadLimit limit(threads);
    const std::vector<Body> bodies{{&pair.a.surface, Rigid{}, {200, 150, 100}, {}, {}},
                                   {&pair.b.surface, pair.pose, {100, 150, 200}, {}, {}}};
    const Camera camera = fit_camera(bodies, glm::normalize(glm::dvec3(1, -2, 1)), {0, 0, 1}, 1.5, 20);
    return encode_png(Scene(bodies).render(camera, small(90, 60)));
  };
  EXPECT_EQ(draw(1), draw(3));
}

TEST(Renderer, FitCameraTouchesThePictureWithoutLeavingIt) {
  const mesh::Mesh sphere = ball(1, 48);
  const std::vector<Body> bodies{{&sphere, {glm::dmat3(1.0), {5, 6, 7}}, {0, 0, 0}, {}, {}}};
  for (const double fov : {0.0, 30.0}) {
    const Camera camera = fit_camera(bodies, {0, 0, 1}, {0, 1, 0}, 1.0, fov, 0.1);
    const Visibility seen = Scene(bodies).look(camera, 100, 100);
    int first = 100;
    for (int x = 0; x < 100; ++x) {
      for (int y = 0; y < 100; ++y) first = seen.body[y * 100 + x] == 0 ? std::min(first, x) : first;
    }
    EXPECT_NEAR(first, 10, 1) << "field of view " << fov;
  }
}

TEST(Renderer, FarAwayScanLooksTheSame) {
  mesh::Mesh near = ball(1, 24);
  mesh::Mesh far = near;
  far.origin = {5.1e6, -3.3e6, 812.5};
  const auto draw = [](const mesh::Mesh& mesh) {
    const std::vector<Body> bodies{{&mesh, Rigid{}, {180, 180, 180}, {}, {}}};
    return Scene(bodies).render(fit_camera(bodies, {0, 0, 1}, {0, 1, 0}, 1.0), small(50, 50)).pixels;
  };
  const auto one = draw(near);
  const auto other = draw(far);
  int different = 0;
  for (std::size_t k = 0; k < one.size(); ++k)
    different += std::abs(int{one[k].r} - int{other[k].r}) > 4 ? 1 : 0;
  EXPECT_LE(different, 10);  // rim pixels: the coordinates are rounded to 1e-9 of the distance
}

TEST(Renderer, CloudIsRefused) {
  mesh::Mesh cloud;
  cloud.vertices = {{0, 0, 0}};
  EXPECT_THROW(Scene({{&cloud, Rigid{}, {0, 0, 0}, {}, {}}}), InputError);
}

}  // namespace
}  // namespace rejoin::report
