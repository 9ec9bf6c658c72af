/// From two fragments to the pose at which they join.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/context.hpp"
#include "core/rigid.hpp"
#include "core/stopwatch.hpp"
#include "mesh/facets.hpp"
#include "mesh/mesh.hpp"
#include "zbuffer/scorer.hpp"

namespace rejoin::match {

enum class Search { Sweep, Esa };
enum class Constraint { None, Direction, Material };
enum class Verdict { Join, Unsure, NoJoin };

/// As JSON, tables and pages have it: "join", "unsure", "no join".
const char* name_of(Verdict verdict);

/// What the user may set; the defaults work.
struct Options {
  Search search = Search::Sweep;
  Constraint constraint = Constraint::None;
  std::vector<glm::dvec3>
      directions_a;  ///< fracture directions, outwards, file axes; empty: found from the facets
  std::vector<glm::dvec3> directions_b;
  double tolerance_deg = 10.0;           ///< how far the facing directions may be off, 0 .. 45
  std::optional<glm::dvec3> material_a;  ///< material axis, file axes
  std::optional<glm::dvec3> material_b;
  std::vector<int> facets_a;  ///< facet numbers that may join (`rejoin facets`); empty: any
  std::vector<int> facets_b;
  /// Poses to align instead of searching, B's file coordinates -> A's; empty: search.
  std::vector<Rigid> proposals;
  /// A rough pose, B's file coordinates -> A's: it and poses near it (match/near.hpp) are looked at alone.  Not for Search::Esa.
  std::optional<Rigid> near;
  int resolution = 128;  ///< pixels across a depth map of a whole fragment
  zbuffer::Backend backend = zbuffer::Backend::Auto;
  int chains = 8;  ///< independent annealing chains
  std::uint64_t seed = 1;
  int max_candidates = 8;  ///< distinct poses that are returned
  /// Go no further with a pair whose poses are weak after the first alignments: for many pairs, of which few join.
  bool promising_only = false;
};

/// A fragment made ready: surface, level of detail, facets.
struct Fragment {
  std::string path;
  mesh::Mesh
      surface;  ///< triangles at full resolution: the scan after clean-up, or the surface of its cloud; without flaps (mesh/flaps.hpp)
  std::optional<mesh::Mesh>
      open;  ///< where some of it cannot touch: what of `surface`, of a noisy one smoothed, lies in no pore (mesh/pores.hpp), or is a break that was
             ///< seen (mesh/filled_holes.hpp)
  mesh::Mesh
      coarse;  ///< a level of detail of `open`, or of `surface`, for depth maps: at most 40,000 faces; of a noisy scan smoothed
  mesh::Segmentation facets;  ///< of `open`, or of `surface`, of a noisy scan smoothed
  double diameter = 0;        ///< mesh units
  double least_extent = 0;    ///< along the axis along which it spreads least, mesh units
  double resolution = 0;      ///< sample spacing, mesh units
  double noise = 0;           ///< of the scan, mesh units (mesh/noise.hpp)
  /// waviness() of its surface, mesh units: errors that near points of the scan share are no larger
  double waviness = std::numeric_limits<double>::infinity();
  double noise_left = 0;  ///< of it, in `coarse` and `facets` of a noisy scan, mesh units; else 0
  std::optional<glm::dvec3>
      middle;  ///< view_centre() of `coarse`, where it is known: it takes time at every pair else
  std::vector<int>
      sample_of_face;  ///< mesh::sample_of_faces() of `coarse`; samples stay when facets are painted
  std::vector<std::string>
      warnings;  ///< what was mended when its file was read, and what may keep joins from being found
  std::vector<StageTime>
      stages;  ///< surface (of a cloud), flaps, smooth (of a noisy scan), pores, coarse, facets; load where a file was read
};

/// What of a fragment others can touch.
inline const mesh::Mesh& open_surface(const Fragment& fragment) {
  return fragment.open ? *fragment.open : fragment.surface;
}

/// Whether both are sherds, thin pieces with a wall thickness of their own.
inline bool both_thin(const Fragment& a, const Fragment& b) {
  return a.facets.wall_thickness > 0 && b.facets.wall_thickness > 0;
}

/// Wall thickness of the thinner of two sherds, mesh units; 0 if either is none.
inline double thinner_wall(const Fragment& a, const Fragment& b) {
  return both_thin(a, b) ? std::min(a.facets.wall_thickness, b.facets.wall_thickness) : 0.0;
}

/// The length by which joints of two sherds are judged, mesh units: the thinner wall, or a tenth of the smaller one's size if that is
/// less, as small sherds of thick vessels have no relief as large as their walls are thick; 0 if either is none.
inline double joint_ruler(const Fragment& a, const Fragment& b) {
  constexpr double kOfSize = 0.1;
  return std::min(thinner_wall(a, b), kOfSize * std::min(a.diameter, b.diameter));
}

/// Spacing of the sparser of both samples by which joints are judged, mesh units.  A solid piece with samples more than three times as far
/// apart as the other one's, of which it would see too little, is sampled more densely for that; so is a long one, of whose breaks it
/// would, down to a thirtieth of the slimmer piece's least extent or the scans' resolution.
double samples_spacing(const Fragment& a, const Fragment& b);

/// By which distances the joint of two pieces is judged.
enum class Breaks {
  Fresh,  ///< by those that the scans can tell
  Worn,   ///< by those that solid pieces wear by, where scans are finer
};

const char* name_of(Breaks breaks);

/// Distance below which surfaces touch, mesh units: a twentieth of joint_ruler() (of solid pieces a share of the samples'
/// spacing), or what the scans' resolution and noise can tell.  Of solid pieces with worn breaks a share of the smaller one's size, where that
/// is more.  \source docs/scoring.md
double contact_tolerance(const Fragment& a, const Fragment& b, Breaks breaks);

/// Whether scans are so fine that worn breaks are to be judged by larger distances than fresh ones.
bool tell_wear(const Fragment& a, const Fragment& b);

/// The triangles that are matched: the scan's own, or laid through the points of a cloud.
/// \param path  for messages
/// \throws InputError  nothing can be laid through the points
mesh::Mesh surface_of(const std::string& path, mesh::Mesh scan);

/// \param scan  what load() gave
/// \param kind  Solid where the user says so
/// \throws InputError  as surface_of()
Fragment prepare(std::string path, mesh::Mesh scan, const Context& context,
                 mesh::PieceKind kind = mesh::PieceKind::Found);

/// The same from the surface as `rejoin batch` keeps it, so that facets have the same numbers and joints the same scores there:
/// these depend a little on the order of the vertices.
/// \throws InputError, IoError  as surface_of() and mesh::as_kept()
Fragment prepare_as_kept(std::string path, mesh::Mesh scan, const Context& context,
                         mesh::PieceKind kind = mesh::PieceKind::Found);

/// Poses B -> A in the files' coordinates and relative to the meshes' origins, where the matcher computes.
Rigid to_origins(const Fragment& a, const Fragment& b, const Rigid& in_files);
Rigid to_files(const Fragment& a, const Fragment& b, const Rigid& at_origins);

/// How good a joint is, and by what.
struct JointError {
  /// e_d, fraction of f_R per pixel step.  These three see the whole fragments, with the walls of thin ones: the score uses none.
  double depth = std::numeric_limits<double>::infinity();
  double slope = std::numeric_limits<double>::infinity();  ///< e_d * N
  double raycast =
      std::numeric_limits<double>::infinity();  ///< slope difference by ray casting the full surfaces
  double overlap = std::numeric_limits<double>::infinity();  ///< A_S / min(A_S1, A_S2)
  double contact_area = 0;                                   ///< squared mesh units
  /// Median |gap| of B's broken surface where it lies over A's (median_gap()), mesh units; infinite without any.
  double gap_median = std::numeric_limits<double>::infinity();
  double penetration =
      0;  ///< volume of B that lies clearly inside A, over the contact area, or the area of what lies inside where that is larger, mesh units
};

struct Candidate {
  Rigid pose;        ///< B's file coordinates -> A's file coordinates
  double score = 0;  ///< 0 .. 1
  bool slides =
      false;  ///< one piece along the other, where that was probed: of poses that would be likelier than not
  JointError error;
  int facet_a = -1;  ///< the facets that face each other; -1: not from a facet
  int facet_b = -1;
  zbuffer::ViewPair view;  ///< depth-map view of the joint (whole-fragment maps)
};

/// What keeps a pose where it is.
struct Stability {
  double margin =
      0;  ///< log-odds by which the best pose is ahead of the best different one, before that was held back
  double next_share = 0;    ///< strength of that one then, share of the best one's
  double repeat_deg = 0;    ///< turn between the poses that either half of the samples gives, degrees
  double repeat_shift = 0;  ///< distance of the joint's middle between them, mesh units
  /// Of the distance between poses pushed to either side where the joint holds least, the share that is left after aligning them
  /// again: 0 both end at one place, 1 free.
  double slide = 0;
  /// Of its strength, the share at the better of two places farther along that direction, where the alignment stays: near 1 where what is
  /// drawn along a line, as a run moulding is, lies in its like.  0 where it returns.
  double elsewhere = 0;
};

/// A point of the search's course, for the convergence picture.
struct Progress {
  long evaluations;
  double best;         ///< lowest energy so far
  double temperature;  ///< 0 where the search has none
};

struct Result {
  std::vector<Candidate> candidates;  ///< by rank(), distinct; empty only if nothing could be tried
  Verdict verdict = Verdict::NoJoin;
  std::string against;  ///< why the best candidate is no join; empty if it is, or there is none
  std::optional<Stability> stability;  ///< of the best candidate; nullopt if it was not probed
  /// Else the pair was not promising: the best pose is the only candidate, and its depth-map errors are not measured.
  bool in_full = true;
  Breaks breaks = Breaks::Fresh;  ///< by which the candidates were judged
  double promise = 0;             ///< strength() of the best pose after the first alignments
  long evaluations = 0;
  bool cancelled = false;                          ///< stopped before the end; what was found is here
  std::vector<StageTime> stages;                   ///< prepare (of the pair), search, align, verify
  std::vector<std::vector<Progress>> convergence;  ///< one a chain (ESA)
  zbuffer::Backend backend = zbuffer::Backend::Auto;
  std::string renderer;
  std::vector<std::string> warnings;
};

/// Finds the pose at which b joins a.
Result match(const Fragment& a, const Fragment& b, const Options& options, const Context& context);

}  // namespace rejoin::match
