#include "run_program.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>

extern char** environ;

namespace rejoin::cli::testing {
namespace {

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  result.reserve(texts.size() + 1);
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

}  // namespace

Running::Running(const std::vector<std::string>& arguments, const std::vector<std::string>& environment,
                 Reader reader) {
  std::vector<std::string> words{REJOIN_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> settings = environment;
  for (char** setting = environ; *setting != nullptr; ++setting) settings.emplace_back(*setting);

  std::array<int, 2> out{};
  std::array<int, 2> err{};
  if (pipe(out.data()) != 0 || pipe(err.data()) != 0) throw std::runtime_error("no pipe");
  if (reader == Reader::Nobody) close(out[0]);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", 0, 0);
  posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err[1], STDERR_FILENO);
  for (const int end : {out[0], out[1], err[0], err[1]}) posix_spawn_file_actions_addclose(&actions, end);
  const int failed = posix_spawn(&process_, REJOIN_PROGRAM, &actions, nullptr, pointers(words).data(),
                                 pointers(settings).data());
  posix_spawn_file_actions_destroy(&actions);
  close(out[1]);
  close(err[1]);
  out_pipe_ = reader == Reader::Nobody ? -1 : out[0];
  err_pipe_ = err[0];
  if (failed != 0) throw std::runtime_error("cannot start " REJOIN_PROGRAM);
}

Running::~Running() {
  if (process_ > 0) finish();
}

bool Running::read_some() {
  std::array<pollfd, 2> ends{pollfd{out_pipe_, POLLIN, 0}, pollfd{err_pipe_, POLLIN, 0}};
  if (out_pipe_ < 0 && err_pipe_ < 0) return false;
  poll(ends.data(), ends.size(), -1);
  const auto take = [](const pollfd& end, int& pipe, std::string& text) {
    if (pipe < 0 || end.revents == 0) return;
    std::array<char, 4096> buffer{};
    const ssize_t count = read(pipe, buffer.data(), buffer.size());
    if (count > 0) {
      text.append(buffer.data(), static_cast<std::size_t>(count));
    } else {
      close(pipe);
      pipe = -1;
    }
  };
  take(ends[0], out_pipe_, output_.out);
  take(ends[1], err_pipe_, output_.err);
  return true;
}

bool Running::wait_for_stderr(const std::string& text) {
  while (output_.err.find(text) == std::string::npos) {
    if (!read_some()) return false;
  }
  return true;
}

bool Running::wait_for_stdout(const std::string& text) {
  while (output_.out.find(text) == std::string::npos) {
    if (!read_some()) return false;
  }
  return true;
}

void Running::kill_now() const {
  kill(process_, SIGKILL);
}

void Running::send(int signal_number) const {
  kill(process_, signal_number);
}

void Running::interrupt() const {
  kill(process_, SIGINT);
}

Finished Running::finish() {
  while (read_some()) {
  }
  int status = 0;
  waitpid(process_, &status, 0);
  process_ = -1;
  output_.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return output_;
}

Finished run(const std::vector<std::string>& arguments, const std::vector<std::string>& environment) {
  return Running(arguments, environment).finish();
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "rejoin-test-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void write_file(const std::string& path, const std::string& content) {
  std::ofstream file(path, std::ios::binary);
  file << content;
  EXPECT_TRUE(file.flush()) << path;
}

bool is_one_line(const std::string& text) {
  return !text.empty() && text.find('\n') == text.size() - 1;
}

}  // namespace rejoin::cli::testing
