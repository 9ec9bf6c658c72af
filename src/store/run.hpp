/// The database of a run, RUN/run.sqlite: which pairs of fragments were tried and what came of it.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "store/records.hpp"

namespace rejoin::store {

/// Name of the database in the run's folder.
inline constexpr const char* kFileName = "run.sqlite";

/// The folder of the run that is given by its folder, or by the database or another file in it.
std::filesystem::path folder_of(const std::filesystem::path& run);

/// An open database.  Every writing call is one transaction: it is there as a whole once the call returns, power cut or not,
/// and not at all if it throws.  One process may write at a time, any number may read meanwhile.  Not thread-safe.
///
/// All calls throw StoreError, naming the file: it is no database of a run, is of a newer schema, is damaged, or the disk is full.
/// The tables are described in docs/store.md.
class Run {
 public:
  /// Opens for reading what `rejoin batch` or `rejoin merge` wrote, as it is at this moment: what others write later is not seen.
  /// \param folder  the run's folder, or the database file itself
  static Run open(const std::filesystem::path& folder);

  /// Opens for writing; makes the database if there is none.  \pre the folder exists
  /// \throws StoreError also if another process has it open for writing
  static Run write(const std::filesystem::path& folder);

  ~Run();
  Run(Run&&) noexcept;
  Run& operator=(Run&&) noexcept;

  /// Default values in a new database.
  Parameters parameters() const;

  /// Which part of the work the database is for, as "I/N"; empty: the whole.
  std::string shard() const;

  /// All fragments, by name.
  std::vector<Fragment> fragments() const;

  /// Which of the fragments are copies() of which; a whole run keeps the pairs that it has.
  std::map<std::string, std::string> copies() const;
  /// The same of the fragments of a folder, of which the run may know some under the same names and hashes.
  /// \param shard  that begin() is to make of the run
  std::map<std::string, std::string> copies_among(const std::vector<Fragment>& fragments,
                                                  const std::string& shard = "") const;

  /// All pairs that are done, best score first, then by evidence and names.
  std::vector<Pair> pairs() const;
  /// The same, one at a time: there may be more than memory holds.
  void each_pair(const std::function<void(const Pair&)>& visit) const;

  /// A pair that is done, by its fragments' ids.
  struct Done {
    std::int64_t a;
    std::int64_t b;
    Stage stage;
  };
  /// All pairs that are done, by ids, ascending; far cheaper than pairs().
  std::vector<Done> done() const;

  /// The poses of a pair, by rank.
  std::vector<Candidate> candidates(const Pair& pair) const;
  std::vector<Candidate> candidates(std::int64_t a, std::int64_t b) const;

  /// Why begin() forgets a fragment.
  enum class Change { Content, Paint, Gone, Unreadable };

  /// What begin() had to forget.
  struct Forgotten {
    bool parameters = false;  ///< all pairs, because they were made with other parameters
    std::map<std::string, Change>
        fragments;               ///< names of those that went with their pairs; of unreadable ones they stay
    std::size_t laid_pairs = 0;  ///< pairs of other fragments that the user laid otherwise than before
  };

  /// Makes the database one of these parameters and fragments: results that do not belong to them are removed, those that do
  /// stay.  A fragment is the same if its name, hash and facets are; its path is brought up to date.  Pairs of copies() do not belong.
  /// Where poses changed, the pairs go whose fragments both have one, or had.
  /// \param fragments  name, path, hash, pose and facets are used
  /// \param shard      as shard() tells it
  /// \throws StoreError also if the database has pairs of another shard, or if the folder has none of its scans, or all with other
  ///         contents or unreadable, for the pairs would be lost
  Forgotten begin(const Parameters& parameters, const std::vector<Fragment>& fragments,
                  const std::string& shard = "");

  /// Removes the pairs that failed, and sets the fragments that are bad to waiting, so that they are tried again.
  void forget_failures();

  /// Sets hash, faces, lengths, state and error of the fragment of this id.
  void save(const Fragment& fragment);

  /// Adds or replaces a pair with its candidates; ranks are given by their order.
  void save(const Pair& pair, const std::vector<Candidate>& candidates);

 private:
  struct Access;
  explicit Run(std::unique_ptr<Access> access);
  std::unique_ptr<Access> access_;
};

}  // namespace rejoin::store
