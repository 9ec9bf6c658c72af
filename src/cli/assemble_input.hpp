/// What rejoin assemble works on.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "assembly/assembly.hpp"
#include "batch/batch.hpp"
#include "cli/console.hpp"
#include "store/remains.hpp"

namespace rejoin::cli {

/// Fragments and the poses of their pairs, ready for assembly.
struct AssembleInput {
  std::vector<std::string> names;   ///< of the files, ascending
  std::vector<std::string> paths;   ///< where the scans were read
  std::vector<std::string> hashes;  ///< of their content
  std::vector<match::Fragment> fragments;
  std::vector<assembly::Link> links;
  std::map<std::pair<std::size_t, std::size_t>, std::string>
      without_pose;        ///< compared pairs without links, the smaller number first, with the reason
  store::Remains remains;  ///< of the run
  std::string results;     ///< store::results_hash() of the run
  std::vector<std::string> warnings;  ///< what else the user should know of the run
  std::vector<std::string> left_out;  ///< constraints that name fragments which cannot be used
  bool failed_now = false;            ///< scans or pairs failed while a folder was matched; told
  std::vector<std::string> lost;      ///< names of scans that were matched and cannot be used any more; told
  std::map<std::string, std::string> bad;  ///< fragments that cannot be used or are copies, with the reason
  std::map<std::string, std::string> copies;  ///< of other fragments, with the names of these
};

/// Name of poses and joins in the run's folder.
inline constexpr const char* kAssemblyName = "assembly.json";

/// Whether the folder is that of a run.
bool is_run(const std::filesystem::path& folder);

/// What constraints can name.
struct KnownNames {
  std::vector<std::string> names;             ///< of all scans, whether they can be used or not
  std::map<std::string, std::string> copies;  ///< of others, with the names of those
};

/// Names of the scans of a run or a folder.
/// \throws IoError, StoreError, InputError  there are none
KnownNames names_in(const std::filesystem::path& folder);

/// Reads a run, or matches all pairs of a folder of scans first, and loads the fragments.  Bad ones are told as warnings and
/// left out.
/// \param folder  of a run (it holds run.sqlite), or of scans
/// \param keep    folder for the run of a folder of scans: a run that is there goes on; nullopt: a passing one
/// \param matching  of a folder of scans
/// \return nothing at all if it was interrupted while matching
/// \throws IoError, StoreError, InputError as batch::run(); InputError fewer than two fragments can be used
AssembleInput read_assemble_input(const std::filesystem::path& folder,
                                  const std::optional<std::filesystem::path>& keep,
                                  const batch::Options& matching, Console& console, const Context& context);

}  // namespace rejoin::cli
