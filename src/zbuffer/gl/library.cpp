#include "zbuffer/gl/library.hpp"

#include <dlfcn.h>

#include "core/error.hpp"

namespace rejoin::zbuffer::gl {

Library::Library(const std::string& subject, const std::string& file, const std::string& mend)
    : handle_(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
  if (handle_ == nullptr) {
    const char* why = dlerror();
    throw BackendError(subject, std::string("cannot load ") + (why != nullptr ? why : file), mend);
  }
}

void* Library::symbol(const char* name) const {
  return dlsym(handle_, name);
}

}  // namespace rejoin::zbuffer::gl
