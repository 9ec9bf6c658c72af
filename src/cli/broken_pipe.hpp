/// Readers of the output that go before its end, as those of "rejoin ... | head -1" do.
#pragma once

namespace rejoin::cli {

/// From now on such a reader does not end the program at the next line: files that are still to be written would be missing.
/// Changes nothing where the caller has asked for no signal.
void outlive_reader();

/// Whether one went.
bool reader_is_gone();

/// Ends the program as the system would have done when the reader went.
[[noreturn]] void end_without_reader();

}  // namespace rejoin::cli
