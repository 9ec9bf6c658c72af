/// Shaded pictures of placed meshes without a display or a GPU.
#pragma once

#include <memory>
#include <vector>

#include "core/rigid.hpp"
#include "mesh/mesh.hpp"
#include "report/image.hpp"

namespace rejoin::report {

/// A mesh in the scene.
struct Body {
  const mesh::Mesh* mesh = nullptr;    ///< not owned; must have faces; needed until the scene is made
  Rigid pose;                          ///< file coordinates -> common frame
  Colour colour{200, 200, 200};        ///< where neither list below is given
  std::vector<Colour> vertex_colours;  ///< one a vertex, or empty
  std::vector<Colour> face_colours;    ///< one a face, or empty; goes before vertex_colours
};

/// Where the eye is.  right and up are unit and perpendicular; the eye looks along -cross(right, up).
struct Camera {
  glm::dvec3 target{0.0};  ///< common frame; in the picture's middle
  glm::dvec3 right{1, 0, 0};
  glm::dvec3 up{0, 1, 0};
  double half_height = 1;  ///< of the picture at the target, mesh units
  double distance = 0;     ///< eye to target, mesh units; 0: orthographic

  glm::dvec3 back() const { return glm::cross(right, up); }  ///< towards the eye
};

/// A camera that sees all the bodies, as large as the picture permits.
/// \param back     direction towards the eye, unit
/// \param up       roughly up in the picture; not parallel to back
/// \param aspect   width / height of the picture
/// \param fov_deg  vertical field of view; 0: orthographic
/// \param margin   share of the picture left free on each side
Camera fit_camera(const std::vector<Body>& bodies, const glm::dvec3& back, const glm::dvec3& up,
                  double aspect, double fov_deg = 0, double margin = 0.04);

struct RenderOptions {
  int width = 800;
  int height = 600;
  int ambient_rays = 3;         ///< a sample; 0: no ambient occlusion.  A pixel has 2 x 2 samples.
  double ambient_reach = 0.35;  ///< how far occluders count, share of the scene's radius
  double relief = 1.0;          ///< 1: full light and shade, 0: flat colours (for colour scales)
  Colour background{250, 250, 250};
};

/// What a pixel shows, for choosing views: body number, -1 = background.
struct Visibility {
  int width = 0;
  int height = 0;
  std::vector<int> body;
  std::vector<std::uint32_t> face;  ///< of that body's mesh
};

/// Placed meshes ready for ray casting (Embree).  Rendering is multi-threaded; the picture does not depend on
/// the threads.
class Scene {
 public:
  /// \throws InputError a body has no faces   \throws BackendError Embree cannot start or is out of memory
  explicit Scene(const std::vector<Body>& bodies);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// Smooth normals (creases over 50 degrees stay sharp), a key light from the upper left of the eye, a fill
  /// light, ambient occlusion, 2 x 2 samples a pixel.  Both sides of a face are drawn.
  Image render(const Camera& camera, const RenderOptions& options) const;

  /// An orthographic camera that sees everything, whatever the direction, always at the same scale.
  /// \param back, up  as for fit_camera()
  Camera overview(const glm::dvec3& back, const glm::dvec3& up) const;

  /// One ray a pixel.
  Visibility look(const Camera& camera, int width, int height) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rejoin::report
