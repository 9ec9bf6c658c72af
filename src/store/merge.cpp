#include "store/merge.hpp"

#include <SQLiteCpp/Backup.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <charconv>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "core/files.hpp"
#include "core/words.hpp"
#include "store/detail/lock.hpp"
#include "store/detail/rows.hpp"
#include "store/detail/schema.hpp"
#include "store/run.hpp"

namespace rejoin::store {
namespace fs = std::filesystem;
namespace {

/// Pairs of the attached run, by its ids, that ours has from another run, searched as far at least.
constexpr const char* kKeepOurs = R"sql(
CREATE TEMP TABLE kept (a INTEGER, b INTEGER, PRIMARY KEY (a, b)) WITHOUT ROWID;
INSERT INTO kept
  SELECT p.a, p.b FROM part.pair p
  JOIN part.fragment u ON u.id = p.a JOIN main.fragment x ON x.name = u.name
  JOIN part.fragment v ON v.id = p.b JOIN main.fragment y ON y.name = v.name
  JOIN main.pair q ON q.a = x.id AND q.b = y.id
  WHERE instr('failed apart sweep match', q.stage) >= instr('failed apart sweep match', p.stage)
)sql";

/// The others, ids turned into ours by the fragments' names.
constexpr const char* kCopyPairs = R"sql(
INSERT OR REPLACE INTO main.pair (a, b, stage, evidence, score, verdict, seconds, error, result)
  SELECT x.id, y.id, p.stage, p.evidence, p.score, p.verdict, p.seconds, p.error, p.result
  FROM part.pair p
  JOIN part.fragment u ON u.id = p.a JOIN main.fragment x ON x.name = u.name
  JOIN part.fragment v ON v.id = p.b JOIN main.fragment y ON y.name = v.name
  WHERE NOT EXISTS (SELECT 1 FROM kept k WHERE k.a = p.a AND k.b = p.b)
)sql";

/// Fragments of the attached run, by their ids there: ours of the same name, and the one that stands for it if it is a copy.
constexpr const char* kMakeOurs = R"sql(
CREATE TEMP TABLE ours (theirs INTEGER PRIMARY KEY, id INTEGER NOT NULL, stands INTEGER NOT NULL);
INSERT INTO ours SELECT u.id, x.id, x.id FROM part.fragment u JOIN main.fragment x ON x.name = u.name;
)sql";

constexpr const char* kStandsFor =
    "UPDATE ours SET stands = (SELECT id FROM main.fragment WHERE name = ?) "
    "WHERE id = (SELECT id FROM main.fragment WHERE name = ?)";

/// Pairs of the attached run that ours lacks, or of which it has a failure only; those of fragments that ours does not have only where
/// the parameter is 1.  What a copy had and the one that stands for it has is not lost.
constexpr const char* kCountLost = R"sql(
SELECT count(*) FROM part.pair p LEFT JOIN ours u ON u.theirs = p.a LEFT JOIN ours v ON v.theirs = p.b
  WHERE (? = 1 OR (u.id IS NOT NULL AND v.id IS NOT NULL)) AND (u.stands IS NULL OR u.stands IS NOT v.stands)
    AND NOT EXISTS (SELECT 1 FROM main.pair q WHERE q.a IN (u.id, u.stands) AND q.b IN (v.id, v.stands)
                    AND (q.stage <> 'failed' OR p.stage = 'failed'))
    AND NOT EXISTS (SELECT 1 FROM main.pair q WHERE q.a IN (v.id, v.stands) AND q.b IN (u.id, u.stands)
                    AND (q.stage <> 'failed' OR p.stage = 'failed'))
)sql";

/// \param slides  has_slides() of the attached run
std::string copy_candidates(bool slides) {
  return fmt::format(
      "INSERT INTO main.candidate (a, b, {}) SELECT x.id, y.id, {} FROM part.candidate c "
      "JOIN part.fragment u ON u.id = c.a JOIN main.fragment x ON x.name = u.name "
      "JOIN part.fragment v ON v.id = c.b JOIN main.fragment y ON y.name = v.name "
      "WHERE NOT EXISTS (SELECT 1 FROM kept k WHERE k.a = c.a AND k.b = c.b)",
      detail::candidate_columns(true), detail::candidate_columns(slides));
}

/// Which of two runs knows more of a fragment: one that could use it, then one that looked at it.
int told_by(FragmentState state) {
  return state == FragmentState::Ready ? 2 : state == FragmentState::Bad ? 1 : 0;
}

struct Whole {
  Parameters parameters;
  std::map<std::string, Fragment> fragments;
  std::vector<std::string> shards;  ///< of the runs, as Run::shard() tells them
};

/// One look at all runs, before anything is written.
Whole survey(const std::vector<fs::path>& runs) {
  Whole whole;
  std::map<std::string, std::size_t> from;  // the first run that has the fragment
  for (const fs::path& folder : runs) {
    const Run run = Run::open(folder);
    whole.shards.push_back(run.shard());
    if (&folder == &runs.front()) whole.parameters = run.parameters();
    if (run.parameters() != whole.parameters) {
      throw StoreError(folder.string(),
                       fmt::format("was made with other parameters or by another version or build than {}",
                                   runs.front().string()),
                       "run its shard again like the others");
    }
    for (const Fragment& fragment : run.fragments()) {
      Fragment& known = whole.fragments.try_emplace(fragment.name, fragment).first->second;
      from.try_emplace(fragment.name, static_cast<std::size_t>(&folder - runs.data()));
      if (known.hash != fragment.hash) {
        const std::string other = runs[from.at(fragment.name)].string();
        if (known.hash == kUnreadable || fragment.hash == kUnreadable) {
          throw StoreError(known.hash == kUnreadable ? other : folder.string(),
                           fmt::format("could not read {}", fragment.name), "run its shard again");
        }
        throw StoreError(folder.string(),
                         fmt::format("knows another content of {} than {}", fragment.name, other),
                         "run the shards again that have the older file");
      }
      if (known.facets != fragment.facets) {
        throw StoreError(folder.string(),
                         fmt::format("has {} painted otherwise than the runs before it", fragment.name),
                         "run its shard again with the --facets of the others");
      }
      if (known.pose != fragment.pose) {
        throw StoreError(folder.string(),
                         fmt::format("has {} elsewhere in the layout than the runs before it", fragment.name),
                         "run its shard again with the --layout of the others");
      }
      if (told_by(fragment.state) > told_by(known.state)) known = fragment;
    }
  }
  return whole;
}

/// Fragments of the attached run that ours does not have.
constexpr const char* kGone =
    "SELECT name FROM part.fragment WHERE name NOT IN (SELECT name FROM main.fragment) ORDER BY name";

/// As Merged tells it; nullopt where the runs are not all shards of one N.
std::optional<std::vector<std::string>> absent_shards(const std::vector<std::string>& shards) {
  std::set<std::size_t> given;
  std::size_t count = 0;
  for (const std::string& shard : shards) {
    std::size_t number = 0;
    std::size_t of = 0;
    const char* end = shard.data() + shard.size();
    const auto first = std::from_chars(shard.data(), end, number);
    if (first.ec != std::errc() || first.ptr == end ||
        std::from_chars(first.ptr + 1, end, of).ec != std::errc() || (count != 0 && of != count))
      return std::nullopt;
    count = of;
    given.insert(number);
  }
  std::vector<std::string> absent;
  for (std::size_t number = 1; number <= count; ++number)
    if (given.count(number) == 0) absent.push_back(fmt::format("{}/{}", number, count));
  return absent;
}

void require_each_once(const std::vector<fs::path>& runs) {
  for (std::size_t k = 0; k < runs.size(); ++k) {
    for (std::size_t earlier = 0; earlier < k; ++earlier) {
      std::error_code absent;  // which opening it tells better
      if (fs::equivalent(folder_of(runs[k]), folder_of(runs[earlier]), absent))
        throw StoreError(runs[k].string(), "is given twice", "give every run once");
    }
  }
}

/// Whether the folder has a database; an empty file is none.
bool has_database(const fs::path& folder) {
  std::error_code absent;
  const std::uintmax_t size = fs::file_size(folder / kFileName, absent);
  return !absent && size > 0;
}

/// A whole may grow in its place, but a shard would be one no longer, and its own command would refuse to go on with it.
void require_no_shard(const fs::path& output) {
  if (!has_database(output)) return;
  const std::string shard = Run::open(output).shard();
  if (shard.empty()) return;
  throw StoreError(output.string(), fmt::format("holds shard {}, and the whole would take its place", shard),
                   "give another folder");
}

/// The whole's fragments, numbered by name, without pairs.
void make_fragments(const fs::path& folder, const Whole& whole) {
  Run run = Run::write(folder);
  std::vector<Fragment> list;
  list.reserve(whole.fragments.size());
  for (const auto& [name, fragment] : whole.fragments) list.push_back(fragment);
  run.begin(whole.parameters, list);
  for (Fragment made : run.fragments()) {
    const std::int64_t id = made.id;
    made = whole.fragments.at(made.name);
    made.id = id;
    run.save(made);
  }
}

void copy_pairs(SQLite::Database& database, const fs::path& folder) {
  SQLite::Statement attach(database, "ATTACH ? AS part");
  attach.bind(1, detail::reading_address(detail::database_file(folder)));
  attach.exec();
  SQLite::Transaction transaction(database);
  database.exec(kKeepOurs);
  database.exec(kCopyPairs);
  database.exec(copy_candidates(detail::has_slides(database, "part")));
  database.exec("DROP TABLE kept");
  transaction.commit();
  database.exec("DETACH part");
}

Merged count(SQLite::Database& database) {
  const auto number = [&database](const char* query) {
    return static_cast<std::size_t>(database.execAndGet(query).getInt64());
  };
  return {number("SELECT count(*) FROM fragment"),
          number("SELECT count(*) FROM pair"),
          number("SELECT count(*) FROM pair WHERE stage = 'failed'"),
          {},
          {}};
}

/// What of the output's own database, if it has one, the whole would not have.
struct Lost {
  std::size_t pairs = 0;
  std::vector<std::string> fragments;
};

/// \param complete  the runs are all shards of a folder: pairs of scans that they do not know are no loss
Lost lost_by(SQLite::Database& whole, const fs::path& output, bool complete) {
  if (!has_database(output)) return {};
  const fs::path file = output / kFileName;
  { const Run usable = Run::open(output); }
  SQLite::Statement attach(whole, "ATTACH ? AS part");
  attach.bind(1, detail::reading_address(file));
  attach.exec();
  Lost lost;
  {
    whole.exec(kMakeOurs);
    SQLite::Statement stands_for(whole, kStandsFor);
    for (const auto& [copy, first] : detail::copies_in(whole, detail::all_fragments(whole), "")) {
      stands_for.reset();
      stands_for.bind(1, first);
      stands_for.bind(2, copy);
      stands_for.exec();
    }
    SQLite::Statement pairs(whole, kCountLost);
    pairs.bind(1, complete ? 0 : 1);
    pairs.executeStep();
    lost.pairs = static_cast<std::size_t>(pairs.getColumn(0).getInt64());
    for (SQLite::Statement gone(whole, kGone); gone.executeStep();)
      lost.fragments.push_back(gone.getColumn(0).getString());
  }
  whole.exec("DROP TABLE ours; DETACH part");
  return lost;
}

void require_nothing_lost(std::size_t lost, const fs::path& output) {
  if (lost == 0) return;
  throw StoreError(
      (output / kFileName).string(),
      fmt::format("holds {} that the given runs do not", counted(lost, "pair")),
      "give another folder, name this one among the runs too, or remove it if it is out of date");
}

/// The output's first database is the new one, moved: never is there one that holds a part.
void move_into_place(const fs::path& made, const fs::path& output) {
  const fs::path file = output / kFileName;
  std::error_code problem;
  for (const char* journal : {"-wal", "-shm", "-journal"}) fs::remove(file.string() + journal, problem);
  fs::rename(made, file, problem);
  if (problem) {
    throw StoreError(file.string(), fmt::format("cannot be written ({})", problem.message()),
                     "check the folder and its permissions");
  }
}

/// Makes the output's database a copy of the new one, as one transaction: who reads it meanwhile goes on reading the old content.
void put_in_place(const fs::path& made, const fs::path& output) {
  if (!has_database(output)) {
    move_into_place(made, output);
    return;
  }
  const std::string path = (output / kFileName).string();
  detail::guarded(path, [&] {
    SQLite::Database source(made.string(), SQLite::OPEN_READONLY);
    SQLite::Database target(path, SQLite::OPEN_READWRITE, detail::kPatience_ms);
    target.exec("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL");
    if (SQLite::Backup(target, source).executeStep(-1) != SQLITE_DONE)
      throw StoreError(path, "is in use by another program", "close it there and run the command again");
  });
}

/// The folder beside the output in which the new database is made.
class PartFolder {
 public:
  explicit PartFolder(fs::path path) : path_(std::move(path)) {
    remove();
    std::error_code ignored;
    fs::create_directories(path_, ignored);
  }
  ~PartFolder() { remove(); }
  PartFolder(const PartFolder&) = delete;
  PartFolder& operator=(const PartFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  void remove() const {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }

  fs::path path_;
};

}  // namespace

Merged merge(const std::vector<fs::path>& runs, const fs::path& output,
             const std::function<void(const fs::path&)>& making) {
  require_each_once(runs);
  const Whole whole = survey(runs);
  require_no_shard(output);
  require_writable_folder(output);
  const detail::WriteLock lock((output / detail::kLockName).string());
  const fs::path place = output / "merge.part";
  if (making) making(place);
  const PartFolder part(place);
  make_fragments(part.path(), whole);
  const std::string path = (part.path() / kFileName).string();
  const auto absent = absent_shards(whole.shards);
  Merged merged = detail::guarded(path, [&] {
    SQLite::Database database(path, SQLite::OPEN_READWRITE | SQLite::OPEN_URI);
    database.exec("PRAGMA foreign_keys = ON");
    for (const fs::path& folder : runs) copy_pairs(database, folder);
    Lost lost = lost_by(database, output, absent && absent->empty());
    require_nothing_lost(lost.pairs, output);
    detail::remove_pairs_of_copies(database);
    Merged made = count(database);
    made.gone = std::move(lost.fragments);
    // Closing would write it too, but say nothing of a full disk, and the file alone is moved.
    database.exec("PRAGMA wal_checkpoint(TRUNCATE)");
    return made;
  });
  put_in_place(path, output);
  if (absent) merged.absent = *absent;
  return merged;
}

}  // namespace rejoin::store
