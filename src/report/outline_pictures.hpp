/// Pictures of flat pieces: a pair with its common boundary, and placed pieces as one image.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "outline/outline.hpp"

namespace rejoin::report {

/// Placed pieces as one RGBA picture, PNG bytes: transparent outside; pieces that came from pictures keep their colours, the
/// others are filled in colours of their own.  One pixel is one file unit unless that makes more than most_pixels a side.
/// \param poses  of each piece into one frame   \pre pieces is not empty, as many poses as pieces
/// \throws IoError, InputError  a piece's picture cannot be read again
std::vector<std::uint8_t> assembled_png(const std::vector<outline::Piece>& pieces,
                                        const std::vector<outline::Planar>& poses, int most_pixels = 4000);

/// Writes match.png (both pieces with the common boundary marked, joined, and the curvature of both along it) and
/// joined.png (see assembled_png); without a candidate only the pieces apart in match.png.
/// \throws IoError a file cannot be written, or a picture not be read again
void write_outline_match_pictures(const std::filesystem::path& folder, const outline::Piece& a,
                                  const outline::Piece& b, const outline::PairResult& result);

}  // namespace rejoin::report
