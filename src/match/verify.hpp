/// The last look at a pose: figures for the report, and how likely the pieces join.
#pragma once

#include <optional>
#include <string>

#include "match/align.hpp"
#include "match/match.hpp"

namespace rejoin::match {

constexpr double kSure = 0.99;     ///< score from which the verdict is "join"
constexpr double kPossible = 0.3;  ///< and from which it is "unsure"

/// Strength at which a joint is as likely as not.
constexpr double kEven = 6.0;

/// Strength of the best pose after the first alignments from which a pair is promising.  \source docs/scoring.md
constexpr double kWorthwhile = 1.0;
constexpr double kWorthwhileThin = 1.5;  ///< the same where both pieces are thin

/// Strength -> log-odds that the pieces join.
double log_odds(double strength);

/// Strength -> probability that the pieces join, 0 .. 1.  \source docs/scoring.md tells how it was calibrated.
double score_of(double strength);

/// Whether nothing in the joint holds one piece on the other in some direction, or it fits as well farther along.
bool slides(const Stability& stability);

/// \param score      of the best candidate
/// \param stability  of it; a pose that half of the samples would turn, that another one comes near, or that was not probed, is no
///                   sure join
Verdict verdict_of(double score, const std::optional<Stability>& stability);

/// Why the verdict is not "join", for users; empty if it is.
/// \param evidence  of the best candidate, as are the others
std::string against(const Evidence& evidence, double score, const std::optional<Stability>& stability);

/// A candidate without errors by depth maps, which stay infinite.
/// \param pose  B -> A, relative to the meshes' origins
Candidate unmeasured(const Fragment& a, const Fragment& b, const Rigid& pose, const Evidence& evidence,
                     double strength);

/// Measures candidates of one pair by rasterised and by ray-cast depth maps of the whole fragments.
class Verifier {
 public:
  /// The fragments must outlive the object.  \throws BackendError as make_scorer
  Verifier(const Fragment& a, const Fragment& b, const Options& options);

  /// \param pose  B -> A, relative to the meshes' origins
  Candidate candidate(const Rigid& pose, const Evidence& evidence, double strength);

  zbuffer::Backend backend() const { return raster_->backend(); }
  std::string renderer() const { return raster_->renderer(); }

 private:
  const Fragment& a_;
  const Fragment& b_;
  zbuffer::ViewOptions view_;
  std::unique_ptr<zbuffer::Scorer> raster_;
  std::unique_ptr<zbuffer::Scorer> raycast_;  ///< made when first asked: its scenes take time
};

}  // namespace rejoin::match
