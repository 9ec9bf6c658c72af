/// Outputs that take the place of earlier ones together.
#pragma once

#include <filesystem>
#include <vector>

#include "cli/interrupt.hpp"

namespace rejoin::cli {

/// Holds a folder of outputs against other commands of this program, whose files would be mixed with these.  The system lets go of it
/// when the process ends, however it ends.  On file systems without locks it holds nothing.
class OutputHold {
 public:
  /// \param folder  of the outputs; it exists
  /// \throws IoError another process holds it
  explicit OutputHold(const std::filesystem::path& folder);
  ~OutputHold();
  OutputHold(const OutputHold&) = delete;
  OutputHold& operator=(const OutputHold&) = delete;

 private:
  int folder_;  ///< below 0: it cannot be opened
};

/// A folder within that of the outputs, where new files are made.  Whatever ends the program before publish() leaves the earlier
/// files as they were, and the stage goes.
class OutputStage {
 public:
  /// \param folder  of the outputs; it exists and is held
  /// \throws IoError the stage cannot be made
  explicit OutputStage(const std::filesystem::path& folder);
  ~OutputStage();
  OutputStage(const OutputStage&) = delete;
  OutputStage& operator=(const OutputStage&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Moves files, and those of folders, from the stage to the folder of the outputs, in this order.
  /// \param files  as they were made in path()
  /// \return where they are now
  /// \throws IoError one cannot be moved
  std::vector<std::filesystem::path> publish(const std::vector<std::filesystem::path>& files) const;

 private:
  std::filesystem::path folder_;
  std::filesystem::path path_;
  RemoveWhenKilled killed_;
};

}  // namespace rejoin::cli
