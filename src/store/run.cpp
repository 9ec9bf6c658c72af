#include "store/run.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>

#include "store/detail/lock.hpp"
#include "store/detail/rows.hpp"
#include "store/detail/schema.hpp"

namespace rejoin::store {
namespace fs = std::filesystem;

struct Run::Access {
  std::string path;
  std::optional<detail::WriteLock> lock;
  std::optional<SQLite::Database> database;

  SQLite::Statement query(const std::string& text) { return {*database, text}; }
};

namespace {

Parameters read_parameters(SQLite::Database& database) {
  SQLite::Statement row(database, "SELECT version, parameters, seed FROM run");
  if (!row.executeStep()) return {};
  return {row.getColumn(0).getString(), row.getColumn(1).getString(),
          static_cast<std::uint64_t>(row.getColumn(2).getInt64())};
}

std::string read_shard(SQLite::Database& database) {
  return database.execAndGet("SELECT shard FROM run").getString();
}

void write_parameters(SQLite::Database& database, const Parameters& parameters, const std::string& shard) {
  SQLite::Statement row(database, "REPLACE INTO run VALUES (1, ?, ?, ?, ?)");
  row.bind(1, parameters.version);
  row.bind(2, parameters.json);
  row.bind(3, static_cast<std::int64_t>(parameters.seed));
  row.bind(4, shard);
  row.exec();
}

void add_fragment(SQLite::Database& database, const Fragment& fragment) {
  SQLite::Statement row(database,
                        "INSERT INTO fragment (name, path, hash, faces, diameter, state, error, spacing, "
                        "noise, wall, pose, facets) "
                        "VALUES (?, ?, ?, 0, 0, 'waiting', '', 0, 0, 0, ?, ?)");
  row.bind(1, fragment.name);
  row.bind(2, fragment.path);
  row.bind(3, fragment.hash);
  row.bind(4, fragment.pose);
  row.bind(5, fragment.facets);
  row.exec();
}

void run_with(SQLite::Database& database, const char* text, const std::string& first, std::int64_t second) {
  SQLite::Statement statement(database, text);
  statement.bind(1, first);
  statement.bind(2, second);
  statement.exec();
}

void remove_fragment(SQLite::Database& database, std::int64_t id) {
  SQLite::Statement statement(database, "DELETE FROM fragment WHERE id = ?");
  statement.bind(1, id);
  statement.exec();
}

bool has_pairs(SQLite::Database& database) {
  return database.execAndGet("SELECT EXISTS (SELECT 1 FROM pair)").getInt() != 0;
}

void require_shard(SQLite::Database& database, const std::string& shard, const std::string& path) {
  const std::string known = read_shard(database);
  if (shard.empty() || shard == known || !has_pairs(database)) return;
  throw StoreError(path, known.empty() ? "holds a whole run" : "holds shard " + known,
                   fmt::format("give shard {} a folder of its own", shard));
}

bool has_results(SQLite::Database& database) {
  return database.execAndGet("SELECT EXISTS (SELECT 1 FROM pair WHERE stage <> 'failed')").getInt() != 0;
}

/// What a folder has of the scans that a database knows.
struct Recognised {
  std::string first_named;     ///< that the folder has under the same name
  std::size_t named = 0;       ///< how many it has so
  std::size_t same = 0;        ///< of those, with the same content
  std::size_t unreadable = 0;  ///< of those, whose content nobody can tell now
};

Recognised recognised(const std::vector<Fragment>& known, const std::map<std::string, Fragment>& in_folder) {
  Recognised found;
  for (const Fragment& fragment : known) {
    const auto now = in_folder.find(fragment.name);
    if (now == in_folder.end()) continue;
    if (found.named++ == 0) found.first_named = fragment.name;
    found.same += now->second.hash == fragment.hash ? 1 : 0;
    found.unreadable += now->second.hash == kUnreadable ? 1 : 0;
  }
  return found;
}

/// A folder of other scans by mistake would empty the run, and many objects have a 1.ply and a 2.ply.
void require_some_known(SQLite::Database& database, const std::map<std::string, Fragment>& in_folder,
                        const std::string& path) {
  const std::vector<Fragment> known = detail::all_fragments(database);
  const Recognised found = recognised(known, in_folder);
  if (found.named == 0 && has_pairs(database)) {
    throw StoreError(path,
                     fmt::format("is of other scans: {} and {} more", known.front().name, known.size() - 1),
                     "give the folder of those scans, or another --out");
  }
  if (found.named == 0 || found.same > 0 || !has_results(database)) return;
  if (found.unreadable > 0) {
    throw StoreError(path,
                     fmt::format("none of its scans can be read as it was: {} and {} more", found.first_named,
                                 found.named - 1),
                     "mount the disk that holds them, or mend their permissions, and run the command again");
  }
  throw StoreError(
      path,
      fmt::format("is of other scans of the same names: {} and {} more", found.first_named, found.named - 1),
      "give another --out, or remove this file if all scans were made anew");
}

/// A fragment's place in the user's layout, earlier and now.
struct Places {
  std::string earlier;
  std::string now;
};

/// Whether the two were beside each other in another way than now; fragments without a place are beside none.
bool are_laid_otherwise(const Places& a, const Places& b) {
  const bool earlier = !a.earlier.empty() && !b.earlier.empty();
  const bool now = !a.now.empty() && !b.now.empty();
  if (!earlier || !now) return earlier != now;
  return a.earlier != a.now || b.earlier != b.now;
}

/// Takes over the poses that are wanted, and removes the pairs that were looked for by others.
/// \return how many
std::size_t forget_laid_otherwise(SQLite::Database& database, const std::map<std::string, Fragment>& wanted) {
  std::map<std::int64_t, Places> places;
  bool any = false;
  for (const Fragment& known : detail::all_fragments(database)) {
    const auto same = wanted.find(known.name);
    if (same == wanted.end()) continue;
    places[known.id] = {known.pose, same->second.pose};
    if (known.pose == same->second.pose) continue;
    any = true;
    run_with(database, "UPDATE fragment SET pose = ? WHERE id = ?", same->second.pose, known.id);
  }
  std::vector<std::pair<std::int64_t, std::int64_t>> others;
  SQLite::Statement pairs(database, "SELECT a, b FROM pair");
  while (any && pairs.executeStep()) {
    const std::pair pair(pairs.getColumn(0).getInt64(), pairs.getColumn(1).getInt64());
    if (are_laid_otherwise(places[pair.first], places[pair.second])) others.push_back(pair);
  }
  SQLite::Statement remove(database, "DELETE FROM pair WHERE a = ? AND b = ?");
  for (const auto& [a, b] : others) {
    remove.reset();
    remove.bind(1, a);
    remove.bind(2, b);
    remove.exec();
  }
  return others.size();
}

/// Removes what is no longer wanted, and takes what stays off `wanted`.
/// \return what was removed, and why
std::map<std::string, Run::Change> forget_changed(SQLite::Database& database,
                                                  std::map<std::string, Fragment>& wanted) {
  std::map<std::string, Run::Change> changes;
  for (const Fragment& known : detail::all_fragments(database)) {
    const auto same = wanted.find(known.name);
    if (same != wanted.end() && same->second.hash == kUnreadable && known.hash != kUnreadable) {
      changes[known.name] = Run::Change::Unreadable;  // for a moment, perhaps: as a disk that is not mounted
      wanted.erase(same);
      continue;
    }
    if (same == wanted.end() || same->second.hash != known.hash || same->second.facets != known.facets) {
      remove_fragment(database, known.id);
      changes[known.name] = same == wanted.end()              ? Run::Change::Gone
                            : same->second.hash != known.hash ? Run::Change::Content
                                                              : Run::Change::Paint;
      continue;
    }
    if (same->second.path != known.path) {
      run_with(database, "UPDATE fragment SET path = ? WHERE id = ?", same->second.path, known.id);
    }
    wanted.erase(same);
  }
  return changes;
}

}  // namespace

fs::path folder_of(const fs::path& run) {
  std::error_code ignored;
  if (!fs::is_regular_file(run, ignored)) return run;
  return run.has_parent_path() ? run.parent_path() : fs::path(".");
}

Run::Run(std::unique_ptr<Access> access) : access_(std::move(access)) {}
Run::~Run() = default;
Run::Run(Run&&) noexcept = default;
Run& Run::operator=(Run&&) noexcept = default;

Run Run::open(const fs::path& folder) {
  auto access = std::make_unique<Access>();
  const fs::path file = detail::database_file(folder);
  access->path = file.string();
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) {
    throw StoreError(access->path, "is not there", "give the folder that rejoin batch wrote");
  }
  detail::guarded(access->path, [&] {
    access->database.emplace(detail::reading_address(file), SQLite::OPEN_READONLY | SQLite::OPEN_URI,
                             detail::kPatience_ms);
    access->database->exec("BEGIN");  // whatever is written from now on is not seen
    detail::require_schema(*access->database, access->path);
  });
  return Run(std::move(access));
}

Run Run::write(const fs::path& folder) {
  auto access = std::make_unique<Access>();
  access->path = (folder / kFileName).string();
  access->lock.emplace((folder / detail::kLockName).string());
  detail::guarded(access->path, [&] {
    access->database.emplace(access->path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE,
                             detail::kPatience_ms);
    SQLite::Database& database = *access->database;
    database.exec("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = OFF");
    detail::make_tables(database);
    detail::require_schema(database, access->path);
    detail::bring_up_to_date(database);
    database.exec("PRAGMA foreign_keys = ON");
  });
  return Run(std::move(access));
}

Parameters Run::parameters() const {
  return detail::guarded(access_->path, [&] { return read_parameters(*access_->database); });
}

std::vector<Fragment> Run::fragments() const {
  return detail::guarded(access_->path, [&] { return detail::all_fragments(*access_->database); });
}

std::map<std::string, std::string> Run::copies() const {
  return copies_among(fragments(), shard());
}

std::map<std::string, std::string> Run::copies_among(const std::vector<Fragment>& fragments,
                                                     const std::string& shard) const {
  return detail::guarded(access_->path,
                         [&] { return detail::copies_in(*access_->database, fragments, shard); });
}

std::vector<Pair> Run::pairs() const {
  std::vector<Pair> list;
  each_pair([&list](const Pair& pair) { list.push_back(pair); });
  return list;
}

void Run::each_pair(const std::function<void(const Pair&)>& visit) const {
  detail::guarded(access_->path, [&] {
    auto rows = access_->query(
        "SELECT p.a, p.b, x.name, y.name, p.stage, p.evidence, p.score, p.verdict, p.seconds, p.error, "
        "p.result "
        "FROM pair p JOIN fragment x ON x.id = p.a JOIN fragment y ON y.id = p.b "
        "ORDER BY p.score DESC, p.evidence DESC, x.name, y.name");
    while (rows.executeStep()) {
      visit({rows.getColumn(0).getInt64(), rows.getColumn(1).getInt64(), rows.getColumn(2).getString(),
             rows.getColumn(3).getString(), detail::stage(rows.getColumn(4).getString()),
             rows.getColumn(5).getDouble(), rows.getColumn(6).getDouble(), rows.getColumn(7).getString(),
             rows.getColumn(8).getDouble(), rows.getColumn(9).getString(), rows.getColumn(10).getString()});
    }
  });
}

std::vector<Run::Done> Run::done() const {
  return detail::guarded(access_->path, [&] {
    auto rows = access_->query("SELECT a, b, stage FROM pair ORDER BY a, b");
    std::vector<Done> list;
    while (rows.executeStep()) {
      list.push_back({rows.getColumn(0).getInt64(), rows.getColumn(1).getInt64(),
                      detail::stage(rows.getColumn(2).getString())});
    }
    return list;
  });
}

std::string Run::shard() const {
  return detail::guarded(access_->path, [&] { return read_shard(*access_->database); });
}

std::vector<Candidate> Run::candidates(const Pair& pair) const {
  return candidates(pair.a, pair.b);
}

std::vector<Candidate> Run::candidates(std::int64_t a, std::int64_t b) const {
  return detail::guarded(access_->path, [&] {
    auto rows =
        access_->query(fmt::format("SELECT {} FROM candidate WHERE a = ? AND b = ? ORDER BY rank",
                                   detail::candidate_columns(detail::has_slides(*access_->database))));
    rows.bind(1, a);
    rows.bind(2, b);
    std::vector<Candidate> list;
    while (rows.executeStep()) {
      const std::optional<Candidate> candidate = detail::candidate_from(rows);
      if (!candidate) {
        throw StoreError(
            access_->path,
            fmt::format("candidate {} of fragments {} and {} has no score from 0 to 1, or no rigid "
                        "pose",
                        rows.getColumn(0).getString(), a, b),
            "put its row right, or delete that of the pair and run rejoin batch again");
      }
      list.push_back(*candidate);
    }
    return list;
  });
}

Run::Forgotten Run::begin(const Parameters& parameters, const std::vector<Fragment>& fragments,
                          const std::string& shard) {
  return detail::guarded(access_->path, [&] {
    SQLite::Database& database = *access_->database;
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    require_shard(database, shard, access_->path);
    std::map<std::string, Fragment> wanted;
    for (const Fragment& fragment : fragments) wanted[fragment.name] = fragment;
    require_some_known(database, wanted, access_->path);
    Forgotten forgotten;
    if (read_parameters(database) != parameters) {
      forgotten.parameters = has_pairs(database);
      database.exec("DELETE FROM pair");
      database.exec(
          "UPDATE fragment SET state = 'waiting', error = '' WHERE state = 'bad'");  // may be read now
    }
    write_parameters(database, parameters, shard);
    const std::map<std::string, Fragment> all = wanted;
    forgotten.fragments = forget_changed(database, wanted);
    forgotten.laid_pairs = forget_laid_otherwise(database, all);
    for (const auto& [name, fragment] : wanted) add_fragment(database, fragment);
    detail::remove_pairs_of_copies(database);
    transaction.commit();
    return forgotten;
  });
}

void Run::forget_failures() {
  detail::guarded(access_->path, [&] {
    SQLite::Transaction transaction(*access_->database, SQLite::TransactionBehavior::IMMEDIATE);
    access_->database->exec("DELETE FROM pair WHERE stage = 'failed'");
    access_->database->exec("UPDATE fragment SET state = 'waiting', error = '' WHERE state = 'bad'");
    transaction.commit();
  });
}

void Run::save(const Fragment& fragment) {
  detail::guarded(access_->path, [&] {
    auto row = access_->query(
        "UPDATE fragment SET faces = ?, diameter = ?, state = ?, error = ?, spacing = ?, noise = ?, wall = "
        "?, "
        "hash = ? WHERE id = ?");
    row.bind(1, fragment.faces);
    row.bind(2, fragment.diameter);
    row.bind(3, detail::name_of(fragment.state));
    row.bind(4, fragment.error);
    row.bind(5, fragment.spacing);
    row.bind(6, fragment.noise);
    row.bind(7, fragment.wall);
    row.bind(8, fragment.hash);
    row.bind(9, fragment.id);
    row.exec();
  });
}

void Run::save(const Pair& pair, const std::vector<Candidate>& candidates) {
  detail::guarded(access_->path, [&] {
    SQLite::Transaction transaction(*access_->database, SQLite::TransactionBehavior::IMMEDIATE);
    auto remove = access_->query("DELETE FROM pair WHERE a = ? AND b = ?");
    remove.bind(1, pair.a);
    remove.bind(2, pair.b);
    remove.exec();
    auto row = access_->query("INSERT INTO pair VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)");
    row.bind(1, pair.a);
    row.bind(2, pair.b);
    row.bind(3, name_of(pair.stage));
    row.bind(4, pair.evidence);
    row.bind(5, pair.score);
    row.bind(6, pair.verdict);
    row.bind(7, pair.seconds);
    row.bind(8, pair.error);
    row.bind(9, pair.result);
    row.exec();
    auto insert = access_->query(fmt::format("INSERT INTO candidate (a, b, {}) VALUES (?, ?{})",
                                             detail::candidate_columns(true), detail::placeholders()));
    int rank = 0;
    for (Candidate candidate : candidates) {
      candidate.rank = ++rank;
      insert.reset();
      insert.bind(1, pair.a);
      insert.bind(2, pair.b);
      detail::bind_candidate(insert, 3, candidate);
      insert.exec();
    }
    transaction.commit();
  });
}

}  // namespace rejoin::store
