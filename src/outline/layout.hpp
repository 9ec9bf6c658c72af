/// Groups of placed pieces.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "outline/contact.hpp"

namespace rejoin::outline {

/// Contact of two pieces of one layout.
struct PlacedContact {
  std::size_t a = 0;
  std::size_t b = 0;
  Contact contact;
};

/// Poses of pieces in the frames of their groups.  At first every piece is a group of its own.
class Layout {
 public:
  /// \param silhouettes  of the pieces; must outlive the layout   \param tolerance  of contacts, file units
  Layout(const std::vector<Silhouette>& silhouettes, double tolerance);

  std::size_t size() const { return poses_.size(); }
  std::size_t group(std::size_t piece) const { return groups_[piece]; }
  const std::vector<std::size_t>& members(std::size_t group) const { return members_[group]; }
  const Planar& pose(std::size_t piece) const { return poses_[piece]; }

  /// Shows the contacts between the pieces of two groups when the second is moved by `moved` into the first's frame, one after the
  /// other for as long as `goes_on` says so.
  /// \return false: it was stopped
  bool visit_contacts(std::size_t first, std::size_t second, const Planar& moved,
                      const std::function<bool(const PlacedContact&)>& goes_on) const;

  /// Contacts within a group.
  std::vector<PlacedContact> contacts_within(std::size_t group) const;

  /// What holds a piece in its group, nats.
  double support(std::size_t piece) const;

  /// Puts `second` into `first`, moved by `moved`.
  void merge(std::size_t first, std::size_t second, const Planar& moved);

  /// Makes a piece a group of its own again.
  void take_off(std::size_t piece);

  /// Moves all pieces of a group a little so that the borders in contact lie on each other: least squares over all
  /// contacts at once, so that no join carries the error of the others.
  /// \param tolerance  distance up to which borders pull at each other, file units
  void spread_error(std::size_t group, double tolerance, int iterations);

  /// Parts of a group that touch each other no more, joined by at least `information`; a group of one part is unchanged.
  void split_loose(std::size_t group, double information);

 private:
  bool near(std::size_t a, const Planar& pose_a, std::size_t b, const Planar& pose_b) const;

  const std::vector<Silhouette>* silhouettes_;
  double tolerance_;
  std::vector<Planar> poses_;
  std::vector<std::size_t> groups_;                // of each piece
  std::vector<std::vector<std::size_t>> members_;  // of each group, ascending; empty: no such group
};

}  // namespace rejoin::outline
