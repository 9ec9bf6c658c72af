/// Tables of a run's database, and the one place that turns SQLite's errors into ours.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <filesystem>
#include <string>

#include "core/error.hpp"

namespace rejoin::store::detail {

/// Raised whenever a table changes its meaning; kept in PRAGMA user_version.
inline constexpr int kSchemaVersion = 4;
inline constexpr int kOldestSchema = 1;  ///< that is still read

/// How long to wait while a reader's checkpoint or a copy holds the file.
inline constexpr int kPatience_ms = 60000;

/// Makes the tables in an empty database; leaves one with tables alone.
void make_tables(SQLite::Database& database);

/// \throws StoreError the file is a database, but none of a run, or one of a newer schema
void require_schema(SQLite::Database& database, const std::string& path);

/// Makes one of an earlier schema one of ours.  \pre opened for writing, foreign keys not yet enforced
void bring_up_to_date(SQLite::Database& database);

/// Whether fragments have spacing, noise and wall, as from schema 2 on.
bool has_lengths(SQLite::Database& database);

/// Whether fragments have what the user knows of them, pose and facets, and pairs may be apart, as from schema 3 on.
bool has_hints(SQLite::Database& database);

/// Whether candidates tell whether one piece slides along the other, as from schema 4 on.
/// \param name  "main", or the name under which another database is attached
bool has_slides(SQLite::Database& database, const std::string& name = "main");

/// The database of a run's folder, or the file itself.
std::filesystem::path database_file(const std::filesystem::path& folder);

/// What SQLite is to open (with OPEN_URI) so that nothing is changed.  A database in WAL mode wants to write files beside it even for
/// reading; where we may not write it is read as it is, unless results are still in the journal beside it: then somebody writes
/// or was stopped, and SQLite reads both by the files that are there, or refuses.
std::string reading_address(const std::filesystem::path& file);

/// SQLite's error as ours, with a mend that fits.
[[noreturn]] void fail(const SQLite::Exception& error, const std::string& path);

/// Runs body; what SQLite throws becomes a StoreError.
template <class Body>
auto guarded(const std::string& path, const Body& body) {
  try {
    return body();
  } catch (const SQLite::Exception& error) {
    fail(error, path);
  }
}

}  // namespace rejoin::store::detail
