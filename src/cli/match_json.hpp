/// The machine-readable result of `rejoin match`, schema rejoin.match/1.
#pragma once

#include <string>

#include "match/match.hpp"

namespace rejoin::cli {

/// \param seconds  wall time of the whole run; with the seconds of the stages all that may differ between two equal runs
std::string match_json(const match::Fragment& a, const match::Fragment& b, const match::Options& options,
                       const match::Result& result, double seconds);

/// Where the time of a run went: the stages of both fragments, "load a" and so on, then those of the pair.
std::vector<StageTime> stage_times(const match::Fragment& a, const match::Fragment& b,
                                   const match::Result& result);

}  // namespace rejoin::cli
