/// Runs of three coarse scans, and what is in them.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "../match/planted_block.hpp"
#include "mesh/save.hpp"
#include "run_program.hpp"

namespace rejoin::cli::testing {

inline constexpr int kCells =
    5;  // as coarse as poses are still found: what is tested is the run, not the match

/// Three pieces of two blocks, of which a7.ply and b7.ply join; and a file that is no scan.
inline void make_scans(const std::string& folder) {
  std::filesystem::create_directories(folder);
  const auto first = match::testing::planted_pair(7, kCells);
  const auto second = match::testing::planted_pair(8, kCells);
  mesh::save(folder + "/a7.ply", first.a);
  mesh::save(folder + "/b7.ply", first.b);
  mesh::save(folder + "/a8.ply", second.a);
  write_file(folder + "/truth.json", "{}");
}

inline int pairs_in(const std::string& run) {
  return SQLite::Database(run + "/run.sqlite", SQLite::OPEN_READONLY)
      .execAndGet("SELECT count(*) FROM pair")
      .getInt();
}

/// Everything in a run's database but for seconds and paths, as text.
inline std::string content(const std::string& run) {
  SQLite::Database database(run + "/run.sqlite", SQLite::OPEN_READONLY);
  std::ostringstream text;
  const auto dump = [&](const char* query) {
    SQLite::Statement rows(database, query);
    while (rows.executeStep()) {
      for (int k = 0; k < rows.getColumnCount(); ++k) text << rows.getColumn(k).getString() << '|';
      text << '\n';
    }
  };
  dump("SELECT version, parameters, seed FROM run");
  dump("SELECT id, name, hash, faces, diameter, state, error, pose, facets FROM fragment ORDER BY id");
  dump("SELECT a, b, stage, evidence, score, verdict, error, result FROM pair ORDER BY a, b");
  dump("SELECT * FROM candidate ORDER BY a, b, rank");
  return text.str();
}

/// "a+b: stage" of every pair.
inline std::vector<std::string> stages_in(const std::string& run) {
  SQLite::Database database(run + "/run.sqlite", SQLite::OPEN_READONLY);
  SQLite::Statement rows(database, "SELECT a || '+' || b || ': ' || stage FROM ranked ORDER BY a, b");
  std::vector<std::string> list;
  while (rows.executeStep()) list.push_back(rows.getColumn(0).getString());
  return list;
}

/// Whether some pose of a7.ply and b7.ply is turned as the true one.
inline bool has_the_join(const std::string& run) {
  SQLite::Database database(run + "/run.sqlite", SQLite::OPEN_READONLY);
  SQLite::Statement poses(
      database,
      "SELECT m11 FROM candidate c JOIN fragment x ON x.id = c.a JOIN fragment y ON y.id = c.b "
      "WHERE x.name = 'a7.ply' AND y.name = 'b7.ply'");
  const double truth = match::testing::planted_pair(7, kCells).truth.rotation[0][0];
  bool found = false;
  while (poses.executeStep()) found = found || std::abs(poses.getColumn(0).getDouble() - truth) < 0.02;
  return found;
}

}  // namespace rejoin::cli::testing
