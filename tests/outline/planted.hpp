/// Pieces with known joins for the tests.
#pragma once

#include <algorithm>
#include <vector>

#include "core/random.hpp"
#include "outline/assembly.hpp"
#include "outline/outline.hpp"

namespace rejoin::outline::planted {

/// A rough line from `from` to `to`: midpoints moved sideways by `roughness` times the halves' length.
inline std::vector<glm::dvec2> rough_line(glm::dvec2 from, glm::dvec2 to, double roughness, int levels,
                                          Random& random) {
  std::vector<glm::dvec2> line = {from, to};
  for (int level = 0; level < levels; ++level) {
    std::vector<glm::dvec2> finer;
    finer.reserve(2 * line.size());
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const glm::dvec2 along = line[i + 1] - line[i];
      const double aside = roughness * random.normal();
      finer.push_back(line[i]);
      finer.push_back(0.5 * (line[i] + line[i + 1]) + aside * glm::dvec2(-along.y, along.x));
    }
    finer.push_back(line.back());
    line = std::move(finer);
  }
  return line;
}

/// The same piece elsewhere, its points at other places of the border, with noise.
inline Piece moved(const Piece& piece, const Planar& pose, double noise, Random& random) {
  Piece out = piece;
  const auto move = [&](std::vector<glm::dvec2>& border) {
    const std::vector<glm::dvec2> before = border;
    const std::vector<double> lengths = arc_lengths(before);
    const std::size_t count = before.size();
    const double shift = random.uniform();
    for (std::size_t i = 0; i < count; ++i) {
      const double s = lengths.back() * (static_cast<double>(i) + shift) / static_cast<double>(count);
      const glm::dvec2 off(noise * random.normal(), noise * random.normal());
      border[i] = pose(point_at(before, lengths, s) + off);
    }
  };
  move(out.outline.points);
  for (std::vector<glm::dvec2>& hole : out.outline.holes) move(hole);
  return out;
}

/// Pieces of a board of columns x rows cells, each 100 units wide and high, with rough borders between them; poses[i]
/// takes piece i's own coordinates to the board's.
struct Board {
  std::vector<Piece> pieces;
  std::vector<Planar> poses;
};

inline Board broken_board(int columns, int rows, double noise, std::uint64_t seed) {
  Random random(seed);
  const auto corner = [&](int x, int y) {
    // Inner corners leave the grid, so that no two pieces have one shape.
    Random own(seed, static_cast<std::uint64_t>(1 + x + 1000 * y));
    const double dx = x > 0 && x < columns ? 24.0 * (own.uniform() - 0.5) : 0.0;
    const double dy = y > 0 && y < rows ? 24.0 * (own.uniform() - 0.5) : 0.0;
    return glm::dvec2(100.0 * x + dx, 100.0 * y + dy);
  };
  const auto border = [&](int x0, int y0, int x1, int y1) {
    const bool outer = (x0 == x1 && (x0 == 0 || x0 == columns)) || (y0 == y1 && (y0 == 0 || y0 == rows));
    return rough_line(corner(x0, y0), corner(x1, y1), outer ? 0.0 : 0.12, 6, random);
  };
  std::vector<std::vector<glm::dvec2>> across;  // borders along x, by y * columns + x
  std::vector<std::vector<glm::dvec2>> up;      // borders along y, by y * (columns + 1) + x
  across.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows + 1));
  up.reserve(static_cast<std::size_t>(columns + 1) * static_cast<std::size_t>(rows));
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x < columns; ++x) across.push_back(border(x, y, x + 1, y));
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x <= columns; ++x) up.push_back(border(x, y, x, y + 1));
  Board board;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      Piece piece;
      piece.name = "piece_" + std::to_string(y * columns + x);
      const auto append = [&](const std::vector<glm::dvec2>& line, bool backward) {
        std::vector<glm::dvec2> part = line;
        if (backward) std::reverse(part.begin(), part.end());
        piece.outline.points.insert(piece.outline.points.end(), part.begin(), part.end() - 1);
      };
      append(across[static_cast<std::size_t>(y * columns + x)], false);
      append(up[static_cast<std::size_t>(y * (columns + 1) + x + 1)], false);
      append(across[static_cast<std::size_t>((y + 1) * columns + x)], true);
      append(up[static_cast<std::size_t>(y * (columns + 1) + x)], true);
      const Planar pose{
          random.uniform(-3.0, 3.0), {random.uniform(-500, 500), random.uniform(-500, 500)}, false};
      board.pieces.push_back(moved(piece, pose, noise, random));
      board.poses.push_back(inverse(pose));
    }
  }
  return board;
}

/// Breaks a piece about `radius` wide out of the middle of the board's first piece, which keeps a hole there; the plug is added at the
/// end, at a place of its own.
inline void break_out_plug(Board& board, double radius, double noise, std::uint64_t seed) {
  Random random(seed);
  constexpr int kCorners = 5;
  std::vector<glm::dvec2> corners;
  for (int k = 0; k < kCorners; ++k) {
    const double angle = 2.0 * M_PI * k / kCorners;
    corners.push_back(glm::dvec2(50.0, 50.0) +
                      radius * random.uniform(0.8, 1.1) * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  Piece plug;
  plug.name = "plug";
  for (int k = 0; k < kCorners; ++k) {
    const std::vector<glm::dvec2> line =
        rough_line(corners[static_cast<std::size_t>(k)],
                   corners[static_cast<std::size_t>((k + 1) % kCorners)], 0.1, 5, random);
    plug.outline.points.insert(plug.outline.points.end(), line.begin(), line.end() - 1);
  }
  Piece hole = plug;
  std::reverse(hole.outline.points.begin(), hole.outline.points.end());
  board.pieces[0].outline.holes.push_back(moved(hole, inverse(board.poses[0]), noise, random).outline.points);
  const Planar pose{random.uniform(-3.0, 3.0), {random.uniform(-500, 500), random.uniform(-500, 500)}, false};
  board.pieces.push_back(moved(plug, pose, noise, random));
  board.poses.push_back(inverse(pose));
}

/// Mean distance by which `pose` misplaces the points of `piece`.
inline double misplacement(const Piece& piece, const Planar& pose, const Planar& truth) {
  double sum = 0.0;
  for (const glm::dvec2& p : piece.outline.points) sum += glm::distance(pose(p), truth(p));
  return sum / static_cast<double>(piece.outline.points.size());
}

/// Mean misplacement of a piece against the board when piece `fixed` is where it belongs.
inline double misplaced(const Board& board, const Assembly& assembly, std::size_t fixed, std::size_t piece) {
  const Planar to_board = board.poses[fixed] * inverse(assembly.placements[fixed].pose);
  return misplacement(board.pieces[piece], to_board * assembly.placements[piece].pose, board.poses[piece]);
}

}  // namespace rejoin::outline::planted
