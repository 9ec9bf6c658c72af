/// rejoin outline shatter
#include <fmt/core.h>

#include <filesystem>

#include "cli/arguments.hpp"
#include "cli/outline_command.hpp"
#include "cli/outputs.hpp"
#include "core/files.hpp"
#include "core/words.hpp"
#include "outline/shatter.hpp"

namespace rejoin::cli {
namespace {

/// What a piece's file holds.
enum class Format { Csv, Pixels, Png };

const Choices<Format> kFormats{{"csv", Format::Csv}, {"pixels", Format::Pixels}, {"png", Format::Png}};

std::string csv_of(const outline::Outline& outline) {
  std::string text = "x,y_down\n";  // pixels of a scan
  for (const glm::dvec2& p : outline.points) text += fmt::format("{:.4f},{:.4f}\n", p.x, p.y);
  return text;
}

class OutlineShatterCommand final : public Command {
 public:
  void define(CLI::App& app) override {
    app.add_option("DIR", folder_, "new or empty folder for the pieces and truth.json")
        ->type_name("DIR")
        ->required()
        ->group("Output");
    add_choice(app, "--format", format_, kFormats, "pixels: of edges (csv)")->group("Output");
    app.option_defaults()->group("Objects");
    CLI::Option* shapes =
        add_number(app, "--shapes", shapes_, {1, 10000}, "random polygons to break, 1 to 10000 (1)");
    add_number(app, "--tiles", tiles_, {1, 10000}, "tiles of 100 to 150 mm instead, 1 to 10000")
        ->excludes(shapes);
    add_number(app, "--pieces", options_.pieces, {2, 100000}, "in all, 2 to 100000 (8)");
    add_number(app, "--resolution", resolution_, {10, 2400}, "10 to 2400; a unit (100), of tiles dpi (300)");
    app.option_defaults()->group("Damage");
    add_number(app, "--wear", options_.wear, {0, 20, "PX"}, "pixels worn off the edges, 0 to 20 (0)");
    add_number(app, "--noise", options_.noise, {0, 3, "PX"},
               "deviation of the scanned edge, 0 to 3 pixels (0)");
    app.add_flag("--flip", options_.flip, "about half of the pieces lie upside down");
    add_seed(app, options_.seed, "of the random numbers");
  }

  ExitCode run(Console& console, Context& context) override {
    const outline::ShatterOptions options = complete_options();
    OutputFolder output(folder_);
    context.report("breaking", 0.0);
    const outline::Shattered broken = outline::shatter(options, context);
    if (context.cancelled()) return interrupted(console);
    const std::string ending = format_ == Format::Png ? ".png" : ".csv";
    for (std::size_t n = 0; n < broken.pieces.size(); ++n) {
      if (context.cancelled()) return interrupted(console);
      context.report("writing pieces", static_cast<double>(n) / static_cast<double>(broken.pieces.size()));
      write_file(output.file(broken.pieces[n].piece.name + ending), content_of(broken.pieces[n], options));
    }
    const std::string truth = output.file("truth.json").string();
    write_file(truth, outline::truth_json(broken, options, ending));
    console.result(
        fmt::format("{} of {}, {}\nwrote {}\n", counted(broken.pieces.size(), "piece"),
                    counted(static_cast<std::size_t>(options.objects), tiles_ > 0 ? "tile" : "shape"),
                    counted(broken.joins.size(), "join"), truth));
    return kDone;
  }

 private:
  static ExitCode interrupted(Console& console) {
    console.end_progress();
    console.warning("interrupted; the folder is not complete");
    return kInterrupted;
  }

  outline::ShatterOptions complete_options() const {
    outline::ShatterOptions options = options_;
    const bool tiles = tiles_ > 0;
    options.kind = tiles ? outline::ObjectKind::Tile : outline::ObjectKind::Shape;
    options.objects = tiles ? tiles_ : shapes_;
    options.resolution = resolution_ > 0 ? resolution_ : tiles ? 300.0 : 100.0;
    options.scan = format_ == Format::Pixels ? outline::ScanKind::Pixels : outline::ScanKind::Samples;
    if (options.pieces < options.objects) {
      throw UsageError("--pieces", fmt::format("{} pieces of {} objects", options.pieces, options.objects),
                       "ask for at least one piece an object");
    }
    return options;
  }

  std::string content_of(const outline::ShatteredPiece& piece, const outline::ShatterOptions& options) const {
    if (format_ != Format::Png) return csv_of(piece.piece.outline);
    const std::vector<std::uint8_t> bytes = outline::picture_png(piece, options);
    return {bytes.begin(), bytes.end()};
  }

  std::string folder_;
  Format format_ = Format::Csv;
  int shapes_ = 1;
  int tiles_ = 0;
  double resolution_ = 0.0;
  outline::ShatterOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_outline_shatter_command() {
  return std::make_unique<OutlineShatterCommand>();
}

}  // namespace rejoin::cli
