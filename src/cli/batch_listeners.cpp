#include "cli/batch_listeners.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/broken_pipe.hpp"
#include "core/words.hpp"

namespace rejoin::cli {
namespace {

using nlohmann::ordered_json;

const char* told(store::Run::Change change) {
  switch (change) {
    case store::Run::Change::Content:
      return "has changed; its pairs are done again";
    case store::Run::Change::Paint:
      return "is painted otherwise than before; its pairs are done again";
    case store::Run::Change::Gone:
      return "is gone; its pairs are dropped";
    case store::Run::Change::Unreadable:
      return "cannot be read now; what is known of it stays";
  }
  return "";
}

/// Failures, which everybody must hear.
class WarningListener : public batch::Listener {
 public:
  explicit WarningListener(Console& console) : console_(console) {}

  void on_start(const store::Run::Forgotten& forgotten, const batch::Progress& /*progress*/) override {
    if (forgotten.parameters) {
      console_.warning(
          "the run was made with other parameters or by another version or build; its pairs are done again");
    }
    for (const auto& [name, change] : forgotten.fragments)
      console_.warning(fmt::format("{}: {}", name, told(change)));
    if (forgotten.laid_pairs > 0) {
      console_.warning(
          fmt::format("{} laid otherwise than before; done again",
                      counted(forgotten.laid_pairs, "pair") + (forgotten.laid_pairs == 1 ? " is" : " are")));
    }
  }

  void on_warning(const std::string& text, const batch::Progress& /*progress*/) override {
    console_.warning(text);
  }

  void on_fragment(const store::Fragment& fragment, const batch::Progress& /*progress*/) override {
    if (fragment.state == store::FragmentState::Bad && told_.insert(fragment.error).second) {
      console_.warning(fragment.error);
    }
  }

  /// A bad scan is told once, not with each of its pairs.
  void on_pair(const store::Pair& pair, const batch::Progress& /*progress*/) override {
    if (pair.stage == store::Stage::Failed && told_.insert(pair.error).second) {
      console_.warning(fmt::format("{} and {}: {}", pair.name_a, pair.name_b, pair.error));
    }
  }

 protected:
  Console& console_;

 private:
  std::set<std::string> told_;
};

class ConsoleListener final : public WarningListener {
 public:
  using WarningListener::WarningListener;

  void on_start(const store::Run::Forgotten& forgotten, const batch::Progress& progress) override {
    WarningListener::on_start(forgotten, progress);
    console_.detail(fmt::format("{} of {} pairs are done already", progress.done, progress.total));
  }

  void on_fragment(const store::Fragment& fragment, const batch::Progress& progress) override {
    WarningListener::on_fragment(fragment, progress);
    show("preparing " + fragment.name, progress);
  }

  void on_pair(const store::Pair& pair, const batch::Progress& progress) override {
    WarningListener::on_pair(pair, progress);
    show(fmt::format("{} of {} pairs, {} left", progress.done, progress.total,
                     duration_text(progress.seconds_left.value_or(0.0))),
         progress);
  }

 private:
  void show(const std::string& text, const batch::Progress& progress) {
    const double total = static_cast<double>(progress.total);
    console_.progress(text, total > 0.0 ? static_cast<double>(progress.done) / total : 1.0);
  }
};

/// A file name may be no UTF-8, but JSON must be: such bytes are replaced.  A program that no longer reads wants no more.
void print_line(Console& console, const ordered_json& json) {
  console.result(json.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n");
  if (reader_is_gone()) end_without_reader();
}

void add_progress(ordered_json& json, const batch::Progress& progress) {
  json["done"] = progress.done;
  json["total"] = progress.total;
  json["failed"] = progress.failed;
  json["seconds_left"] =
      progress.seconds_left ? ordered_json(std::round(*progress.seconds_left)) : ordered_json();
}

class JsonListener final : public WarningListener {
 public:
  using WarningListener::WarningListener;

  void on_start(const store::Run::Forgotten& forgotten, const batch::Progress& progress) override {
    WarningListener::on_start(forgotten, progress);
    ordered_json names = ordered_json::array();
    for (const auto& [name, change] : forgotten.fragments)
      if (change != store::Run::Change::Unreadable) names.push_back(name);
    ordered_json json = {
        {"event", "start"},
        {"forgotten",
         {{"all_pairs", forgotten.parameters}, {"fragments", names}, {"laid_pairs", forgotten.laid_pairs}}}};
    add_progress(json, progress);
    print_line(console_, json);
  }

  void on_warning(const std::string& text, const batch::Progress& progress) override {
    WarningListener::on_warning(text, progress);
    ordered_json json = {{"event", "warning"}, {"text", text}};
    add_progress(json, progress);
    print_line(console_, json);
  }

  void on_fragment(const store::Fragment& fragment, const batch::Progress& progress) override {
    WarningListener::on_fragment(fragment, progress);
    const bool bad = fragment.state == store::FragmentState::Bad;
    ordered_json json = {{"event", "fragment"},
                         {"name", fragment.name},
                         {"state", bad ? "bad" : "ready"},
                         {"faces", fragment.faces},
                         {"diameter", fragment.diameter},
                         {"error", bad ? ordered_json(fragment.error) : ordered_json()}};
    add_progress(json, progress);
    print_line(console_, json);
  }

  void on_pair(const store::Pair& pair, const batch::Progress& progress) override {
    WarningListener::on_pair(pair, progress);
    const bool failed = pair.stage == store::Stage::Failed;
    ordered_json json = {
        {"event", "pair"},         {"a", pair.name_a},
        {"b", pair.name_b},        {"stage", name_of(pair.stage)},
        {"score", pair.score},     {"verdict", failed ? ordered_json() : ordered_json(pair.verdict)},
        {"seconds", pair.seconds}, {"error", failed ? ordered_json(pair.error) : ordered_json()}};
    add_progress(json, progress);
    print_line(console_, json);
  }
};

}  // namespace

std::unique_ptr<batch::Listener> make_console_listener(Console& console) {
  return std::make_unique<ConsoleListener>(console);
}

std::unique_ptr<batch::Listener> make_json_listener(Console& console) {
  return std::make_unique<JsonListener>(console);
}

void tell_end_as_json(Console& console, const batch::Summary& summary) {
  ordered_json bad = ordered_json::array();
  for (const store::Fragment& fragment : summary.bad) bad.push_back(fragment.name);
  ordered_json json = {
      {"event", "end"},       {"fragments", summary.fragments},     {"copies", summary.copies},
      {"bad_fragments", bad}, {"done_before", summary.done_before}, {"interrupted", summary.cancelled}};
  add_progress(json, summary.progress);
  print_line(console, json);
}

std::string duration_text(double seconds) {
  if (seconds < 59.5) return fmt::format("{:.0f} s", seconds);
  const long minutes = std::lround(seconds / 60.0);
  return minutes < 60 ? fmt::format("{} min", minutes)
                      : fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

}  // namespace rejoin::cli
