/// Every pair of a folder of scans, into a run's database.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "batch/painted.hpp"
#include "batch/tiles.hpp"
#include "core/context.hpp"
#include "match/match.hpp"
#include "store/run.hpp"

namespace rejoin::batch {

/// Scans that the user laid together roughly, by name: a scan's file coordinates -> those of the layout.
using Layout = std::map<std::string, Rigid>;

struct Options {
  Options() { match.promising_only = true; }

  match::Options match;
  /// Pairs of a folder of so many scans are all searched in full: it takes minutes, and each join is one of few.
  std::size_t few_scans = 16;
  /// Two scans of it are looked for near the pose that they have there, and there alone, in full.  If they lie too far apart there to
  /// touch, they are not looked for.
  Layout layout;
  Painted painted;                                ///< breaks where they are found wrong
  mesh::PieceKind kind = mesh::PieceKind::Found;  ///< of all scans
  Shard shard;
  bool retry = false;                 ///< try again what failed in an earlier run
  std::vector<std::string> warnings;  ///< of reading these options; the listener hears them after the start
};

/// How far a run is.
struct Progress {
  std::size_t done = 0;                ///< pairs, those of earlier runs included
  std::size_t total = 0;               ///< pairs of the shard
  std::size_t failed = 0;              ///< of those done
  std::optional<double> seconds_left;  ///< estimate, wall clock; none while there is nothing to tell by
};

/// Hears what happens, as it happens, from one thread at a time.
class Listener {
 public:
  virtual ~Listener() = default;
  virtual void on_start(const store::Run::Forgotten& /*forgotten*/, const Progress& /*progress*/) {}
  /// Something about the scans that the user should look at; the run goes on.
  virtual void on_warning(const std::string& /*text*/, const Progress& /*progress*/) {}
  /// A fragment was made ready, or is bad (those of an earlier run are told at the start).
  virtual void on_fragment(const store::Fragment& /*fragment*/, const Progress& /*progress*/) {}
  /// A pair is in the database.
  virtual void on_pair(const store::Pair& /*pair*/, const Progress& /*progress*/) {}
};

struct Summary {
  std::size_t fragments = 0;  ///< that the shard needs, and their copies
  std::size_t copies = 0;     ///< of those
  std::vector<store::Fragment>
      bad;  ///< that cannot be used; with those whose names no result can tell, which no database knows
  std::size_t done_before = 0;  ///< pairs found done
  Progress progress;            ///< at the end
  bool cancelled = false;       ///< what is missing is done by the next run
};

/// A hash of the sources on which the result of a pair depends.
std::string matcher();

/// By what a run is made, as its parameters keep it: the version, with matcher(), for builds between two versions differ.
std::string version();

/// Matches all pairs of the folder's scans that the run's database lacks, several side by side.  The same inputs and options give the same
/// content (but for seconds), whatever the number of threads and however often it was stopped; pairs that were searched in full among
/// options.few_scans scans stay so when more come.
///
/// A scan that cannot be used, or a pair that fails, is marked and the rest goes on.  A file with the content of another has no pairs: the
/// one that has some in the database, or else the one with the shorter name, stands for both (store::Run::copies_among()).
///
/// \param inputs  folder of scans
/// \param output  folder of the run, made if it is not there: run.sqlite, fragments/, pairs.csv
/// \throws IoError     the folders cannot be read or written
/// \throws InputError  fewer than two different scans
/// \throws StoreError  the database cannot be used, or the disk is full; what is done so far is kept
Summary run(const std::filesystem::path& inputs, const std::filesystem::path& output, const Options& options,
            Listener& listener, const Context& context);

}  // namespace rejoin::batch
