/// rejoin merge
#include "store/merge.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "batch/shelf.hpp"
#include "batch/table.hpp"
#include "cli/command.hpp"
#include "cli/interrupt.hpp"
#include "core/words.hpp"
#include "store/remains.hpp"
#include "store/run.hpp"

namespace rejoin::cli {
namespace {

/// "shards 2/9, 5/9 are missing": as many as fit a line.
std::string told_absent(const std::vector<std::string>& absent) {
  constexpr std::size_t kMost = 10;
  std::string text = absent.size() == 1 ? "shard " : "shards ";
  for (std::size_t k = 0; k < absent.size() && k < kMost; ++k) text += (k > 0 ? ", " : "") + absent[k];
  if (absent.size() > kMost) text += fmt::format(" and {} more", absent.size() - kMost);
  return text + (absent.size() == 1 ? " is" : " are") +
         " missing; merge again with all, or give this run to rejoin batch for the rest";
}

class MergeCommand final : public Command {
 public:
  void define(CLI::App& app) override {
    app.add_option("RUN", runs_, "folders that rejoin batch --shard wrote")->required()->group("Input");
    app.add_option("--out", out_, "folder of the whole")->type_name("RUN")->required()->group("Output");
  }

  ExitCode run(Console& console, Context& /*context*/) override {
    const NothingToSave guard;
    const std::filesystem::path out = out_;
    std::optional<RemoveWhenKilled> killed;
    const store::Merged merged = store::merge(
        {runs_.begin(), runs_.end()}, out,
        [&](const std::filesystem::path& part) { killed.emplace(std::filesystem::absolute(part)); });
    killed.reset();
    std::vector<std::filesystem::path> caches;
    for (const std::string& run : runs_) caches.push_back(store::folder_of(run) / batch::kCacheName);
    batch::gather_surfaces(caches, out / batch::kCacheName);
    const store::Run whole = store::Run::open(out);
    const std::filesystem::path table = out / batch::kTableName;
    batch::write_table(whole, table);
    console.result(counted(merged.fragments, "fragment") + ", " + counted(merged.pairs, "pair"));
    const std::size_t missing = store::remains(whole).missing;
    if (missing > 0) console.result(fmt::format(" ({} still to be done)", missing));
    console.result("\n");
    console.wrote(table);
    for (const std::string& name : merged.gone)
      console.warning(name + ": is gone from the scans; its pairs are forgotten");
    if (missing > 0 && !merged.absent.empty()) console.warning(told_absent(merged.absent));
    if (merged.failed == 0) return kDone;
    console.warning(counted(merged.failed, "pair") + " failed; pairs.csv tells why, under error");
    return kFailure;
  }

 private:
  std::vector<std::string> runs_;
  std::string out_;
};

}  // namespace

std::unique_ptr<Command> make_merge_command() {
  return std::make_unique<MergeCommand>();
}

}  // namespace rejoin::cli
