/// rejoin split
#include "mesh/split.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "cli/arguments.hpp"
#include "cli/command.hpp"
#include "cli/fragment.hpp"
#include "cli/interrupt.hpp"
#include "cli/json_values.hpp"
#include "cli/outputs.hpp"
#include "core/files.hpp"
#include "core/version.hpp"
#include "core/words.hpp"
#include "mesh/load.hpp"
#include "mesh/save.hpp"
#include "report/split_picture.hpp"

namespace rejoin::cli {
namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

std::string file_name(const std::string& scan, std::size_t number) {
  return fmt::format("{}_{}.ply", fs::path(scan).stem().string(), number);
}

/// \throws UsageError pieces of two scans would have the same names
void require_different_stems(const std::vector<std::string>& scans) {
  std::map<std::string, std::string> scan_of;
  for (const std::string& scan : scans) {
    const auto [earlier, first] = scan_of.emplace(fs::path(scan).stem().string(), scan);
    if (!first) {
      throw UsageError(scan, fmt::format("its pieces would have the names of those of {}", earlier->second),
                       "split them into two folders, or rename one");
    }
  }
}

/// \throws UsageError the file may be that of a piece
void require_no_piece(const std::string& option, const std::string& file, const fs::path& folder,
                      const std::vector<std::string>& scans) {
  std::error_code ignored;  // of a folder that is not there yet
  const fs::path path = fs::weakly_canonical(fs::absolute(file), ignored);
  if (path.parent_path() != fs::weakly_canonical(fs::absolute(folder) / "piece", ignored).parent_path())
    return;
  const bool may_be_piece = std::ranges::any_of(scans, [&](const std::string& scan) {
    const std::string begin = fs::path(scan).stem().string() + "_";
    return path.extension() == ".ply" && path.filename().string().starts_with(begin);
  });
  if (may_be_piece)
    throw UsageError(file, "has a name that a piece may get", fmt::format("give {} another name", option));
}

std::string bounds_text(const mesh::Mesh& piece) {
  const mesh::Box box = mesh::bounds(piece);
  const glm::vec3 size = box.high - box.low;
  return fmt::format("{:.4g} x {:.4g} x {:.4g}", size.x, size.y, size.z);
}

/// What was made of a scan, in a line.
/// \param table_is_asked  whether the scan was looked at for a table
std::string summary(const std::string& path, const mesh::Mesh& scan, const mesh::Split& split,
                    bool table_is_asked) {
  const bool cloud = scan.is_cloud();
  const char* of_it = cloud ? "of its points" : "of its area";
  std::string text = fmt::format("{}: {}", path, counted(split.pieces.size(), "piece"));
  if (split.table) {
    text += fmt::format("; cut off the table ({:.0f} % {}) up to {:.3g} above it", 100.0 * split.table_share,
                        of_it, split.cut);
  } else {
    const bool one = split.pieces.size() == 1;
    text += one && split.crumbs.parts == 0 ? " and no table: nothing to split" : ", no table";
    if (one && table_is_asked) text += " (if it lies on a table, say --table yes)";
  }
  if (split.crumbs.parts > 0) {
    text += fmt::format("; left out {} ({}, {:.3g} % {}; the largest has {:.3g} % of the largest piece)",
                        counted(split.crumbs.parts, "crumb"),
                        counted(split.crumbs.elements, cloud ? "point" : "face"), 100.0 * split.crumbs.share,
                        of_it, 100.0 * split.crumbs.largest);
  }
  return text + "\n";
}

std::string table_of(const std::string& path, const std::vector<mesh::Mesh>& pieces) {
  std::string text;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const mesh::Mesh& piece = pieces[k];
    text += fmt::format(
        "  {:<30} {:>16}  {}\n", file_name(path, k + 1),
        piece.is_cloud() ? counted(piece.vertices.size(), "point") : counted(piece.faces.size(), "face"),
        bounds_text(piece));
  }
  return text;
}

ordered_json split_json(const std::string& path, const mesh::Split& split) {
  ordered_json pieces = ordered_json::array();
  for (const mesh::Mesh& piece : split.pieces) {
    const mesh::Box box = mesh::bounds(piece);
    pieces.push_back({{"file", file_name(path, pieces.size() + 1)},
                      {"faces", piece.faces.size()},
                      {"points", piece.vertices.size()},
                      {"area", piece.is_cloud() ? ordered_json() : ordered_json(mesh::surface_area(piece))},
                      {"bounds",
                       {cli::to_json(piece.origin + glm::dvec3(box.low)),
                        cli::to_json(piece.origin + glm::dvec3(box.high))}}});
  }
  ordered_json table;
  if (split.table) {
    table = {{"share", split.table_share}, {"direction", cli::to_json(split.table->up)}, {"cut", split.cut}};
  }
  return {{"path", path},
          {"table", table},
          {"crumbs",
           {{"parts", split.crumbs.parts},
            {"elements", split.crumbs.elements},
            {"share", split.crumbs.share},
            {"largest", split.crumbs.largest}}},
          {"pieces", pieces}};
}

class SplitCommand final : public Command {
 public:
  void define(CLI::App& app) override {
    app.add_option("SCAN", scans_, "scans of several pieces, on a table or not")->required()->group("Input");
    app.add_option("--out", out_, "new or empty folder for SCAN_1.ply (largest), ...")
        ->type_name("DIR")
        ->required()
        ->group("Output");
    app.add_option("--json", json_, "write what was written or left out (-: to stdout)")
        ->type_name("FILE")
        ->group("Output");
    app.add_option("--png", png_, "write a picture of the pieces from six sides, numbered")
        ->type_name("FILE")
        ->group("Output");
    app.option_defaults()->group("Cut (touching pieces are one: scan them apart, or raise --cut)");
    using TableUse = mesh::SplitOptions::TableUse;
    add_choice<TableUse>(app, "--table", options_.table,
                         {{"auto", TableUse::Auto}, {"yes", TableUse::Yes}, {"no", TableUse::No}},
                         "whether they lie on one (auto)");
    add_number(app, "--cut", options_.cut, {0, 1e9, "H"}, "height of the cut above the table (the spacing)");
    add_number(app, "--least", least_, {0, 100, "P"}, "smallest piece, percent of the largest, 0 to 100 (1)");
  }

  ExitCode run(Console& console, Context& context) override {
    require_ending("--png", png_, ".png");
    for (const std::string& scan : scans_)
      require_no_folder(scan, fmt::format("name the scans in it: {}", (fs::path(scan) / "*.ply").string()));
    require_different_stems(scans_);
    if (options_.cut && options_.table == mesh::SplitOptions::TableUse::No)
      throw UsageError("--cut", "is a height above a table", "leave it or --table no away");
    if (json_) require_no_piece("--json", *json_, out_, scans_);
    OutputFolder output(out_);
    for (const auto& file : {json_, png_}) {
      if (file) require_writable_file(*file);
    }
    options_.least = least_ / 100.0;
    bool failed = false;
    for (const std::string& path : scans_) {
      context.report("split " + path, 0.0);
      if (!split_one(path, output, console)) failed = true;
      if (!context.cancelled()) continue;
      console.warning("interrupted; the pieces of further scans are not written");
      return kInterrupted;
    }
    for (const auto& file : {json_, png_}) {
      if (file) output.add(*file);
    }
    if (json_)
      write_file(*json_, text_of({{"schema", "rejoin.split/1"}, {"scans", result_}, {"version", kVersion}}));
    if (png_ && !pictures_.empty()) report::write_png(*png_, report::stacked(pictures_));
    for (const auto& file : {json_, png_}) {
      if (file && (file != png_ || !pictures_.empty())) console.wrote(*file);
    }
    return failed ? kFailure : kDone;
  }

 private:
  /// \return false: the scan cannot be used, which is told
  bool split_one(const std::string& path, OutputFolder& output, Console& console) {
    mesh::Loaded scan;
    mesh::Split split;
    try {
      const NothingToSave guard;
      require_tellable_name(path);
      scan = mesh::load(path, mesh::Weld::Places, mesh::Content::Several);
      split = mesh::split(path, scan.mesh, options_);
    } catch (const Error& error) {
      console.warning(error.what());
      result_.push_back({{"path", path}, {"error", error.what()}});
      return false;
    }
    for (const std::size_t k : split.touching) {
      scan.warnings.push_back(
          fmt::format("{}: {} may be pieces that touch: it falls apart {:.3g} above the table (look at "
                      "--png; scan them apart, or "
                      "raise --cut)",
                      path, file_name(path, k + 1), mesh::kHigherCut * split.cut));
    }
    for (const std::string& warning : scan.warnings) console.warning(warning);
    for (std::size_t k = 0; k < split.pieces.size(); ++k)
      mesh::save(output.file(file_name(path, k + 1)), split.pieces[k]);
    const bool table_is_asked = options_.table != mesh::SplitOptions::TableUse::No;
    console.result(summary(path, scan.mesh, split, table_is_asked) + table_of(path, split.pieces));
    result_.push_back(split_json(path, split));
    result_.back()["warnings"] = scan.warnings;
    if (png_) pictures_.push_back(report::split_picture(path, split.pieces));
    return true;
  }

  std::vector<std::string> scans_;
  std::string out_;
  std::optional<std::string> json_;
  std::optional<std::string> png_;
  mesh::SplitOptions options_;
  double least_ = 1.0;
  ordered_json result_ = ordered_json::array();
  std::vector<report::Image> pictures_;
};

}  // namespace

std::unique_ptr<Command> make_split_command() {
  return std::make_unique<SplitCommand>();
}

}  // namespace rejoin::cli
