/// Loading of a fragment for a subcommand.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "cli/console.hpp"
#include "core/context.hpp"
#include "match/match.hpp"

namespace rejoin::cli {

/// A folder where one scan is taken.  \throws IoError
void require_no_folder(const std::string& path, const std::string& mend);

/// Adds --solid: what the pieces are.
void add_solid(CLI::App& app, bool& solid);

/// What --solid means.
inline mesh::PieceKind kind_of(bool solid) {
  return solid ? mesh::PieceKind::Solid : mesh::PieceKind::Found;
}

/// Reads a scan, shows what had to be mended as warnings, and makes it ready.
/// \throws IoError, InputError as mesh::load()
match::Fragment load_fragment(const std::string& path, Console& console, const Context& context,
                              mesh::PieceKind kind = mesh::PieceKind::Found);

/// Gives every painted surface (`--facets FILE`) to the fragments that it lies on.
/// \throws IoError, InputError as mesh::load(); it has no colours or lies on no fragment
void use_painted_facets(const std::vector<std::string>& files, const std::vector<match::Fragment*>& fragments,
                        Console& console);

}  // namespace rejoin::cli
