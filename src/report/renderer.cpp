#include "report/renderer.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <optional>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"
#include "report/detail/soup.hpp"

namespace rejoin::report {
namespace {

using detail::ShadingPoint;
using detail::Soup;

constexpr int kSide = 2;  ///< samples a pixel along each axis

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};

template <class Item>
void copy_into(RTCGeometry geometry, RTCBufferType type, RTCFormat format, const std::vector<Item>& items) {
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Item), items.size());
  if (buffer == nullptr && !items.empty()) {
    throw BackendError("picture", "out of memory for " + std::to_string(items.size()) + " items",
                       "simplify the scans");
  }
  if (!items.empty()) std::memcpy(buffer, items.data(), items.size() * sizeof(Item));
}

/// The eye in the soup's frame: where the ray of a picture position starts, and where it goes.
struct Eye {
  glm::vec3 target, right, up, back;
  float half_width, half_height, distance, start;

  Eye(const Camera& camera, const Soup& soup, int width, int height)
      : target(camera.target - soup.centre),
        right(camera.right),
        up(camera.up),
        back(camera.back()),
        half_width(static_cast<float>(camera.half_height * width / height)),
        half_height(static_cast<float>(camera.half_height)),
        distance(static_cast<float>(camera.distance)),
        start(static_cast<float>(2 * soup.radius + glm::length(camera.target - soup.centre))) {}

  /// \param x, y  -1 .. 1, y upwards
  std::pair<glm::vec3, glm::vec3> ray(float x, float y) const {
    const glm::vec3 seen = target + x * half_width * right + y * half_height * up;
    if (distance <= 0) return {seen + start * back, -back};
    const glm::vec3 origin = target + distance * back;
    return {origin, glm::normalize(seen - origin)};
  }
};

RTCRayHit ray_from(const glm::vec3& origin, const glm::vec3& direction) {
  RTCRayHit query{};
  query.ray.org_x = origin.x;
  query.ray.org_y = origin.y;
  query.ray.org_z = origin.z;
  query.ray.dir_x = direction.x;
  query.ray.dir_y = direction.y;
  query.ray.dir_z = direction.z;
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = ~0U;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return query;
}

/// What one sample of the picture saw.
struct Sample {
  glm::vec3 position{0.0F};
  glm::vec3 normal{0.0F};
  glm::vec3 albedo{0.0F};
  float open = 1;  ///< share of the ambient light that arrives
  int body = -1;
};

/// Colour of the light that leaves the sample towards the eye, linear.
glm::vec3 shade(const Sample& sample, float open, const Eye& eye, float relief) {
  const glm::vec3 key = glm::normalize(-0.55F * eye.right + 0.65F * eye.up + 0.75F * eye.back);
  const glm::vec3 fill = glm::normalize(0.8F * eye.right - 0.1F * eye.up + 0.6F * eye.back);
  const float lit = std::max(0.0F, glm::dot(sample.normal, key));
  const float filled = std::max(0.0F, glm::dot(sample.normal, fill));
  const float sky = 0.5F + 0.5F * glm::dot(sample.normal, eye.up);
  const float light =
      open * (0.30F + 0.10F * sky) + 0.78F * lit * (0.35F + 0.65F * open) + 0.20F * filled * open;
  return sample.albedo * glm::mix(1.0F, light, relief);
}

/// Direction about the normal with a density that follows the cosine (Malley).
glm::vec3 cosine_direction(const glm::vec3& normal, float u, float v) {
  const float sign = std::copysign(1.0F, normal.z);  // Duff et al. 2017, a frame without a branch
  const float a = -1.0F / (sign + normal.z);
  const float b = normal.x * normal.y * a;
  const glm::vec3 x(1 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x);
  const glm::vec3 y(b, sign + normal.y * normal.y * a, -normal.y);
  const float radius = std::sqrt(u);
  const float turn = 2 * std::numbers::pi_v<float> * v;
  return radius * std::cos(turn) * x + radius * std::sin(turn) * y +
         std::sqrt(std::max(0.0F, 1 - u)) * normal;
}

/// The samples of a whole picture, row after row from the top.
struct Film {
  int width, height;
  std::vector<Sample> samples;

  Film(int w, int h) : width(w), height(h), samples(static_cast<std::size_t>(w) * h) {}
  const Sample& at(int x, int y) const { return samples[static_cast<std::size_t>(y) * width + x]; }
};

/// Mean openness of the neighbours on the same piece of surface: few rays a sample then make a calm picture.
float smoothed_openness(const Film& film, int x, int y, float pixel) {
  constexpr int kReach = 4;
  const Sample& middle = film.at(x, y);
  float sum = 0;
  float weight = 0;
  for (int j = std::max(0, y - kReach); j <= std::min(film.height - 1, y + kReach); ++j) {
    for (int i = std::max(0, x - kReach); i <= std::min(film.width - 1, x + kReach); ++i) {
      const Sample& other = film.at(i, j);
      if (other.body != middle.body || glm::dot(other.normal, middle.normal) < 0.85F) continue;
      if (std::abs(glm::dot(other.position - middle.position, middle.normal)) > 3 * pixel) continue;
      sum += other.open;
      weight += 1;
    }
  }
  return weight > 0 ? sum / weight : middle.open;
}

}  // namespace

struct Scene::Impl {
  Soup soup;
  std::unique_ptr<RTCDeviceTy, DeviceRelease> device;
  std::unique_ptr<RTCSceneTy, SceneRelease> scene;

  explicit Impl(const std::vector<Body>& bodies)
      : soup(detail::make_soup(bodies)), device(rtcNewDevice(nullptr)) {
    if (!device)
      throw BackendError("picture", "Embree gives no device", "check that libembree3 is installed whole");
    scene.reset(rtcNewScene(device.get()));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    copy_into(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, soup.vertices);
    copy_into(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, soup.faces);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene.get(), geometry);
    rtcReleaseGeometry(geometry);
    const ThreadLimit one(1);  // the same tree, so the same picture, on every machine
    rtcCommitScene(scene.get());
  }

  std::optional<RTCRayHit> cast(const std::pair<glm::vec3, glm::vec3>& ray) const {
    RTCRayHit query = ray_from(ray.first, ray.second);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect1(scene.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return query;
  }

  bool occluded(const glm::vec3& origin, const glm::vec3& direction, float reach) const {
    RTCRay ray = ray_from(origin, direction).ray;
    ray.tfar = reach;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene.get(), &context, &ray);
    return ray.tfar < 0;
  }

  Sample sample(const std::pair<glm::vec3, glm::vec3>& ray) const {
    const auto hit = cast(ray);
    if (!hit) return {};
    ShadingPoint point = detail::shading_point(soup, hit->hit.primID, hit->hit.u, hit->hit.v);
    Sample result;
    result.position = ray.first + hit->ray.tfar * ray.second;
    result.body = soup.body_of(hit->hit.primID);
    result.albedo = point.albedo;
    if (glm::dot(point.flat, ray.second) > 0) point.normal = -point.normal;
    result.normal = point.normal;
    return result;
  }

  /// \param stream  own random numbers for each sample, whatever thread draws it
  float openness(const Sample& sample, int rays, float reach, std::uint64_t stream) const {
    constexpr float kGolden = 0.61803399F;
    Random random(stream, 17);
    const auto shift_u = static_cast<float>(random.uniform());
    const auto shift_v = static_cast<float>(random.uniform());
    const glm::vec3 origin = sample.position + 1e-4F * static_cast<float>(soup.radius) * sample.normal;
    int blocked = 0;
    for (int k = 0; k < rays; ++k) {
      const float u = (static_cast<float>(k) + shift_u) / static_cast<float>(rays);
      const float turn = shift_v + kGolden * static_cast<float>(k);
      blocked += occluded(origin, cosine_direction(sample.normal, u, turn - std::floor(turn)), reach) ? 1 : 0;
    }
    return 1 - static_cast<float>(blocked) / static_cast<float>(rays);
  }

  Film expose(const Eye& eye, const RenderOptions& options) const {
    Film film(options.width * kSide, options.height * kSide);
    const float reach = static_cast<float>(options.ambient_reach * soup.radius);
    parallel_for(film.height, 4, [&](std::size_t first, std::size_t last) {
      for (std::size_t y = first; y < last; ++y) {
        for (int x = 0; x < film.width; ++x) {
          const float across = 2 * (static_cast<float>(x) + 0.5F) / static_cast<float>(film.width) - 1;
          const float down = 2 * (static_cast<float>(y) + 0.5F) / static_cast<float>(film.height) - 1;
          const std::size_t index = y * film.width + x;
          Sample& seen = film.samples[index] = sample(eye.ray(across, -down));
          if (seen.body < 0 || options.ambient_rays <= 0) continue;
          seen.open = openness(seen, options.ambient_rays, reach, index);
        }
      }
    });
    return film;
  }
};

Scene::Scene(const std::vector<Body>& bodies) : impl_(std::make_unique<Impl>(bodies)) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

Image Scene::render(const Camera& camera, const RenderOptions& options) const {
  const Eye eye(camera, impl_->soup, options.width, options.height);
  const Film film = impl_->expose(eye, options);
  const float pixel = 2 * eye.half_height / static_cast<float>(options.height);
  const glm::vec3 background = glm::vec3(options.background) / 255.0F;
  const glm::vec3 behind(detail::to_linear(background.r), detail::to_linear(background.g),
                         detail::to_linear(background.b));
  Image image(options.width, options.height, options.background);
  parallel_for(image.height, 4, [&](std::size_t first, std::size_t last) {
    for (std::size_t y = first; y < last; ++y) {
      for (int x = 0; x < image.width; ++x) {
        glm::vec3 light(0.0F);
        for (int k = 0; k < kSide * kSide; ++k) {
          const int i = x * kSide + k % kSide;
          const int j = static_cast<int>(y) * kSide + k / kSide;
          const Sample& seen = film.at(i, j);
          const bool calm = options.ambient_rays > 0 && seen.body >= 0;
          const float open = calm ? smoothed_openness(film, i, j, pixel) : 1.0F;
          light += seen.body < 0 ? behind : shade(seen, open, eye, static_cast<float>(options.relief));
        }
        light /= static_cast<float>(kSide * kSide);
        const glm::vec3 srgb(detail::to_srgb(light.r), detail::to_srgb(light.g), detail::to_srgb(light.b));
        image.at(x, static_cast<int>(y)) = Colour(255.0F * srgb + 0.5F);
      }
    }
  });
  return image;
}

Camera Scene::overview(const glm::dvec3& back, const glm::dvec3& up) const {
  const glm::dvec3 right = glm::normalize(glm::cross(up, back));
  return {impl_->soup.centre, right, glm::cross(back, right), impl_->soup.radius, 0};
}

Visibility Scene::look(const Camera& camera, int width, int height) const {
  const Eye eye(camera, impl_->soup, width, height);
  const std::size_t count = static_cast<std::size_t>(width) * height;
  Visibility result{width, height, std::vector<int>(count, -1), std::vector<std::uint32_t>(count, 0)};
  parallel_for(count, 256, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const float x = 2 * (static_cast<float>(k % width) + 0.5F) / static_cast<float>(width) - 1;
      const std::size_t row = k / width;
      const float y = 2 * (static_cast<float>(row) + 0.5F) / static_cast<float>(height) - 1;
      const auto hit = impl_->cast(eye.ray(x, -y));
      if (!hit) continue;
      result.body[k] = impl_->soup.body_of(hit->hit.primID);
      result.face[k] = hit->hit.primID - impl_->soup.first_face[result.body[k]];
    }
  });
  return result;
}

}  // namespace rejoin::report
