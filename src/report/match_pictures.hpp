/// The files of `rejoin match --out DIR`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "match/match.hpp"

namespace rejoin::report {

struct MatchOutputOptions {
  int map_resolution = 256;  ///< pixels across the depth maps that are shown
};

/// The line under the title of depth_difference.png: the candidate's figures, as in the JSON of the run.
/// \param overlap  whether the maps of the picture have a pixel in common
std::string difference_note(const match::JointError& error, bool overlap);

/// The files that write_match_outputs() may write.
std::vector<std::filesystem::path> match_outputs(const std::filesystem::path& folder);

/// Writes the pictures and files of the best candidate:
///   match.png              the fragments opened, joined, their faces coloured by gap, a cut through the
/// joint
///   depth_a.png, depth_b.png, depth_difference.png   both maps along the joint (B's mirrored into A's
/// frame), and where
///                          their slopes differ
///   convergence.svg        the course of an annealing search; of others the candidates' scores
///   joined.glb, joined.ply A and B moved onto it, in A's file coordinates, with the scans' colours;
///                          a scan without has a tint
/// Each file is written whole or not at all.  Without a candidate only convergence.svg is written, and
/// what an earlier match left of the others is removed.
/// \return the files, in the order in which they were written
/// \throws IoError the folder or a file cannot be written
std::vector<std::filesystem::path> write_match_outputs(const std::filesystem::path& folder,
                                                       const match::Fragment& a, const match::Fragment& b,
                                                       const match::Result& result,
                                                       const MatchOutputOptions& options = {});

}  // namespace rejoin::report
