/// Help pages, man pages and completion from one description of the options.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace rejoin::cli {

/// One line of help.
struct HelpLine {
  std::string names;     ///< "A", "--json", "--direction-a|-b"
  std::string argument;  ///< "FILE"; empty for a flag
  std::string description;
};

/// Options under one heading.
struct HelpGroup {
  std::string heading;
  std::vector<HelpLine> lines;
};

/// The visible options of a command, in the order of their definition.  Two options that differ only in their
/// last "-a" and
/// "-b" share a line.
std::vector<HelpGroup> help_groups(const CLI::App& app);

/// "rejoin match [OPTIONS] A B"
std::string usage_line(const CLI::App& app);

/// The subcommands that are not hidden.
std::vector<const CLI::App*> visible_subcommands(const CLI::App& app);

/// Writes help that fits a screen of 80 columns.
class HelpFormatter : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
};

}  // namespace rejoin::cli
