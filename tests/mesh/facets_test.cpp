#include "mesh/facets.hpp"
#include "core/angle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "core/random.hpp"
#include "facet_shapes.hpp"
#include "mesh/detail/weld.hpp"

namespace rejoin::mesh {
namespace {

using test::box;
using test::flat;
using test::shell;

TEST(Samples, DensityDoesNotDependOnTheTessellation) {
  // The box's top has 16 times as many triangles an area as a coarse box's; both get the same samples an area.
  const Mesh fine = box({40, 30, 20}, 40, flat);
  const Mesh coarse = box({40, 30, 20}, 10, flat);
  const auto few = sample_surface(coarse, 5000);
  const auto many = sample_surface(fine, 5000);
  EXPECT_NEAR(static_cast<double>(few.size()), static_cast<double>(many.size()),
              0.02 * static_cast<double>(few.size()));
  // Planes along the grid's axes fill 1 cell for every cell's face of area, others up to 1.7: the count allows for 1.5.
  EXPECT_GT(few.size(), 3000U);
  EXPECT_LT(few.size(), 6000U);
}

TEST(Samples, EveryPartOfAPlaneIsCovered) {
  const Mesh mesh = box({40, 30, 20}, 10, flat);
  const auto samples = sample_surface(mesh, 4000);
  // On a grid of twice the spacing no cell of the top may be empty.
  std::set<std::pair<int, int>> seen;
  const double cell = 2.0 * samples.spacing;
  for (const auto& p : samples.points) {
    if (p.z > 19.99F) seen.insert({static_cast<int>(p.x / cell), static_cast<int>(p.y / cell)});
  }
  const auto cells = static_cast<std::size_t>(40.0 / cell) * static_cast<std::size_t>(30.0 / cell);
  EXPECT_GE(seen.size(), cells);
}

TEST(Facets, BoxHasSixSidesWithTheirAreasAndNormals) {
  const auto s = segment(box({40, 30, 20}, 20, flat));
  ASSERT_EQ(s.facets.size(), 6U);
  const double areas[] = {1200, 1200, 800, 800, 600, 600};
  for (std::size_t k = 0; k < 6; ++k) {
    // A facet gives up at most one row of samples at its border, and takes as much from its neighbours.
    EXPECT_NEAR(s.facets[k].area, areas[k], 0.12 * areas[k]);
    const glm::dvec3 n = glm::abs(s.facets[k].normal);
    EXPECT_GT(std::max({n.x, n.y, n.z}), std::cos(2.0 * kDegree));
  }
}

TEST(Facets, BreaksThatMeetAtABluntEdgeAreTwo) {
  const double lean = 18.75 * kDegree;  // to both sides of the ridge: the breaks meet at 37.5 degrees
  const Mesh roof = box({60, 60, 30}, 30, [&](float x, float) {
    return (30.0F - std::abs(x - 30.0F)) * static_cast<float>(std::tan(lean));
  });
  int up = 0;
  for (const Facet& facet : segment(roof).facets) {
    if (facet.normal.z < 0.5) continue;
    ++up;
    EXPECT_NEAR(facet.area, 60 * 30 / std::cos(lean), 0.2 * 60 * 30);  // the edge goes to one of them
    EXPECT_NEAR(std::abs(facet.normal.x), std::sin(lean), std::sin(3.0 * kDegree));
  }
  EXPECT_EQ(up, 2);
}

/// Facets of a cut that look up (+z).
std::vector<const Facet*> looking_up(const Cut& cut) {
  std::vector<const Facet*> list;
  for (const Facet& facet : cut.facets) {
    if (facet.normal.z > 0.5) list.push_back(&facet);
  }
  return list;
}

/// A box 60 wide and deep whose top is a part of a cylinder that leans by up to `lean_deg` to both sides.
Mesh barrel(double lean_deg) {
  const double radius = 30.0 / std::sin(lean_deg * kDegree);
  return box({60, 60, 30}, 30, [&](float x, float) {
    const double aside = static_cast<double>(x) - 30.0;
    return static_cast<float>(std::sqrt(radius * radius - aside * aside) -
                              std::sqrt(radius * radius - 900.0));
  });
}

TEST(Creases, SidesThatMeetAtABluntRidgeAreTwoThatTheConeTakesForOne) {
  const double lean = 14.0 * kDegree;  // to both sides of the ridge: a bend of 28 degrees
  const Mesh roof = box({60, 60, 30}, 30, [&](float x, float) {
    return (30.0F - std::abs(x - 30.0F)) * static_cast<float>(std::tan(lean));
  });
  const Segmentation s = segment(roof);
  EXPECT_EQ(looking_up(s).size(), 1U);
  const auto sides = looking_up(s.creased);
  ASSERT_EQ(sides.size(), 2U);
  for (const Facet* side : sides) {
    EXPECT_NEAR(side->area, 60 * 30 / std::cos(lean), 0.2 * 60 * 30);  // the edge goes to one of them
    EXPECT_NEAR(std::abs(side->normal.x), std::sin(lean), std::sin(3.0 * kDegree));
  }
}

TEST(Creases, SmoothBendIsOneFacetUntilItsNormalsSpreadTooFar) {
  EXPECT_EQ(looking_up(segment(barrel(30.0)).creased).size(), 1U);
  // sin(x)/x of an arc of +-60 degrees is 0.83: its normals spread by 0.17, those of a cap of 30 degrees by 0.067.
  EXPECT_GT(looking_up(segment(barrel(60.0)).creased).size(), 1U);
}

TEST(Creases, WavesAreNone) {
  // Slopes up to 0.35 to and fro: neighbouring flanks bend by up to 39 degrees, but as much down as up along their borders.
  const auto waves = [](float x, float y) { return 0.7F * std::sin(0.5F * x) * std::sin(0.5F * y + 0.3F); };
  const Segmentation s = segment(box({60, 60, 30}, 60, waves));
  const auto top = looking_up(s.creased);
  ASSERT_EQ(top.size(), 1U);
  EXPECT_GT(top.front()->area, 0.9 * 60 * 60);
}

TEST(Creases, EverySampleIsInOneFacetAtMost) {
  const Segmentation s = segment(barrel(60.0));
  std::vector<int> seen(s.samples.size(), -1);
  std::size_t in_facets = 0;
  for (std::size_t f = 0; f < s.creased.facets.size(); ++f) {
    for (const auto i : s.creased.facets[f].samples) {
      EXPECT_EQ(seen[i], -1);
      seen[i] = static_cast<int>(f);
      ++in_facets;
    }
  }
  EXPECT_EQ(seen, s.creased.facet_of_sample);
  EXPECT_GT(in_facets, s.samples.size() * 95 / 100);
}

TEST(Creases, ThinWallsHaveNoSecondCut) {
  EXPECT_TRUE(segment(shell(60, 40)).creased.facets.empty());
}

TEST(Facets, RoughSideIsTheRoughest) {
  const auto rough = [](float x, float y) {
    return 0.25F * std::sin(2.1F * x + 0.3F) * std::sin(1.7F * y + x);
  };
  const auto s = segment(box({40, 30, 20}, 40, rough));
  const Facet* roughest = &s.facets.front();
  for (const auto& facet : s.facets) {
    if (facet.roughness > roughest->roughness) roughest = &facet;
  }
  EXPECT_GT(roughest->normal.z, 0.9);
}

TEST(Facets, ShellHasItsWallThickness) {
  const auto s = segment(shell(90, 60));
  EXPECT_NEAR(s.wall_thickness, 5.0, 0.15);  // the rays' median over a wall of exactly 5
}

TEST(Facets, ShellsFractureSurfaceIsItsFourNarrowSides) {
  const auto s = segment(shell(90, 60));
  int fracture = 0;
  double area = 0;
  for (const auto& facet : s.facets) {
    if (!facet.fracture) continue;
    ++fracture;
    area += facet.area;
  }
  // Two straight ends (5 x 60) and two quarter rings (pi/4 (50^2 - 45^2)).
  const double truth = 2 * 300 + 2 * std::numbers::pi / 4 * (2500 - 2025);
  EXPECT_EQ(fracture, 4);
  EXPECT_NEAR(area, truth,
              0.25 * truth);  // a row of samples at either edge of a 5 mm strip may go either way
}

TEST(Facets, CracksOfALargeThinPlateAreFacets) {
  // A zigzag crack of seven legs, 50 mm along the plate and 30 to and fro: each is a four hundredth of the plate's surface.
  Mesh plate = box({350, 175, 4}, 70, flat);
  const auto crack = [](float x) { return 30.0F * std::abs(std::remainder(x, 100.0F)) / 50.0F; };
  for (glm::vec3& p : plate.vertices) p.y += crack(p.x) * (1.0F - p.y / 175.0F);
  const Segmentation s = segment(plate);
  ASSERT_NEAR(s.wall_thickness, 4.0, 0.1);
  const double across = s.wall_thickness / s.samples.spacing;
  EXPECT_GT(across, 4.0) << "samples across a crack";
  const double slope = 30.0 / 50.0;
  for (int leg = 0; leg < 7; ++leg) {
    const double up = leg % 2 == 0 ? slope : -slope;
    const glm::dvec3 normal = glm::normalize(glm::dvec3(up, -1.0, 0.0));
    const glm::dvec3 middle(25.0 + 50.0 * leg, 15.0, 2.0);
    const auto its = std::ranges::count_if(s.facets, [&](const Facet& facet) {
      return facet.fracture && glm::dot(facet.normal, normal) > std::cos(5.0 * kDegree) &&
             glm::distance(facet.centre, middle) < 5.0;
    });
    EXPECT_EQ(its, 1) << "leg " << leg;
  }
}

/// Share of the samples that `among` chooses which are of this class.
template <class Among>
double share_of(const Segmentation& s, Surface wanted, Among among) {
  int all = 0;
  int right = 0;
  for (std::size_t i = 0; i < s.samples.size(); ++i) {
    if (!among(s.samples.points[i])) continue;
    ++all;
    right += s.surface[i] == wanted ? 1 : 0;
  }
  EXPECT_GT(all, 200);
  return right / static_cast<double>(std::max(1, all));
}

/// What is left of a handle: a round stump, all of whose sides together are as large as a facet, none of them alone.
TEST(Facets, StumpAmidAWallIsABreak) {
  const float radius = 4.5F;
  const glm::vec3 middle(50, 40, 5);
  const Mesh plate = test::box({100, 80, 5}, 240, [&](float x, float y) {
    const float across = std::hypot(x - middle.x, y - middle.y);
    return across < radius ? std::sqrt(radius * radius - across * across) : 0.0F;
  });
  const Segmentation s = segment(plate);
  const auto is_stump = [&](const Facet& f) {
    return f.fracture && glm::distance(f.centre, glm::dvec3(middle)) < static_cast<double>(radius);
  };
  ASSERT_EQ(std::ranges::count_if(s.facets, is_stump), 1);
  const Facet& stump = *std::ranges::find_if(s.facets, is_stump);
  EXPECT_GT(stump.normal.z, 0.99);
  EXPECT_GT(stump.area, 0.5 * 2 * std::numbers::pi * radius * radius);  // its steep foot may be missing
}

TEST(Facets, BreakThatRunsAskewThroughAWallIsNoWall) {
  // A plate whose two ends lean by 55 degrees: behind a break lies the wall, leaning by 35, at some place as far as the wall is thick.
  const float lean = 1.43F;
  Mesh plate = box({80, 60, 6}, 80, flat);
  for (glm::vec3& p : plate.vertices) p.x += lean * p.z;
  const Segmentation s = segment(plate);
  ASSERT_NEAR(s.wall_thickness, 6.0, 0.1);
  const auto end = [&](const glm::vec3& p) { return std::min(p.x - lean * p.z, 80.0F - p.x + lean * p.z); };
  const auto in_middle = [](const glm::vec3& p) { return p.y > 8.0F && p.y < 52.0F; };
  EXPECT_GT(share_of(s, Surface::Fracture,
                     [&](const glm::vec3& p) {
                       return in_middle(p) && end(p) < 0.01F && p.z > 0.8F && p.z < 5.2F;
                     }),
            0.97);
}

/// A plate of 60 across, as thick as this at every place along it.
template <class Thickness>
Mesh plate_as_thick_as(float length, Thickness thickness) {
  Mesh plate = box({length, 60, 1}, 80, flat);
  for (glm::vec3& p : plate.vertices) p.z *= thickness(p.x);
  return plate;
}

/// Expects that its sides are walls and its ends breaks.
template <class Thickness>
void expect_walls(const Segmentation& s, float length, Thickness thickness) {
  const auto off_ends = [&](const glm::vec3& p) { return std::min({p.x, length - p.x, p.y, 60.0F - p.y}); };
  const auto off_walls = [&](const glm::vec3& p) { return std::min(p.z, thickness(p.x) - p.z); };
  EXPECT_GT(share_of(s, Surface::Original, [&](const glm::vec3& p) { return off_ends(p) > 2.0F; }), 0.99);
  EXPECT_GT(share_of(s, Surface::Fracture,
                     [&](const glm::vec3& p) { return off_ends(p) < 0.01F && off_walls(p) > 1.0F; }),
            0.97);
}

/// From 0 to 1 between two places, without a crease.
float smooth_step(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

TEST(Facets, WallThatThickensIsNoBreak) {
  // As towards a vessel's foot.
  const auto thickness = [](float x) { return 6.0F + 10.0F * smooth_step(35.0F, 55.0F, x); };
  const Segmentation s = segment(plate_as_thick_as(80.0F, thickness));
  ASSERT_NEAR(s.wall_thickness, 6.0, 0.3);
  expect_walls(s, 80.0F, thickness);
}

TEST(Facets, WallMuchThinnerThanMostIsNoBreak) {
  // As of a piece of the foot itself.
  const auto thickness = [](float x) { return 16.0F - 10.0F * smooth_step(50.0F, 70.0F, x); };
  const Segmentation s = segment(plate_as_thick_as(95.0F, thickness));
  ASSERT_NEAR(s.wall_thickness, 16.0, 0.5);
  expect_walls(s, 95.0F, thickness);
}

TEST(Facets, FlanksOfThrowingRidgesAreNoBreaks) {
  // Three of them, on one side; their slopes lean by up to 34 degrees.
  const auto thickness = [](float x) {
    const bool ridged = x > 25.0F && x < 52.0F;
    return 6.0F + (ridged ? 1.0F - std::cos(2.0F * std::numbers::pi_v<float> * (x - 25.0F) / 9.0F) : 0.0F);
  };
  const Segmentation s = segment(plate_as_thick_as(80.0F, thickness));
  ASSERT_NEAR(s.wall_thickness, 6.0, 0.5);
  expect_walls(s, 80.0F, thickness);
}

TEST(Facets, WallsOfANoisyScanAreWalls) {
  Mesh plate = box({80, 60, 6}, 80, flat);
  Random random(5, 0);
  for (glm::vec3& p : plate.vertices) {
    if (p.z == 0.0F || p.z == 6.0F)
      p.z += static_cast<float>(0.5 * (random.uniform() + random.uniform() - 1.0));
  }
  const Segmentation s = segment(plate);
  ASSERT_NEAR(s.wall_thickness, 6.0, 0.3);
  const auto on_wall = [](const glm::vec3& p) {
    return p.x > 2.0F && p.x < 78.0F && p.y > 2.0F && p.y < 58.0F;
  };
  EXPECT_GT(share_of(s, Surface::Original, on_wall), 0.97);
}

/// The mesh without the faces whose middle is chosen, its sides welded together.
template <class Chosen>
Mesh without(Mesh mesh, Chosen chosen) {
  detail::weld(mesh);
  std::erase_if(mesh.faces, [&](const glm::uvec3& f) {
    return chosen((mesh.vertices[f.x] + mesh.vertices[f.y] + mesh.vertices[f.z]) / 3.0F);
  });
  return mesh;
}

float around_axis(const glm::vec3& p) {
  return std::hypot(p.x, p.y);
}

/// Share of the samples of shell() whose class is right, those within a sample spacing of an edge left out.
double rightly_classed(const Segmentation& s) {
  std::size_t right = 0;
  std::size_t asked = 0;
  const auto margin = static_cast<float>(s.samples.spacing);
  for (std::size_t i = 0; i < s.samples.size(); ++i) {
    const glm::vec3 p = s.samples.points[i];
    const float r = around_axis(p);
    const float to_break = std::min({p.x, p.y, p.z, 60.0F - p.z});
    const float to_wall = std::min(50.0F - r, r - 45.0F);
    const bool broken = to_break < 0.01F;
    if ((broken ? to_wall : to_break) < margin) continue;
    ++asked;
    right += (s.surface[i] == Surface::Fracture) == broken ? 1 : 0;
  }
  return static_cast<double>(right) / static_cast<double>(asked);
}

TEST(Facets, SherdScannedFromOutsideHasItsBreaksAndTheirWidthForAWall) {
  const auto s = segment(without(shell(90, 60), [](const glm::vec3& p) { return around_axis(p) < 45.05F; }));
  EXPECT_NEAR(s.wall_thickness, 5.0, 0.75);  // a row of samples at either edge of a strip may go either way
  EXPECT_GT(rightly_classed(s), 0.98);
}

TEST(Facets, SherdScannedFromInsideHasItsBreaksToo) {
  // The middles of the outer wall's faces lie up to 0.01 inside the cylinder.
  const auto s = segment(without(shell(90, 60), [](const glm::vec3& p) { return around_axis(p) > 49.95F; }));
  EXPECT_NEAR(s.wall_thickness, 5.0, 0.75);
  EXPECT_GT(rightly_classed(s), 0.98);
}

TEST(Facets, WallWhoseOtherSideIsMissingInPartsIsNoBreak) {
  const auto s = segment(
      without(shell(90, 60), [](const glm::vec3& p) { return around_axis(p) < 45.05F && p.z > 25.0F; }));
  EXPECT_NEAR(s.wall_thickness, 5.0, 0.15);
  EXPECT_GT(rightly_classed(s), 0.98);
}

TEST(Facets, SolidPieceWithoutItsBottomIsNoSherd) {
  // A slab, whose sides are narrow and end with the scan, is one; a lump is not.
  const auto bottom = [](const glm::vec3& p) { return p.z < 0.01F; };
  EXPECT_EQ(segment(without(box({40, 30, 20}, 20, flat), bottom)).wall_thickness, 0.0);
  EXPECT_NEAR(segment(without(box({40, 30, 4}, 20, flat), bottom)).wall_thickness, 4.0, 0.6);
}

TEST(Facets, NothingDependsOnTheUnit) {
  // A power of two changes no rounding, so that everything must agree to the last bit but for squares and roots.
  const float scale = 1.0F / 1024.0F;
  const Mesh large = shell(60, 40);
  Mesh small = large;
  for (auto& v : small.vertices) v *= scale;
  const auto a = segment(large);
  const auto b = segment(small);
  ASSERT_EQ(a.facets.size(), b.facets.size());
  EXPECT_NEAR(a.wall_thickness, 1024.0 * b.wall_thickness, 1e-6);
  for (std::size_t k = 0; k < a.facets.size(); ++k) {
    EXPECT_EQ(a.facets[k].fracture, b.facets[k].fracture);
    EXPECT_NEAR(a.facets[k].area, 1024.0 * 1024.0 * b.facets[k].area, 1e-6 * a.facets[k].area);
  }
}

TEST(Facets, EveryFaceOfASideBelongsToItsFacet) {
  const Mesh mesh = box({40, 30, 20}, 20, flat);
  const auto s = segment(mesh);
  const auto facets = facet_of_faces(s, sample_of_faces(s, mesh));
  const auto normals = face_normals(mesh);
  std::size_t right = 0;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    right += facets[f] >= 0 &&
             glm::dot(glm::dvec3(normals[f]), s.facets[static_cast<std::size_t>(facets[f])].normal) > 0.9;
  }
  EXPECT_GT(right, facets.size() * 95 / 100);
}

TEST(Denser, KeepsFacetsAndSurfacesOnMoreSamples) {
  const Mesh mesh = box({40, 30, 20}, 20, flat);
  const Segmentation few = segment(mesh);
  const Segmentation many = denser(few, mesh, 0.5 * few.samples.spacing);
  EXPECT_NEAR(many.samples.spacing, 0.5 * few.samples.spacing, 0.01 * few.samples.spacing);
  EXPECT_GT(many.samples.size(), 3 * few.samples.size());
  ASSERT_EQ(many.facets.size(), few.facets.size());
  ASSERT_EQ(many.facet_of_sample.size(), many.samples.size());
  ASSERT_EQ(many.surface.size(), many.samples.size());
  std::size_t strangers = 0;  // on another side of the box than their facet
  for (std::size_t i = 0; i < many.samples.size(); ++i) {
    const int facet = many.facet_of_sample[i];
    if (facet < 0) continue;
    const glm::vec3 side(many.facets[static_cast<std::size_t>(facet)].normal);
    if (glm::dot(side, many.samples.normals[i]) < 0.7F) ++strangers;
  }
  EXPECT_LT(strangers, many.samples.size() / 50);
  EXPECT_NEAR(many.sample_area * static_cast<double>(many.samples.size()), surface_area(mesh), 1.0);
}

}  // namespace
}  // namespace rejoin::mesh
