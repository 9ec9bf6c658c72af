#include "store/detail/schema.hpp"

#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cctype>

#include "store/run.hpp"

namespace rejoin::store::detail {
namespace {

constexpr int kApplication = 0x726a6e31;  // "rjn1": `file` and others can tell what the database is

constexpr const char* kRunAndFragments = R"sql(
CREATE TABLE run (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  version TEXT NOT NULL,
  parameters TEXT NOT NULL,
  seed INTEGER NOT NULL,
  shard TEXT NOT NULL
);
CREATE TABLE fragment (
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE,
  path TEXT NOT NULL,
  hash TEXT NOT NULL,
  faces INTEGER NOT NULL,
  diameter REAL NOT NULL,
  state TEXT NOT NULL CHECK (state IN ('waiting', 'ready', 'bad')),
  error TEXT NOT NULL,
  spacing REAL NOT NULL DEFAULT 0,
  noise REAL NOT NULL DEFAULT 0,
  wall REAL NOT NULL DEFAULT 0,
  pose TEXT NOT NULL DEFAULT '',
  facets TEXT NOT NULL DEFAULT ''
);
INSERT INTO run VALUES (1, '', '{}', 1, '');
)sql";

/// A table of this name.
constexpr const char* kPairs = R"sql(
CREATE TABLE {} (
  a INTEGER NOT NULL REFERENCES fragment ON DELETE CASCADE,
  b INTEGER NOT NULL REFERENCES fragment ON DELETE CASCADE,
  stage TEXT NOT NULL CHECK (stage IN ('apart', 'sweep', 'match', 'failed')),
  evidence REAL NOT NULL,
  score REAL NOT NULL,
  verdict TEXT NOT NULL,
  seconds REAL NOT NULL,
  error TEXT NOT NULL,
  result TEXT NOT NULL,
  PRIMARY KEY (a, b)
) WITHOUT ROWID;
)sql";

constexpr const char* kCandidates = R"sql(
CREATE TABLE candidate (
  a INTEGER NOT NULL,
  b INTEGER NOT NULL,
  rank INTEGER NOT NULL,
  score REAL NOT NULL,
  m11 REAL NOT NULL, m12 REAL NOT NULL, m13 REAL NOT NULL, m14 REAL NOT NULL,
  m21 REAL NOT NULL, m22 REAL NOT NULL, m23 REAL NOT NULL, m24 REAL NOT NULL,
  m31 REAL NOT NULL, m32 REAL NOT NULL, m33 REAL NOT NULL, m34 REAL NOT NULL,
  m41 REAL NOT NULL, m42 REAL NOT NULL, m43 REAL NOT NULL, m44 REAL NOT NULL,
  facet_a INTEGER NOT NULL,
  facet_b INTEGER NOT NULL,
  depth REAL, slope REAL, raycast REAL, overlap REAL, contact_area REAL, gap_median REAL, penetration REAL,
  slides INTEGER NOT NULL DEFAULT 0,
  PRIMARY KEY (a, b, rank),
  FOREIGN KEY (a, b) REFERENCES pair ON DELETE CASCADE
) WITHOUT ROWID;
)sql";

constexpr const char* kLooksAtPairs = R"sql(
CREATE INDEX pair_of_b ON pair (b);
CREATE VIEW ranked AS
  SELECT x.name AS a, y.name AS b, p.score, p.verdict, p.stage, p.evidence, p.seconds, p.error
  FROM pair p JOIN fragment x ON x.id = p.a JOIN fragment y ON y.id = p.b
  ORDER BY p.score DESC, x.name, y.name;
)sql";

int pragma(SQLite::Database& database, const char* name) {
  return database.execAndGet(fmt::format("PRAGMA {}", name)).getInt();
}

/// From schema 1 to 2.
constexpr const char* kAddLengths = R"sql(
ALTER TABLE fragment ADD COLUMN spacing REAL NOT NULL DEFAULT 0;
ALTER TABLE fragment ADD COLUMN noise REAL NOT NULL DEFAULT 0;
ALTER TABLE fragment ADD COLUMN wall REAL NOT NULL DEFAULT 0;
)sql";

/// From schema 2 to 3.
std::string add_hints() {
  return "ALTER TABLE fragment ADD COLUMN pose TEXT NOT NULL DEFAULT '';"
         "ALTER TABLE fragment ADD COLUMN facets TEXT NOT NULL DEFAULT ''; DROP VIEW ranked;" +
         fmt::format(kPairs, "pair_with_apart") +
         "INSERT INTO pair_with_apart SELECT * FROM pair; DROP TABLE pair;"
         "ALTER TABLE pair_with_apart RENAME TO pair;" +
         kLooksAtPairs;
}

/// From schema 3 to 4.
constexpr const char* kAddSlides = "ALTER TABLE candidate ADD COLUMN slides INTEGER NOT NULL DEFAULT 0";

constexpr const char* kGiveARun = "give the folder that rejoin batch wrote";

const char* mend_of(int code, const std::string& path) {
  switch (code) {
    case SQLITE_FULL:
    case SQLITE_IOERR:
      return "free some space or check the disk, then run the command again: it goes on where it stopped";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another rejoin works on this run; wait for its end";
    case SQLITE_NOTADB:
      if (std::filesystem::path(path).filename() != kFileName) return kGiveARun;
      [[fallthrough]];
    case SQLITE_CORRUPT:
      return "move the file away and run rejoin batch again";
    case SQLITE_CANTOPEN:
    case SQLITE_READONLY:
      return "check the folder and its permissions; while results are still in run.sqlite-wal, a run can be "
             "read only where files can be made: copy its folder to such a place";
    default:
      return "check the folder and its permissions";
  }
}

/// Whether results lie beside the database that are not in it yet.
bool has_journal(const std::filesystem::path& file) {
  std::error_code absent;
  const std::uintmax_t size = std::filesystem::file_size(file.string() + "-wal", absent);
  return !absent && size > 0;
}

}  // namespace

void make_tables(SQLite::Database& database) {
  SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
  if (pragma(database, "user_version") == 0 &&
      database.execAndGet("SELECT count(*) FROM sqlite_master").getInt() == 0) {
    database.exec(kRunAndFragments + fmt::format(kPairs, "pair") + kCandidates + kLooksAtPairs);
    database.exec(
        fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", kApplication, kSchemaVersion));
  }
  transaction.commit();
}

void require_schema(SQLite::Database& database, const std::string& path) {
  if (pragma(database, "application_id") != kApplication) {
    throw StoreError(path, "is no database of a run", kGiveARun);
  }
  const int version = pragma(database, "user_version");
  if (version < kOldestSchema || version > kSchemaVersion) {
    throw StoreError(
        path,
        fmt::format("has schema {}, this program knows {} to {}", version, kOldestSchema, kSchemaVersion),
        "use the rejoin that wrote it, or run rejoin batch into a new folder");
  }
}

void bring_up_to_date(SQLite::Database& database) {
  SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
  if (!has_lengths(database)) database.exec(kAddLengths);
  if (!has_hints(database)) database.exec(add_hints());
  if (!has_slides(database)) database.exec(kAddSlides);
  database.exec(fmt::format("PRAGMA user_version = {}", kSchemaVersion));
  transaction.commit();
}

bool has_lengths(SQLite::Database& database) {
  return pragma(database, "user_version") >= 2;
}

bool has_hints(SQLite::Database& database) {
  return pragma(database, "user_version") >= 3;
}

bool has_slides(SQLite::Database& database, const std::string& name) {
  return pragma(database, (name + ".user_version").c_str()) >= 4;
}

std::filesystem::path database_file(const std::filesystem::path& folder) {
  std::error_code ignored;
  return std::filesystem::is_directory(folder, ignored) ? folder / kFileName : folder;
}

std::string reading_address(const std::filesystem::path& file) {
  std::error_code ignored;
  const std::filesystem::path real = std::filesystem::weakly_canonical(file, ignored);
  std::string address = "file:";
  for (const char c : real.string()) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = std::isalnum(byte) != 0 || c == '/' || c == '.' || c == '-' || c == '_';
    address += plain ? std::string(1, c) : fmt::format("%{:02x}", byte);
  }
  const bool writable = access(real.parent_path().c_str(), W_OK) == 0;
  return address + (writable || has_journal(real) ? "?mode=ro" : "?immutable=1");
}

void fail(const SQLite::Exception& error, const std::string& path) {
  throw StoreError(path, fmt::format("the database refuses ({})", error.what()),
                   mend_of(error.getErrorCode() & 0xff, path));
}

}  // namespace rejoin::store::detail
