/// What a user or a program hears of a batch.
#pragma once

#include <memory>

#include "batch/batch.hpp"
#include "cli/console.hpp"

namespace rejoin::cli {

/// Failures as warnings, the course as a progress bar with the time left.
std::unique_ptr<batch::Listener> make_console_listener(Console& console);

/// One JSON object a line on stdout, each with "event": "start", "warning", "fragment", "pair".  Failures are warnings too.
std::unique_ptr<batch::Listener> make_json_listener(Console& console);

/// The last line for programs, "event": "end".
void tell_end_as_json(Console& console, const batch::Summary& summary);

/// "2 h 5 min", "3 min", "40 s".
std::string duration_text(double seconds);

}  // namespace rejoin::cli
