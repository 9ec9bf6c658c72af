/// The only exceptions that rejoin's modules throw.
#pragma once

#include <stdexcept>
#include <string>

namespace rejoin {

/// Base of all errors.  what() is one line: "SUBJECT: PROBLEM; MEND".
class Error : public std::runtime_error {
 public:
  /// \param subject  file (or option, or backend) that is at fault
  /// \param problem  what is wrong and where in it ("byte 512", "face 17")
  /// \param mend     what the user can do about it; may be empty
  Error(const std::string& subject, const std::string& problem, const std::string& mend = "")
      : std::runtime_error(subject + ": " + problem + (mend.empty() ? "" : "; " + mend)) {}
};

/// The content of an input is unusable.
class InputError : public Error {
  using Error::Error;
};

/// A file or folder cannot be read or written.
class IoError : public Error {
  using Error::Error;
};

/// A run's database cannot be used.
class StoreError : public Error {
  using Error::Error;
};

/// A rendering backend is missing or failed.
class BackendError : public Error {
  using Error::Error;
};

}  // namespace rejoin
