/// Between rows and records.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "store/records.hpp"

namespace rejoin::store::detail {

/// Columns of candidate_from(), in its order; bind_candidate() binds the same after a and b.
/// \param slides  has_slides() of the database
std::string candidate_columns(bool slides);

/// ", ?" for each of candidate_columns().
std::string placeholders();

/// copies() of fragments that may have pairs in the database, under their names and hashes.  In a shard names alone tell which stands
/// for all, for shards know nothing of each other and have to choose alike.
/// \param shard  for which the database is, or is to be; empty: the whole
std::map<std::string, std::string> copies_in(SQLite::Database& database,
                                             const std::vector<Fragment>& fragments,
                                             const std::string& shard);

/// Removes the pairs of copies_in() and their candidates.
void remove_pairs_of_copies(SQLite::Database& database);

const char* name_of(FragmentState state);
FragmentState fragment_state(const std::string& name);
Stage stage(const std::string& name);

Fragment fragment_from(SQLite::Statement& row);
/// By name.
/// \throws StoreError one has no sound name of a file, no path, or a hash that is none
std::vector<Fragment> all_fragments(SQLite::Database& database);
/// Nothing if its rank, score or pose is none.
std::optional<Candidate> candidate_from(SQLite::Statement& row);

/// Binds the columns of kCandidateColumns to parameters first, first + 1, ...
void bind_candidate(SQLite::Statement& statement, int first, const Candidate& candidate);

}  // namespace rejoin::store::detail
