#include "cli/outline_calibration.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "run_program.hpp"

namespace rejoin::cli::testing {
namespace {

using nlohmann::json;

/// x -> scale * R(angle) * (flipped ? (x, -y) : (x, y)) + shift, as the file has it.
struct Place {
  double angle;
  double scale;
  bool flipped;
  glm::dvec2 shift;

  glm::dvec2 operator()(const glm::dvec2& p) const {
    const double y = flipped ? -p.y : p.y;
    return scale * glm::dvec2(std::cos(angle) * p.x - std::sin(angle) * y,
                              std::sin(angle) * p.x + std::cos(angle) * y) +
           shift;
  }
  json matrix() const {
    const glm::dvec2 x = (*this)({1, 0}) - shift;
    const glm::dvec2 y = (*this)({0, 1}) - shift;
    return {{x.x, y.x, shift.x}, {x.y, y.y, shift.y}, {0, 0, 1}};
  }
};

class KnownJoins : public ::testing::Test {
 protected:
  std::vector<outline::KnownJoin> read(const json& joins) const {
    std::vector<outline::Piece> pieces(places_.size());
    json fragments;
    for (std::size_t k = 0; k < places_.size(); ++k) {
      pieces[k].name = std::string(1, static_cast<char>('a' + k));
      fragments[pieces[k].name] = {{"pose", places_[k].matrix()}};
    }
    write_file(folder_ / "known.json", json({{"fragments", fragments}, {"joins", joins}}).dump());
    return read_known_joins(folder_ / "known.json", pieces);
  }

  const TemporaryFolder folder_;
  const std::array<Place, 4> places_{
      {{0.3, 2, false, {5, -1}}, {-2.0, 2, false, {1, 7}}, {1.1, 2, true, {3, 3}}, {2.5, 2, true, {-4, 2}}}};
};

TEST_F(KnownJoins, PosesTakeBThroughTheCommonFrameToA) {
  const auto joins = read(json::array({{"a", "b"}, {"c", "d"}}));
  ASSERT_EQ(joins.size(), 2U);
  for (const outline::KnownJoin& join : joins) {
    for (const glm::dvec2& point : {glm::dvec2(0, 0), glm::dvec2(3, 1), glm::dvec2(-2, 5)}) {
      const glm::dvec2 along = places_[join.a](join.pose(point));
      const glm::dvec2 direct = places_[join.b](point);
      EXPECT_NEAR(along.x, direct.x, 1e-12) << join.a;
      EXPECT_NEAR(along.y, direct.y, 1e-12) << join.a;
    }
  }
}

TEST_F(KnownJoins, OnesWithAPieceUpsideDownAreLeftOut) {
  EXPECT_EQ(read(json::array({{"a", "c"}, {"a", "b"}})).size(), 1U);
  EXPECT_THROW(read(json::array({{"a", "c"}})), InputError);
}

}  // namespace
}  // namespace rejoin::cli::testing
