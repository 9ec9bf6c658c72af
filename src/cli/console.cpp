#include "cli/console.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "core/files.hpp"

namespace rejoin::cli {

std::string harmless(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') c = '?';
  }
  return result;
}

std::string harmless_line(std::string_view text) {
  std::string result = harmless(text);
  std::replace(result.begin(), result.end(), '\n', '?');
  return result;
}

namespace {

/// Without an exception where nothing takes it: files are worth more than words, and the end of main() looks at stdout.
void put(std::FILE* stream, const std::string& text) {
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), stream));
}

}  // namespace

Console::Console() : terminal_(isatty(STDERR_FILENO) == 1), last_drawn_(std::chrono::steady_clock::now()) {}

Console::~Console() {
  end_progress();
}

void Console::result(std::string_view text) {
  end_progress();
  if (quiet) return;
  put(stdout, harmless(text));
  std::fflush(stdout);  // Ctrl-C during the pictures that follow must not lose it
}

void Console::wrote(const std::filesystem::path& file) {
  if (!is_stdout(file)) result(fmt::format("wrote {}\n", file.string()));
}

void Console::warning(std::string_view text) {
  if (!warned_.emplace(text).second) return;
  end_progress();
  put(stderr, fmt::format("rejoin: warning: {}\n", harmless_line(text)));
}

void Console::detail(std::string_view text) {
  if (!verbose) return;
  end_progress();
  put(stderr, harmless(text) + "\n");
}

void Console::progress(std::string_view stage, double fraction) {
  constexpr int kWidth = 30;
  constexpr auto kPause = std::chrono::milliseconds(50);
  constexpr auto kLinePause = std::chrono::minutes(1);  // in a log, which keeps every line
  const auto now = std::chrono::steady_clock::now();
  if (quiet || (!terminal_ && !verbose)) return;
  if ((bar_drawn_ || !terminal_) && now - last_drawn_ < (terminal_ ? kPause : kLinePause)) return;
  const double share = std::clamp(fraction, 0.0, 1.0);
  last_drawn_ = now;
  if (!terminal_) {
    put(stderr, fmt::format("{:3.0f} % {}\n", 100 * share, harmless_line(stage)));
    return;
  }
  const int full = static_cast<int>(share * kWidth);
  put(stderr, fmt::format("\r\033[K[{:=<{}}{: <{}}] {:3.0f} % {}", "", full, "", kWidth - full, 100 * share,
                          harmless_line(stage)));
  std::fflush(stderr);
  bar_drawn_ = true;
}

void Console::end_progress() {
  if (!bar_drawn_) return;
  put(stderr, "\r\033[K");
  std::fflush(stderr);
  bar_drawn_ = false;
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace rejoin::cli
