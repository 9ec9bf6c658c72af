#include "cli/help.hpp"

#include <fmt/core.h>

namespace rejoin::cli {
namespace {

std::string option_names(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name(true);
  std::string names;
  for (const std::string& name : option.get_snames()) names += "-" + name + ", ";
  for (const std::string& name : option.get_lnames()) names += "--" + name + ", ";
  names.resize(names.size() - 2);
  return names;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Whether `second` is the "-b" to the "-a" of `first`.
bool is_pair(const HelpLine& first, const HelpLine& second) {
  return ends_with(first.names, "-a") && ends_with(second.names, "-b") &&
         first.names.substr(0, first.names.size() - 1) == second.names.substr(0, second.names.size() - 1);
}

void add_line(std::vector<HelpGroup>& groups, const std::string& heading, HelpLine line) {
  for (HelpGroup& group : groups) {
    if (group.heading != heading) continue;
    if (is_pair(group.lines.back(), line)) {
      group.lines.back().names += "|-b";
    } else if (line.description.empty()) {  // told with the one before
      group.lines.back().names += " " + line.names;
    } else {
      group.lines.push_back(std::move(line));
    }
    return;
  }
  groups.push_back({heading, {std::move(line)}});
}

std::string layout(const std::string& left, const std::string& description) {
  return fmt::format("  {:<23} {}\n", left, description);
}

std::string layout(const HelpGroup& group) {
  std::string text = group.heading + ":\n";
  for (const HelpLine& line : group.lines) {
    text += layout(line.argument.empty() ? line.names : line.names + " " + line.argument, line.description);
  }
  return text;
}

}  // namespace

std::vector<HelpGroup> help_groups(const CLI::App& app) {
  std::vector<HelpGroup> groups;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    const std::string argument =
        option->get_positional() || option->get_type_size_max() == 0 ? "" : option->get_type_name();
    add_line(groups, option->get_group(), {option_names(*option), argument, option->get_description()});
  }
  return groups;
}

std::string usage_line(const CLI::App& app) {
  std::string line = app.get_name();
  for (const CLI::App* parent = app.get_parent(); parent; parent = parent->get_parent())
    line.insert(0, parent->get_name() + " ");
  if (!visible_subcommands(app).empty()) return line + " COMMAND [OPTIONS]";
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional()) continue;
    line += " " + option->get_name(true);
    if (option->get_items_expected_max() > 1) line += "...";
  }
  return line + " [OPTIONS]";
}

std::vector<const CLI::App*> visible_subcommands(const CLI::App& app) {
  std::vector<const CLI::App*> commands;
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (!command->get_group().empty()) commands.push_back(command);
  }
  return commands;
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string /*name*/,
                                     CLI::AppFormatMode /*mode*/) const {
  std::string text = fmt::format("Usage: {}\n{}\n", usage_line(*app), app->get_description());
  const std::vector<const CLI::App*> commands = visible_subcommands(*app);
  if (!commands.empty()) text += "\nCommands:\n";
  for (const CLI::App* command : commands) text += layout(command->get_name(), command->get_description());
  // Lines are scarce: the longest help has just as many as a terminal.
  std::string gap = commands.empty() ? "" : "\n";
  for (const HelpGroup& group : help_groups(*app)) {
    text += gap + layout(group);
    gap = "\n";
  }
  const std::string footer = app->get_footer();
  return footer.empty() ? text : text + footer + "\n";
}

}  // namespace rejoin::cli
