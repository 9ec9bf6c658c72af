/// Breaks an object into fragments with known poses, to measure a search on.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/context.hpp"
#include "core/rigid.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::shatter {

/// Lengths are shares of the object's diameter, so that they suit any unit.
struct Options {
  int pieces = 8;
  std::uint64_t seed = 1;
  bool cracks = false;       ///< one after another, else all at once around sites
  double roughness = 1.0;    ///< of the breaks; 0: plane, 1: like broken stone
  double erosion = 0.001;    ///< radius to which edges are worn
  double chips = 3.0;        ///< mean number of chips off a fragment's edges
  double chip_size = 0.012;  ///< largest radius of a chip
  double noise = 0.0001;     ///< standard deviation of the scanner's error along the normal
  double correlated =
      0.0;  ///< standard deviation of the error that near points share, along the normal, as of photographs
  double wavelength = 0.02;  ///< of that: points half of it apart share 0.4 of it
  double closed = 0.0;       ///< share of the breaks that was not seen: holes that membranes close
  double hole_size = 0.05;   ///< radius of the largest such hole
  double spacing = 0.004;    ///< edge length of the fragments' meshes
};

struct Piece {
  mesh::Mesh scan;  ///< in its own file coordinates
  Rigid to_world;   ///< file coordinates -> the object's
};

/// Two pieces that share a break, as far as both still have their side of it.
struct Contact {
  std::size_t a;
  std::size_t b;
  double area;  ///< of the break, squared mesh units
};

struct Shattered {
  std::vector<Piece> pieces;
  std::vector<Contact> contacts;  ///< a < b, in ascending order; without those of a few faces
  double diameter = 0;            ///< of the object, mesh units
  double lost = 0;                ///< share of its volume that hangs together with no piece's largest part
  bool cancelled = false;         ///< then nothing else is set
};

/// Breaks a closed surface.  Every piece is polygonised on a grid of its own, turned at random, so that pieces
/// have no vertex in common; then it is moved by a random rigid motion.  A piece is its largest connected part;
/// splinters are lost.  Same input and options give the same pieces for any number of threads.
/// \param name  for messages
/// \throws InputError  the surface is not closed, or no cut into that many connected pieces was found
Shattered shatter(const std::string& name, const mesh::Mesh& object, const Options& options,
                  const Context& context);

}  // namespace rejoin::shatter
