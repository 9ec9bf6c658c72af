#include "mesh/ray_scene.hpp"

#include <embree3/rtcore.h>

#include <cmath>
#include <cstring>

#include "core/error.hpp"

namespace rejoin::mesh {

struct RayScene::Impl {
  const Mesh* mesh = nullptr;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  ~Impl() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

RayScene::RayScene(const Mesh& mesh) : impl_(std::make_unique<Impl>()) {
  impl_->mesh = &mesh;
  impl_->device = rtcNewDevice(nullptr);
  if (impl_->device == nullptr)
    throw BackendError("Embree", "no device could be made",
                       "give it more memory (ulimit -v), or check the libembree3 package");
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(impl_->scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT));
  RTCGeometry geometry = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(glm::vec3), mesh.vertices.size());
  if (vertices == nullptr) throw BackendError("Embree", "out of memory", "simplify the scan");
  std::memcpy(vertices, mesh.vertices.data(), mesh.vertices.size() * sizeof(glm::vec3));
  // Not so the vertices: Embree may read a little beyond the last one.
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.faces.data(), 0,
                             sizeof(glm::uvec3), mesh.faces.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(impl_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(impl_->scene);
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

std::optional<RayScene::Hit> RayScene::first_hit(const glm::vec3& start, const glm::vec3& direction,
                                                 float near, float far) const {
  RTCRayHit query{};
  query.ray.org_x = start.x;
  query.ray.org_y = start.y;
  query.ray.org_z = start.z;
  query.ray.dir_x = direction.x;
  query.ray.dir_y = direction.y;
  query.ray.dir_z = direction.z;
  query.ray.tnear = near;
  query.ray.tfar = far;
  query.ray.mask = ~0U;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(impl_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return Hit{query.ray.tfar, query.hit.primID, start + query.ray.tfar * direction};
}

namespace {

/// Nearest point of a triangle (Ericson, Real-Time Collision Detection, 5.1.5: Voronoi regions of its
/// features).
glm::vec3 nearest_on_triangle(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b,
                              const glm::vec3& c) {
  const glm::vec3 ab = b - a;
  const glm::vec3 ac = c - a;
  const glm::vec3 ap = p - a;
  const float d1 = glm::dot(ab, ap);
  const float d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const glm::vec3 bp = p - b;
  const float d3 = glm::dot(ab, bp);
  const float d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const glm::vec3 cp = p - c;
  const float d5 = glm::dot(ab, cp);
  const float d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const float sum = va + vb + vc;
  return a + vb / sum * ab + vc / sum * ac;
}

struct NearestState {
  const Mesh* mesh;
  glm::vec3 point;
  RayScene::Hit best;
  bool found = false;
};

bool visit_triangle(RTCPointQueryFunctionArguments* args) {
  auto& state = *static_cast<NearestState*>(args->userPtr);
  const glm::uvec3 face = state.mesh->faces[args->primID];
  const auto& v = state.mesh->vertices;
  const glm::vec3 nearest = nearest_on_triangle(state.point, v[face.x], v[face.y], v[face.z]);
  const float distance = glm::distance(nearest, state.point);
  if (distance >= args->query->radius) return false;
  args->query->radius = distance;
  state.best = {distance, args->primID, nearest};
  state.found = true;
  return true;
}

}  // namespace

std::optional<RayScene::Hit> RayScene::nearest(const glm::vec3& point, float radius) const {
  NearestState state{impl_->mesh, point, {}, false};
  RTCPointQuery query{point.x, point.y, point.z, 0.0F, radius};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(impl_->scene, &query, &context, visit_triangle, &state);
  return state.found ? std::optional(state.best) : std::nullopt;
}

}  // namespace rejoin::mesh
