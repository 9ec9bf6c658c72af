/// Outputs that would destroy what is read, or cannot be meant.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/console.hpp"

namespace rejoin::cli {

/// For what a command reads by default, which no option names.
/// \param option  that names the output
/// \throws UsageError both are the same file
void require_apart(const std::string& option, const std::filesystem::path& output,
                   const std::filesystem::path& input);

/// For a file beside those that a command writes into a folder under names of its own.
/// \param output  none: nothing is refused
/// \param files   of the folder
/// \throws UsageError the output is one of them
void require_apart_from_outputs(const std::string& option, const std::optional<std::string>& output,
                                const std::vector<std::filesystem::path>& files);

/// A new or empty folder for outputs.  If an exception ends it, what was written goes, so that the same command can be given again, and
/// nothing else that came to lie there meanwhile; a folder that was made for outputs goes again if it holds nothing.
class OutputFolder {
 public:
  /// \throws IoError as require_empty_folder()
  explicit OutputFolder(const std::filesystem::path& path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Names an output in the folder, right before it is written.
  /// \return its path
  std::filesystem::path file(const std::string& name);

  /// The same for the output of another option, which may lie in the folder.
  void add(const std::filesystem::path& file);

 private:
  std::filesystem::path path_;
  std::vector<std::filesystem::path> files_;  ///< that are outputs
  bool made_ = false;                         ///< for the outputs
  int exceptions_;
};

/// For a file that goes beside a run, or into it.
/// \param run          folder of a run, or of none (then nothing is refused)
/// \param replaceable  name of a file in the run that the command writes anew; empty: none
/// \throws UsageError the output is a file that the run consists of, or one of its scans
void require_apart_from_run(const std::string& option, const std::filesystem::path& output,
                            const std::filesystem::path& run, const std::string& replaceable);

/// \throws UsageError an output's name does not end in `ending`, such as ".png"
void require_ending(const std::string& option, const std::optional<std::string>& file,
                    const std::string& ending);

/// Whether an interrupted command leaves an output as an earlier one wrote it; if so, that is told.
/// \param files   what the output consists of; one that is there is enough
/// \param earlier  what it is of: "match"
bool keeps_earlier(const std::filesystem::path& output, const std::vector<std::filesystem::path>& files,
                   const char* earlier, Console& console);

/// Looks at the values of a parsed command's, and its commands', options in the groups "Input" and "Output".
/// \throws UsageError an input or output is empty, an output is a file that is read too or a scan or piece in a folder that is read,
///         two outputs are one file, or an output has the name of a file where a folder is taken
void require_sound_paths(const CLI::App& command);

}  // namespace rejoin::cli
