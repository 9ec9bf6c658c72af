/// What rejoin outline writes as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "outline/assembly.hpp"
#include "outline/outline.hpp"
#include "outline/read.hpp"

namespace rejoin::cli {

/// 3 x 3, row major.
nlohmann::ordered_json to_json(const outline::Planar& pose);

/// How a match was searched, for the record.
struct OutlineSearch {
  std::string method;
  double seconds = 0.0;
  bool interrupted = false;
};

/// Schema "rejoin.outline-match/1".
std::string outline_match_json(const outline::Piece& a, const outline::Piece& b,
                               const outline::PairResult& result, const OutlineSearch& search);

/// Schema "rejoin.outline-assembly/1".
std::string assembly_json(const outline::PieceSet& set, const outline::Assembly& assembly,
                          const OutlineSearch& search);

}  // namespace rejoin::cli
