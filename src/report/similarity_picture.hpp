/// The pairs of a set of flat pieces as one square of cells.
#pragma once

#include <filesystem>
#include <vector>

#include "outline/assembly.hpp"

namespace rejoin::report {

/// Writes a square with a row and a column a piece, named, and a scale of colours.  Above the diagonal a cell shows the length
/// of the common border of the pair's best candidate, whether it was used or not, with a frame around those of the assembly's
/// joins; below the diagonal the contact of each join.  Cells shrink for many pieces, down to 3 pixels; then every second,
/// third .. piece is named.
/// \pre assembly.similarity is not empty
/// \throws IoError the file cannot be written
void write_similarity_picture(const std::filesystem::path& path, const std::vector<outline::Piece>& pieces,
                              const outline::Assembly& assembly);

}  // namespace rejoin::report
