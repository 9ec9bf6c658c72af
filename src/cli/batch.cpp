/// rejoin batch
#include "batch/batch.hpp"

#include <fmt/core.h>

#include <charconv>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "batch/table.hpp"
#include "cli/arguments.hpp"
#include "cli/batch_listeners.hpp"
#include "cli/command.hpp"
#include "cli/hints.hpp"
#include "core/words.hpp"

namespace rejoin::cli {
namespace {

constexpr std::size_t kMostShards = 1000000;

/// "3/8": the third of eight.
/// \throws UsageError
batch::Shard parse_shard(const std::string& text) {
  batch::Shard shard;
  const char* end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, shard.number);
  const bool slash = number.ec == std::errc() && number.ptr != end && *number.ptr == '/';
  const auto count = slash ? std::from_chars(number.ptr + 1, end, shard.count) : number;
  if (!slash || count.ec != std::errc() || count.ptr != end || shard.number < 1 ||
      shard.number > shard.count || shard.count > kMostShards) {
    throw UsageError("--shard", fmt::format("'{}' is no part of a whole", text),
                     "give I/N, such as 1/8 .. 8/8");
  }
  return shard;
}

class BatchCommand final : public Command {
 public:
  void define(CLI::App& app) override {
    app.add_option("DIR", inputs_, "folder of scans (ply obj stl off gltf glb drc xyz pts)")
        ->required()
        ->group("Input");
    hints_.define(app);
    app.add_option("--out", out_, "folder of the run; goes on with what it holds")
        ->type_name("RUN")
        ->required()
        ->group("Output");
    app.add_flag("--json", json_, "tell the course as JSON lines on stdout")->group("Output");
    app.option_defaults()->group("Search");
    app.add_option("--shard", shard_, "do part I of N, into a folder of its own")->type_name("I/N");
    app.add_flag("--thorough", thorough_, "search all pairs in full, also of more than 16 scans");
    app.add_flag("--retry", options_.retry, "try again what failed before");
    add_number(app, "--resolution", options_.match.resolution, {8, 2048},
               "pixels across a depth map, 8 to 2048 (128)");
    add_choice(app, "--backend", options_.match.backend, backend_choices(), "what draws");
    add_seed(app, options_.match.seed, "kept with the run; draws nothing");
  }

  ExitCode run(Console& console, Context& context) override {
    options_.match.promising_only = !thorough_;
    if (shard_) options_.shard = parse_shard(*shard_);
    hints_.read_into(options_, inputs_);
    const auto listener = json_ ? make_json_listener(console) : make_console_listener(console);
    const auto begin = std::chrono::steady_clock::now();
    const batch::Summary summary = batch::run(inputs_, out_, options_, *listener, context);
    console.end_progress();
    const double seconds = seconds_since(begin);
    if (json_) {
      tell_end_as_json(console, summary);
    } else {
      console.result(text_of(summary, seconds));
    }
    if (shard_ && summary.progress.total == 0) {
      console.warning(
          fmt::format("shard {} has no pairs: the folder has too few for so many shards", *shard_));
    }
    return tell_end(console, summary);
  }

 private:
  std::string text_of(const batch::Summary& summary, double seconds) const {
    const batch::Progress& progress = summary.progress;
    std::string text = counted(summary.fragments, "fragment");
    if (summary.copies > 0)
      text += fmt::format(" ({} left out)",
                          summary.copies == 1 ? "a copy" : std::to_string(summary.copies) + " copies");
    // Scripts look for these words (scripts/slurm/shard), so they stay as they are for one pair too.
    text += fmt::format(", {} of {} pairs done, {} of them now", progress.done, progress.total,
                        progress.done - summary.done_before);
    if (progress.failed > 0) text += fmt::format(", {} failed", progress.failed);
    return text + fmt::format(", in {}\nwrote {}\n", duration_text(seconds),
                              (std::filesystem::path(out_) / batch::kTableName).string());
  }

  ExitCode tell_end(Console& console, const batch::Summary& summary) const {
    if (summary.cancelled) {
      console.warning("interrupted; the same command goes on where it stopped");
      return kInterrupted;
    }
    if (summary.progress.failed == 0 && summary.bad.empty()) return kDone;
    console.warning(fmt::format(
        "{} of {} failed, {} cannot be used; mend what is wrong and run the same command again, or add "
        "--retry",
        summary.progress.failed, counted(summary.progress.total, "pair"),
        counted(summary.bad.size(), "scan")));
    return kFailure;
  }

  std::string inputs_;
  std::string out_;
  std::optional<std::string> shard_;
  bool json_ = false;
  bool thorough_ = false;
  Hints hints_;
  batch::Options options_;
};

}  // namespace

std::unique_ptr<Command> make_batch_command() {
  return std::make_unique<BatchCommand>();
}

}  // namespace rejoin::cli
