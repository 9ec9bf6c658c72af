#include "cli/hints.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "batch/inputs.hpp"
#include "cli/command.hpp"
#include "cli/fragment.hpp"
#include "cli/layout.hpp"

namespace rejoin::cli {

void Hints::define(CLI::App& app) {
  app.add_option("--layout", layout_, "scans laid together by hand: MeshLab project, JSON")
      ->type_name("FILE")
      ->group("Input");
  app.add_option("--facets", painted_, "painted breaks: NAME-facets.ply of scans")
      ->type_name("DIR")
      ->group("Input");
  add_solid(app, solid_);
}

void Hints::read_into(batch::Options& options, const std::string& scans) const {
  if (layout_) {
    LaidScans laid = read_layout(*layout_, batch::find_scans(scans));
    options.layout = std::move(laid.layout);
    options.warnings = std::move(laid.warnings);
  }
  options.kind = kind_of(solid_);
  if (!painted_) return;
  batch::FoundPainted found = batch::find_painted(*painted_, batch::names_of(batch::find_scans(scans)));
  options.painted = std::move(found.painted);
  std::ranges::move(found.warnings, std::back_inserter(options.warnings));
}

}  // namespace rejoin::cli
