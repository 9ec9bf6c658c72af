/// What a pose is worth, and how far its fast error (rasterised, simplified meshes) is from the slow one (ray-cast, full
/// meshes), and why.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "match/match.hpp"
#include "match/pose_space.hpp"
#include "match/rendering_difference.hpp"

namespace rejoin::match {

/// A pose as the depth maps see it.
struct PoseView {
  FacingView facing;
  ViewCentres centres;
  double view_side = 0;  ///< f_R, mesh units
};

/// The view of a pose along the mean normal of the surfaces in contact; where nothing touches, from centroid
/// to centroid.
/// \param pose  B's file coordinates -> A's file coordinates
PoseView view_of_pose(const Fragment& a, const Fragment& b, const Rigid& pose);

struct CompareOptions {
  int resolution = 128;                                 ///< pixels across the maps
  zbuffer::Backend drawing = zbuffer::Backend::Raster;  ///< what is held against ray casting
  int steps = 1;  ///< poses on each side of the given one, in each of five directions: (2 steps + 1)^5 in all
  double angle_step_deg = 2.0;  ///< between poses, each of three angles
  double shift_step = 0.01;     ///< between poses, share of the larger diameter
};

/// One pose of the grid around the given one: by how much it was turned and shifted, and its errors.
struct GridPose {
  std::array<double, 3> angles_deg{};  ///< about the view's x, y and z axis, of A
  std::array<double, 2> shift{};       ///< of A in the view's plane, mesh units
  zbuffer::PairScore drawn;            ///< drawing backend, coarse meshes: what a search sees
  zbuffer::PairScore cast;             ///< ray casting, coarse meshes
  zbuffer::PairScore cast_full;        ///< ray casting, full meshes: the reference
};

/// How two columns of errors (as slopes) agree over the grid; poses without overlap in either are left out.
struct ErrorAgreement {
  int poses = 0;
  double mean = 0;         ///< mean |difference|, slope
  double max = 0;          ///< largest |difference|, slope
  double relative = 0;     ///< mean |difference| / mean of the second
  double correlation = 0;  ///< Pearson's; 0 where one column does not vary
};

struct Comparison {
  Candidate joint;  ///< the given pose as judge() has it
  PoseView view;
  int resolution = 0;
  std::string renderer;  ///< of the drawing backend
  std::string caster;
  GridPose pose;  ///< the given one
  std::vector<GridPose> grid;
  RenderingDifference drawing;       ///< drawn - cast, same (coarse) meshes
  RenderingDifference detail;        ///< cast coarse - cast full
  ErrorAgreement drawing_agreement;  ///< drawn against cast
  ErrorAgreement detail_agreement;   ///< cast against cast_full
  ErrorAgreement total_agreement;    ///< drawn against cast_full
};

/// \throws BackendError a backend is missing   \throws InputError an option is out of range
Comparison compare(const Fragment& a, const Fragment& b, const Rigid& pose, const CompareOptions& options,
                   const Context& context);

}  // namespace rejoin::match
