/// What all scorers of one backend share: the context, its limits and the compiled programs.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "zbuffer/gl/context.hpp"
#include "zbuffer/gl/objects.hpp"

namespace rejoin::zbuffer::gl {

struct Limits {
  bool software = false;
  std::size_t storage_bytes = 0;  ///< of one buffer that shaders write
  int group_size = 0;             ///< invocations of one work group, at most
  int texture_layers = 0;         ///< of one array texture
};

/// Making a context and compiling take longer than scoring thousands of poses, and a batch makes a scorer for
/// every pair: so one engine serves them all.  Scorers in several threads take turns.
class Engine {
 public:
  explicit Engine(std::unique_ptr<Context> context);

  /// Makes the context current and keeps other threads out while it lives.
  class Session {
   public:
    explicit Session(Engine& engine) : lock_(engine.mutex_), bound_(*engine.context_) {}

   private:
    std::lock_guard<std::mutex> lock_;
    Bound bound_;
  };

  const Functions& gl() const { return context_->gl(); }
  const Context& context() const { return *context_; }
  const Limits& limits() const { return limits_; }

  /// The program of these stages, compiled once.  \pre a Session lives
  GLuint program(const std::vector<Stage>& stages, const std::string& defines);

  /// Depth maps that the drawings of a context take turns in, as every pair has drawings of its own and making room takes long.
  struct Maps {
    Buffer buffer;
    std::size_t bytes = 0;
    bool empty = false;  ///< every pixel of every map
  };

  /// \pre a Session lives
  Maps& maps() { return maps_; }

 private:
  std::unique_ptr<Context> context_;
  Limits limits_;
  std::map<std::string, Program> programs_;
  Maps maps_;
  std::mutex mutex_;
};

/// The process's engine of a backend, made at the first call.  It lives until the process ends: drivers tear
/// their own threads down at exit, in no defined order with ours.
/// \throws BackendError  always the same one once it has failed
std::shared_ptr<Engine> shared_engine(Backend backend);

}  // namespace rejoin::zbuffer::gl
