/// Headless OpenGL contexts.
#pragma once

#include <memory>
#include <string>

#include "zbuffer/gl/functions.hpp"
#include "zbuffer/scorer.hpp"

namespace rejoin::zbuffer::gl {

struct ContextOptions {
  /// Name of the shared library to open, "libEGL.so.1", or its path.  Empty: the environment's REJOIN_EGL_LIBRARY /
  /// REJOIN_OSMESA_LIBRARY, else the system's libEGL.so.1 / libOSMesa.so.8 (or .6).
  std::string soname;
  /// Asks the driver to report misuse; the reports come out of Context::check().
  bool debug = false;
};

/// One core profile context, 4.3 or later, without a window.  Any thread may use it, one at a time.
class Context {
 public:
  virtual ~Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Makes it current in this thread.  \throws BackendError
  virtual void bind() = 0;
  /// Gives the thread back what was current before bind().  Never throws.
  virtual void release() noexcept = 0;

  const Functions& gl() const { return gl_; }
  /// GL_RENDERER, "llvmpipe (LLVM 15.0.6, 256 bits)".
  const std::string& renderer() const { return renderer_; }
  /// GL_VERSION, "4.5 (Core Profile) Mesa 22.3.6".
  const std::string& version() const { return version_; }
  /// "backend gpu": the subject of this context's messages.
  const std::string& subject() const { return subject_; }

  /// \pre bound  \throws BackendError if GL recorded an error since the last call
  void check(const char* doing) const;

 protected:
  explicit Context(Backend backend);
  /// Fills gl(), renderer() and version().  \pre bound  \throws BackendError too old, a function is missing
  void load(const FunctionLoader& loader, bool debug);

 private:
  static void APIENTRY note(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                            const GLchar* message, const void* context);

  Functions gl_;
  std::string renderer_;
  std::string version_;
  std::string subject_;
  mutable std::string misuse_;  ///< what the driver said in debug mode, not yet thrown
};

/// Current while it lives.
class Bound {
 public:
  explicit Bound(Context& context) : context_(context) { context_.bind(); }
  ~Bound() { context_.release(); }
  Bound(const Bound&) = delete;
  Bound& operator=(const Bound&) = delete;

 private:
  Context& context_;
};

/// EGL: devices first, those that are hardware before those that are not, then the surfaceless platform.
std::unique_ptr<Context> make_egl_context(const ContextOptions& options);
std::unique_ptr<Context> make_osmesa_context(const ContextOptions& options);

/// \pre backend is Gpu or OsMesa
/// \throws BackendError  the library or a driver is missing, or too old; says what to install or choose
/// instead
std::unique_ptr<Context> make_context(Backend backend, const ContextOptions& options = {});

/// Whether a GL_RENDERER string names a rasteriser that runs on the CPU.
bool is_software_renderer(const std::string& renderer);

}  // namespace rejoin::zbuffer::gl
