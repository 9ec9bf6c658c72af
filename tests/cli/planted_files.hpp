/// A planted pair as files.
#pragma once

#include "../match/planted_block.hpp"
#include "mesh/save.hpp"
#include "run_program.hpp"

namespace rejoin::cli::testing {

/// Two halves of a block cut along a known surface, saved in a folder of their own.
struct PlantedFiles {
  PlantedFiles() {
    mesh::save(a, pair.a);
    mesh::save(b, pair.b);
  }

  const TemporaryFolder folder;
  const match::testing::PlantedPair pair = match::testing::planted_pair(7, 32);
  const std::string a = folder / "a.ply";
  const std::string b = folder / "b.ply";
  const std::string json = folder / "result.json";
};

}  // namespace rejoin::cli::testing
