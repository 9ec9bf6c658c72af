/// Putting shards together.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace rejoin::store {

struct Merged {
  std::size_t fragments = 0;  ///< in the whole, copies() included
  std::size_t pairs = 0;
  std::size_t failed = 0;  ///< of the pairs
  /// "I/N" of shards that are not among the runs, ascending; none where the runs are not all shards of one N.
  std::vector<std::string> absent;
  /// Names of fragments that the output knew and no run does: of scans that were taken away.
  std::vector<std::string> gone;
};

/// Copies all fragments and pairs of the runs into one.  Pairs that several have are taken once: what was searched in full
/// before what ended at the sweep, a failure last; fragments are numbered by name, as a single run
/// over all of them numbers them.  The whole replaces what the output held, completely or not at all; who
/// reads the output meanwhile goes on reading what it held.
/// \param runs    folders of runs, at least one, made with the same parameters, each once; the output may be one of them unless it is
///                a shard
/// \param output  an existing folder
/// \param making  is told the folder in the output in which the new database is made, before that is; it goes again, also if the merge
///                fails
/// \throws StoreError runs were made with other parameters or by another version, a fragment of the same name has another content in two of
///         them, the output has pairs that none of the runs has (but for those of scans
///         that are gone, if the runs are all shards of a folder) or is a shard, a run is given twice, or a database cannot be used
Merged merge(const std::vector<std::filesystem::path>& runs, const std::filesystem::path& output,
             const std::function<void(const std::filesystem::path& folder)>& making = {});

}  // namespace rejoin::store
