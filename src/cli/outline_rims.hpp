/// rejoin outline match on two scans: their rims.
#pragma once

#include <optional>
#include <string>

#include "cli/command.hpp"

namespace rejoin::cli {

/// Proposes poses by the rims of two scans; the best is printed, all go to `json`, those of an interrupted search only if it is not there.
ExitCode match_rims(const std::string& path_a, const std::string& path_b, std::optional<std::string> json,
                    Console& console, Context& context);

}  // namespace rejoin::cli
