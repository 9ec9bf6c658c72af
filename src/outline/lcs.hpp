/// Matching of outlines by the longest common subsequence of their slope changes.
#pragma once

#include <memory>

#include "outline/matcher.hpp"

namespace rejoin::outline {

/// The paper's parameters (section 8.2, table 1); its values for a resolution of 200 are in table 2.
struct LcsOptions {
  double step = 0.0;          ///< between samples of a border, file units; 0: as the files' points lie
  int window = 27;            ///< edge characterization points, odd, 5 to 201
  double straight_deg = 0.6;  ///< straight corner maximum, degrees a sample
  double match_deg = 0.3;     ///< LCS maximum match, degrees a sample
  double confidence = 0.25;  ///< LSQ confidence in matches: share of the matches on either side of the centre
  bool flips = true;         ///< pieces may lie upside down
  bool local = true;   ///< besides the paper's one subsequence of whole borders, look for shorter agreements
  int scales = 2;      ///< the second is three times as coarse, for worn edges; 1 to 4
  int candidates = 6;  ///< results a pair, at most
};

/// The method of naiman 2018: slope changes by least-squares parabolas, the longest common subsequence of closed borders,
/// its middle as the first guess of a pose, non-linear least squares, micro-stitching along the seam, and a score from what
/// the two borders turn along it, from gap, overlap and length.
///
/// Deviations: outlines run counter-clockwise here, so of the 16 variants only the 8 that can join are looked at (the other 8
/// lay one piece upon the other).  One subsequence of whole borders finds joins along a good part of a border; shorter ones
/// are found by alignments that pay for what they leave out (`local`), as section 7.1 proposes.
/// \throws InputError an option is out of range
std::unique_ptr<Matcher> make_lcs(const LcsOptions& options = {});

}  // namespace rejoin::outline
