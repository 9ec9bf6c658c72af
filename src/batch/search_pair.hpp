/// One pair, from two prepared fragments to a row of the database.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/context.hpp"
#include "match/match.hpp"
#include "store/records.hpp"

namespace rejoin::batch {

struct Searched {
  store::Pair pair;  ///< all but ids and names
  std::vector<store::Candidate> candidates;
};

/// Searches the pair; not if options.near has them apart (match::may_touch()).  An error of the search becomes a failed pair.
/// \return nullopt if it was cancelled
std::optional<Searched> search_pair(const match::Fragment& a, const match::Fragment& b,
                                    const match::Options& options, const Context& context);

/// What of the options has an influence on results, as JSON with sorted keys; the seed is kept apart.
std::string parameters_json(const match::Options& options, mesh::PieceKind kind);

/// The kind that they tell.
mesh::PieceKind kind_of(const store::Parameters& parameters);

/// A pose as store::Fragment keeps it: 4 x 4 as JSON, with all digits.
std::string pose_text(const Rigid& pose);

}  // namespace rejoin::batch
