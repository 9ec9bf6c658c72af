/// The file of --constraints.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "assembly/assembly.hpp"

namespace rejoin::cli {

/// A file of constraints as it was read: a pipe can be read but once.
struct ConstraintsFile {
  std::string path;
  std::string text;
};

/// What a file of constraints asks for, as it has it.
struct NamedConstraints {
  using Pairs = std::vector<std::pair<std::string, std::string>>;
  Pairs must_join;
  Pairs must_not_join;
  std::vector<std::pair<std::string, Rigid>> poses;
};

/// What can be asked of an assembly of it.
struct AskedConstraints {
  assembly::Constraints constraints;
  NamedConstraints named;  ///< all, left out or not
  std::vector<std::string>
      left_out;  ///< of those that name a fragment that cannot be used: which, and the reason
};

/// \throws IoError it cannot be read   \throws InputError it is nested without end
ConstraintsFile open_constraints(const std::string& path);

/// Reads {"must_join": [[A, B], ...], "must_not_join": [[A, B], ...], "poses": {A: 4 x 4, ...}}; every part may be missing.  A pose may
/// be the name of a file with the 4 x 4 numbers, from the folder of the constraints.
/// \param names     of the fragments; those in the file are these
/// \param unusable  other fragments, with the reasons: what names one of them is left out
/// \param copies    other names of fragments, with those that stand for them and are meant
/// \throws IoError a file of a pose cannot be read
/// \throws InputError it is no such file, names a fragment that is not there, a fragment with itself, a pair as both, or different
///         poses of a scan and its copy
AskedConstraints read_constraints(const ConstraintsFile& file, const std::vector<std::string>& names,
                                  const std::map<std::string, std::string>& unusable = {},
                                  const std::map<std::string, std::string>& copies = {});

}  // namespace rejoin::cli
