#include "cli/broken_pipe.hpp"

#include <signal.h>
#include <unistd.h>

namespace rejoin::cli {
namespace {

volatile sig_atomic_t g_reader_is_gone = 0;

void on_broken_pipe(int /*signal*/) {
  g_reader_is_gone = 1;
}

}  // namespace

void outlive_reader() {
  struct sigaction before = {};
  sigaction(SIGPIPE, nullptr, &before);
  if (before.sa_handler == SIG_IGN) return;
  struct sigaction action = {};
  action.sa_handler = on_broken_pipe;
  sigemptyset(&action.sa_mask);
  sigaction(SIGPIPE, &action, nullptr);
}

bool reader_is_gone() {
  return g_reader_is_gone != 0;
}

void end_without_reader() {
  signal(SIGPIPE, SIG_DFL);
  raise(SIGPIPE);
  _exit(128 + SIGPIPE);  // where the signal is blocked
}

}  // namespace rejoin::cli
