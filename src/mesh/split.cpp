#include "mesh/split.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <utility>

#include "core/components.hpp"
#include "core/error.hpp"
#include "core/rigid.hpp"
#include "mesh/detail/apart.hpp"
#include "mesh/detail/cloud_parts.hpp"
#include "mesh/detail/parts.hpp"
#include "mesh/point_index.hpp"

namespace rejoin::mesh {
namespace {

constexpr double kLeastFront = 0.002;  // of the scan stands on its table
constexpr double kTableOfPart = 0.01;  // of a part is table: it hangs together with it
constexpr double kLow = 2.0;           // cuts above the table that a piece rises at least
constexpr double kNear = 5.0;          // spacings, from a piece to what still belongs to it
constexpr double kOverlap = 0.1;       // of the smaller part's cells on the table: it lies above the other
constexpr double kOfTwo = 0.1;         // of a piece's weight: a part of it that may be another piece
constexpr std::size_t kMostParts = 1000;

using Members = std::vector<std::uint32_t>;  // faces, or points, in ascending order

Mesh chosen(const Mesh& scan, const Members& members) {
  if (members.size() == (scan.is_cloud() ? scan.vertices.size() : scan.faces.size())) return scan;
  return scan.is_cloud() ? points_of(scan, members) : submesh(scan, members);
}

std::vector<detail::Part> measured(const Mesh& scan, const std::vector<std::uint32_t>& part_of) {
  return scan.is_cloud() ? detail::measured_point_parts(scan, part_of)
                         : detail::measured_parts(scan, part_of);
}

/// Of every face, or point, the number of its part.
std::vector<std::uint32_t> parts_of(const Mesh& scan) {
  if (!scan.is_cloud()) return detail::part_of_faces(scan);
  return detail::parts_of_cloud(scan.vertices, detail::CloudNeighbours(scan.vertices).near()).part_of_point;
}

double weight_of(const Mesh& scan) {
  return scan.is_cloud() ? static_cast<double>(scan.vertices.size()) : surface_area(scan);
}

double height_above(const Table& table, const glm::vec3& point) {
  return glm::dot(glm::dvec3(point), table.up) - table.height;
}

/// Which parts of a mesh hang together with the table: those with some of its surface, which faces them.
std::vector<bool> parts_with_table(const Mesh& mesh, const Table& table,
                                   const std::vector<std::uint32_t>& part_of_face) {
  const std::vector<detail::Part> parts = detail::measured_parts(mesh, part_of_face);
  std::vector<double> flat(parts.size(), 0.0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    std::array<glm::dvec3, 3> at;
    bool in_plane = true;
    for (int k = 0; k < 3; ++k) {
      const glm::vec3& corner = mesh.vertices[mesh.faces[f][k]];
      at[static_cast<std::size_t>(k)] = glm::dvec3(corner);
      in_plane = in_plane && std::abs(height_above(table, corner)) <= table.thickness;
    }
    const glm::dvec3 facing = 0.5 * glm::cross(at[1] - at[0], at[2] - at[0]);
    const double area = glm::length(facing);
    if (in_plane && glm::dot(facing, table.up) > kFacesUp * area) flat[part_of_face[f]] += area;
  }
  std::vector<bool> result(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k) result[k] = flat[k] > kTableOfPart * parts[k].weight;
  return result;
}

/// Faces, or points, that lie above the cut.
Members above(const Mesh& scan, const Table& table, double cut) {
  Members kept;
  const auto is_above = [&](std::uint32_t vertex) {
    return height_above(table, scan.vertices[vertex]) > cut;
  };
  for (std::uint32_t i = 0; scan.is_cloud() && i < scan.vertices.size(); ++i) {
    if (is_above(i)) kept.push_back(i);
  }
  for (std::uint32_t f = 0; f < scan.faces.size(); ++f) {
    const glm::uvec3& face = scan.faces[f];
    if (is_above(face.x) && is_above(face.y) && is_above(face.z)) kept.push_back(f);
  }
  return kept;
}

/// The same, and the faces of parts that merely lie on the table.
Members above_table(const Mesh& scan, const Table& table, double cut) {
  Members kept = above(scan, table, cut);
  if (scan.is_cloud()) return kept;
  const std::vector<std::uint32_t> part_of_face = detail::part_of_faces(scan);
  const std::vector<bool> with_table = parts_with_table(scan, table, part_of_face);
  Members whole;
  for (std::uint32_t f = 0; f < scan.faces.size(); ++f) {
    if (!with_table[part_of_face[f]]) whole.push_back(f);
  }
  Members both;
  std::ranges::set_union(kept, whole, std::back_inserter(both));
  return both;
}

/// Places on the table, as wide as a few spacings, that a part lies above.
std::vector<std::pair<int, int>> cells_above(const Mesh& part, const Table& table, double width) {
  const glm::dmat3 frame = frame_of(table.up);
  std::vector<std::pair<int, int>> cells;
  cells.reserve(part.vertices.size());
  for (const glm::vec3& vertex : part.vertices) {
    cells.emplace_back(std::floor(glm::dot(glm::dvec3(vertex), frame[0]) / width),
                       std::floor(glm::dot(glm::dvec3(vertex), frame[1]) / width));
  }
  std::ranges::sort(cells);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

bool do_overlap(const std::vector<std::pair<int, int>>& a, const std::vector<std::pair<int, int>>& b) {
  std::vector<std::pair<int, int>> both;
  std::ranges::set_intersection(a, b, std::back_inserter(both));
  return static_cast<double>(both.size()) > kOverlap * static_cast<double>(std::min(a.size(), b.size()));
}

/// Of every two blocks on a table, whether they lie beside each other.
detail::Apart apart_on(const Table& table, const std::vector<detail::Block>& blocks, double spacing) {
  std::vector<std::vector<std::pair<int, int>>> cells;
  cells.reserve(blocks.size());
  for (const detail::Block& block : blocks) cells.push_back(cells_above(block.mesh, table, 2.0 * spacing));
  detail::Apart apart(blocks.size(), std::vector<bool>(blocks.size(), false));
  for (std::size_t a = 0; a < blocks.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) apart[a][b] = apart[b][a] = !do_overlap(cells[a], cells[b]);
  }
  return apart;
}

/// Which blocks are one piece.
Components pieces_of(const std::vector<detail::Block>& blocks, const std::optional<Table>& table,
                     double spacing) {
  Components pieces(blocks.size());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open;  // pairs that closed surfaces do not settle
  for (std::uint32_t a = 0; a < blocks.size(); ++a) {
    for (std::uint32_t b = 0; b < a; ++b) {
      if (!detail::are_two_closed(blocks[a], blocks[b])) open.emplace_back(a, b);
    }
  }
  if (open.empty()) return pieces;
  const detail::Apart apart = table ? apart_on(*table, blocks, spacing) : detail::apart_by_planes(blocks);
  for (const auto& [a, b] : open) {
    if (!apart[a][b]) pieces.unite(a, b);
  }
  return pieces;
}

/// The piece that some place is next to; the number of pieces where none is next to any.
class NearestPiece {
 public:
  NearestPiece(const Mesh& scan, const std::vector<Members>& pieces, double spacing)
      : reach_(static_cast<float>(kNear * spacing)), none_(pieces.size()), index_({}) {
    std::vector<glm::vec3> points;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      const Mesh piece = chosen(scan, pieces[k]);
      points.insert(points.end(), piece.vertices.begin(), piece.vertices.end());
      piece_of_.resize(points.size(), k);
    }
    index_ = PointIndex(points);
  }

  /// By whichever of the places comes closest to a piece.
  std::size_t of(const std::vector<glm::vec3>& places) const {
    std::size_t piece = none_;
    float least = reach_;
    for (const glm::vec3& place : places) {
      const auto nearest = index_.nearest_within(place, least);
      if (!nearest) continue;
      piece = piece_of_[nearest->first];
      least = nearest->second;
    }
    return piece;
  }

 private:
  float reach_;
  std::size_t none_;
  PointIndex index_;
  std::vector<std::size_t> piece_of_;
};

/// What is left after the cut, part by part.
class Rest {
 public:
  Rest(const std::string& name, Mesh scan, double spacing)
      : name_(name), scan_(std::move(scan)), spacing_(spacing) {
    const std::vector<std::uint32_t> part_of = parts_of(scan_);
    parts_ = measured(scan_, part_of);
    members_ = detail::members_of_parts(part_of, parts_.size());
  }

  /// Leaves out the table's parts: those that are no higher than the cut, and what it left of unevenness.
  void drop_table(const Table& table, double cut) {
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      double low = std::numeric_limits<double>::infinity();
      double high = -low;
      for (const std::uint32_t member : members_[k]) {
        for (const glm::vec3& corner : corners_of(member)) {
          low = std::min(low, height_above(table, corner));
          high = std::max(high, height_above(table, corner));
        }
      }
      if (high <= cut || (low > cut && high <= kLow * cut)) members_[k].clear();
    }
  }

  double weight() const {
    double sum = 0;
    for (std::size_t k = 0; k < parts_.size(); ++k) sum += members_[k].empty() ? 0.0 : parts_[k].weight;
    return sum;
  }

  /// The pieces among the parts, and the crumbs, whose share is of `whole`.
  void part_into(Split& result, double least, double whole) {
    double most = 0;
    for (std::size_t k = 0; k < parts_.size(); ++k)
      most = std::max(most, members_[k].empty() ? 0.0 : parts_[k].weight);
    std::vector<detail::Block> blocks;
    std::vector<std::size_t> part_of_block;
    std::vector<std::size_t> small;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      if (members_[k].empty()) continue;
      if (parts_[k].weight < least * most) {
        small.push_back(k);
        continue;
      }
      if (blocks.size() == kMostParts) {
        throw InputError(name_, fmt::format("is more than {} parts of like size", kMostParts),
                         "merge close vertices in the scanning software");
      }
      blocks.push_back({parts_[k], chosen(scan_, members_[k])});
      part_of_block.push_back(k);
    }
    std::vector<Members> pieces = united(blocks, part_of_block, result.table);
    add_small(small, pieces, result.crumbs, {whole, most});
    for (Members& piece : pieces) {
      std::ranges::sort(piece);
      result.pieces.push_back(chosen(scan_, piece));
    }
    std::ranges::stable_sort(result.pieces, std::greater(),
                             [](const Mesh& piece) { return weight_of(piece); });
  }

 private:
  std::vector<glm::vec3> corners_of(std::uint32_t member) const {
    if (scan_.is_cloud()) return {scan_.vertices[member]};
    const glm::uvec3& face = scan_.faces[member];
    return {scan_.vertices[face.x], scan_.vertices[face.y], scan_.vertices[face.z]};
  }

  std::vector<Members> united(const std::vector<detail::Block>& blocks,
                              const std::vector<std::size_t>& part_of_block,
                              const std::optional<Table>& table) const {
    Components components = pieces_of(blocks, table, spacing_);
    std::vector<Members> pieces(blocks.size());
    for (std::uint32_t b = 0; b < blocks.size(); ++b) {
      const Members& members = members_[part_of_block[b]];
      Members& piece = pieces[components.of(b)];
      piece.insert(piece.end(), members.begin(), members.end());
    }
    std::erase_if(pieces, [](const Members& piece) { return piece.empty(); });
    return pieces;
  }

  struct Weights {
    double whole;
    double largest;
  };

  void add_small(const std::vector<std::size_t>& small, std::vector<Members>& pieces, Crumbs& crumbs,
                 const Weights& weights) const {
    if (small.empty()) return;
    const NearestPiece nearest(scan_, pieces, spacing_);
    for (const std::size_t k : small) {
      const Members& members = members_[k];
      std::vector<glm::vec3> places;
      for (const std::uint32_t member : members)
        std::ranges::copy(corners_of(member), std::back_inserter(places));
      const std::size_t piece = nearest.of(places);
      if (piece < pieces.size()) {
        pieces[piece].insert(pieces[piece].end(), members.begin(), members.end());
        continue;
      }
      ++crumbs.parts;
      crumbs.elements += members.size();
      crumbs.share += parts_[k].weight / weights.whole;
      crumbs.largest = std::max(crumbs.largest, parts_[k].weight / weights.largest);
    }
  }

  const std::string& name_;
  Mesh scan_;
  double spacing_;
  std::vector<detail::Part> parts_;
  std::vector<Members> members_;  ///< none: the part is left out
};

std::size_t large_parts(const Mesh& scan, double whole) {
  const auto is_large = [whole](const detail::Part& part) { return part.weight >= kOfTwo * whole; };
  return static_cast<std::size_t>(std::ranges::count_if(measured(scan, parts_of(scan)), is_large));
}

/// Whether a piece falls into more parts where it is cut higher.
bool falls_apart(const Mesh& piece, const Table& table, double cut) {
  const Members members = above(piece, table, cut);
  if (members.empty()) return false;
  const double whole = weight_of(piece);
  return large_parts(chosen(piece, members), whole) > large_parts(piece, whole);
}

std::optional<Table> table_of(const std::string& name, const Mesh& scan, SplitOptions::TableUse use) {
  if (use == SplitOptions::TableUse::No) return std::nullopt;
  const bool must = use == SplitOptions::TableUse::Yes;
  std::optional<Table> table = find_table(scan, {kLeastFront, !must});
  if (must && !table) {
    throw InputError(name, "has no plane of a fifth of it or more on which the rest stands",
                     "leave --table away");
  }
  return table;
}

}  // namespace

Split split(const std::string& name, const Mesh& scan, const SplitOptions& options) {
  Split result;
  const double spacing = resolution(scan);
  const double whole = weight_of(scan);
  result.table = table_of(name, scan, options.table);
  if (!result.table) {
    Rest(name, scan, spacing).part_into(result, options.least, whole);
    return result;
  }
  result.cut = options.cut.value_or(result.table->thickness);
  const Members kept = above_table(scan, *result.table, result.cut);
  const std::string nothing =
      fmt::format("nothing stands out of the table by more than {:.3g}", kLow * result.cut);
  if (kept.empty()) throw InputError(name, nothing, "give a smaller --cut");
  Rest rest(name, chosen(scan, kept), spacing);
  rest.drop_table(*result.table, result.cut);
  result.table_share = 1.0 - rest.weight() / whole;
  if (!(rest.weight() > 0)) throw InputError(name, nothing, "give a smaller --cut");
  rest.part_into(result, options.least, whole);
  for (std::size_t k = 0; k < result.pieces.size(); ++k) {
    if (falls_apart(result.pieces[k], *result.table, kHigherCut * result.cut)) result.touching.push_back(k);
  }
  return result;
}

}  // namespace rejoin::mesh
