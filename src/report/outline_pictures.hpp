/// Pictures of a pair of flat pieces.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "outline/outline.hpp"

namespace rejoin::report {

/// Writes match.png (both pieces at one scale with the common boundary marked, as the best candidate lays them, and the
/// curvature of both along it) and joined.png (see outline::assembled_png()); without a candidate only the pieces apart in
/// match.png.
/// Pieces with y up are drawn so, where they lie together if both are.
/// \param verdict  of the best candidate, "join" ..; its title
/// \return the files, in this order
/// \throws IoError a file cannot be written, or a picture not be read again
std::vector<std::filesystem::path> write_outline_match_pictures(const std::filesystem::path& folder,
                                                                const outline::Piece& a,
                                                                const outline::Piece& b,
                                                                const outline::PairResult& result,
                                                                const std::string& verdict);

/// The files that write_outline_match_pictures() may write.
std::vector<std::filesystem::path> outline_match_pictures(const std::filesystem::path& folder);

}  // namespace rejoin::report
