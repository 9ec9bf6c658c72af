#include "cli/interrupt.hpp"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <climits>
#include <cstring>
#include <ctime>
#include <string>

#include "cli/command.hpp"

namespace rejoin::cli {
namespace {

// A signal handler can reach nothing but globals.
std::atomic<Context*> g_context{nullptr};
std::atomic<const char*> g_told{nullptr};  // where there is nothing to save
std::atomic<bool> g_has_folder{false};
std::atomic<int> g_signal{SIGINT};      // the first that came
std::array<char, PATH_MAX> g_folder{};  // ends with a zero
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<Context*>::is_always_lock_free &&
              std::atomic<bool>::is_always_lock_free && std::atomic<const char*>::is_always_lock_free);

/// Once this process has ended and no thread of it writes there any more; by what may be called in a signal handler.
void remove_folder_afterwards() {
  if (!g_has_folder.load()) return;
  const pid_t self = getpid();
  if (_Fork() != 0) return;
  constexpr timespec kPause{0, 10'000'000};
  while (getppid() == self) nanosleep(&kPause, nullptr);
  execl("/bin/rm", "rm", "-rf", "--", g_folder.data(), nullptr);
  _exit(kFailure);
}

/// What shells say of a program that the signal ended.
constexpr int exit_code_of(int signal_number) {
  return 128 + signal_number;
}
static_assert(exit_code_of(SIGINT) == kInterrupted);

void on_interrupt(int signal_number) {
  Context* context = g_context.load();
  if (const char* told = g_told.load(); told != nullptr) {
    for (const char* text : {"\nrejoin: ", told, "\n"}) {
      const ssize_t written = write(STDERR_FILENO, text, std::strlen(text));
      static_cast<void>(written);  // nothing else can be done about it here
    }
    remove_folder_afterwards();
    _exit(exit_code_of(signal_number));
  }
  if (context != nullptr && !context->cancelled()) {
    g_signal = signal_number;
    return context->cancel();
  }
  remove_folder_afterwards();
  signal(signal_number, SIG_DFL);
  raise(signal_number);  // once the handler is left
}

}  // namespace

Interrupt::Interrupt(Context& context) {
  g_context = &context;
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  for (std::size_t k = 0; k < kSignals.size(); ++k) {
    sigaction(kSignals[k], nullptr, &before_[k]);
    const bool is_ignored = kSignals[k] == SIGHUP && before_[k].sa_handler == SIG_IGN;  // by nohup
    if (!is_ignored) sigaction(kSignals[k], &action, nullptr);
  }
}

Interrupt::~Interrupt() {
  for (std::size_t k = 0; k < kSignals.size(); ++k) sigaction(kSignals[k], &before_[k], nullptr);
  g_context = nullptr;
}

int Interrupt::exit_code() const {
  return exit_code_of(g_signal);
}

NothingToSave::NothingToSave(const char* told) {
  g_told = told;
}

NothingToSave::~NothingToSave() {
  g_told = nullptr;
}

RemoveWhenKilled::RemoveWhenKilled(const std::filesystem::path& folder) {
  const std::string name = folder.string();
  if (name.size() >= g_folder.size()) return;
  name.copy(g_folder.data(), name.size());
  g_folder[name.size()] = '\0';
  g_has_folder = true;
}

RemoveWhenKilled::~RemoveWhenKilled() {
  g_has_folder = false;
}

}  // namespace rejoin::cli
