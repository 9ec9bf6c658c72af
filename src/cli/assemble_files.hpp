/// Files that rejoin assemble writes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "assembly/assembly.hpp"
#include "cli/assemble_constraints.hpp"
#include "cli/assemble_input.hpp"

namespace rejoin::cli {

/// Numbers in braces, as in assembly::Placement::reason, replaced by names.
std::string with_names(const std::string& text, const std::vector<std::string>& names);

/// Why a fragment is placed nowhere, and how many of its pairs were not there to tell.
std::string reason_of(const AssembleInput& input, const assembly::Result& result, std::size_t fragment);

/// What the user should know of the whole: pairs that are not compared yet, constraints that could not be kept.
std::vector<std::string> warnings_of(const AssembleInput& input, const assembly::Result& result);

/// "rejoin.assembly/1".
/// \param constraints  what the user asked for; it is told too
std::string assembly_json(const AssembleInput& input, const NamedConstraints& constraints,
                          const assembly::Result& result);

/// A MeshLab project of the scans' files at their poses.
std::string meshlab_project(const AssembleInput& input, const assembly::Result& result);

/// Whoever has a scan of such a name must not lose it.
/// \throws IoError the folder has a file that write_assembly() would replace, and no matrices, which every assembly has
void require_models_of_assembly(const std::filesystem::path& folder);

/// assembled.glb, .ply, .mlp and .png, and a folder "cloudcompare" with a matrix a fragment; those of an earlier assembly there are
/// removed.
/// \return what was written; of the matrices the folder
/// \throws IoError
std::vector<std::filesystem::path> write_assembly(const std::filesystem::path& folder,
                                                  const AssembleInput& input, const assembly::Result& result);

}  // namespace rejoin::cli
