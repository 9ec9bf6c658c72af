#include "rims/propose.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "mesh/load.hpp"
#include "rims/rim.hpp"

namespace rejoin::rims {
namespace {

match::Fragment sherd(const char* name) {
  const std::string path = std::string(REJOIN_SOURCE_DIR) + "/meshes/bowl/" + name;
  return match::prepare(path, mesh::load(path).mesh, {});
}

/// meshes/bowl/truth.json
Rigid true_pose() {
  return {glm::dmat3(0.6935989429146068, 0.6717379489820176, -0.26017039471310455,  //
                     -0.17932101711939463, -0.18879258161019524, -0.9655057399871962, -0.6976850859857946,
                     0.7163277804374129, -0.010489602785799731),
          {190.0262852794986, -291.2804423054491, -246.90542695680796}};
}

class Bowl : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    a_ = new match::Fragment(sherd("a.drc"));
    b_ = new match::Fragment(sherd("b.drc"));
  }
  static void TearDownTestSuite() {
    delete a_;
    delete b_;
  }
  static match::Fragment* a_;
  static match::Fragment* b_;
};
match::Fragment* Bowl::a_ = nullptr;
match::Fragment* Bowl::b_ = nullptr;

TEST_F(Bowl, ASherdHasARimOnEitherWallOneWallApart) {
  const std::vector<Rim> rims = find_rims(*a_, a_->facets.samples.spacing, 2.0);
  ASSERT_GE(rims.size(), 2U);
  std::vector<double> thickness;
  for (const Rim& rim : rims) {
    for (const RimPoint& point : rim.points) {
      thickness.push_back(point.thickness);
      EXPECT_NEAR(glm::length(point.along), 1.0, 1e-9);
      EXPECT_NEAR(glm::length(point.wall), 1.0, 1e-9);
      EXPECT_NEAR(glm::dot(point.along, point.wall), 0.0, 1e-9);
    }
  }
  const auto middle = thickness.begin() + static_cast<std::ptrdiff_t>(thickness.size() / 2);
  std::nth_element(thickness.begin(), middle, thickness.end());
  // Worn edges take something off the band between the rims, never add to it.
  EXPECT_GT(*middle, 0.6 * a_->facets.wall_thickness);
  EXPECT_LT(*middle, 1.1 * a_->facets.wall_thickness);
}

TEST_F(Bowl, TheTrueJoinIsAmongTheFirstFiveProposals) {
  const std::vector<Proposal> proposals = propose(*a_, *b_, {}, {});
  ASSERT_GE(proposals.size(), 5U);
  const Rigid truth = true_pose();
  const glm::dvec3 centre = b_->surface.origin + mesh::centroid(b_->surface);
  const auto right = [&](const Proposal& proposal) {
    return angle_between(proposal.pose, truth) < 0.087 &&
           glm::distance(proposal.pose(centre), truth(centre)) < 0.02 * a_->diameter;
  };
  EXPECT_TRUE(std::any_of(proposals.begin(), proposals.begin() + 5, right));
}

TEST_F(Bowl, OneThreadAndTwoProposeTheSame) {
  std::vector<std::vector<Proposal>> found;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    found.push_back(propose(*a_, *b_, {}, {}));
  }
  ASSERT_FALSE(found[0].empty());
  ASSERT_EQ(found[0].size(), found[1].size());
  for (std::size_t i = 0; i < found[0].size(); ++i) {
    const Proposal& one = found[0][i];
    const Proposal& two = found[1][i];
    EXPECT_EQ(one.pose.rotation, two.pose.rotation);
    EXPECT_EQ(one.pose.translation, two.pose.translation);
    EXPECT_EQ(one.evidence, two.evidence);
    EXPECT_EQ(one.length, two.length);
    EXPECT_EQ(one.strength, two.strength);
  }
}

}  // namespace
}  // namespace rejoin::rims
