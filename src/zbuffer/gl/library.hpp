/// A shared library opened at run time, so that a missing one is a message and not a failed start.
#pragma once

#include <string>

namespace rejoin::zbuffer::gl {

class Library {
 public:
  /// \param subject  names the backend in messages, "backend gpu"
  /// \throws BackendError  the library cannot be opened; says why and what to install
  Library(const std::string& subject, const std::string& file, const std::string& mend);

  /// Function `name`, nullptr if the library has none.
  template <typename Function>
  Function find(const char* name) const {
    return reinterpret_cast<Function>(symbol(name));
  }

 private:
  void* symbol(const char* name) const;

  // Never closed: GL drivers leave threads and exit handlers behind.
  void* handle_;
};

}  // namespace rejoin::zbuffer::gl
