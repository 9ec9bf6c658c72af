/// A mesh as it is loaded from a file.
#pragma once

#include "mesh/load.hpp"
#include "mesh/save.hpp"
#include "shapes.hpp"

namespace rejoin::mesh::test {

inline Loaded through_ply(const Mesh& mesh, Content content = Content::OnePiece) {
  const TemporaryFolder folder;
  save(folder / "a.ply", mesh);
  return load(folder / "a.ply", Weld::Places, content);
}

}  // namespace rejoin::mesh::test
