/// Pictures of a pair of flat pieces.
#pragma once

#include <filesystem>

#include "outline/outline.hpp"

namespace rejoin::report {

/// Writes match.png (both pieces with the common boundary marked, joined, and the curvature of both along it) and
/// joined.png (see outline::assembled_png()); without a candidate only the pieces apart in match.png.
/// \throws IoError a file cannot be written, or a picture not be read again
void write_outline_match_pictures(const std::filesystem::path& folder, const outline::Piece& a,
                                  const outline::Piece& b, const outline::PairResult& result);

}  // namespace rejoin::report
