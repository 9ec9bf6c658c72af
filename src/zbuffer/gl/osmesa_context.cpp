/// OSMesa: Mesa's software rasteriser drawing into memory, without any window system or device.
#include <array>
#include <cstdlib>
#include <memory>

#include "core/error.hpp"
#include "zbuffer/gl/context.hpp"
#include "zbuffer/gl/library.hpp"

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

namespace rejoin::zbuffer::gl {
namespace {

/// OSMesa 22.3 never frees about 1 KB a context and 320 bytes of its own; while this lives, the leak checker of a
/// sanitized build does not count what is allocated.
class [[maybe_unused]] AllocationsNotOurs {
 public:
#if defined(__SANITIZE_ADDRESS__)
  AllocationsNotOurs() {
    __lsan_disable();
  }
  ~AllocationsNotOurs() {
    __lsan_enable();
  }
#else
  AllocationsNotOurs() = default;
#endif
  AllocationsNotOurs(const AllocationsNotOurs&) = delete;
  AllocationsNotOurs& operator=(const AllocationsNotOurs&) = delete;
};

// From GL/osmesa.h, which cannot be included: it brings GL/gl.h, and that excludes GL/glcorearb.h.
constexpr int kRgba = GL_RGBA;
constexpr int kFormat = 0x22;
constexpr int kDepthBits = 0x30;
constexpr int kProfile = 0x33;
constexpr int kCoreProfile = 0x34;
constexpr int kMajorVersion = 0x36;
constexpr int kMinorVersion = 0x37;
struct NativeContext;
using CreateFunction = NativeContext* (*)(const int* attributes, NativeContext* share);
using DestroyFunction = void (*)(NativeContext* context);
using MakeCurrentFunction = GLboolean (*)(NativeContext* context, void* pixels, GLenum type, GLsizei width,
                                          GLsizei height);
using FindFunction = AnyFunction (*)(const char* name);

constexpr const char* kOsMesaMend = "install libosmesa6 or choose --backend raster";

Library open_library(const std::string& subject, const ContextOptions& options) {
  const char* from_environment = std::getenv("REJOIN_OSMESA_LIBRARY");
  if (!options.soname.empty()) return {subject, options.soname, kOsMesaMend};
  if (from_environment != nullptr) return {subject, from_environment, kOsMesaMend};
  try {
    return {subject, "libOSMesa.so.8", kOsMesaMend};
  } catch (const BackendError&) {
    return {subject, "libOSMesa.so.6", kOsMesaMend};  // the library's name before Mesa 10
  }
}

struct OsMesa {
  CreateFunction create;
  DestroyFunction destroy;
  MakeCurrentFunction make_current;
  FindFunction find;
};

OsMesa find_functions(const std::string& subject, const Library& library) {
  const OsMesa mesa{
      library.find<CreateFunction>("OSMesaCreateContextAttribs"),
      library.find<DestroyFunction>("OSMesaDestroyContext"),
      library.find<MakeCurrentFunction>("OSMesaMakeCurrent"),
      library.find<FindFunction>("OSMesaGetProcAddress"),
  };
  if (mesa.create == nullptr || mesa.destroy == nullptr || mesa.make_current == nullptr ||
      mesa.find == nullptr) {
    throw BackendError(subject, "the library is no OSMesa with core profiles", kOsMesaMend);
  }
  return mesa;
}

class OsMesaContext : public Context {
 public:
  explicit OsMesaContext(const ContextOptions& options)
      : Context(Backend::OsMesa), mesa_(find_functions(subject(), open_library(subject(), options))) {
    constexpr std::array<int, 12> kAttributes{kFormat,       kRgba, kDepthBits,    0, kProfile, kCoreProfile,
                                              kMajorVersion, 4,     kMinorVersion, 3, 0,        0};
    const AllocationsNotOurs allocations;
    context_ = {mesa_.create(kAttributes.data(), nullptr), mesa_.destroy};
    if (!context_) throw BackendError(subject(), "OSMesa cannot make an OpenGL 4.3 context", kOsMesaMend);
    const Bound bound(*this);
    load(mesa_.find, options.debug);
  }

  void bind() override {
    const AllocationsNotOurs allocations;
    if (mesa_.make_current(context_.get(), pixels_.data(), GL_UNSIGNED_BYTE, GLsizei{kSide},
                           GLsizei{kSide}) == GL_FALSE) {
      throw BackendError(subject(), "the OSMesa context cannot be made current", kOsMesaMend);
    }
  }
  void release() noexcept override { mesa_.make_current(nullptr, nullptr, 0, 0, 0); }

 private:
  // Everything is drawn into textures; the context's own picture only has to exist.
  static constexpr std::size_t kSide = 16;

  OsMesa mesa_;
  std::array<unsigned char, kSide * kSide * 4> pixels_{};
  std::unique_ptr<NativeContext, DestroyFunction> context_{nullptr, mesa_.destroy};
};

}  // namespace

std::unique_ptr<Context> make_osmesa_context(const ContextOptions& options) {
  return std::make_unique<OsMesaContext>(options);
}

}  // namespace rejoin::zbuffer::gl
