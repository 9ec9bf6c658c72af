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
/// \throws IoError the folder has a file that would be replaced by one of make_models(), and no matrices, which every assembly has
void require_models_of_assembly(const std::filesystem::path& folder);

/// Whether an assembly's models lie in the folder.
bool has_models(const std::filesystem::path& folder);

/// Makes assembled.mlp, .glb, .ply and .png, and a folder "cloudcompare" with a matrix a fragment; nothing of nothing.
/// \return what was made; of the matrices the folder
/// \throws IoError
std::vector<std::filesystem::path> make_models(const std::filesystem::path& folder,
                                               const AssembleInput& input, const assembly::Result& result);

/// The files that make_models() may write right into the folder.
std::vector<std::filesystem::path> model_files(const std::filesystem::path& folder);

/// Removes what an earlier assembly wrote and would be taken for this one's: matrices of the pieces that its project places, and
/// of nothing (no `made`) the models, too.
/// \param made  by make_models(), on its way into the folder
void remove_earlier(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& made);

}  // namespace rejoin::cli
