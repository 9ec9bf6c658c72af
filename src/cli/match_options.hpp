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
  /// without its partner, options without effect
  match::Options values() const;

 private:
  /// \throws UsageError an option was given that changes nothing
  void require_effect(const match::Options& options) const;

  match::Options options_;
  const CLI::Option* tolerance_ = nullptr;  ///< owned by the subcommand
  const CLI::Option* chains_ = nullptr;
  std::optional<match::Constraint> constraint_;
  std::vector<std::string> directions_a_;
  std::vector<std::string> directions_b_;
  std::optional<std::string> material_a_;
  std::optional<std::string> material_b_;
};

}  // namespace rejoin::cli
