/// What the user knows of the scans of a folder: --layout, --facets and --solid.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "batch/batch.hpp"

namespace rejoin::cli {

/// Options of the commands that match a folder of scans.
class Hints {
 public:
  /// Adds them to a subcommand.
  void define(CLI::App& app);

  /// Name of one that was given; nullptr: none was.
  const char* given() const {
    return layout_ ? "--layout" : painted_ ? "--facets" : solid_ ? "--solid" : nullptr;
  }

  /// Reads their files.
  /// \param scans  the folder
  /// \throws IoError, InputError as read_layout() and batch::find_painted()
  /// \throws UsageError the painted surfaces lie in the folder of the scans
  void read_into(batch::Options& options, const std::string& scans) const;

 private:
  std::optional<std::string> layout_;
  std::optional<std::string> painted_;
  bool solid_ = false;
};

}  // namespace rejoin::cli
