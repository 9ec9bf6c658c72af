/// The paper's own search: Enhanced Simulated Annealing over the seven numbers of the pose.
#pragma once

#include <string>
#include <vector>

#include "anneal/anneal.hpp"
#include "match/constraints.hpp"
#include "match/directions.hpp"
#include "match/match.hpp"
#include "match/pose_space.hpp"

namespace rejoin::match {

/// Which surface the depth maps show.
enum class MapSource {
  Fragment,  ///< the whole fragment at its coarse level: the paper's way
  Facet,     ///< only the fracture facets that face each other; implies a search by directions
};

/// Settings beyond those of match::Options.
struct EsaOptions {
  MapSource maps = MapSource::Fragment;
  EnergyRule rule;  ///< material_axes are filled in by the search, which takes it at_resolution()
  int directions_per_fragment =
      4;  ///< taken from the roughest facets where neither directions nor facets are given
  int silhouette_rotations = 24;  ///< rotations for which the silhouettes are centred
  double shift_range = 0.1;       ///< bound of |x1| and |y1| as a fraction of R
  double jitter_deg = 5.0;        ///< of the locked angles under a material axis
  anneal::Options annealing;      ///< chains, seed and first_stream are filled in by the search
  bool every_chain = false;       ///< return the end of every chain, in order of combination and chain
};

/// Where one annealing chain ended.
struct EsaHypothesis {
  Rigid pose;              ///< B's file coordinates -> A's file coordinates, in contact
  double energy = 0;       ///< with the biases
  zbuffer::ViewPair view;  ///< about the centres of `centres`
  ViewCentres centres;
  double view_side = 0;      ///< f_R of the maps, mesh units
  zbuffer::PairScore score;  ///< without the biases
  int direction_a = -1;      ///< number of the direction of A that faced B; -1: searched without directions
  int direction_b = -1;
  int facet_a = -1;  ///< facet that the direction came from; -1: none
  int facet_b = -1;
  int chain = 0;  ///< 0 .. Options::chains - 1
  anneal::Ending ending = anneal::Ending::Cancelled;
};

/// How the search went.
struct EsaStats {
  long evaluations = 0;
  bool cancelled = false;
  std::vector<std::vector<Progress>> convergence;  ///< one a chain of every combination, in their order
  zbuffer::Backend backend = zbuffer::Backend::Auto;
  std::string renderer;
  std::vector<std::string> warnings;
};

/// Anneals `options.chains` chains for every combination of directions (one combination without
/// directions, two under a material axis that restricts: its two senses) and brings each chain's best view
/// into contact.
/// \return distinct poses with finite energy, lowest energy first, at most options.max_candidates; the best of
///         every combination has a place before the second best of any.  EsaOptions::every_chain: all chains'
///         ends instead.  What was found so far if the context is cancelled; empty if a fragment has no facet
///         to take directions from
/// \throws InputError constraints that do not go together (see plan_constraints)
/// \throws BackendError the backend is missing
/// \source papaioannou 2002, sections 4 and 5
std::vector<EsaHypothesis> esa_search(const Fragment& a, const Fragment& b, const Options& options,
                                      const EsaOptions& esa, const Context& context,
                                      EsaStats* stats = nullptr);

/// Centres and view side of the paper's maps of whole fragments.
zbuffer::ViewOptions whole_fragment_view(const Fragment& a, const Fragment& b, int resolution);

/// Two poses of B are the same when they differ by at most 5 degrees and 2 % of `diameter` at B's centre.
bool same_pose(const Rigid& first, const Rigid& second, const glm::dvec3& centre_b, double diameter);

}  // namespace rejoin::match
