/// Fracture against original surface, and the surface cut into facets.
#pragma once

#include <cstdint>
#include <vector>

#include "core/rigid.hpp"
#include "mesh/mesh.hpp"
#include "mesh/samples.hpp"

namespace rejoin::mesh {

/// One piece of surface that is seen as a whole from its mean normal.
struct Facet {
  std::vector<std::uint32_t> samples;  ///< into Segmentation::samples
  glm::dvec3 normal{0, 0, 1};          ///< mean, unit, outwards
  glm::dvec3 centre{0.0};              ///< mean of the samples, relative to the mesh's origin
  glm::dvec3 along{1, 0, 0};           ///< longest in-plane direction, unit, perpendicular to normal
  double length = 0;                   ///< extent along `along`, mesh units
  double width = 0;                    ///< extent across it
  double area = 0;                     ///< squared mesh units
  double roughness = 0;                ///< mean of the samples' roughness
  bool fracture = false;               ///< broken surface (may join), else original surface
};

/// Which surface a sample belongs to.
enum class Surface : std::uint8_t { Original, Fracture };

/// What a piece is.
enum class PieceKind : std::uint8_t {
  Found,  ///< a sherd with walls, or a solid piece: told by its shape
  Solid,  ///< without walls, whatever its shape: blades and slabs have parallel faces too, which may be broken
};

/// A surface cut into facets.
struct Cut {
  std::vector<int> facet_of_sample;  ///< index into facets, -1 where none
  std::vector<Facet> facets;         ///< fracture facets first, largest first in each class
};

/// Samples of a surface and their facets.
struct Segmentation : Cut {
  Samples samples;                 ///< of the segmented mesh
  std::vector<glm::vec3> normals;  ///< per sample, smoothed over about three spacings
  std::vector<Surface> surface;    ///< per sample
  std::vector<float>
      roughness;  ///< per sample: rms distance from the local quadric, as a fraction of its radius
  Cut creased;  ///< solid pieces: cut once more, along the creases; no facets in thin walls and painted facets
  double wall_thickness = 0;  ///< most frequent wall thickness, mesh units; 0 for a solid piece
  std::vector<bool>
      backed;              ///< per sample: other surface lies behind it; a scan from one side has hardly any
  double sample_area = 0;  ///< surface that a sample stands for on average, squared mesh units
};

/// Segments a surface.
///
/// Thin-walled pieces: a point whose inward ray meets a parallel surface from behind at 0.5 to 1.8 wall
/// thicknesses is original surface, and so are facets about as wide as what is behind them is thick, or wider (a foot); the rest is fracture; then
/// points follow their surroundings.  Broken islands amid the wall, as the scars of handles are, become facets as a whole where their parts are too small.  Where breaks hardly go through the walls, both are the faces of a flake, which is solid.  Solid pieces: every facet counts as fracture, as
/// roughness does not tell a break from a carved or weathered surface.  Facets grow over smoothed normals from
/// the flattest places, until they have bent by an angle; of solid pieces they are cut along the creases, too, as a break that
/// one of the cuts parts is often whole in the other. \pre the mesh has faces \source papaioannou 2002,
/// section 6.2 (mean normals of the most irregular compact facets)
/// \param size  diameter(mesh)
Segmentation segment(const Mesh& mesh, double size, PieceKind kind = PieceKind::Found);
Segmentation segment(const Mesh& mesh);

/// For every point with a normal the nearest sample that looks the same way, of the four nearest, or -1.
std::vector<int> nearest_alike(const Segmentation& segmentation, const std::vector<glm::vec3>& points,
                               const std::vector<glm::vec3>& normals);

/// The same facets on samples with another spacing, mesh units: each sample is of the surface and the facet of the nearest one that looks the same way.
Segmentation denser(const Segmentation& segmentation, const Mesh& mesh, double spacing);

/// Parts of facets: each is halved across its longest extent, and so are the halves.
/// \param cut  of the segmentation
/// \param facets  those of `cut` that are parted, indices
/// \return the parts alone; the facet of a part is that of any of its samples in `cut`
Cut quarters(const Segmentation& segmentation, const Cut& cut, const std::vector<int>& facets);

/// Share of the surface behind which nothing lies: large for a scan from one side.
double unbacked_share(const Segmentation& segmentation);

/// For every face of `mesh` (the segmented one, or another level of detail of it) the nearest sample that looks the same way,
/// or -1.
std::vector<int> sample_of_faces(const Segmentation& segmentation, const Mesh& mesh);

/// For every face the facet of its sample, or -1.
/// \param sample_of_face  sample_of_faces() of the mesh
std::vector<int> facet_of_faces(const Cut& cut, std::vector<int> sample_of_face);

}  // namespace rejoin::mesh
