// Repeats figures 12 and 13 of papaioannou 2002 on sets of fragments with known poses: how often the
// annealing reaches the right pose, how often its most frequent wrong one, and the mean matching error of
// both.  Markdown on stdout.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "fragment_set.hpp"
#include "runs.hpp"

namespace rejoin::bench {
namespace {

const std::map<std::string, Knowledge> kKnowledge = {
    {"none", Knowledge::Nothing}, {"facets", Knowledge::RoughestFacets}, {"true", Knowledge::TrueDirection}};
const std::map<std::string, zbuffer::Backend> kBackends = {
    {"auto", zbuffer::Backend::Auto},       {"gpu", zbuffer::Backend::Gpu},
    {"osmesa", zbuffer::Backend::OsMesa},   {"raster", zbuffer::Backend::Raster},
    {"raycast", zbuffer::Backend::RayCast}, {"reference", zbuffer::Backend::Reference}};

struct Arguments {
  std::vector<std::string> sets;
  std::vector<std::string> constraints = {"none", "facets", "true"};
  std::string backend = "auto";
  double least_contact = 0;
  bool both_criteria = false;
  bool facet_maps = false;
  bool no_overlap_bias = false;
  RunOptions run;
};

void print_head(const RunOptions& run) {
  fmt::print(
      "{} runs a row, {} x {} pixels, {}{}, shifts up to {} R, N_fail {}{}, seed {}\n\n", run.seeds,
      run.resolution, run.resolution,
      run.maps == match::MapSource::Fragment ? "maps of the whole fragments" : "maps of the fracture facets",
      run.overlap_bias ? ", overlap bias" : "", run.shift_range, run.failed_stages,
      run.equilibrium == anneal::Equilibrium::Both ? ", both criteria of equilibrium" : "", run.first_seed);
  fmt::print(
      "| set | pair | contact | constraint | right | <e_d> | most frequent wrong | <e_d> | e_d at the truth "
      "| "
      "evaluations a run | s a run |\n");
  fmt::print("| --- | --- | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
}

std::string share(const Group& group, int runs) {
  return fmt::format("{:.0f} %", 100.0 * group.runs / runs);
}

std::string error_of(const Group& group) {
  return group.runs > 0 ? fmt::format("{:.4f}", group.mean_error) : "-";
}

void print_row(const std::string& set, const Join& join, const std::string& constraint,
               const std::optional<Outcome>& outcome) {
  const auto stem = [](const std::string& name) { return std::filesystem::path(name).stem().string(); };
  fmt::print("| {} | {} + {} | {:.0f} | {} | ", set, stem(join.a), stem(join.b), join.contact_area,
             constraint);
  if (!outcome) {
    fmt::print("no direction | | | | | | |\n");
  } else {
    fmt::print("{} | {} | {} | {} | {} | {} | {:.2f} |\n", share(outcome->right, outcome->runs),
               error_of(outcome->right), share(outcome->wrong, outcome->runs), error_of(outcome->wrong),
               outcome->error_at_truth ? fmt::format("{:.4f}", *outcome->error_at_truth) : "-",
               outcome->evaluations / outcome->runs, outcome->seconds / outcome->runs);
  }
  std::fflush(stdout);
}

void measure_set(const std::string& folder, const Arguments& arguments) {
  const FragmentSet set = read_set(folder);
  Shelf shelf(set);
  for (const Join& join : set.joins) {
    if (join.contact_area < arguments.least_contact) continue;
    const match::Fragment& a = shelf.get(join.a);
    const match::Fragment& b = shelf.get(join.b);
    const PairTruth truth(a, b, inverse(set.to_world.at(join.a)) * set.to_world.at(join.b));
    for (const std::string& constraint : arguments.constraints) {
      print_row(set.name, join, constraint, measure(a, b, truth, kKnowledge.at(constraint), arguments.run));
    }
  }
}

int run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Repeats figures 12 and 13 of papaioannou 2002 on fragment sets with known poses.");
  app.add_option("sets", arguments.sets, "folders with a truth.json")->required();
  app.add_option("--constraints", arguments.constraints,
                 "none, facets (directions of the roughest), true (direction)")
      ->check(CLI::IsMember(kKnowledge));
  app.add_option("--seeds", arguments.run.seeds, "runs a row")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--seed", arguments.run.first_seed, "of the random streams")->capture_default_str();
  app.add_option("--resolution", arguments.run.resolution, "pixels across")->capture_default_str();
  app.add_option("--directions", arguments.run.directions, "facet directions a fragment")
      ->capture_default_str();
  app.add_option("--min-contact", arguments.least_contact, "leave out joins with less contact area");
  app.add_option("--backend", arguments.backend)->check(CLI::IsMember(kBackends))->capture_default_str();
  app.add_option("--shift-range", arguments.run.shift_range, "of x1 and y1, fraction of R")
      ->capture_default_str();
  app.add_option("--failed-stages", arguments.run.failed_stages, "N_fail")->capture_default_str();
  app.add_flag("--both-criteria", arguments.both_criteria,
               "a temperature needs 80 tried and 8 accepted moves");
  app.add_flag("--facet-maps", arguments.facet_maps, "draw the fracture facets alone");
  app.add_flag("--no-overlap-bias", arguments.no_overlap_bias, "e_d alone");
  CLI11_PARSE(app, argc, argv);
  arguments.run.backend = kBackends.at(arguments.backend);
  arguments.run.overlap_bias = !arguments.no_overlap_bias;
  if (arguments.both_criteria) arguments.run.equilibrium = anneal::Equilibrium::Both;
  if (arguments.facet_maps) arguments.run.maps = match::MapSource::Facet;
  print_head(arguments.run);
  for (const std::string& folder : arguments.sets) measure_set(folder, arguments);
  return 0;
}

}  // namespace
}  // namespace rejoin::bench

int main(int argc, char** argv) {
  try {
    return rejoin::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
