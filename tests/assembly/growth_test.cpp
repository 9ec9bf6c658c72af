/// What a growth amounts to, of which the best is kept.
#include <gtest/gtest.h>

#include "assembly/grow.hpp"
#include "broken_balls.hpp"

namespace rejoin::assembly::testing {
namespace {

const Box& six_pieces() {
  static const Box box = [] {
    Box made;
    made.add_ball(1.0F, 3, 6);
    return made;
  }();
  return box;
}

Growth grown(const std::vector<Link>& links) {
  std::vector<Piece> pieces;
  for (const match::Fragment& fragment : six_pieces().fragments) pieces.emplace_back(fragment);
  const Options options;
  return Grower(pieces, links, options).grow({}, Context());
}

TEST(Growth, ContactsVouchForNothingThatLinksSay) {
  double before = 0.0;
  for (const double score : {0.98, 0.995}) {
    const Growth growth = grown(six_pieces().all_true(score));
    EXPECT_EQ(growth.vouched, 0.0) << score;
    EXPECT_GT(growth.evidence, before) << score;
    before = growth.evidence;
  }
}

TEST(Growth, ContactsVouchForWhatNoLinkSays) {
  const Corner corner = corner_of(six_pieces());
  const std::vector<Link> links{six_pieces().true_link(corner.a, corner.b, 0.995),
                                six_pieces().true_link(corner.b, corner.c, 0.5)};
  EXPECT_GT(grown(links).vouched, 0.0);
}

TEST(Growth, OfTwoObjectsTheOneWithMoreLinksIsKept) {
  const Box& box = six_pieces();
  const std::vector<Link> links{
      box.true_link(3, 0, 0.995), box.true_link(3, 1, 0.995), box.false_link(0, 1, 0.9949, 0.0, 2.0),
      box.true_link(3, 5, 0.995), box.true_link(0, 5, 0.995), box.true_link(1, 5, 0.5),
      box.true_link(3, 4, 0.2),   box.true_link(0, 4, 0.2),   box.true_link(1, 4, 0.2),
      box.true_link(0, 2, 0.1),   box.true_link(1, 2, 0.1),   box.true_link(2, 4, 0.1),
      box.true_link(2, 5, 0.1)};
  const Result result = run(box, links);
  EXPECT_EQ(groups_of(result), std::set<int>{0});
  EXPECT_LT(box.worst_turn(result), 0.5);
  const Rigid of_1_on_3 = inverse(result.placements[3].pose) * result.placements[1].pose;
  EXPECT_LT(glm::distance(of_1_on_3.translation, box.truth(3, 1).translation), 0.1)
      << "a false link of equal score put it beside the ball";
}

}  // namespace
}  // namespace rejoin::assembly::testing
