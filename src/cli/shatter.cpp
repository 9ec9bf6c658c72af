/// rejoin shatter
#include "shatter/shatter.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "cli/arguments.hpp"
#include "cli/command.hpp"
#include "cli/json_values.hpp"
#include "cli/outputs.hpp"
#include "core/files.hpp"
#include "core/version.hpp"
#include "core/words.hpp"
#include "mesh/load.hpp"
#include "mesh/save.hpp"

namespace rejoin::cli {
namespace {

using nlohmann::ordered_json;

constexpr double kToldLoss = 0.02;  // share of the object; less are splinters

/// All as wide as the last of `count`, so that lists by name are in order.
std::string file_name(std::size_t number, std::size_t count) {
  const std::size_t width = std::max<std::size_t>(2, std::to_string(count - 1).size());
  return fmt::format("fragment_{:0{}}.ply", number, width);
}

ordered_json truth_json(const std::string& solid, const shatter::Options& options,
                        const shatter::Shattered& shattered) {
  ordered_json fragments = ordered_json::object();
  const std::size_t count = shattered.pieces.size();
  for (std::size_t k = 0; k < count; ++k) {
    const shatter::Piece& piece = shattered.pieces[k];
    fragments[file_name(k, count)] = {{"faces", piece.scan.faces.size()},
                                      {"to_world", to_json(piece.to_world)}};
  }
  ordered_json joins = ordered_json::array();
  for (const shatter::Contact& contact : shattered.contacts) {
    joins.push_back({file_name(contact.a, count), file_name(contact.b, count), contact.area});
  }
  return {{"solid", std::filesystem::path(solid).filename().string()},
          {"unit", "as in the file"},
          {"diameter", shattered.diameter},
          {"lost", shattered.lost},
          {"seed", options.seed},
          {"cracks", options.cracks},
          {"roughness", options.roughness},
          {"erode", options.erosion * shattered.diameter},
          {"chips", options.chips},
          {"noise", options.noise * shattered.diameter},
          {"correlated", options.correlated * shattered.diameter},
          {"wavelength", options.wavelength * shattered.diameter},
          {"closed", options.closed},
          {"spacing", options.spacing * shattered.diameter},
          {"version", kVersion},
          {"fragments", fragments},
          {"joins", joins}};
}

class ShatterCommand final : public Command {
 public:
  void define(CLI::App& app) override {
    app.add_option("MESH", path_, "closed surface: ply, obj, stl, off, gltf, glb or drc")
        ->required()
        ->group("Input");
    app.add_option("--out", out_, "new or empty folder for fragments and truth.json")
        ->type_name("DIR")
        ->required()
        ->group("Output");
    app.option_defaults()->group("Break (lengths in percent of the diameter)");
    add_number(app, "--pieces", options_.pieces, {2, 10000}, "how many fragments, 2 to 10000 (8)");
    add_seed(app, options_.seed, "another seed, another break");
    app.add_flag("--cracks", options_.cracks, "bent cracks, one after another, that end at older ones");
    add_number(app, "--roughness", options_.roughness, {0, 4},
               "of the breaks: 0 plane, 1 stone, up to 4 (1)");
    add_number(app, "--erosion", erosion_, {0, 5}, "radius of worn edges, 0 to 5 (0.1)");
    add_number(app, "--chips", options_.chips, {0, 100}, "mean number of chips off a fragment (3)");
    add_number(app, "--noise", noise_, {0, 1}, "deviation of the scanner, 0 to 1 (0.01)");
    add_number(app, "--correlated", correlated_, {0, 1}, "deviation that near points share, 0 to 1 (0)");
    add_number(app, "--wavelength", wavelength_, {0.1, 50}, "of that deviation, 0.1 to 50 (2)");
    add_number(app, "--closed-holes", closed_, {0, 90}, "percent of breaks, closed smoothly, 0 to 90 (0)");
    add_number(app, "--spacing", spacing_, {0.05, 5}, "edge length of the meshes, 0.05 to 5 (0.4)");
  }

  ExitCode run(Console& console, Context& context) override {
    OutputFolder output(out_);
    options_.erosion = erosion_ / 100.0;
    options_.noise = noise_ / 100.0;
    options_.correlated = correlated_ / 100.0;
    options_.wavelength = wavelength_ / 100.0;
    options_.closed = closed_ / 100.0;
    options_.spacing = spacing_ / 100.0;
    const mesh::Loaded loaded = mesh::load(path_, mesh::Weld::Places, mesh::Content::Whole);
    for (const std::string& warning : loaded.warnings) console.warning(warning);
    const shatter::Shattered shattered = shatter::shatter(path_, loaded.mesh, options_, context);
    console.end_progress();
    if (shattered.cancelled) {
      console.warning("interrupted; nothing is written");
      return kInterrupted;
    }
    if (shattered.lost >= kToldLoss) {
      console.warning(fmt::format(
          "{}: {:.0f} % of it is lost, as not all pieces hang together and only the largest part of "
          "each is written; give --cracks, another --seed or other --pieces, or a smaller --spacing",
          path_, 100 * shattered.lost));
    }
    if (shattered.contacts.empty()) {
      console.warning(fmt::format(
          "{}: no two fragments touch: edges of {:.3g} % of its diameter are too long for so thin a "
          "wall, or the breaks are too worn; give a smaller --spacing or --erosion",
          path_, spacing_));
    }
    for (std::size_t k = 0; k < shattered.pieces.size(); ++k) {
      mesh::save(output.file(file_name(k, shattered.pieces.size())), shattered.pieces[k].scan);
    }
    const std::string truth = output.file("truth.json").string();
    write_file(truth, text_of(truth_json(path_, options_, shattered)));
    console.result(fmt::format("{}, {}\nwrote {}\n", counted(shattered.pieces.size(), "fragment"),
                               counted(shattered.contacts.size(), "join"), truth));
    return kDone;
  }

 private:
  std::string path_;
  std::string out_;
  double erosion_ = 0.1;
  double noise_ = 0.01;
  double correlated_ = 0.0;
  double wavelength_ = 2.0;
  double closed_ = 0.0;
  double spacing_ = 0.4;
  shatter::Options options_;
};

}  // namespace

std::unique_ptr<Command> make_shatter_command() {
  return std::make_unique<ShatterCommand>();
}

}  // namespace rejoin::cli
