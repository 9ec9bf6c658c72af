/// Broken balls with known poses, and joins that are true, false or unsure.
#pragma once

#include <algorithm>
#include <set>
#include <vector>

#include "../mesh/shapes.hpp"
#include "assembly/assembly.hpp"
#include "core/angle.hpp"
#include "shatter/shatter.hpp"

namespace rejoin::assembly::testing {

/// The pieces of one or more balls; made once for all tests.
struct Box {
  std::vector<match::Fragment> fragments;
  std::vector<Rigid> to_world;
  std::vector<shatter::Contact> contacts;

  void add_ball(float radius, std::uint64_t seed, int pieces) {
    shatter::Options options;
    options.pieces = pieces;
    options.seed = seed;
    options.spacing = 0.03;
    options.roughness = 2.0;
    options.chips = 0.0;
    const shatter::Shattered ball =
        shatter::shatter("ball", mesh::test::icosphere(radius, 4), options, Context());
    const std::size_t first = fragments.size();
    for (const shatter::Piece& piece : ball.pieces) {
      fragments.push_back(match::prepare("piece", piece.scan, Context()));
      to_world.push_back(piece.to_world);
    }
    for (const shatter::Contact& c : ball.contacts) contacts.push_back({first + c.a, first + c.b, c.area});
  }

  bool touch(std::size_t a, std::size_t b) const {
    return std::any_of(contacts.begin(), contacts.end(), [&](const shatter::Contact& c) {
      return c.a == std::min(a, b) && c.b == std::max(a, b);
    });
  }

  Rigid truth(std::size_t a, std::size_t b) const { return inverse(to_world[a]) * to_world[b]; }

  Link true_link(std::size_t a, std::size_t b, double score) const { return {a, b, truth(a, b), score}; }

  std::vector<Link> all_true(double score) const {
    std::vector<Link> links;
    links.reserve(contacts.size());
    for (const shatter::Contact& c : contacts) links.push_back(true_link(c.a, c.b, score));
    return links;
  }

  /// b turned and shifted against where it belongs, in a's axes about the middle of b.
  Link false_link(std::size_t a, std::size_t b, double score, double turn_deg, double shift) const {
    const glm::dvec3 centre = mesh::centroid(fragments[b].surface) + fragments[b].surface.origin;
    const glm::dvec3 at = truth(a, b)(centre);
    const glm::dmat3 turn = axis_rotation(glm::normalize(glm::dvec3(1, 2, 3)), turn_deg * kDegree);
    const glm::dvec3 push = shift * fragments[b].diameter * glm::normalize(glm::dvec3(3, -1, 1));
    return {a, b, Rigid{turn, at + push - turn * at} * truth(a, b), score};
  }

  /// b's middle put on a's.
  Link inside_link(std::size_t a, std::size_t b, double score) const {
    const auto middle = [&](std::size_t k) {
      return mesh::centroid(fragments[k].surface) + fragments[k].surface.origin;
    };
    return {a, b, Rigid{glm::dmat3(1.0), middle(a) - middle(b)}, score};
  }

  /// Largest angle, degrees, by which two pieces of a group lie wrong to each other.
  double worst_turn(const Result& result) const {
    double worst = 0.0;
    for (std::size_t a = 0; a < fragments.size(); ++a) {
      for (std::size_t b = a + 1; b < fragments.size(); ++b) {
        const Placement& x = result.placements[a];
        const Placement& y = result.placements[b];
        if (x.group < 0 || x.group != y.group) continue;
        worst = std::max(worst, angle_between(inverse(x.pose) * y.pose, truth(a, b)) / kDegree);
      }
    }
    return worst;
  }
};

inline const Box& ball() {
  static const Box box = [] {
    Box made;
    made.add_ball(10.0F, 3, 5);
    return made;
  }();
  return box;
}

inline const Box& two_balls() {
  static const Box box = [] {
    Box made = ball();
    made.add_ball(7.0F, 8, 3);
    return made;
  }();
  return box;
}

inline Result run(const Box& box, const std::vector<Link>& links, const Options& options = {}) {
  return assemble(box.fragments, links, options, Context());
}

inline std::set<int> groups_of(const Result& result) {
  std::set<int> groups;
  for (const Placement& p : result.placements) groups.insert(p.group);
  return groups;
}

/// Two pieces that touch, and a third that touches both.
struct Corner {
  std::size_t a, b, c;
};

inline Corner corner_of(const Box& box) {
  for (const auto& contact : box.contacts) {
    for (std::size_t c = 0; c < box.fragments.size(); ++c) {
      if (c != contact.a && c != contact.b && box.touch(contact.a, c) && box.touch(contact.b, c)) {
        return {contact.a, contact.b, c};
      }
    }
  }
  return {0, 0, 0};
}

/// Three pieces in a row: the first and the last do not touch.
inline Corner row_of(const Box& box) {
  const std::size_t count = box.fragments.size();
  for (std::size_t b = 0; b < count; ++b)
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t c = a + 1; c < count; ++c)
        if (box.touch(a, b) && box.touch(b, c) && !box.touch(a, c)) return {a, b, c};
  return {0, 0, 0};
}

}  // namespace rejoin::assembly::testing
