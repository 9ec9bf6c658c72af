/// Pieces that were scanned together, each by itself.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/table.hpp"

namespace rejoin::mesh {

inline constexpr double kHigherCut = 3.0;  ///< cuts above the table, where pieces that touch may be apart

struct SplitOptions {
  enum class TableUse {
    Auto,  ///< what find_table() takes for one is cut off, however little stands on it
    Yes,   ///< there is one, even if pieces reach beyond it
    No     ///< there is none
  };
  TableUse table = TableUse::Auto;
  std::optional<double>
      cut;  ///< height above the table's plane up to which all is cut off, mesh units; the table's thickness
  double least = 0.01;  ///< the smallest piece, as a share of the largest: smaller parts are crumbs
};

/// Parts that belong to no piece.
struct Crumbs {
  std::size_t parts = 0;
  std::size_t elements = 0;  ///< faces, or points
  double share = 0;          ///< of the area, or of the points
  double largest = 0;        ///< one, as a share of the largest piece
};

struct Split {
  std::vector<Mesh> pieces;    ///< largest first, with the scan's origin, normals and colours
  std::optional<Table> table;  ///< that was cut off
  double cut = 0;              ///< height above its plane
  double table_share = 0;      ///< of the area, or of the points, that went with it
  Crumbs crumbs;
  std::vector<std::size_t> touching;  ///< pieces that fall apart where they are cut kHigherCut times as high
};

/// Cuts the table off and parts what is left: faces that share vertices are one piece, and points that lie no farther apart than five
/// times their spacing.  Pieces that touch are one.  Parts stay together that are sides of one sherd or lie in each other; on a table,
/// those that lie above each other, but for closed surfaces.  What lies within five spacings of a piece belongs to it, however small.
///
/// Faces stay whole: those that reach below the cut go, but none of a part that lies on the table without hanging together with it.
///
/// \param name  for errors
/// \throws InputError there is no table and options ask for one, nothing stands on it, or the scan is more than 1000 parts
/// \pre the mesh has an area, or the cloud points
Split split(const std::string& name, const Mesh& scan, const SplitOptions& options = {});

}  // namespace rejoin::mesh
