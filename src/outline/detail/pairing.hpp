/// Candidates of the multi-scale method: two stretches of two borders with a pairing of their samples.
/// \source leitao 2000, section 3
#pragma once

#include <cstdint>
#include <vector>

namespace rejoin::outline::detail {

/// What is compared of a pair at one scale: A forward, B backward with its sign changed, so that true partners are equal.
/// Sequences are closed; indices may run beyond their ends and wrap.
struct Sequence {
  std::vector<float> values;
  std::vector<float> relief;  ///< 0..1 of each sample: how much shape there is around it
};
struct Sequences {
  const Sequence* a = nullptr;
  const Sequence* b = nullptr;
};

/// Sample i of A is paired with sample j of B's sequence; both may exceed the number of samples (they wrap), neither
/// falls along a path.
struct PairedSamples {
  std::int32_t i = 0;
  std::int32_t j = 0;
};

/// A candidate with its pairing (r, s) and its discriminant Delta (negative: probably true).
struct Candidate {
  std::vector<PairedSamples> path;
  double discriminant = 0.0;
};

/// The parameters of one scale.
struct ScaleParameters {
  double xi = 0.0;     ///< critical sample mismatch, radians of turning a sample
  double zeta = 0.0;   ///< penalty of an asymmetric step, radians
  double n_min = 0.0;  ///< least length that can be told from chance, samples
};

/// Delta(a, b; r, s) of a pairing.  \source leitao 2000, eq. (2) to (4); deviation: xi^2 is multiplied by both samples'
/// relief, so that straight borders, which fit each other anywhere, gain nothing.  With relief 1 it is the paper's.
double discriminant(const Sequences& sequences, const std::vector<PairedSamples>& path,
                    const ScaleParameters& parameters);

/// All pairs of stretches with one-to-one pairing whose Delta is least and negative: on each diagonal the stretches
/// of greatest gain.  Near duplicates (on diagonals at most 2 apart, overlapping) are left out.
/// \param least  shorter stretches are left out, samples
/// \param most   the best this many
/// \source leitao 2000, "Initial candidates"; cost: size of A * size of B
std::vector<Candidate> initial_candidates(const Sequences& sequences, const ScaleParameters& parameters,
                                          int least, std::size_t most);

/// The pairing of least Delta within `band` samples to either side of a given one, with free ends.
/// \source leitao 2000, "Candidate refinement", "Incremental matching"; cost: path length * band
Candidate refine(const Sequences& sequences, const ScaleParameters& parameters,
                 const std::vector<PairedSamples>& around, int band);

/// The pairing of least Delta of all pairings of the two closed sequences, by plain dynamic programming: the single-scale
/// method that the multi-scale one is compared with.  Cost: 4 * size of A * size of B.
Candidate refine_everywhere(const Sequences& sequences, const ScaleParameters& parameters);

/// Best first; of two that overlap on nearly the same diagonal one is left, grown by what only the other covers.
/// \param most  the best this many stay, before merging
void prune_and_merge(std::vector<Candidate>& candidates, std::size_t size_a, std::size_t size_b,
                     std::size_t most);

}  // namespace rejoin::outline::detail
