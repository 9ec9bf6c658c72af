/// The commands of rejoin outline, and what they share.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "cli/command.hpp"
#include "outline/matcher.hpp"
#include "outline/multiscale.hpp"
#include "outline/read.hpp"

namespace rejoin::cli {

std::unique_ptr<Command> make_outline_calibrate_command();
std::unique_ptr<Command> make_outline_match_command();
std::unique_ptr<Command> make_outline_assemble_command();
std::unique_ptr<Command> make_outline_shatter_command();

/// How outlines are compared.
enum class OutlineMethod { Automatic, Multiscale, Lcs, Emd, Frechet };

/// Adds --method.
void add_outline_method(CLI::App& app, OutlineMethod& method);

/// Adds --calibration, which goes with it.
void add_calibration(CLI::App& app, std::optional<std::string>& calibration);

/// Adds --dust, --keep-core, --keep-threads and --part-touching.
void add_picture_options(CLI::App& app, outline::ExtractOptions& options);

/// Reads a calibration into the options, if one is given.
/// \throws UsageError the method is not multiscale, which alone has such numbers
/// \throws IoError, InputError see read_calibration()
void apply_calibration(const std::optional<std::string>& calibration, OutlineMethod method,
                       outline::MultiscaleOptions& options);

/// Warns of a calibration that hardly fits the pieces.
/// \throws InputError it does not at all
void check_calibration(const std::optional<std::string>& calibration,
                       const outline::MultiscaleOptions& options, const std::vector<outline::Piece>& pieces,
                       Console& console);

/// Sets the search of a pair as thorough as a single one can afford to be, if there are few pairs, so that a folder of few
/// pieces has the joins that outline match finds.
void search_pairs_in_full(std::size_t pairs, outline::MultiscaleOptions& options);

/// "multiscale" ...; what Automatic stands for is named as such.
const char* name_of(OutlineMethod method);

/// Warns of long holes where the method compares none.
void check_holes(OutlineMethod method, const std::vector<outline::Piece>& pieces, Console& console);

/// The matcher of a method.
std::unique_ptr<outline::Matcher> make_matcher(OutlineMethod method,
                                               const outline::MultiscaleOptions& multiscale = {});

/// A piece as results name it: "scan.jpg#2" is the second largest of scan.jpg.
struct PieceName {
  std::string file;
  std::size_t number = 1;
  bool numbered = false;
};

/// What the user means; a file that is called so is taken as such.
PieceName piece_name(const std::string& given);

/// A piece of a file, the largest if no number is given; tells of repairs, and then of further pieces.
/// \throws InputError the file holds less pieces
outline::Piece load_piece(const PieceName& name, const outline::ExtractOptions& options, Console& console);

/// The pieces of a folder; tells of repairs, of files that cannot be used and of copies.
outline::PieceSet load_folder(const std::string& folder, const outline::ExtractOptions& options,
                              Console& console, const Context& context);

/// The exit code of a command that has used a folder: kFailure, told, if a file of it could not be used.
ExitCode finished_with(const outline::PieceSet& set, Console& console);

/// A true join's score is hardly ever below: "no join".
inline constexpr double kUnsureScore = 0.3;

/// A score's verdict: "join", "unsure" or "no join".
const char* outline_verdict(double score);

}  // namespace rejoin::cli
