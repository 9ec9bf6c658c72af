/// Loading of a fragment for a subcommand.
#pragma once

#include <string>

#include "cli/console.hpp"
#include "core/context.hpp"
#include "match/match.hpp"

namespace rejoin::cli {

/// Reads a scan, shows what had to be mended as warnings, and makes it ready.
/// \throws IoError, InputError as mesh::load()
match::Fragment load_fragment(const std::string& path, Console& console, const Context& context);

}  // namespace rejoin::cli
