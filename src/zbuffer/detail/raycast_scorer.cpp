#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/error.hpp"
#include "zbuffer/detail/backends.hpp"
#include "zbuffer/detail/canvas.hpp"
#include "zbuffer/detail/drawable.hpp"
#include "zbuffer/detail/map_scorer.hpp"

namespace rejoin::zbuffer::detail {
namespace {

constexpr int kTile = 4;  ///< a packet is a square of 4 x 4 pixels, which keeps its rays together
constexpr int kRays = kTile * kTile;

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, DeviceRelease>;
using Scene = std::unique_ptr<RTCSceneTy, SceneRelease>;

Device open_device() {
  Device device(rtcNewDevice(nullptr));
  if (!device) {
    throw BackendError("raycast",
                       "Embree gives no device (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")",
                       "choose raster");
  }
  return device;
}

/// A fragment as Embree holds it.
class RayTarget {
 public:
  RayTarget(const Device& device, const mesh::Mesh& mesh) : scene_(rtcNewScene(device.get())) {
    const std::vector<glm::uvec3> faces = finite_faces(mesh);
    box_ = box_of(mesh, faces);
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    copy_into(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices);
    copy_into(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, faces);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);  // no ray slips through between two triangles
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(scene_.get());
    if (rtcGetDeviceError(device.get()) != RTC_ERROR_NONE) {
      throw BackendError("raycast", "Embree cannot build the scene", "choose raster");
    }
  }

  RTCScene scene() const { return scene_.get(); }
  const mesh::Box& box() const { return box_; }

 private:
  template <class Item>
  static void copy_into(RTCGeometry geometry, RTCBufferType type, RTCFormat format,
                        const std::vector<Item>& items) {
    void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Item), items.size());
    if (buffer != nullptr && !items.empty()) std::memcpy(buffer, items.data(), items.size() * sizeof(Item));
  }

  Scene scene_;
  mesh::Box box_;
};

/// Rays of one projection, expressed in the fragment's own frame so that its scene is built once only.
class RayGrid {
 public:
  /// \param nearest  smallest depth that a surface can have; the rays start there, Embree knows no negative
  /// distances
  RayGrid(const Projection& projection, double nearest) {
    const glm::dmat3 back = glm::inverse(glm::dmat3(projection.linear));
    const double length = glm::length(back[2]);
    across_ = back[0];
    down_ = back[1];
    direction_ = glm::vec3(back[2] / length);
    depth_per_unit_ = static_cast<float>(1.0 / length);
    start_ = static_cast<float>(std::min(0.0, nearest));
    corner_ = back * (glm::dvec3(0, 0, start_) - glm::dvec3(projection.offset));
  }

  void aim(RTCRayHit16& rays, int lane, int i, int j) const {
    const glm::vec3 origin(corner_ + across_ * (i + 0.5) + down_ * (j + 0.5));
    rays.ray.org_x[lane] = origin.x;
    rays.ray.org_y[lane] = origin.y;
    rays.ray.org_z[lane] = origin.z;
    rays.ray.dir_x[lane] = direction_.x;
    rays.ray.dir_y[lane] = direction_.y;
    rays.ray.dir_z[lane] = direction_.z;
    rays.ray.tnear[lane] = 0;
    rays.ray.tfar[lane] = std::numeric_limits<float>::infinity();
    rays.ray.time[lane] = 0;
    rays.ray.mask[lane] = 0xFFFFFFFFU;
    rays.ray.flags[lane] = 0;
    rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    rays.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
  }

  float depth(float distance) const { return start_ + distance * depth_per_unit_; }

 private:
  glm::dvec3 across_, down_, corner_;
  glm::vec3 direction_;
  float depth_per_unit_ = 1;
  float start_ = 0;
};

/// Casts the packet whose first pixel is (left, top).
void cast(RTCScene scene, const RayGrid& grid, int left, int top, const Canvas& canvas) {
  alignas(64) std::array<int, kRays> valid{};
  alignas(64) RTCRayHit16 rays;
  for (int lane = 0; lane < kRays; ++lane) {
    const int i = left + lane % kTile;
    const int j = top + lane / kTile;
    valid[lane] = i < canvas.width && j < canvas.height ? -1 : 0;
    grid.aim(rays, lane, i, j);
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid.data(), scene, &context, &rays);
  for (int lane = 0; lane < kRays; ++lane) {
    if (valid[lane] == 0 || rays.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
    const std::ptrdiff_t row = top + lane / kTile;
    canvas.depth[row * canvas.width + left + lane % kTile] = grid.depth(rays.ray.tfar[lane]);
  }
}

/// Ray casting by Embree: slower than drawing, independent of the pixel grid's size in faces, exact at edges.
class RayCastScorer final : public MapScorer {
 public:
  RayCastScorer(const mesh::Mesh& a, const mesh::Mesh& b, const ViewOptions& options)
      : MapScorer(options), device_(open_device()), a_(device_, a), b_(device_, b) {}

  Backend backend() const override { return Backend::RayCast; }
  std::string renderer() const override { return raycast_renderer(); }

 protected:
  void render(Side side, const Projection& projection, std::span<float> depth) const override {
    const RayTarget& target = side == Side::A ? a_ : b_;
    const auto [low, high] = projected(target.box(), projection);
    const int last = options().resolution - 1;
    const auto pixel = [&](float x) {
      return static_cast<int>(std::clamp(std::floor(x), 0.0F, static_cast<float>(last)));
    };
    if (!(high.x > 0 && high.y > 0 && low.x <= static_cast<float>(last + 1) &&
          low.y <= static_cast<float>(last + 1))) {
      return;
    }
    const RayGrid grid(projection, low.z);
    const Canvas canvas{depth.data(), options().resolution, options().resolution};
    for (int top = pixel(low.y) / kTile * kTile; top <= pixel(high.y); top += kTile) {
      for (int left = pixel(low.x) / kTile * kTile; left <= pixel(high.x); left += kTile) {
        cast(target.scene(), grid, left, top, canvas);
      }
    }
  }

 private:
  Device device_;
  RayTarget a_;
  RayTarget b_;
};

}  // namespace

std::string raycast_renderer() {
  return "Embree " + std::to_string(RTC_VERSION_MAJOR) + "." + std::to_string(RTC_VERSION_MINOR) + "." +
         std::to_string(RTC_VERSION_PATCH);
}

std::unique_ptr<Scorer> make_raycast(const mesh::Mesh& a, const mesh::Mesh& b, const ViewOptions& options) {
  return std::make_unique<RayCastScorer>(a, b, options);
}

}  // namespace rejoin::zbuffer::detail
