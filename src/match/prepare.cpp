#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/error.hpp"
#include "match/match.hpp"
#include "match/pose_space.hpp"
#include "match/waviness.hpp"
#include "mesh/bodies.hpp"
#include "mesh/filled_holes.hpp"
#include "mesh/flaps.hpp"
#include "mesh/noise.hpp"
#include "mesh/pores.hpp"
#include "mesh/save.hpp"
#include "mesh/smooth.hpp"
#include "mesh/surface.hpp"
#include "mesh/table.hpp"

namespace rejoin::match {
namespace {

constexpr std::size_t kCoarseFaces = 40000;
/// Edges across a wall: with fewer, a break has hardly any shape to be known by (docs/results.md, coarse meshes of sherds).
constexpr double kEdgesAcross = 3.5;
constexpr double kNoisy = 0.1;        // of the points' spacing: what is left of less hides in the tolerance
constexpr double kShapeless = 0.25;   // of the points' spacing: shape between them that is no noise
constexpr double kFromOneSide = 0.5;  // share of a surface without anything behind it
// Shares of the breaks' area that are filled holes: less hardly matters, more is taken for a smooth break.
constexpr double kLeastFilled = 0.05;
constexpr double kMostFilled = 0.6;

/// Faces of the breaks; their walls may have fewer.
mesh::Mesh broken_surface(const Fragment& fragment) {
  mesh::Mesh broken;
  const mesh::Mesh& surface = open_surface(fragment);
  broken.vertices = surface.vertices;
  const std::vector<int> samples = mesh::sample_of_faces(fragment.facets, surface);
  for (std::size_t f = 0; f < samples.size(); ++f) {
    if (samples[f] < 0) continue;
    const auto sample = static_cast<std::size_t>(samples[f]);
    if (fragment.facets.surface[sample] == mesh::Surface::Fracture) broken.faces.push_back(surface.faces[f]);
  }
  return broken;
}

/// Of equilateral triangles as large as the surface's are on average; 0 without faces.
double mean_edge(const mesh::Mesh& surface) {
  if (surface.faces.empty()) return 0.0;
  const double area = mesh::surface_area(surface) / static_cast<double>(surface.faces.size());
  return std::sqrt(4.0 / std::sqrt(3.0) * area);
}

void doubt_coarse_walls(Fragment& fragment) {
  if (fragment.facets.wall_thickness <= 0) return;
  const double edge = mean_edge(broken_surface(fragment));
  const double across = edge > 0 ? fragment.facets.wall_thickness / edge : 0.0;
  if (across <= 0.0 || across >= kEdgesAcross) return;
  fragment.warnings.push_back(
      fmt::format("{}: its mesh has {:.2f} edges across the wall ({:.3g} thick); few joins are sure with "
                  "fewer than {:.1f}: scan or export it more finely",
                  fragment.path, across, fragment.facets.wall_thickness, kEdgesAcross));
}

/// Where both sides of a wall are nearer to each other than points are, normals that are estimated mix them, and no wall is found to be
/// coarse for.
void doubt_shapeless_points(Fragment& fragment, bool noisy) {
  if (noisy || fragment.noise < kShapeless * fragment.resolution) return;
  fragment.warnings.push_back(fmt::format(
      "{}: its points are too far apart ({:.3g}) for its shape, off which they lie by {:.3g}: its surfaces "
      "are hardly told apart; scan or export it more finely, a cloud with normals",
      fragment.path, fragment.resolution, fragment.noise));
}

/// Walls of a sherd that is taken for a solid piece lie on those of others as breaks do.
void doubt_scans_from_one_side(Fragment& fragment, mesh::PieceKind kind) {
  const double unbacked = mesh::unbacked_share(fragment.facets);
  if (kind == mesh::PieceKind::Solid || fragment.facets.wall_thickness > 0 || unbacked < kFromOneSide) return;
  fragment.warnings.push_back(fmt::format(
      "{}: nothing lies behind {:.0f} % of it, as of a scan from one side, and it is taken for a "
      "solid piece: if it is a sherd, its wall may be joined as a break; scan the other side, too, "
      "or paint the breaks (rejoin facets)",
      fragment.path, 100.0 * unbacked));
}

/// A sherd of which the edges were not scanned joins nothing: without a word "no join" would tell of breaks that nobody saw.
void doubt_missing_breaks(Fragment& fragment) {
  const bool any = std::ranges::any_of(fragment.facets.facets, &mesh::Facet::fracture);
  if (any || fragment.facets.wall_thickness <= 0) return;
  fragment.warnings.push_back(fmt::format(
      "{}: no break is seen on it, only the sides of its wall ({:.3g} thick), and nothing can join it: scan "
      "its edges, too, or paint the breaks (rejoin facets)",
      fragment.path, fragment.facets.wall_thickness));
}

/// Such a scan is matched as one piece.
void doubt_several_bodies(Fragment& fragment) {
  const std::vector<double> shares = mesh::bodies(fragment.surface);
  if (shares.size() < 2) return;
  std::string list;
  for (const double share : shares)
    list += fmt::format("{}{:.0f} %", list.empty() ? "" : ", ", 100.0 * share);
  fragment.warnings.push_back(
      fmt::format("{}: holds {} bodies ({} of its area) and is matched as one piece: if they are "
                  "several, give each a file of its own (rejoin split)",
                  fragment.path, shares.size(), list));
}

/// What hangs on a piece lies in its neighbours as soon as they are put together.
void cut_off_flaps(Fragment& fragment) {
  mesh::Flaps flaps = mesh::cut_off_flaps(fragment.surface);
  if (flaps.rest) {
    fragment.surface = std::move(*flaps.rest);
    fragment.warnings.push_back(
        fmt::format("{}: {:.0f} % of it hangs on it as a thin sheet, as of a table that was scanned with it, "
                    "and is left out",
                    fragment.path, 100.0 * flaps.share));
  }
  if (flaps.doubtful > 0) {
    fragment.warnings.push_back(fmt::format(
        "{}: {:.0f} % of it hangs on it as a thin sheet: if that is of a table, cut it off in the scanning "
        "software; it keeps joins from being found",
        fragment.path, 100.0 * flaps.doubtful));
  }
}

void tell_pores(Fragment& fragment, double share) {
  fragment.warnings.push_back(
      fmt::format("{}: {:.0f} % of it lies in pores, where nothing can touch it, and is left out",
                  fragment.path, 100.0 * share));
}

/// \param matched  of which the fragment is made ready: its surface, smoothed or without what cannot touch
void make_coarse(Fragment& fragment, const mesh::Mesh& matched) {
  fragment.coarse = matched.faces.size() > kCoarseFaces ? mesh::simplify(matched, kCoarseFaces) : matched;
  fragment.middle = view_centre(fragment.coarse);
}

double area_of(const mesh::Mesh& mesh, std::size_t face) {
  const auto& [a, b, c] = std::array{mesh.vertices[mesh.faces[face].x], mesh.vertices[mesh.faces[face].y],
                                     mesh.vertices[mesh.faces[face].z]};
  return 0.5 * static_cast<double>(glm::length(glm::cross(b - a, c - a)));
}

/// What software made up where nothing was seen speaks against true joints: it is left out of the breaks, if there is any.
/// \param filled  faces of `matched`, ascending
void leave_out_filled_holes(Fragment& fragment, const mesh::Mesh& matched,
                            const std::vector<std::uint32_t>& filled, mesh::PieceKind kind) {
  const std::vector<int> samples = mesh::sample_of_faces(fragment.facets, matched);
  std::vector<std::uint32_t> kept;
  double broken = 0.0;
  double made_up = 0.0;
  auto next = filled.begin();
  for (std::uint32_t f = 0; f < matched.faces.size(); ++f) {
    const bool is_filled = next != filled.end() && *next == f;
    if (is_filled) ++next;
    const bool is_broken = samples[f] >= 0 && fragment.facets.surface[static_cast<std::size_t>(samples[f])] ==
                                                  mesh::Surface::Fracture;
    const double area = is_broken ? area_of(matched, f) : 0.0;
    broken += area;
    if (is_filled) made_up += area;
    if (!is_filled || !is_broken) kept.push_back(f);
  }
  const double share = broken > 0.0 ? made_up / broken : 0.0;
  if (share < kLeastFilled || share > kMostFilled) return;
  fragment.open = mesh::submesh(matched, kept);
  make_coarse(fragment, *fragment.open);
  const bool solid = fragment.facets.wall_thickness <= 0;  // with less of its breaks it may look like a sherd
  fragment.facets = mesh::segment(*fragment.open, fragment.diameter, solid ? mesh::PieceKind::Solid : kind);
  fragment.warnings.push_back(
      fmt::format("{}: {:.0f} % of its breaks are smoother than the scan's noise, as where software closes "
                  "holes, and are left out; export it without closing holes if joins are missing",
                  fragment.path, 100.0 * share));
}

void doubt_table(Fragment& fragment) {
  const std::optional<mesh::Table> table = mesh::find_table(fragment.surface);
  if (!table) return;
  fragment.warnings.push_back(fmt::format(
      "{}: {:.0f} % of it is a plane, as a table that was scanned with the piece is; it hides the breaks: "
      "cut it off (rejoin split)",
      fragment.path, 100.0 * table->share));
}

}  // namespace

double samples_spacing(const Fragment& a, const Fragment& b) {
  // What the small piece's patches of relief bear, at which nothing is sampled anew.
  constexpr double kUnlike = 3.0;
  constexpr double kDenser = 4.0;  // at most: sixteen times the samples
  // Samples across the slimmer piece: the breaks of a long bone are as small.
  constexpr double kAcross = 30.0;
  const auto [fine, coarse] = std::minmax(a.facets.samples.spacing, b.facets.samples.spacing);
  if (a.noise_left > 0 || b.noise_left > 0 || both_thin(a, b)) return coarse;
  const double slim = std::min(a.least_extent, b.least_extent) / kAcross;
  const double scan = std::max(a.resolution, b.resolution);
  return std::clamp(std::min(kUnlike * fine, std::max(slim, scan)), coarse / kDenser, coarse);
}

double contact_tolerance(const Fragment& a, const Fragment& b, Breaks breaks) {
  constexpr double kNoiseInGaps = 3.0;  // deviations of gaps by what is left of noise that still touch
  constexpr double kWorn = 0.0075;      // of the smaller piece's size
  constexpr double kMore = 1.25;        // than of fresh breaks, at least: else both ways say the same
  const double ruler = joint_ruler(a, b);
  const double fresh = std::max({ruler > 0 ? 0.05 * ruler : 0.15 * samples_spacing(a, b),
                                 0.3 * std::max(a.resolution, b.resolution),
                                 kNoiseInGaps * std::hypot(a.noise_left, b.noise_left)});
  if (breaks == Breaks::Fresh || a.facets.wall_thickness > 0 || b.facets.wall_thickness > 0) return fresh;
  const double worn = kWorn * std::min(a.diameter, b.diameter);
  return worn > kMore * fresh ? worn : fresh;
}

bool tell_wear(const Fragment& a, const Fragment& b) {
  return contact_tolerance(a, b, Breaks::Worn) > contact_tolerance(a, b, Breaks::Fresh);
}

mesh::Mesh surface_of(const std::string& path, mesh::Mesh scan) {
  mesh::Mesh surface = scan.is_cloud() ? mesh::surface_of_cloud(scan) : std::move(scan);
  if (surface.faces.empty()) {
    throw InputError(path, "no surface could be laid through its points", "scan it more densely");
  }
  return surface;
}

Fragment prepare_as_kept(std::string path, mesh::Mesh scan, const Context& context, mesh::PieceKind kind) {
  std::vector<StageTime> stages;
  Stopwatch clock(stages);
  mesh::Mesh kept = mesh::as_kept(surface_of(path, std::move(scan)), path);
  clock.lap("keep");
  Fragment fragment = prepare(std::move(path), std::move(kept), context, kind);
  fragment.stages.insert(fragment.stages.begin(), stages.begin(), stages.end());
  return fragment;
}

Fragment prepare(std::string path, mesh::Mesh scan, const Context& context, mesh::PieceKind kind) {
  context.report("prepare " + path, 0.0);
  Fragment fragment;
  fragment.path = std::move(path);
  Stopwatch clock(fragment.stages);
  fragment.surface = surface_of(fragment.path, std::move(scan));
  clock.lap("surface");
  cut_off_flaps(fragment);
  clock.lap("flaps");
  fragment.diameter = mesh::diameter(fragment.surface);
  fragment.resolution = mesh::resolution(fragment.surface);
  fragment.noise = mesh::noise(fragment.surface);
  const bool noisy =
      fragment.noise > kNoisy * fragment.resolution && mesh::is_of_scanner(fragment.noise, fragment.surface);
  mesh::Mesh even;
  if (noisy) {
    even = mesh::smooth(fragment.surface, mesh::kSmoothRadius * fragment.resolution);
    fragment.noise_left = mesh::kNoiseLeft * fragment.noise;
    clock.lap("smooth");
  }
  std::optional<mesh::Open> open = mesh::without_pores(noisy ? even : fragment.surface, fragment.diameter);
  if (open) {
    fragment.open = std::move(open->surface);
    tell_pores(fragment, open->share);
  }
  clock.lap("pores");
  const mesh::Mesh& matched = noisy && !fragment.open ? even : open_surface(fragment);
  make_coarse(fragment, matched);
  clock.lap("coarse");
  fragment.facets = mesh::segment(matched, fragment.diameter, kind);
  const std::vector<std::uint32_t> filled =
      fragment.open ? std::vector<std::uint32_t>() : mesh::filled_holes(fragment.surface);
  if (!filled.empty()) leave_out_filled_holes(fragment, matched, filled, kind);
  fragment.waviness = waviness(fragment.facets, fragment.diameter, fragment.resolution);
  fragment.least_extent = mesh::least_extent(fragment.facets.samples.points);
  fragment.sample_of_face = mesh::sample_of_faces(fragment.facets, fragment.coarse);
  doubt_coarse_walls(fragment);
  doubt_shapeless_points(fragment, noisy);
  doubt_scans_from_one_side(fragment, kind);
  doubt_missing_breaks(fragment);
  doubt_several_bodies(fragment);
  doubt_table(fragment);
  clock.lap("facets");
  context.report("prepare " + fragment.path, 1.0);
  return fragment;
}

Rigid to_origins(const Fragment& a, const Fragment& b, const Rigid& in_files) {
  return Rigid{glm::dmat3(1.0), -a.surface.origin} * in_files * Rigid{glm::dmat3(1.0), b.surface.origin};
}

Rigid to_files(const Fragment& a, const Fragment& b, const Rigid& at_origins) {
  return Rigid{glm::dmat3(1.0), a.surface.origin} * at_origins * Rigid{glm::dmat3(1.0), -b.surface.origin};
}

}  // namespace rejoin::match
