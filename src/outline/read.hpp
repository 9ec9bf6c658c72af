/// Flat pieces from files of any known kind.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/context.hpp"
#include "outline/extract.hpp"
#include "outline/outline.hpp"

namespace rejoin::outline {

/// What a folder holds and its pieces do not.
struct LeftOut {
  std::string name;    ///< of the file or piece
  std::string reason;  ///< one line for the user
};

/// What a file or a folder holds.
struct PieceSet {
  std::vector<Piece> pieces;       ///< of one file: largest first
  std::vector<std::string> notes;  ///< repairs and doubts, "FILE: ..." each; for the user
  std::vector<LeftOut> unusable;   ///< files of a folder that read_pieces() refuses, with its reasons
  std::vector<LeftOut> repeated;   ///< pieces of a folder that are the same, point for point, as another
  std::vector<LeftOut>
      left_out;  ///< pieces of a folder that are none, as rulers, or that the user wants left out
};

/// Whether a file of a folder may be one of its pieces by its name, as read_folder() has it.
bool has_piece_name(const std::string& path);

/// Pieces of one file, by its name's ending:
/// - png, jpg, jpeg, tif, tiff: pictures, see extract()
/// - csv, txt: one outline, or several closed ones with blank lines between them or a column that names each point's piece ("piece,x,y"), a point "x,y" a line (comma, semicolon, tab or
///   blanks); "1,5;2,5", "1,5 2,5" and fields in quotes have decimal commas; a first line of words may say which columns are x and y, else they are the first two; y points up unless that line calls it y_down
/// - svg: each closed subpath of paths, polygons, rectangles, circles and ellipses is a border, one inside another a
///   hole; curves are flattened, transforms applied; what is hidden, drawn twice or covers the page is left out, with a
///   note, and so is told what a drawing has that is not read
/// - geojson, json: each Polygon and each part of a MultiPolygon is a piece, with its holes
/// Small self-crossings are cut off with a note; a border that is no outline is left out with one, if others are left; a file's y axis is kept as it is.
/// \throws IoError   the file cannot be read
/// \throws InputError its content is no outline; the message names the place
PieceSet read_pieces(const std::string& path, const ExtractOptions& options = {});

/// The pieces of one file, as of a scan with all of them, or of all files of a folder that read_pieces() knows, but for .json (other files end so), in the order of their names; copies of one count once.
/// A file whose name is no UTF-8 is unusable: results are JSON, in which names are keys.
/// \throws IoError    no such folder
/// \throws InputError no file in it is known, or none can be used
PieceSet read_folder(const std::string& folder, const ExtractOptions& options = {},
                     const Context& context = Context());

/// What to say of pieces of which some have y up and some down, which their coordinates are compared as if they had not;
/// nullopt: all have it the same way.  read_folder() has it in its notes.
std::optional<std::string> doubt_axes(const std::vector<Piece>& pieces);

/// What to say of pieces whose borders are hundreds of times as long as most others', as where one file is in degrees and others in
/// metres: what all are compared by fits neither kind.  read_folder() has it in its notes.
std::optional<std::string> doubt_units(const std::vector<Piece>& pieces);

/// Dots or units an inch that the pieces' files tell, if they agree; what is told is as for doubt_resolutions().
std::optional<double> told_resolution(const std::vector<Piece>& pieces);

/// What to say of pictures and drawings whose files tell different resolutions or units; up to 96 dots an inch, which programs
/// write where they know none, are passed over.  read_folder() has it in its notes.
std::optional<std::string> doubt_resolutions(const std::vector<std::string>& files);

}  // namespace rejoin::outline
