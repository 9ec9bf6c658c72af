/// Assemblies of searches that were stopped, or went on with another method.
#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "core/parallel.hpp"
#include "outline/assembly.hpp"
#include "outline/emd.hpp"
#include "outline/multiscale.hpp"
#include "planted.hpp"

namespace rejoin::outline {
namespace {

/// Finds the true joins of a row of pieces, or nothing, and cancels its context at the pair (1, 2).
class StoppedMatcher final : public Matcher {
 public:
  explicit StoppedMatcher(Context& context, const planted::Board* known = nullptr)
      : context_(context), known_(known) {}
  void prepare(const std::vector<Piece>& /*pieces*/) override {}
  PairResult match(std::size_t a, std::size_t b, const Context& /*context*/) const override {
    if (a == 1 && b == 2) context_.cancel();
    if (context_.cancelled() || known_ == nullptr || b != a + 1) return {};
    JoinCandidate join;
    join.score = 0.9;
    join.pose = inverse(known_->poses[a]) * known_->poses[b];
    return {{join}};
  }

 private:
  Context& context_;
  const planted::Board* known_;
};

TEST(Assembly, OfASearchThatWasStoppedHasTheJoinsItFound) {
  const ThreadLimit limit(1);
  const planted::Board board = planted::broken_board(3, 1, 0.05, 62);
  Context context;
  const StoppedMatcher matcher(context, &board);
  const Assembly assembly = assemble(board.pieces, matcher, {}, context);
  EXPECT_TRUE(assembly.cancelled);
  ASSERT_EQ(assembly.joins.size(), 1U);
  EXPECT_LT(misplaced(board, assembly, 0, 1), 0.3);
  EXPECT_EQ(assembly.untried, std::vector<std::size_t>{2});
}

// Of three pieces the pairs (0, 1) and (0, 2) are looked at, and (1, 2) is not.
TEST(Assembly, PiecesThatNobodyComparedAreNotSaidToFitNowhere) {
  const ThreadLimit limit(1);
  const planted::Board board = planted::broken_board(3, 1, 0.05, 62);
  Context context;
  const StoppedMatcher matcher(context);
  const Assembly assembly = assemble(board.pieces, matcher, {}, context);
  EXPECT_EQ(assembly.unplaced, std::vector<std::size_t>{0});
  EXPECT_EQ(assembly.untried, (std::vector<std::size_t>{1, 2}));
}

/// Knows how neighbours from one piece of a board to another join, and which pairs it was asked for.
class NeighbourMatcher final : public Matcher {
 public:
  NeighbourMatcher(const planted::Board& board, std::size_t first, std::size_t last)
      : board_(board), first_(first), last_(last) {}
  void prepare(const std::vector<Piece>& /*pieces*/) override {}
  PairResult match(std::size_t a, std::size_t b, const Context& /*context*/) const override {
    asked.emplace(a, b);
    if (b != a + 1 || a < first_ || b > last_) return {};
    JoinCandidate join;
    join.score = 0.9;
    join.pose = inverse(board_.poses[a]) * board_.poses[b];
    return {{join}};
  }

  mutable std::set<std::pair<std::size_t, std::size_t>> asked;

 private:
  const planted::Board& board_;
  std::size_t first_;
  std::size_t last_;
};

TEST(Assembly, ASecondSearchLooksAtWhatIsLeft) {
  const ThreadLimit limit(1);
  const planted::Board board = planted::broken_board(4, 1, 0.05, 62);
  const NeighbourMatcher first(board, 0, 2);
  NeighbourMatcher second(board, 2, 3);
  AssemblyOptions options;
  options.second = &second;
  const Assembly assembly = assemble(board.pieces, first, options, Context());
  EXPECT_EQ(second.asked, (std::set<std::pair<std::size_t, std::size_t>>{{0, 3}, {1, 3}, {2, 3}}));
  EXPECT_TRUE(assembly.unplaced.empty());
  EXPECT_LT(misplaced(board, assembly, 0, 3), 0.3);
  // What it finds alone would not do.
  options.second = nullptr;
  EXPECT_EQ(assemble(board.pieces, first, options, Context()).unplaced, std::vector<std::size_t>{3});
}

/// Ends the search at its first pair.
class CancellingMatcher final : public Matcher {
 public:
  explicit CancellingMatcher(Context& context) : context_(context) {}
  void prepare(const std::vector<Piece>& /*pieces*/) override {}
  PairResult match(std::size_t /*a*/, std::size_t /*b*/, const Context& /*context*/) const override {
    context_.cancel();
    return {};
  }

 private:
  Context& context_;
};

TEST(Assembly, OfASecondSearchThatWasStoppedHasWhatTheFirstFound) {
  const ThreadLimit limit(1);
  const planted::Board board = planted::broken_board(4, 1, 0.05, 62);
  const NeighbourMatcher first(board, 0, 2);
  Context context;
  CancellingMatcher second(context);
  AssemblyOptions options;
  options.second = &second;
  const Assembly assembly = assemble(board.pieces, first, options, context);
  EXPECT_TRUE(assembly.cancelled);
  EXPECT_EQ(assembly.joins.size(), 2U);
  EXPECT_EQ(assembly.untried, std::vector<std::size_t>{3});
  EXPECT_TRUE(assembly.unplaced.empty());
}

TEST(Assembly, ASecondSearchIsNotAskedIfNothingIsLeft) {
  const ThreadLimit limit(1);
  const planted::Board board = planted::broken_board(3, 1, 0.05, 62);
  const NeighbourMatcher first(board, 0, 2);
  NeighbourMatcher second(board, 0, 2);
  AssemblyOptions options;
  options.second = &second;
  EXPECT_EQ(assemble(board.pieces, first, options, Context()).joins.size(), 2U);
  EXPECT_TRUE(second.asked.empty());
}

}  // namespace
}  // namespace rejoin::outline
