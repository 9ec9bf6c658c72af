/// What a run's database holds, as plain values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "core/rigid.hpp"

namespace rejoin::store {

/// By what the results were made.  Results of other parameters are never mixed in one database.
struct Parameters {
  std::string version;     ///< of the program
  std::string json;        ///< all that has an influence on the results, but for the seed
  std::uint64_t seed = 1;  ///< of the random numbers

  bool operator==(const Parameters&) const = default;
};

enum class FragmentState {
  Waiting,  ///< not looked at yet
  Ready,    ///< could be made ready for matching
  Bad,      ///< its file is unusable; `error` says why
};

/// Stands for the hash of a file that could not be read; says nothing of its content.
inline constexpr const char* kUnreadable = "unreadable";

struct Fragment {
  std::int64_t id = 0;  ///< > 0 in a database; 0: none yet
  std::string name;     ///< the file's name in its folder, unique in the run
  std::string path;     ///< where it was read, absolute
  std::string hash;     ///< of the file's content, hexadecimal
  std::string
      pose;  ///< where the user laid it by hand, as text that is the same for the same pose; empty: nowhere
  std::string facets;  ///< hash of the content of the facets that the user painted on it; empty: none
  std::int64_t faces = 0;
  double diameter =
      0;  ///< mesh units, as the next three; these are 0 where not known (a run of an earlier build), or none
  double spacing = 0;  ///< of its points
  double noise = 0;
  double wall = 0;  ///< thickness, of a sherd
  FragmentState state = FragmentState::Waiting;
  std::string error;  ///< one line, empty unless Bad

  bool operator==(const Fragment&) const = default;
};

/// How many pairs of a fragment were searched, by its name; 0 of those that are not in it.
using SearchedPairs = std::map<std::string, std::size_t>;

/// Fragments whose file has the content of another, with the name of the one that stands for both: the one with more searched pairs,
/// so that none is lost by a copy that comes later; of equals stands_for_both() tells.  Copies have no pairs.
/// \param fragments  name and hash are used
std::map<std::string, std::string> copies(const std::vector<Fragment>& fragments,
                                          const SearchedPairs& searched = {});

/// What is told of a run with a copy: a sentence without its full stop.
/// \param first  stands for both
std::string told_of_copy(const std::string& copy, const std::string& first);
/// Why a copy has no place; its name goes before.
std::string reason_of_copy(const std::string& first);

/// How far a pair was taken.
enum class Stage {
  Apart,   ///< not searched: the user laid both too far apart to touch
  Sweep,   ///< the sweep and the first alignments found too little for more
  Match,   ///< searched in full
  Failed,  ///< `error` says why; not tried again while the inputs stay
};

/// As tables and JSON have it: "apart", "sweep", "match", "failed".
const char* name_of(Stage stage);

struct Pair {
  std::int64_t a = 0;  ///< fragment ids, a's name before b's
  std::int64_t b = 0;
  std::string name_a;
  std::string name_b;
  Stage stage = Stage::Failed;
  double evidence = 0;  ///< strength of the best pose after the first alignments
  double score = 0;     ///< 0 .. 1, comparable across pairs
  std::string verdict;  ///< "join", "unsure" or "no join"; empty if it failed
  double seconds = 0;   ///< spent on it, all stages
  std::string error;    ///< one line, empty unless Failed
  std::string result;   ///< JSON: evaluations, backend, renderer, warnings; {} if it failed
};

/// A pose at which a pair may join.  Figures that were not measured are infinite.
struct Candidate {
  int rank = 0;  ///< from 1, likeliest first, which need not be the highest score
  double score = 0;
  Rigid pose;           ///< B's file coordinates -> A's file coordinates
  bool slides = false;  ///< one piece along the other
  int facet_a = -1;
  int facet_b = -1;
  double depth = std::numeric_limits<double>::infinity();    ///< slope difference per pixel step
  double slope = std::numeric_limits<double>::infinity();    ///< the same as a slope
  double raycast = std::numeric_limits<double>::infinity();  ///< slope difference by ray casting
  double overlap = std::numeric_limits<double>::infinity();  ///< fraction of the smaller silhouette
  double contact_area = 0;                                   ///< squared mesh units
  double gap_median = 0;                                     ///< of |gap|, mesh units
  double penetration = 0;                                    ///< mesh units
};

}  // namespace rejoin::store
