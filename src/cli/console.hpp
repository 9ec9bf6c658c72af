/// What the user sees while and after the program works.
#pragma once

#include <chrono>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>

namespace rejoin::cli {

/// Text for a terminal: control characters, which a file's name may hold and a terminal would obey, become '?'.  Line ends and tabs stay.
std::string harmless(std::string_view text);

/// The same for one line: line ends in it become '?', too.
std::string harmless_line(std::string_view text);

/// Results go to stdout, everything else to stderr; all of it harmless().  Not thread-safe.
class Console {
 public:
  bool quiet = false;    ///< no results on stdout and no progress; warnings and errors stay
  bool verbose = false;  ///< more on stderr

  /// Looks whether stderr is a terminal; elsewhere progress is a line a minute, for --verbose alone.
  Console();
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// A part of the result, with its line end.
  void result(std::string_view text);

  /// The line that tells an output; nothing of one that is the standard output itself.
  void wrote(const std::filesystem::path& file);

  /// A text is told once, however often it comes.
  void warning(std::string_view text);

  /// A line for --verbose.
  void detail(std::string_view text);

  /// Draws the bar, or writes the line that is due.  fraction: 0 .. 1
  void progress(std::string_view stage, double fraction);

  /// Takes the bar away before something else is written.
  void end_progress();

 private:
  std::set<std::string> warned_;
  bool terminal_;
  bool bar_drawn_ = false;
  std::chrono::steady_clock::time_point last_drawn_;
};

double seconds_since(std::chrono::steady_clock::time_point begin);

}  // namespace rejoin::cli
