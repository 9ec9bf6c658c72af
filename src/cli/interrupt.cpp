#include "cli/interrupt.hpp"

#include <signal.h>
#include <unistd.h>

#include <atomic>

#include "cli/command.hpp"

namespace rejoin::cli {
namespace {

// A signal handler can reach nothing but globals.
std::atomic<Context*> g_context{nullptr};
std::atomic<bool> g_nothing_to_save{false};
static_assert(std::atomic<Context*>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

void on_interrupt(int /*signal*/) {
  if (g_nothing_to_save.load()) {
    constexpr char kText[] = "\nrejoin: interrupted\n";
    const ssize_t written = write(STDERR_FILENO, kText, sizeof kText - 1);
    static_cast<void>(written);  // nothing else can be done about it here
    _exit(kInterrupted);
  }
  if (Context* context = g_context.load()) context->cancel();
}

}  // namespace

Interrupt::Interrupt(Context& context) {
  g_context = &context;
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // the second Ctrl-C finds the default: die
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
}

Interrupt::~Interrupt() {
  signal(SIGINT, SIG_DFL);
  g_context = nullptr;
}

NothingToSave::NothingToSave() {
  g_nothing_to_save = true;
}

NothingToSave::~NothingToSave() {
  g_nothing_to_save = false;
}

}  // namespace rejoin::cli
