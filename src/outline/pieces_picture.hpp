/// The pieces of a set as they were read.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "outline/outline.hpp"

namespace rejoin::outline {

/// Pieces on one sheet; a larger set shows its first ones.
inline constexpr std::size_t kMostOnASheet = 400;

/// Writes a sheet of all pieces, each cut out of its picture with what lies around it (white where that is transparent), its outline drawn over it in red and
/// its name below: what shows at once where an outline is not the piece's.
/// \throws IoError, InputError  a picture cannot be read again, or the sheet cannot be written
void write_pieces_picture(const std::filesystem::path& path, const std::vector<Piece>& pieces);

}  // namespace rejoin::outline
