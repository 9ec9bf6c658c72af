/// Outlines of the pieces in a picture.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "outline/outline.hpp"

namespace rejoin::outline {

struct ExtractOptions {
  double dust = 2.0;  ///< pieces and holes of less are, percent of the largest piece's area
  bool keep_rectangles =
      false;                  ///< in folders: those that lie beside other pieces in one picture, as rulers do
  bool keep_core = false;     ///< white rims along tears of printed paper stay, see detail::take_off_core()
  bool keep_threads = false;  ///< hairs and the like stay, see detail::take_off_threads()
  bool part_touching =
      false;  ///< pieces are parted where they hang together by a narrow neck, see detail::necks()
  std::size_t max_pixels = 120000000;  ///< larger pictures are refused before they are decoded
};

/// What a picture holds.
struct Extraction {
  std::vector<Outline>
      pieces;  ///< largest first; pixel centres have whole coordinates, x right, y down, upright
  std::vector<std::string> notes;  ///< what was repaired or may be wrong, a sentence each; for the user
};

/// Pieces of a PNG, JPEG or TIFF, as sub-pixel contours: where alpha passes one half or, in a picture without
/// transparency, where the colour is half-way from the plain background's (that of the frame; light that changes slowly
/// over the picture is evened out, with a note) to that of the piece beside it.  Soft shadows are background, print is
/// piece.  Of torn prints the white core beyond the printed face is left out, and so are hairs and threads that run out of a piece, with notes.  8 and 16 bits, grey, colour and CMYK; holes are kept.  A piece that runs out of the picture is cut there,
/// with a note, or left out if others are whole.
/// \throws IoError   the file cannot be read
/// \throws InputError it is no such picture, too large, truncated, or shows no piece on a plain background
Extraction extract(const std::string& path, const ExtractOptions& options = {});

}  // namespace rejoin::outline
