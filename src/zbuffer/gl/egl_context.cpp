/// EGL: every device that the system's drivers know, then the surfaceless platform.
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "zbuffer/gl/context.hpp"
#include "zbuffer/gl/library.hpp"

namespace rejoin::zbuffer::gl {
namespace {

constexpr const char* kSubject = "backend gpu";
constexpr const char* kEglMend =
    "install libegl1 with a driver (libgl1-mesa-dri, or the GPU's own) or choose --backend raster";

// X(member and name without "egl", type)
#define REJOIN_EGL_FUNCTIONS(X)                           \
  X(BindAPI, PFNEGLBINDAPIPROC)                           \
  X(ChooseConfig, PFNEGLCHOOSECONFIGPROC)                 \
  X(CreateContext, PFNEGLCREATECONTEXTPROC)               \
  X(CreatePbufferSurface, PFNEGLCREATEPBUFFERSURFACEPROC) \
  X(DestroyContext, PFNEGLDESTROYCONTEXTPROC)             \
  X(DestroySurface, PFNEGLDESTROYSURFACEPROC)             \
  X(GetCurrentContext, PFNEGLGETCURRENTCONTEXTPROC)       \
  X(GetCurrentDisplay, PFNEGLGETCURRENTDISPLAYPROC)       \
  X(GetCurrentSurface, PFNEGLGETCURRENTSURFACEPROC)       \
  X(GetError, PFNEGLGETERRORPROC)                         \
  X(GetProcAddress, PFNEGLGETPROCADDRESSPROC)             \
  X(Initialize, PFNEGLINITIALIZEPROC)                     \
  X(MakeCurrent, PFNEGLMAKECURRENTPROC)                   \
  X(QueryAPI, PFNEGLQUERYAPIPROC)                         \
  X(QueryString, PFNEGLQUERYSTRINGPROC)

struct Egl {
#define REJOIN_EGL_MEMBER(name, type) type name = nullptr;
  REJOIN_EGL_FUNCTIONS(REJOIN_EGL_MEMBER)
#undef REJOIN_EGL_MEMBER
  // Extensions; nullptr where the system has none of it.
  PFNEGLGETPLATFORMDISPLAYEXTPROC GetPlatformDisplay = nullptr;
  PFNEGLQUERYDEVICESEXTPROC QueryDevices = nullptr;
  PFNEGLQUERYDEVICESTRINGEXTPROC QueryDeviceString = nullptr;
};

Egl open_egl(const ContextOptions& options) {
  const char* from_environment = std::getenv("REJOIN_EGL_LIBRARY");
  std::string file = from_environment != nullptr ? from_environment : "libEGL.so.1";
  if (!options.soname.empty()) file = options.soname;
  const Library library(kSubject, file, kEglMend);
  Egl egl;
#define REJOIN_EGL_LOAD(name, type)           \
  egl.name = library.find<type>("egl" #name); \
  if (egl.name == nullptr) throw BackendError(kSubject, file + " lacks egl" #name, kEglMend);
  REJOIN_EGL_FUNCTIONS(REJOIN_EGL_LOAD)
#undef REJOIN_EGL_LOAD
  const auto extension = [&]<typename Function>(Function& function, const char* name) {
    function = reinterpret_cast<Function>(egl.GetProcAddress(name));
  };
  extension(egl.GetPlatformDisplay, "eglGetPlatformDisplayEXT");
  extension(egl.QueryDevices, "eglQueryDevicesEXT");
  extension(egl.QueryDeviceString, "eglQueryDeviceStringEXT");
  return egl;
}

bool has_word(const char* list, std::string_view word) {
  std::string_view rest = list != nullptr ? list : "";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == word) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

/// A place where a context may come from.
struct Candidate {
  EGLenum platform;
  void* native;
  bool software;  ///< the driver says so; what it draws with may turn out to be software all the same
};

std::vector<Candidate> list_candidates(const Egl& egl) {
  std::vector<Candidate> candidates;
  const char* client = egl.QueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (egl.GetPlatformDisplay == nullptr) return candidates;
  if (egl.QueryDevices != nullptr && has_word(client, "EGL_EXT_platform_device")) {
    std::array<EGLDeviceEXT, 64> devices{};
    EGLint count = 0;
    if (egl.QueryDevices(devices.size(), devices.data(), &count) == EGL_FALSE) count = 0;
    for (EGLint i = 0; i < count; ++i) {
      const char* can =
          egl.QueryDeviceString != nullptr ? egl.QueryDeviceString(devices[i], EGL_EXTENSIONS) : nullptr;
      candidates.push_back({EGL_PLATFORM_DEVICE_EXT, devices[i], has_word(can, "EGL_MESA_device_software")});
    }
    std::stable_partition(candidates.begin(), candidates.end(),
                          [](const Candidate& c) { return !c.software; });
  }
  if (has_word(client, "EGL_MESA_platform_surfaceless")) {
    candidates.push_back({EGL_PLATFORM_SURFACELESS_MESA, nullptr, true});
  }
  return candidates;
}

class EglContext : public Context {
 public:
  EglContext(const Egl& egl, const Candidate& candidate, bool debug) : Context(Backend::Gpu), egl_(egl) {
    // Displays are the process's, shared with whoever else uses EGL in it; so it is never terminated here.
    display_ = egl_.GetPlatformDisplay(candidate.platform, native_display(candidate), nullptr);
    require(display_ != EGL_NO_DISPLAY, "no display");
    require(egl_.Initialize(display_, nullptr, nullptr) == EGL_TRUE, "eglInitialize failed");
    const EGLenum api = egl_.QueryAPI();
    require(egl_.BindAPI(EGL_OPENGL_API) == EGL_TRUE, "the driver has no desktop OpenGL");
    create(debug);
    egl_.BindAPI(api);
    try {
      const Bound bound(*this);
      load([this](const char* name) { return reinterpret_cast<AnyFunction>(egl_.GetProcAddress(name)); },
           debug);
    } catch (...) {
      destroy();
      throw;
    }
  }
  ~EglContext() override { destroy(); }

  void bind() override {
    before_ = {egl_.QueryAPI(), egl_.GetCurrentDisplay(), egl_.GetCurrentContext(),
               egl_.GetCurrentSurface(EGL_DRAW), egl_.GetCurrentSurface(EGL_READ)};
    egl_.BindAPI(EGL_OPENGL_API);
    require(egl_.MakeCurrent(display_, surface_, surface_, context_) == EGL_TRUE,
            "the context cannot be made current");
  }
  void release() noexcept override {
    if (before_.context != EGL_NO_CONTEXT) {
      egl_.MakeCurrent(before_.display, before_.draw, before_.read, before_.context);
    } else {
      egl_.MakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    egl_.BindAPI(before_.api);
  }

 private:
  struct Previous {
    EGLenum api = EGL_OPENGL_ES_API;
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    EGLSurface draw = EGL_NO_SURFACE;
    EGLSurface read = EGL_NO_SURFACE;
  };

  static void* native_display(const Candidate& candidate) {
    return candidate.native != nullptr ? candidate.native : EGL_DEFAULT_DISPLAY;
  }

  void require(bool good, const char* problem) const {
    if (good) return;
    std::array<char, 16> code{};
    std::snprintf(code.data(), code.size(), " (0x%04x)", static_cast<unsigned>(egl_.GetError()));
    throw BackendError(kSubject, std::string("EGL: ") + problem + code.data(), kEglMend);
  }

  /// A config for a 1 x 1 pixel buffer where there is one, else any; none at all is fine for surfaceless
  /// contexts.
  std::optional<EGLConfig> choose_config(EGLint surface_type) const {
    const std::array<EGLint, 5> wanted{EGL_SURFACE_TYPE, surface_type, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                       EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (egl_.ChooseConfig(display_, wanted.data(), &config, 1, &count) == EGL_FALSE || count < 1)
      return std::nullopt;
    return config;
  }

  void create(bool debug) {
    const char* can = egl_.QueryString(display_, EGL_EXTENSIONS);
    const bool surfaceless = has_word(can, "EGL_KHR_surfaceless_context");
    std::optional<EGLConfig> config = choose_config(EGL_PBUFFER_BIT);
    const bool buffer = config.has_value();
    if (!config) config = choose_config(0);
    if (!config && has_word(can, "EGL_KHR_no_config_context")) config = EGL_NO_CONFIG_KHR;
    require(config.has_value() && (surfaceless || buffer), "no config for drawing without a window");
    const std::array<EGLint, 9> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                           4,
                                           EGL_CONTEXT_MINOR_VERSION,
                                           3,
                                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                           debug ? EGL_CONTEXT_OPENGL_DEBUG : EGL_NONE,
                                           EGL_TRUE,
                                           EGL_NONE};
    context_ = egl_.CreateContext(display_, *config, EGL_NO_CONTEXT, attributes.data());
    require(context_ != EGL_NO_CONTEXT, "no OpenGL 4.3 core context");
    if (!surfaceless) {
      constexpr std::array<EGLint, 5> kPixel{EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
      surface_ = egl_.CreatePbufferSurface(display_, *config, kPixel.data());
      if (surface_ == EGL_NO_SURFACE) destroy();
      require(surface_ != EGL_NO_SURFACE, "no pixel buffer");
    }
  }

  void destroy() noexcept {
    if (surface_ != EGL_NO_SURFACE) egl_.DestroySurface(display_, surface_);
    if (context_ != EGL_NO_CONTEXT) egl_.DestroyContext(display_, context_);
    surface_ = EGL_NO_SURFACE;
    context_ = EGL_NO_CONTEXT;
  }

  Egl egl_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  EGLSurface surface_ = EGL_NO_SURFACE;
  Previous before_;
};

}  // namespace

std::unique_ptr<Context> make_egl_context(const ContextOptions& options) {
  const Egl egl = open_egl(options);
  std::unique_ptr<Context> software;
  std::exception_ptr failure;
  for (const Candidate& candidate : list_candidates(egl)) {
    if (software && candidate.software) break;
    try {
      auto context = std::make_unique<EglContext>(egl, candidate, options.debug);
      if (!is_software_renderer(context->renderer())) return context;
      if (!software) software = std::move(context);
    } catch (const BackendError&) {
      failure = std::current_exception();
    }
  }
  if (software) return software;
  if (failure) std::rethrow_exception(failure);
  throw BackendError(kSubject, "EGL knows no device and no surfaceless platform", kEglMend);
}

}  // namespace rejoin::zbuffer::gl
