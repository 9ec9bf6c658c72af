#include "cli/outline_command.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "cli/arguments.hpp"
#include "cli/interrupt.hpp"
#include "cli/outline_calibration.hpp"
#include "core/error.hpp"
#include "core/words.hpp"
#include "outline/emd.hpp"
#include "outline/lcs.hpp"

namespace rejoin::cli {
namespace {

// Nothing is found yet that Ctrl-C could save, and one picture may take long.
outline::PieceSet read_file_or_end(const std::string& path, const outline::ExtractOptions& options) {
  const NothingToSave guard;
  return outline::read_pieces(path, options);
}

outline::PieceSet read_folder_or_end(const std::string& folder, const outline::ExtractOptions& options,
                                     const Context& context) {
  const NothingToSave guard;
  return outline::read_folder(folder, options, context);
}

/// "FILE: TEXT" notes, those of one text as one: thirty pictures of one scanner have the same doubt.
std::vector<std::string> told_together(const std::vector<std::string>& notes) {
  constexpr std::size_t kMost = 3;  // told one by one
  std::map<std::string, std::vector<std::string>> files;
  for (const std::string& note : notes)
    if (const std::size_t at = note.find(": "); at != std::string::npos)
      files[note.substr(at)].push_back(note.substr(0, at));
  std::vector<std::string> result;
  for (const std::string& note : notes) {
    const std::size_t at = note.find(": ");
    const std::vector<std::string>* same = at == std::string::npos ? nullptr : &files[note.substr(at)];
    if (!same || same->size() <= kMost) {
      result.push_back(note);
    } else if (same->front() == note.substr(0, at)) {
      result.push_back(
          fmt::format("{}, {} and {} more{}", (*same)[0], (*same)[1], same->size() - 2, note.substr(at)));
    }
  }
  return result;
}

/// Those of six pieces.  More are seldom joined by one pair alone, and a search in full has more false candidates as well.
constexpr std::size_t kFewPairs = 15;

const Choices<OutlineMethod> kMethods{{"auto", OutlineMethod::Automatic},
                                      {"multiscale", OutlineMethod::Multiscale},
                                      {"lcs", OutlineMethod::Lcs},
                                      {"emd", OutlineMethod::Emd},
                                      {"frechet", OutlineMethod::Frechet}};

}  // namespace

void add_outline_method(CLI::App& app, OutlineMethod& method) {
  add_choice(app, "--method", method, kMethods, "how to compare (auto)")->group("Search");
}

void add_calibration(CLI::App& app, std::optional<std::string>& calibration) {
  app.add_option("--calibration", calibration, "from outline calibrate (the usual numbers)")
      ->type_name("FILE")
      ->group("Input");
}

void add_picture_options(CLI::App& app, outline::ExtractOptions& options) {
  add_number(app, "--dust", options.dust, {0, 50, "PERCENT"}, "smallest piece, 0 to 50 % of the largest (2)")
      ->group("Input");
  app.add_flag("--keep-core", options.keep_core, "torn prints: keep the white rims along their tears")
      ->group("Input");
  app.add_flag("--keep-threads", options.keep_threads, "keep hairs and threads that run out of pieces")
      ->group("Input");
  app.add_flag("--part-touching", options.part_touching, "part pieces of a picture where they touch")
      ->group("Input");
}

void apply_calibration(const std::optional<std::string>& calibration, OutlineMethod method,
                       outline::MultiscaleOptions& options) {
  if (!calibration) return;
  if (method != OutlineMethod::Automatic && method != OutlineMethod::Multiscale) {
    throw UsageError("--calibration", fmt::format("serves multiscale only, not {}", name_of(method)),
                     "leave it out, or --method");
  }
  read_calibration(*calibration, options);
}

void check_calibration(const std::optional<std::string>& calibration,
                       const outline::MultiscaleOptions& options, const std::vector<outline::Piece>& pieces,
                       Console& console) {
  const auto doubt = calibration ? doubt_calibration(*calibration, options, pieces) : std::nullopt;
  if (doubt) console.warning(*doubt);
}

void search_pairs_in_full(std::size_t pairs, outline::MultiscaleOptions& options) {
  if (pairs > kFewPairs) return;
  // Short boundaries, too, and whatever might be one is fitted: the shape of the samples alone tells little of so short a stretch,
  // so that the true one is often far down.  Where the outline is blurred it is that at the coarse scales, too.
  options.min_length_share = 1.0 / 40.0;
  options.per_pair = 256;
  options.fitted = 256;
  options.per_coarse_scale = 16;
}

const char* name_of(OutlineMethod method) {
  switch (method) {
    case OutlineMethod::Automatic:
    case OutlineMethod::Multiscale:
      break;
    case OutlineMethod::Lcs:
      return "lcs";
    case OutlineMethod::Emd:
      return "emd";
    case OutlineMethod::Frechet:
      return "frechet";
  }
  return "multiscale";
}

void check_holes(OutlineMethod method, const std::vector<outline::Piece>& pieces, Console& console) {
  constexpr double kLong = 1.0 / 12.0;  // of the middle piece's border
  if (method == OutlineMethod::Automatic || method == OutlineMethod::Multiscale) return;
  const double least = kLong * outline::median_perimeter(pieces);
  const auto holed = std::ranges::find_if(pieces, [&](const outline::Piece& piece) {
    return outline::long_borders(piece.outline, least).size() > 1;
  });
  if (holed == pieces.end()) return;
  console.warning(fmt::format("{} has a hole, and what may lie in holes is found by multiscale only, not {}",
                              holed->name, name_of(method)));
}

std::unique_ptr<outline::Matcher> make_matcher(OutlineMethod method,
                                               const outline::MultiscaleOptions& multiscale) {
  switch (method) {
    case OutlineMethod::Automatic:
    case OutlineMethod::Multiscale:
      break;
    case OutlineMethod::Lcs:
      return outline::make_lcs();
    case OutlineMethod::Emd:
      return outline::make_emd();
    case OutlineMethod::Frechet:
      return outline::make_frechet();
  }
  return outline::make_multiscale(multiscale);
}

PieceName piece_name(const std::string& given) {
  constexpr std::size_t kMostDigits = 9;
  const std::size_t at = given.rfind('#');
  std::error_code ignored;
  if (at == std::string::npos || at == 0 || std::filesystem::exists(given, ignored)) return {given, 1, false};
  const std::string number = given.substr(at + 1);
  const bool numbered = !number.empty() && number.size() <= kMostDigits && number[0] != '0' &&
                        number.find_first_not_of("0123456789") == std::string::npos;
  if (!numbered) return {given, 1, false};
  return {given.substr(0, at), std::stoul(number), true};
}

outline::Piece load_piece(const PieceName& name, const outline::ExtractOptions& options, Console& console) {
  outline::PieceSet set = read_file_or_end(name.file, options);
  for (const std::string& note : set.notes) console.warning(note);
  const std::string has = "holds " + counted(set.pieces.size(), "piece");
  if (name.number > set.pieces.size())
    throw InputError(fmt::format("{}#{}", name.file, name.number), "the file " + has, "give a lower number");
  if (set.pieces.size() > 1 && !name.numbered)
    console.warning(fmt::format("{}: {}; the largest is taken, {}#2 is the next", name.file, has, name.file));
  return std::move(set.pieces[name.number - 1]);
}

outline::PieceSet load_folder(const std::string& folder, const outline::ExtractOptions& options,
                              Console& console, const Context& context) {
  outline::PieceSet set = read_folder_or_end(folder, options, context);
  console.end_progress();
  for (const std::string& note : told_together(set.notes)) console.warning(note);
  for (const outline::LeftOut& file : set.unusable) console.warning(file.reason);
  for (const outline::LeftOut& piece : set.repeated) console.warning(piece.reason);
  return set;
}

ExitCode finished_with(const outline::PieceSet& set, Console& console) {
  if (set.unusable.empty()) return kDone;
  console.warning(
      fmt::format("{} of the folder's files cannot be used; mend them and run the same command again",
                  set.unusable.size()));
  return kFailure;
}

const char* outline_verdict(double score) {
  return score >= outline::kSureScore ? "join" : score >= kUnsureScore ? "unsure" : "no join";
}

}  // namespace rejoin::cli
