/// rejoin outline assemble
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <numeric>
#include <optional>
#include <set>
#include <system_error>

#include "cli/arguments.hpp"
#include "cli/outline_command.hpp"
#include "cli/outline_json.hpp"
#include "cli/outputs.hpp"
#include "core/files.hpp"
#include "core/words.hpp"
#include "outline/assembly.hpp"
#include "outline/assembly_pictures.hpp"
#include "outline/emd.hpp"
#include "outline/pieces_picture.hpp"
#include "report/similarity_picture.hpp"

namespace rejoin::cli {
namespace {

/// How many parts of an object there would be without the joins that are not sure.
std::size_t firm_parts(const outline::Assembly& assembly, std::size_t group) {
  std::vector<std::size_t> parts(assembly.placements.size());
  std::iota(parts.begin(), parts.end(), std::size_t{0});
  for (const outline::AssemblyJoin& join : assembly.joins)
    if (join.score >= outline::kSureScore)
      std::ranges::replace(parts, std::size_t{parts[join.b]}, std::size_t{parts[join.a]});
  std::set<std::size_t> distinct;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (assembly.placements[i].group == group) distinct.insert(parts[i]);
  return distinct.size();
}

/// Joins that a person has to decide: a border that fits other pieces, too.
std::string contested(const std::vector<outline::Piece>& pieces, const outline::Assembly& assembly) {
  constexpr std::size_t kMost = 8;
  std::string text;
  std::size_t count = 0;
  for (const outline::AssemblyJoin& join : assembly.joins) {
    if (join.rivals.empty()) continue;
    const outline::AssemblyRival& best = join.rivals.front();
    if (join.score >= outline::kSureScore && best.score < outline::kSureScore) continue;
    if (++count > kMost) continue;
    const bool same = best.piece == join.a || best.piece == join.b;
    text += fmt::format("  {} + {} (score {:.2f}): ", pieces[join.a].name, pieces[join.b].name, join.score);
    text += same ? fmt::format("they fit there in another way, too ({:.2f})\n", best.score)
                 : fmt::format("the same border of {} fits {}, too ({:.2f})\n", pieces[best.at].name,
                               pieces[best.piece].name, best.score);
  }
  if (count > kMost)
    text += fmt::format("  and {} whose border fits others, too (\"rivals\" in the JSON)\n",
                        counted(count - kMost, "join"));
  return text;
}

/// What is said of an object all of whose pieces others have the outlines of.
std::string repeated(const outline::Assembly& assembly, std::size_t group, std::size_t size) {
  std::size_t again = 0;
  bool turned = true;
  for (const outline::AssemblyRepeat& repeat : assembly.repeats) {
    if (assembly.placements[repeat.piece].group != group) continue;
    ++again;
    turned = turned && repeat.turned_over;
  }
  if (again < size) return "";
  return turned ? "; all have the outlines of others turned over: pictures of their other sides"
                : "; all have the outlines of others: other scans of them, or cut to the same shapes";
}

/// Why a piece has no place.
std::string without_place(const std::vector<outline::Piece>& pieces, const outline::Assembly& assembly,
                          std::size_t piece) {
  const std::string& name = pieces[piece].name;
  const auto repeat = std::ranges::find(assembly.repeats, piece, &outline::AssemblyRepeat::piece);
  if (repeat != assembly.repeats.end())
    return fmt::format(
        "  fits nowhere: {} (has the outline of {}{}, or cut to one shape)\n", name, pieces[repeat->of].name,
        repeat->turned_over ? " turned over: a picture of its other side" : ": another scan of it");
  const auto refused = std::ranges::find(assembly.refused, piece, &outline::AssemblyRival::piece);
  const double best = refused != assembly.refused.end() ? refused->score : outline::kSureScore;
  for (const outline::AssemblyJoin& join : assembly.joins) {
    const auto rival = std::ranges::find(join.rivals, piece, &outline::AssemblyRival::piece);
    if (rival != join.rivals.end() && rival->score >= best)
      return fmt::format("  its place is taken: {} (fits {}, {:.2f}, but {} lies there)\n", name,
                         pieces[rival->at].name, rival->score,
                         pieces[rival->at == join.a ? join.b : join.a].name);
  }
  if (refused != assembly.refused.end())
    return fmt::format(
        "  has no place: {} (fits {}, {:.2f}, but others are in its way there, or nothing else bears it "
        "out)\n",
        name, pieces[refused->at].name, refused->score);
  return fmt::format("  fits nowhere: {}\n", name);
}

std::string summary(const std::vector<outline::Piece>& pieces, const outline::Assembly& assembly) {
  std::vector<std::size_t> sizes;
  for (const outline::Placement& placement : assembly.placements) {
    if (placement.group >= sizes.size()) sizes.resize(placement.group + 1, 0);
    ++sizes[placement.group];
  }
  const auto proposed = std::count_if(assembly.joins.begin(), assembly.joins.end(),
                                      [](const outline::AssemblyJoin& join) { return join.proposed; });
  std::string text = fmt::format("{} of {} pieces placed; {}",
                                 pieces.size() - assembly.unplaced.size() - assembly.untried.size(),
                                 pieces.size(), counted(assembly.joins.size(), "join"));
  if (!assembly.joins.empty())
    text += fmt::format(", {} found pair by pair, borders {:.3g} apart (rms)", proposed, assembly.rms);
  text += "\n";
  for (std::size_t group = 0; group < sizes.size() && sizes[group] > 1; ++group) {
    const std::size_t parts = firm_parts(assembly, group);
    text += fmt::format("  object {}: {} pieces", group + 1, sizes[group]);
    if (sizes[group] == 2 && parts == 2)
      text += fmt::format(", by a join that is not sure (its score is below {})", outline::kSureScore);
    else if (parts == sizes[group])
      text += fmt::format(", none of whose joins is sure (their scores are below {})", outline::kSureScore);
    else if (parts > 1)
      text +=
          fmt::format(", of which {} parts hold together only by joins that are not sure (scores below {})",
                      parts, outline::kSureScore);
    text += repeated(assembly, group, sizes[group]) + "\n";
  }
  text += contested(pieces, assembly);
  for (const std::size_t piece : assembly.unplaced) text += without_place(pieces, assembly, piece);
  for (const std::size_t piece : assembly.untried)
    text += fmt::format("  not tried with all others: {}\n", pieces[piece].name);
  return text;
}

class OutlineAssembleCommand final : public Command {
 public:
  void define(CLI::App& app) override {
    app.add_option("DIR", folder_, "folder or file of pieces: png, jpg, tif, csv, svg, geojson")
        ->required()
        ->group("Input");
    app.add_option("--json", json_, "write poses and joins (-: to stdout)")
        ->type_name("FILE")
        ->group("Output");
    app.add_option("--out", out_, "write pictures of objects, joins and similarity")
        ->type_name("DIR")
        ->group("Output");
    add_outline_method(app, method_);
    add_calibration(app, calibration_);
    add_picture_options(app, pictures_);
    app.add_flag("--keep-rectangles", pictures_.keep_rectangles,
                 "keep rectangles beside other pieces, as of rulers")
        ->group("Input");
    app.add_option("--leave-out", left_out_, "no piece, by its name in pieces.png; repeatable")
        ->type_name("NAME")
        ->allow_extra_args(false)
        ->group("Input");
  }

  ExitCode run(Console& console, Context& context) override {
    const auto begin = std::chrono::steady_clock::now();
    outline::MultiscaleOptions multiscale;
    apply_calibration(calibration_, method_, multiscale);
    if (out_) require_out();  // first, for --json may lie in it
    if (json_) require_writable_file(*json_);
    outline::PieceSet set = load_folder(folder_, pictures_, console, context);
    leave_out(set);
    const std::size_t count = set.pieces.size();
    if (count < 2)
      throw InputError(folder_,
                       set.left_out.empty() ? "holds one piece only" : "has less than two pieces left",
                       "give a folder of pieces");
    search_pairs_in_full(count * (count - 1) / 2, multiscale);
    check_calibration(calibration_, multiscale, set.pieces, console);
    check_holes(method_, set.pieces, console);
    console.detail(fmt::format("read {} pieces in {:.2f} s", set.pieces.size(), seconds_since(begin)));
    const std::unique_ptr<outline::Matcher> matcher = make_matcher(method_, multiscale);
    matcher->prepare(set.pieces);
    console.detail(fmt::format("prepared after {:.2f} s", seconds_since(begin)));
    const std::unique_ptr<outline::Matcher> second =
        method_ == OutlineMethod::Automatic ? outline::make_emd() : nullptr;
    outline::AssemblyOptions options;
    options.second = second.get();
    const outline::Assembly assembly = outline::assemble(set.pieces, *matcher, options, context);
    console.detail(fmt::format("assembled after {:.2f} s", seconds_since(begin)));
    console.end_progress();
    if (assembly.cancelled) console.warning("interrupted; what follows is less than possible");
    if (json_ && assembly.cancelled && keeps_earlier(*json_, {*json_}, "assembly", console)) json_.reset();
    if (json_) {
      const char* method = method_ == OutlineMethod::Automatic ? "auto" : name_of(method_);
      const OutlineSearch search{method, seconds_since(begin), assembly.cancelled};
      write_file(*json_, assembly_json(set, assembly, search));
    }
    console.result(summary(set.pieces, assembly));
    if (!assembly.unplaced.empty() && method_ != OutlineMethod::Lcs)
      console.result(
          "  what lies upside down fits nowhere either; --method lcs finds it, but takes straight edges for "
          "joins\n");
    if (!assembly.unplaced.empty() && method_ == OutlineMethod::Multiscale)
      console.result(
          "  if a strip is missing between the pieces, as of worn edges, --method emd or auto may place "
          "more\n");
    if (!assembly.joins.empty() && method_ == OutlineMethod::Lcs)
      console.result("  lcs takes straight edges for joins: look at every one of them\n");
    if (json_) console.result(fmt::format("wrote {}\n", *json_));
    if (out_ && !assembly.cancelled) write_pictures(set.pieces, assembly, console, context);
    return assembly.cancelled ? kInterrupted : finished_with(set, console);
  }

 private:
  /// \throws UsageError the user's own pictures among the pieces, or --json, have names of what would be written
  void require_out() const {
    if (json_ && outline::has_result_name(*json_))
      require_apart_from_outputs("--json", json_,
                                 {std::filesystem::path(*out_) / std::filesystem::path(*json_).filename()});
    require_writable_folder(*out_);
    std::error_code ignored;
    if (!std::filesystem::equivalent(*out_, folder_, ignored)) return;
    const auto foreign = outline::foreign_result(*out_);
    if (foreign)
      throw UsageError(foreign->string(), "lies among the pieces and would be lost",
                       "give --out another place");
  }

  void leave_out(outline::PieceSet& set) const {
    const auto known = [](const std::vector<outline::LeftOut>& list, const std::string& name) {
      return std::ranges::find(list, name, &outline::LeftOut::name) != list.end();
    };
    for (const std::string& name : left_out_) {
      if (known(set.left_out, name) || known(set.repeated, name)) continue;
      const auto piece = std::ranges::find(set.pieces, name, &outline::Piece::name);
      if (piece == set.pieces.end())
        throw UsageError("--leave-out", fmt::format("'{}' names no piece of the folder", name),
                         "take a name from pieces.png, as scan.jpg#2");
      set.pieces.erase(piece);
      set.left_out.push_back({name, "left out by the user"});
    }
  }

  void write_pictures(const std::vector<outline::Piece>& pieces, const outline::Assembly& assembly,
                      Console& console, const Context& context) const {
    context.report("drawing pictures", 0.0);  // reads all scans again
    std::vector<std::filesystem::path> files{std::filesystem::path(*out_) / "pieces.png"};
    outline::write_pieces_picture(files[0], pieces);
    for (auto& file : outline::write_assembly_pictures(*out_, pieces, assembly))
      files.push_back(std::move(file));
    files.push_back(std::filesystem::path(*out_) / "similarity.png");
    report::write_similarity_picture(files.back(), pieces, assembly);
    console.end_progress();
    for (const std::filesystem::path& file : files) console.result(fmt::format("wrote {}\n", file.string()));
  }

  std::string folder_;
  std::optional<std::string> json_;
  std::optional<std::string> out_;
  std::optional<std::string> calibration_;
  outline::ExtractOptions pictures_;
  std::vector<std::string> left_out_;
  OutlineMethod method_ = OutlineMethod::Automatic;
};

}  // namespace

std::unique_ptr<Command> make_outline_assemble_command() {
  return std::make_unique<OutlineAssembleCommand>();
}

}  // namespace rejoin::cli
