/// From poses of pairs to poses of all: which joins hold together, what belongs to which object, where everything lies.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/context.hpp"
#include "core/rigid.hpp"
#include "match/match.hpp"

namespace rejoin::assembly {

/// A pose at which two fragments may join.
struct Link {
  std::size_t a = 0;  ///< fragment numbers; a != b
  std::size_t b = 0;
  Rigid pose;        ///< b's file coordinates -> a's file coordinates
  double score = 0;  ///< how likely they join so, 0 .. 1
  bool holds =
      true;  ///< false if match::Stability casts doubt on it, or was not asked: however high the score, it needs a witness
  bool slides = false;  ///< one piece along the other: other such contacts bear no witness
};

/// What the user knows.
struct Constraints {
  std::vector<std::pair<std::size_t, std::size_t>>
      must_join;  ///< if they do not anyhow, they join at their best pose that fits, however low its score
  std::vector<std::pair<std::size_t, std::size_t>> must_not_join;  ///< never touch
  std::vector<std::pair<std::size_t, Rigid>> pinned;  ///< file coordinates -> common frame; all in one group
};

struct Options {
  double sure = 0.99;          ///< score from which a join is used without another witness
  double loop_weight = 5.0;    ///< what a second pair that agrees adds to the log-odds of a join
  double same_turn_deg = 8.0;  ///< poses of a pair that agree are turned by less against each other
  double same_shift = 0.04;    ///< and shifted by less, share of the smaller fragment's diameter
  int retries = 24;            ///< other orders that are tried where strong joins contradict each other
  Constraints constraints;
  std::map<std::pair<std::size_t, std::size_t>, std::string>
      without_pose;  ///< why pairs have no link, the smaller number first; told of those that must join
};

/// A join of the assembly.
struct Join {
  std::size_t a = 0;
  std::size_t b = 0;
  double score =
      0;  ///< of the candidate that agrees with the assembly, or without any as the contact lies there
  double contact_area = 0;  ///< squared mesh units
  double gap_median = 0;    ///< mesh units; both as in match::JointError
  bool found = false;       ///< no candidate said so: the two touch where others have put them
};

/// Where a fragment lies.
struct Placement {
  Rigid pose;             ///< file coordinates -> the group's common frame
  int group = -1;         ///< -1: placed nowhere
  double confidence = 0;  ///< 0 .. 1, from the joins that hold it
  std::string reason;  ///< why it is placed nowhere; names no fragment but by its number in brackets: "{3}"
};

struct Result {
  std::vector<Placement> placements;  ///< one a fragment
  std::vector<Join> joins;            ///< strongest first
  int groups = 0;                     ///< numbered from 0, largest first
  std::vector<std::string>
      warnings;                     ///< constraints that could not be kept; fragments as in Placement::reason
  std::vector<std::string> doubts;  ///< sure joins that part two objects; fragments likewise
  bool cancelled = false;  ///< stopped early; what is there is consistent but may be less than possible
};

/// Assembles fragments.
///
/// Poses that a pair's search missed are first added from the poses of two pairs with a common fragment, where they prove good.
/// Groups grow by the most certain join between two of them.  A join's certainty is its own log-odds, more for every other
/// pair of the two groups that has a candidate at the same pose, less for every strong candidate that contradicts.  Joins
/// that would put fragments into each other are rejected.  Where strong joins were left out, growth is tried again with
/// them first, and the assembly with most evidence is kept.  In the end all fragments of a group are aligned together.
///
/// Deterministic.  The links' order does not matter but for exact ties.
/// \param fragments  made ready by match::prepare(); open surfaces and surfaces of clouds are fine
/// \pre numbers in links and constraints are below fragments.size()
Result assemble(const std::vector<match::Fragment>& fragments, const std::vector<Link>& links,
                const Options& options, const Context& context);

}  // namespace rejoin::assembly
