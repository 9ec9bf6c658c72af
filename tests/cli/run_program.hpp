/// Runs the built program the way a shell does.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rejoin::cli::testing {

struct Finished {
  int exit_code = -1;  ///< 128 + signal if one killed it
  std::string out;
  std::string err;
};

/// Who reads the program's stdout: nobody does behind a "| true" that has ended.
enum class Reader { Us, Nobody };

/// A started program with its stdout and stderr in pipes.
class Running {
 public:
  /// \param arguments    after the program's name
  /// \param environment  "NAME=value", added to ours
  explicit Running(const std::vector<std::string>& arguments,
                   const std::vector<std::string>& environment = {}, Reader reader = Reader::Us);
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  /// Reads stderr until it contains `text`; false if the program ended before.
  bool wait_for_stderr(const std::string& text);

  /// The same of stdout.
  bool wait_for_stdout(const std::string& text);

  void interrupt() const;
  void send(int signal_number) const;

  /// What a power cut or the system's memory guard does to it.
  void kill_now() const;

  /// Reads the rest and waits for the end.
  Finished finish();

 private:
  bool read_some();

  int process_ = -1;
  int out_pipe_ = -1;
  int err_pipe_ = -1;
  Finished output_;
};

Finished run(const std::vector<std::string>& arguments, const std::vector<std::string>& environment = {});

/// A folder of its own for a test, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

std::string read_file(const std::string& path);
void write_file(const std::string& path, const std::string& content);

/// Whether the text is one line, with its end.
bool is_one_line(const std::string& text);

}  // namespace rejoin::cli::testing
