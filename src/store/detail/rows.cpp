#include "store/detail/rows.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "core/error.hpp"
#include "core/utf8.hpp"
#include "store/detail/schema.hpp"

namespace rejoin::store::detail {
namespace {

/// What was not measured is infinite here and NULL there, as not every tool can show an infinity.
double measured(const SQLite::Column& column) {
  return column.isNull() ? std::numeric_limits<double>::infinity() : column.getDouble();
}

void bind_measured(SQLite::Statement& statement, int index, double value) {
  if (std::isfinite(value)) {
    statement.bind(index, value);
  } else {
    statement.bind(index);
  }
}

std::array<double, 7> figures(const Candidate& c) {
  return {c.depth, c.slope, c.raycast, c.overlap, c.contact_area, c.gap_median, c.penetration};
}

/// Those of the fragments that are as the database knows them and whose content others have, too.
SearchedPairs searched_pairs_of_equals(SQLite::Database& database, const std::vector<Fragment>& fragments) {
  std::map<std::string, std::size_t> with_hash;
  for (const Fragment& fragment : fragments) ++with_hash[fragment.hash];
  SQLite::Statement count(database,
                          "SELECT count(*) FROM fragment f JOIN pair p ON p.a = f.id OR p.b = f.id "
                          "WHERE f.name = ? AND f.hash = ? AND p.stage IN ('sweep', 'match')");
  SearchedPairs searched;
  for (const Fragment& fragment : fragments) {
    if (with_hash[fragment.hash] < 2) continue;
    count.reset();
    count.bind(1, fragment.name);
    count.bind(2, fragment.hash);
    count.executeStep();
    searched[fragment.name] = static_cast<std::size_t>(count.getColumn(0).getInt64());
  }
  return searched;
}

bool is_control(char c) {
  return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}

bool is_hexadecimal(const std::string& text) {
  return std::ranges::all_of(text, [](unsigned char c) { return std::isxdigit(c) != 0; });
}

/// What is wrong with a fragment, in the words of a message; empty: nothing.  Its name and hashes become those of files, and a database
/// may be anybody's.
std::string fault_of(const Fragment& fragment) {
  const std::string& name = fragment.name;
  if (name.empty() || name == "." || name == ".." || name.find('/') != std::string::npos || !is_utf8(name) ||
      std::ranges::any_of(name, is_control))
    return "has no name of a file";
  if (fragment.path.empty()) return "has no path";
  if (fragment.hash.empty() || (fragment.hash != kUnreadable && !is_hexadecimal(fragment.hash)))
    return "has a hash that is not hexadecimal";
  return is_hexadecimal(fragment.facets) ? "" : "has a hash of facets that is not hexadecimal";
}

/// \throws StoreError the fragment is none that rejoin writes
void require_sound(const Fragment& fragment, SQLite::Database& database) {
  const std::string fault = fault_of(fragment);
  if (fault.empty()) return;
  std::string name = valid_utf8(fragment.name);
  std::ranges::replace_if(name, is_control, '?');
  throw StoreError(sqlite3_db_filename(database.getHandle(), "main"),
                   fmt::format("its fragment {} (\"{}\") {}", fragment.id, name, fault),
                   "put its row right, or move the file away and run rejoin batch again");
}

}  // namespace

std::map<std::string, std::string> copies_in(SQLite::Database& database,
                                             const std::vector<Fragment>& fragments,
                                             const std::string& shard) {
  return shard.empty() ? copies(fragments, searched_pairs_of_equals(database, fragments)) : copies(fragments);
}

void remove_pairs_of_copies(SQLite::Database& database) {
  const std::vector<Fragment> fragments = all_fragments(database);
  const std::string shard = database.execAndGet("SELECT shard FROM run").getString();
  const std::map<std::string, std::string> left_out = copies_in(database, fragments, shard);
  SQLite::Statement remove(database, "DELETE FROM pair WHERE a = ?1 OR b = ?1");
  for (const Fragment& fragment : fragments) {
    if (left_out.count(fragment.name) == 0) continue;
    remove.reset();
    remove.bind(1, fragment.id);
    remove.exec();
  }
}

const char* name_of(FragmentState state) {
  switch (state) {
    case FragmentState::Ready:
      return "ready";
    case FragmentState::Bad:
      return "bad";
    case FragmentState::Waiting:
      break;
  }
  return "waiting";
}

FragmentState fragment_state(const std::string& name) {
  if (name == "ready") return FragmentState::Ready;
  return name == "bad" ? FragmentState::Bad : FragmentState::Waiting;
}

Stage stage(const std::string& name) {
  if (name == "apart") return Stage::Apart;
  if (name == "sweep") return Stage::Sweep;
  return name == "match" ? Stage::Match : Stage::Failed;
}

std::string candidate_columns(bool slides) {
  return std::string(
             "rank, score, m11, m12, m13, m14, m21, m22, m23, m24, m31, m32, m33, m34, m41, m42, m43, m44, "
             "facet_a, facet_b, depth, slope, raycast, overlap, contact_area, gap_median, penetration, ") +
         (slides ? "slides" : "0");
}

std::string placeholders() {
  const std::string columns = candidate_columns(true);
  std::string text = ", ?";
  for (const char c : columns) text += c == ',' ? ", ?" : "";
  return text;
}

Fragment fragment_from(SQLite::Statement& row) {
  Fragment fragment;
  fragment.id = row.getColumn(0).getInt64();
  fragment.name = row.getColumn(1).getString();
  fragment.path = row.getColumn(2).getString();
  fragment.hash = row.getColumn(3).getString();
  fragment.faces = row.getColumn(4).getInt64();
  fragment.diameter = row.getColumn(5).getDouble();
  fragment.state = fragment_state(row.getColumn(6).getString());
  fragment.error = row.getColumn(7).getString();
  fragment.spacing = row.getColumn(8).getDouble();
  fragment.noise = row.getColumn(9).getDouble();
  fragment.wall = row.getColumn(10).getDouble();
  fragment.pose = row.getColumn(11).getString();
  fragment.facets = row.getColumn(12).getString();
  return fragment;
}

std::vector<Fragment> all_fragments(SQLite::Database& database) {
  SQLite::Statement rows(database,
                         fmt::format("SELECT id, name, path, hash, faces, diameter, state, error, {}, {} "
                                     "FROM fragment ORDER BY name",
                                     has_lengths(database) ? "spacing, noise, wall" : "0, 0, 0",
                                     has_hints(database) ? "pose, facets" : "'', ''"));
  std::vector<Fragment> list;
  while (rows.executeStep()) {
    list.push_back(fragment_from(rows));
    require_sound(list.back(), database);
  }
  return list;
}

std::optional<Candidate> candidate_from(SQLite::Statement& row) {
  for (int k = 0; k < 18; ++k) {  // what is no number would be read as 0
    if (!row.getColumn(k).isInteger() && !row.getColumn(k).isFloat()) return std::nullopt;
  }
  Candidate candidate;
  candidate.rank = row.getColumn(0).getInt();
  candidate.score = row.getColumn(1).getDouble();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) candidate.pose.rotation[j][i] = row.getColumn(2 + 4 * i + j).getDouble();
    candidate.pose.translation[i] = row.getColumn(5 + 4 * i).getDouble();
    if (!std::isfinite(candidate.pose.translation[i])) return std::nullopt;
  }
  if (!is_rotation(candidate.pose.rotation) || !(candidate.score >= 0.0 && candidate.score <= 1.0))
    return std::nullopt;
  candidate.facet_a = row.getColumn(18).getInt();
  candidate.facet_b = row.getColumn(19).getInt();
  candidate.depth = measured(row.getColumn(20));
  candidate.slope = measured(row.getColumn(21));
  candidate.raycast = measured(row.getColumn(22));
  candidate.overlap = measured(row.getColumn(23));
  candidate.contact_area = measured(row.getColumn(24));
  candidate.gap_median = measured(row.getColumn(25));
  candidate.penetration = measured(row.getColumn(26));
  candidate.slides = row.getColumn(27).getInt() != 0;
  return candidate;
}

void bind_candidate(SQLite::Statement& statement, int first, const Candidate& candidate) {
  int next = first;
  statement.bind(next++, candidate.rank);
  statement.bind(next++, candidate.score);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) statement.bind(next++, candidate.pose.rotation[j][i]);
    statement.bind(next++, candidate.pose.translation[i]);
  }
  for (const double value : {0.0, 0.0, 0.0, 1.0}) statement.bind(next++, value);
  statement.bind(next++, candidate.facet_a);
  statement.bind(next++, candidate.facet_b);
  for (const double value : figures(candidate)) bind_measured(statement, next++, value);
  statement.bind(next, candidate.slides ? 1 : 0);
}

}  // namespace rejoin::store::detail
