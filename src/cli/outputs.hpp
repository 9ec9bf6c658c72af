/// Outputs that would destroy what is read, or cannot be meant.
#pragma once

#include <CLI/App.hpp>

namespace rejoin::cli {

/// Looks at the values of a parsed command's, and its commands', options in the groups "Input" and "Output".
/// \throws UsageError an output is empty, is a file that is read too or a scan or piece in a folder that is read, or has the name of a file where a
///         folder is taken
void require_outputs_apart(const CLI::App& command);

}  // namespace rejoin::cli
