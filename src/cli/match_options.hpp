/// The options of `rejoin match`.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "match/match.hpp"

namespace rejoin::cli {

/// Fills match::Options from the command line.
class MatchOptions {
 public:
  /// Adds the options, with their ranges, to a subcommand.
  void define(CLI::App& app);

  /// Directions given without --constraint mean `direction`; two material axes without it mean `material`.
  /// \throws UsageError what the ranges of single options cannot tell: directions of length 0, an axis
  /// without its partner
  match::Options values() const;

 private:
  match::Options options_;
  std::optional<match::Constraint> constraint_;
  std::vector<std::string> directions_a_;
  std::vector<std::string> directions_b_;
  std::string material_a_;
  std::string material_b_;
};

}  // namespace rejoin::cli
