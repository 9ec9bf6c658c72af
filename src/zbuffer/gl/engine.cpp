#include "zbuffer/gl/engine.hpp"

#include <algorithm>
#include <array>
#include <exception>

namespace rejoin::zbuffer::gl {
namespace {

Limits read_limits(const Context& context) {
  const Functions& gl = context.gl();
  Limits limits;
  limits.software = is_software_renderer(context.renderer());
  GLint value = 0;
  gl.GetIntegerv(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS, &value);
  limits.group_size = value;
  gl.GetIntegeri_v(GL_MAX_COMPUTE_WORK_GROUP_SIZE, 0, &value);
  limits.group_size = std::min(limits.group_size, value);
  gl.GetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &value);
  limits.texture_layers = value;
  GLint64 bytes = 0;
  gl.GetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
  limits.storage_bytes = static_cast<std::size_t>(bytes);
  return limits;
}

/// An engine, or why there is none.
struct Slot {
  std::once_flag once;
  std::shared_ptr<Engine> engine;
  std::exception_ptr failure;
};

}  // namespace

Engine::Engine(std::unique_ptr<Context> context) : context_(std::move(context)) {
  const Session session(*this);
  limits_ = read_limits(*context_);
  context_->check("reading the driver's limits");
}

GLuint Engine::program(const std::vector<Stage>& stages, const std::string& defines) {
  std::string key = defines;
  for (const Stage& stage : stages) key.append("|").append(stage.files.back());
  const auto found = programs_.find(key);
  if (found != programs_.end()) return found->second.name();
  Program made = make_program(gl(), context_->subject(), stages, defines);
  return programs_.emplace(key, std::move(made)).first->second.name();
}

std::shared_ptr<Engine> shared_engine(Backend backend) {
  static auto& slots = *new std::array<Slot, 2>;  // never destroyed, see the header
  Slot& slot = slots[backend == Backend::OsMesa ? 1 : 0];
  std::call_once(slot.once, [&] {
    try {
      slot.engine = std::make_shared<Engine>(make_context(backend));
    } catch (...) {
      slot.failure = std::current_exception();
    }
  });
  if (slot.failure) std::rethrow_exception(slot.failure);
  return slot.engine;
}

}  // namespace rejoin::zbuffer::gl
