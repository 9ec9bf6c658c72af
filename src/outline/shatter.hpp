/// Flat objects broken into pieces with known joins, for experiments and tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/context.hpp"
#include "outline/outline.hpp"

namespace rejoin::outline {

/// What is broken.
enum class ObjectKind {
  Shape,  ///< naiman's random polygon: about 10 units wide, edges and steps of a break of 0.3 to 0.9 units, straight
  Tile  ///< a rectangle of 100 to 150 mm a side; breaks are rough down to a pixel and a half
};

/// How a piece's border is recorded.
enum class ScanKind {
  Samples,  ///< points about a pixel apart, off the border by `noise`
  Pixels    ///< the outermost pixels of a scan in black and white
};

struct ShatterOptions {
  ObjectKind kind = ObjectKind::Shape;
  ScanKind scan = ScanKind::Samples;
  int objects = 1;            ///< how many are broken
  int pieces = 8;             ///< in all, shared out evenly among the objects
  double resolution = 100.0;  ///< shapes: pixels a unit; tiles: dots an inch
  double wear =
      0.0;  ///< depth to which edges are worn off, pixels; with bites of up to 4 times that here and there
  double noise = 0.0;  ///< deviation of the recorded border, pixels
  bool turn = true;    ///< pieces lie at random angles
  bool flip = false;   ///< every other piece, by chance, lies upside down
  std::uint64_t seed = 1;
};

/// A piece as it was scanned.
struct ShatteredPiece {
  Piece piece;                     ///< pixels; named piece_000 and so on
  std::vector<glm::dvec2> border;  ///< the true border in the same coordinates, worn
  Planar to_object;                ///< pixels of the scan -> pixels of the unbroken objects' common frame
  std::size_t object = 0;
};

/// Two pieces that were one along a stretch.
struct TrueJoin {
  std::size_t a = 0;
  std::size_t b = 0;
  double length = 0.0;  ///< of the line that broke, before wear, pixels
};

struct Shattered {
  std::vector<ShatteredPiece> pieces;
  std::vector<TrueJoin> joins;  ///< a < b, ascending
  double pixel_size = 1.0;      ///< tiles: mm; shapes: 1
  std::string unit;             ///< "mm" or "px"
};

/// Makes the objects and breaks them: the largest piece is broken again and again by a random walk from a point inside to
/// the border both ways.  The two sides of a break share one line, and each is worn and scanned on its own grid.
/// The same options give the same pieces for any number of threads.
/// \throws InputError an option is out of range, or the pieces get too small for the resolution (about 20 pixels across)
/// \source naiman 2018, section 3; leitao 2000, the experiment with five tiles
Shattered shatter(const ShatterOptions& options, const Context& context = {});

/// A piece of an object as an RGBA picture of one colour with a pattern that runs on across the breaks, PNG bytes.
std::vector<std::uint8_t> picture_png(const ShatteredPiece& piece, const ShatterOptions& options);

/// Poses and joins as the evaluation of assemblies wants them: {"unit", "seed", "fragments": {NAME + ending: {"to_world",
/// "object"}}, "joins": [[a, b, length]]}, JSON.
/// \param ending  of the pieces' files, ".csv" or ".png"
std::string truth_json(const Shattered& shattered, const ShatterOptions& options, const std::string& ending);

}  // namespace rejoin::outline
