/// Pictures of placed pieces.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "outline/assembly.hpp"

namespace rejoin::outline {

struct PictureOptions {
  int longest_side = 4000;        ///< of a picture, pixels; pictures of pieces are not enlarged
  int drawn_side = 1600;          ///< of a picture of pieces that have no picture of their own, pixels
  std::size_t most_objects = 16;  ///< drawn, the largest first
};

/// Placed pieces as one picture, with y up if all of them have it so, PNG bytes: in the pictures' own colours (pieces from outlines get one each), transparent
/// outside.
/// \param poses  of each piece into one frame   \pre pieces is not empty, as many poses as pieces
/// \throws IoError, InputError  a piece's picture cannot be read again
std::vector<std::uint8_t> assembled_png(const std::vector<Piece>& pieces, const std::vector<Planar>& poses,
                                        const PictureOptions& options = {});

/// Whether a file has the name of a picture of an assembly, of pieces or of their similarity.
bool has_result_name(const std::filesystem::path& file);

/// The first file of a folder that has_result_name() and is none that this program wrote; nullopt: none has.
std::optional<std::filesystem::path> foreign_result(const std::filesystem::path& folder);

/// Writes into a folder, each file whole or not at all:
/// - object_1.png ..: the pieces of an object in their places, see assembled_png()
/// - joins_1.png ..: the same pieces in grey with their common boundaries in red and the pieces' numbers where
///   each is widest, and beside them which number is which piece
/// Pictures of further objects that an earlier run has left there are removed; others of such names stay.
/// \return the files
/// \throws IoError a picture cannot be read again or a file cannot be written
std::vector<std::filesystem::path> write_assembly_pictures(const std::filesystem::path& folder,
                                                           const std::vector<Piece>& pieces,
                                                           const Assembly& assembly,
                                                           const PictureOptions& options = {});

}  // namespace rejoin::outline
