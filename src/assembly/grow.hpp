/// Groups that grow by the most certain join.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "assembly/evidence.hpp"
#include "assembly/spread.hpp"
#include "assembly/witness.hpp"

namespace rejoin::assembly {

/// Why a join was not used.
struct Rejection {
  enum class Why { Overlap, Contradiction, Forbidden };
  std::size_t link = 0;
  Why why = Why::Overlap;
  std::size_t a =
      0;  ///< the fragments that would overlap, touch against the user's will, or whose join contradicts
  std::size_t b = 0;
};

/// Groups of fragments with poses.
struct Growth {
  std::vector<Rigid> poses;        ///< into the group's frame
  std::vector<std::size_t> group;  ///< one of the group's members stands for it
  std::vector<std::size_t> used;   ///< links that made groups one
  std::vector<double> odds;        ///< log-odds of each of them, with what other pairs add
  std::vector<Rejection>
      rejected;  ///< links above the limit that were not used, in the order they were tried
  double vouched =
      0;  ///< log-odds that contacts without links gave to the links that were used; links count in `evidence`
  double evidence = 0;  ///< log-odds of all links that agree, less those of strong ones that do not
};

/// Grows groups from the same pieces and links in different orders.
class Grower {
 public:
  /// All must outlive the object.
  Grower(const std::vector<Piece>& pieces, const std::vector<Link>& links, const Options& options);

  /// Pairs whose links go before all others from now on, best first, if they fit; none before.
  void want(const std::vector<std::pair<std::size_t, std::size_t>>& pairs);

  /// \param first    links that go before all others but those of wanted pairs, if they fit
  /// \param context  told by how many the groups have become fewer
  Growth grow(const std::set<std::size_t>& first, const Context& context);

  /// Strong links that the growth leaves unsatisfied: those of two groups, or of one group with another pose.
  std::vector<std::size_t> unsatisfied(const Growth& growth) const;

  /// Those of unsatisfied() that given poses part: nothing else puts the two pieces into one group.
  std::vector<std::size_t> parted_by_pins(const Growth& growth) const;

  /// The link of a pair that agrees with the growth and has the best score; links.size() if none does.
  std::size_t agreeing(const Growth& growth, std::size_t a, std::size_t b) const;

  /// Moves the members of a group so that all their contacts fit as well as they can together; pinned pieces stay.
  void settle(Growth& growth, const std::vector<std::size_t>& members) const;

 private:
  using Key = std::pair<std::size_t, std::size_t>;  ///< two groups or fragments, the smaller number first

  /// A way to make two groups one.
  struct Proposal {
    std::size_t link;
    double alone;         ///< log-odds of the link itself, less what contradicts it
    double agreeing;      ///< log-odds that other pairs add
    double vouched;       ///< those of contacts without links, where they were asked
    double wish;          ///< what lets it go before others
    bool heard;           ///< whether their contacts were asked, not their links alone
    std::size_t against;  ///< a strong link that contradicts; links.size(): none

    double odds() const { return alone + agreeing; }
    double certainty() const { return odds() + wish; }
  };

  /// Links, the members of the groups that they would put together (the largest, then those that move), and the links that hold these.
  struct Question {
    std::vector<std::size_t> links;
    std::vector<std::vector<std::size_t>> groups;
    std::vector<std::size_t> held_by;

    friend bool operator<(const Question& x, const Question& y) {
      return std::tie(x.links, x.groups, x.held_by) < std::tie(y.links, y.groups, y.held_by);
    }
  };

  /// How groups move, by their numbers: the first of a question not.
  using Moves = std::map<std::size_t, Rigid>;

  /// What a question came to.
  struct Way {
    Question question;
    double odds;     ///< log-odds of its links, with what contacts of other pairs add
    double vouched;  ///< by contacts without links
  };

  /// What contacts of other pairs add; nothing where pieces would lie in each other.
  using Answers = std::vector<std::optional<Heard>>;

  /// Two links that make three groups one.
  struct Two {
    std::array<std::size_t, 2> links;
    double alone;  ///< log-odds of `worth`, less what both hear alone
    double
        worth;  ///< log-odds of both with what either hears alone, against that only one is true and that none is
  };

  /// One growth on its way.
  struct State {
    Growth growth;
    std::map<std::size_t, std::vector<std::size_t>> members;
    std::map<Key, std::vector<std::size_t>> between;  ///< links between two groups
    std::map<Key, std::vector<Proposal>> proposals;   ///< best first
    std::set<std::size_t> unsettled;                  ///< groups that grew since they were settled
    const std::set<std::size_t>* first = nullptr;
  };

  State start(const std::set<std::size_t>& first) const;
  void pin(State& state) const;
  void propose(State& state, const Key& key) const;
  Proposal weigh(const State& state, const Key& key, std::size_t link) const;
  static void rank(std::vector<Proposal>& proposals);
  void settle_all(State& state, const Context& context) const;
  bool hear(State& state, const Context& context);
  Question question(const State& state, std::vector<std::size_t> links) const;
  std::optional<Heard> answer(const State& state, const Question& question) const;
  Answers answers(const State& state, const std::vector<Question>& questions, const Context& context);
  Moves moves(const State& state, const Question& question) const;
  bool lies_elsewhere(const State& state, const std::vector<std::size_t>& links, const Moves& moves) const;
  double among_places(double odds, const std::vector<double>& others) const;
  double among_places(const State& state, const std::vector<Proposal>& list) const;
  bool try_best(State& state);
  bool try_two(State& state, const Context& context);
  std::optional<Way> surest(const State& state, const std::vector<Way>& ways, double least) const;
  std::vector<Two> unsure_together(const State& state, const Context& context);
  bool fits(State& state, std::size_t link);
  std::optional<Key> forbidden_touch(const State& state, std::size_t link) const;
  bool overlap(std::size_t a, std::size_t b, const Rigid& b_to_a);
  void merge(State& state, std::size_t link, double odds) const;
  void sum_up(Growth& growth) const;
  void tell_contradictions(State& state) const;

  /// Takes the second group's frame to the first's, by a link between them.
  Rigid transform(const State& state, std::size_t link, std::size_t into) const;
  std::size_t agreeing(std::size_t a, std::size_t b, const Rigid& b_to_a) const;
  std::vector<Touching> contacts_of(const Growth& growth, const std::vector<std::size_t>& members) const;
  bool must(const std::vector<Key>& pairs, std::size_t link) const;

  const std::vector<Piece>& pieces_;
  const std::vector<Link>& links_;
  const Options& options_;
  std::vector<double> odds_;                          ///< log-odds, one a link
  std::map<Key, std::vector<std::size_t>> links_of_;  ///< by fragments, best first
  std::vector<Key> wanted_, unwanted_;
  std::map<Question, std::optional<Heard>> answered_;  ///< before, wherever the groups lay by then
  std::map<std::vector<double>, bool> overlaps_;       ///< what was computed before, by pair and pose
};

}  // namespace rejoin::assembly
