#include "cli/match_options.hpp"

#include "cli/arguments.hpp"
#include "cli/command.hpp"

namespace rejoin::cli {
namespace {

const Choices<match::Search> kSearches = {{"sweep", match::Search::Sweep}, {"esa", match::Search::Esa}};
const Choices<std::optional<match::Constraint>> kConstraints = {{"none", match::Constraint::None},
                                                                {"direction", match::Constraint::Direction},
                                                                {"material", match::Constraint::Material}};

void add_directions(CLI::App& app, const char* name, std::vector<std::string>& texts) {
  app.add_option(name, texts, "fracture direction, may be repeated")
      ->type_name("x,y,z")
      ->expected(1)
      ->take_all();
}

void add_facets(CLI::App& app, const char* name, std::vector<int>& numbers) {
  add_numbers(app, name, numbers, {0, 1e6, "N,N,..."}, "facets that may join (rejoin facets)");
}

}  // namespace

void MatchOptions::define(CLI::App& app) {
  app.option_defaults()->group("Search");
  add_choice(app, "--search", options_.search, kSearches, "over facets, or the paper's annealing");
  add_choice(app, "--constraint", constraint_, kConstraints, "what is known");
  add_directions(app, "--direction-a", directions_a_);
  add_directions(app, "--direction-b", directions_b_);
  tolerance_ = add_number(app, "--tolerance", options_.tolerance_deg, {0, 45, "DEG"},
                          "how far directions may be off, 0 to 45 (10)");
  app.add_option("--material-a", material_a_, "axis of the material, such as its layers")->type_name("x,y,z");
  app.add_option("--material-b", material_b_, "the same of B")->type_name("x,y,z");
  add_facets(app, "--facets-a", options_.facets_a);
  add_facets(app, "--facets-b", options_.facets_b);
  add_number(app, "--resolution", options_.resolution, {8, 2048},
             "pixels across a depth map, 8 to 2048 (128)");
  add_choice(app, "--backend", options_.backend, backend_choices(), "what draws");
  chains_ =
      add_number(app, "--chains", options_.chains, {1, 256}, "annealing chains side by side, 1 to 256 (8)");
  add_seed(app, options_.seed, "of the random numbers (esa)");
}

match::Options MatchOptions::values() const {
  match::Options options = options_;
  options.directions_a = parse_directions("--direction-a", directions_a_);
  options.directions_b = parse_directions("--direction-b", directions_b_);
  if (material_a_) options.material_a = parse_direction("--material-a", *material_a_);
  if (material_b_) options.material_b = parse_direction("--material-b", *material_b_);
  if (options.material_a.has_value() != options.material_b.has_value()) {
    throw UsageError(options.material_a ? "--material-b" : "--material-a", "is missing",
                     "give the material axis of both fragments");
  }
  const bool any_facet = !options.facets_a.empty() || !options.facets_b.empty();
  const bool any_direction = !options.directions_a.empty() || !options.directions_b.empty() ||
                             (any_facet && options.search == match::Search::Esa);  // the facets' own
  options.constraint = constraint_.value_or(any_direction        ? match::Constraint::Direction
                                            : options.material_a ? match::Constraint::Material
                                                                 : match::Constraint::None);
  if (options.constraint == match::Constraint::Material && !options.material_a) {
    throw UsageError("--constraint material", "needs --material-a and --material-b", "add them as x,y,z");
  }
  if (constraint_ == match::Constraint::Direction && !any_direction &&
      options.search == match::Search::Sweep) {
    throw UsageError("--constraint direction", "needs --direction-a or --direction-b",
                     "add them as x,y,z, or use --search esa, which takes those of the facets");
  }
  if (constraint_ == match::Constraint::None && (any_direction || options.material_a)) {
    throw UsageError("--constraint none", "contradicts the directions or facets that are given",
                     "leave out one of the two");
  }
  require_effect(options);
  return options;
}

/// An option that changes nothing is a mistake: the user expects something of it.
void MatchOptions::require_effect(const match::Options& options) const {
  if (tolerance_->count() > 0 && options.constraint == match::Constraint::None) {
    throw UsageError(
        "--tolerance", "has no direction that it could be of",
        "add directions or axes of the material (with --search esa facets will do), or leave it out");
  }
  const auto require_one = [](const std::vector<int>& facets, const std::vector<glm::dvec3>& directions,
                              const char* facets_name, const char* directions_name) {
    if (facets.empty() || directions.empty()) return;
    throw UsageError(directions_name,
                     std::string("changes nothing: ") + facets_name + " says which breaks are looked at",
                     "leave out one of the two");
  };
  require_one(options.facets_a, options.directions_a, "--facets-a", "--direction-a");
  require_one(options.facets_b, options.directions_b, "--facets-b", "--direction-b");
  if (chains_->count() > 0 && options.search != match::Search::Esa)
    throw UsageError("--chains", "serves --search esa only", "leave out one, or add the other");
}

}  // namespace rejoin::cli
