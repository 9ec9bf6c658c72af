/// What a run's folder holds, made ready for its page.
#pragma once

#include <filesystem>

#include "cli/console.hpp"
#include "core/context.hpp"
#include "report/run_report.hpp"

namespace rejoin::cli {

/// Reads RUN/run.sqlite, RUN/assembly.json if it is there, and the scans.  A scan that cannot be read is told in the report's
/// warnings and shown by the surface that the run keeps, or without a picture where there is none.
/// \param listed  the best pairs that get all their figures
/// \return what was read so far if it was cancelled
/// \throws StoreError  no database, or not one of a run
/// \throws InputError  assembly.json is no assembly of this run
report::RunReport read_run(const std::filesystem::path& run, std::size_t listed, Console& console,
                           const Context& context);

}  // namespace rejoin::cli
