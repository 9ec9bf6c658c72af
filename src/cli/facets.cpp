/// rejoin facets
#include <fmt/core.h>

#include <map>
#include <optional>

#include "cli/command.hpp"
#include "cli/fragment.hpp"
#include "cli/json_values.hpp"
#include "cli/outputs.hpp"
#include "core/files.hpp"
#include "core/version.hpp"
#include "mesh/facets.hpp"
#include "mesh/save.hpp"
#include "report/facet_picture.hpp"

namespace rejoin::cli {
namespace {

using nlohmann::ordered_json;

/// The surface with every facet in its own colour; vertices between facets are doubled so that borders stay
/// sharp.
mesh::Mesh coloured(const mesh::Mesh& surface, const mesh::Segmentation& facets) {
  const std::vector<int> facet_of_face = mesh::facet_of_faces(facets, mesh::sample_of_faces(facets, surface));
  mesh::Mesh result;
  result.origin = surface.origin;
  std::map<std::pair<std::uint32_t, int>, std::uint32_t> copies;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const int number = facet_of_face[f];
    glm::uvec3 face;
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t vertex = surface.faces[f][corner];
      const auto [copy, added] = copies.try_emplace({vertex, number}, result.vertices.size());
      if (added) {
        result.vertices.push_back(surface.vertices[vertex]);
        result.colours.push_back(report::facet_colour(number, facets));
      }
      face[corner] = copy->second;
    }
    result.faces.push_back(face);
  }
  return result;
}

std::string table(const mesh::Segmentation& facets) {
  std::string text = fmt::format("{:>6}  {:<8} {:>10} {:>9} {:>9} {:>9}  {}\n", "number", "surface", "area",
                                 "length", "width", "rough %", "direction (outwards)");
  for (std::size_t i = 0; i < facets.facets.size(); ++i) {
    const mesh::Facet& facet = facets.facets[i];
    text += fmt::format("{:>6}  {:<8} {:>10.4g} {:>9.4g} {:>9.4g} {:>9.2f}  {:.3f},{:.3f},{:.3f}\n", i,
                        facet.fracture ? "fracture" : "original", facet.area, facet.length, facet.width,
                        100.0 * facet.roughness, facet.normal.x, facet.normal.y, facet.normal.z);
  }
  return text + "rough %: rms height over a fitted curved patch, of the patch's radius\n";
}

std::string facets_json(const match::Fragment& fragment) {
  ordered_json list = ordered_json::array();
  for (const mesh::Facet& facet : fragment.facets.facets) {
    list.push_back({{"number", list.size()},
                    {"fracture", facet.fracture},
                    {"area", facet.area},
                    {"length", facet.length},
                    {"width", facet.width},
                    {"roughness", facet.roughness},
                    {"direction", to_json(facet.normal)},
                    {"along", to_json(facet.along)},
                    {"centre", to_json(fragment.surface.origin + facet.centre)}});
  }
  const ordered_json json = {{"schema", "rejoin.facets/1"},
                             {"path", fragment.path},
                             {"faces", fragment.surface.faces.size()},
                             {"diameter", fragment.diameter},
                             {"noise", fragment.noise},
                             {"wall_thickness", fragment.facets.wall_thickness},
                             {"facets", list},
                             {"warnings", fragment.warnings},
                             {"version", kVersion}};
  return text_of(json);
}

class FacetsCommand final : public Command {
 public:
  void define(CLI::App& app) override {
    app.add_option("A", path_, "scan: ply, obj, stl, off, gltf, glb, drc, xyz or pts")
        ->required()
        ->group("Input");
    app.add_option("--facets", painted_, "the PLY of --ply, painted: a colour a facet")
        ->type_name("FILE")
        ->group("Input");
    add_solid(app, solid_);
    app.add_option("--ply", ply_, "write the surface with a colour for each facet")
        ->type_name("FILE")
        ->group("Output");
    app.add_option("--png", png_, "write a picture of it from six sides, facets numbered")
        ->type_name("FILE")
        ->group("Output");
    app.add_option("--json", json_, "write the table as JSON (-: to stdout)")
        ->type_name("FILE")
        ->group("Output");
  }

  ExitCode run(Console& console, Context& context) override {
    require_ending("--ply", ply_, ".ply");
    require_ending("--png", png_, ".png");
    for (const auto& file : {ply_, png_, json_}) {
      if (file) require_writable_file(*file);
    }
    match::Fragment fragment = load_fragment(path_, console, context, kind_of(solid_));
    if (context.cancelled()) return kInterrupted;
    if (painted_) use_painted_facets({*painted_}, {&fragment}, console);
    console.result(fmt::format(
        "{}: diameter {:.4g}, noise {:.2g}, {}\n", path_, fragment.diameter, fragment.noise,
        fragment.facets.wall_thickness > 0 ? fmt::format("wall {:.3g} thick", fragment.facets.wall_thickness)
                                           : std::string("solid")));
    console.result(table(fragment.facets));
    if (ply_) mesh::save(*ply_, coloured(fragment.surface, fragment.facets));
    if (png_) report::write_png(*png_, report::facet_picture(fragment.surface, fragment.facets, path_));
    if (json_) write_file(*json_, facets_json(fragment));
    for (const auto& file : {ply_, png_, json_}) {
      if (file) console.wrote(*file);
    }
    return kDone;
  }

 private:
  std::string path_;
  std::optional<std::string> painted_;
  bool solid_ = false;
  std::optional<std::string> ply_;
  std::optional<std::string> png_;
  std::optional<std::string> json_;
};

}  // namespace

std::unique_ptr<Command> make_facets_command() {
  return std::make_unique<FacetsCommand>();
}

}  // namespace rejoin::cli
