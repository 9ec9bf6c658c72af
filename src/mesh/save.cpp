#include "mesh/save.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "core/files.hpp"
#include "mesh/detail/draco_codec.hpp"
#include "mesh/detail/writers.hpp"

namespace rejoin::mesh {
namespace {

/// All parts in the common frame.  Normals and colours that only some parts have are made for the others.
detail::Soup merged(const std::vector<Placed>& parts) {
  const bool normals =
      std::any_of(parts.begin(), parts.end(), [](const Placed& p) { return !p.mesh->normals.empty(); });
  const bool colours =
      std::any_of(parts.begin(), parts.end(), [](const Placed& p) { return !p.mesh->colours.empty(); });
  constexpr glm::u8vec3 kGrey(200, 200, 200);
  detail::Soup soup;
  for (const Placed& part : parts) {
    const Mesh& mesh = *part.mesh;
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    for (const glm::vec3& vertex : mesh.vertices)
      soup.points.push_back(part.pose(mesh.origin + glm::dvec3(vertex)));
    if (normals) {
      Mesh shaded;
      if (mesh.normals.empty()) {
        shaded = mesh;
        compute_normals(shaded);
      }
      for (const glm::vec3& normal : mesh.normals.empty() ? shaded.normals : mesh.normals) {
        soup.normals.emplace_back(part.pose.rotation * glm::dvec3(normal));
      }
    }
    if (colours) {
      soup.colours.insert(soup.colours.end(), mesh.colours.begin(), mesh.colours.end());
      soup.colours.resize(soup.points.size(), kGrey);
    }
    for (const glm::uvec3& face : mesh.faces)
      soup.add_triangle(first + face.x, first + face.y, first + face.z);
  }
  return soup;
}

/// The parts with the first one's origin at zero if that is far away: viewers place the nodes of a GLB by floats, in which parts
/// would part.
std::vector<Placed> near_the_origin(std::vector<Placed> parts) {
  const glm::dvec3 first = parts.front().pose(parts.front().mesh->origin);
  if (glm::length(first) <= kFarFromOrigin * diameter(*parts.front().mesh)) return parts;
  for (Placed& part : parts) part.pose = Rigid{glm::dmat3(1.0), -first} * part.pose;
  return parts;
}

std::string encode_draco(const std::vector<Placed>& parts, const std::string& name) {
  const detail::Soup soup = merged(parts);
  return detail::encode_draco(soup, detail::is_far(soup), name);
}

std::string encode(const std::filesystem::path& path, const std::vector<Placed>& parts) {
  const std::string extension = extension_of(path);
  if (extension == ".glb") {
    std::string glb = detail::write_glb(parts.size() > 1 ? near_the_origin(parts) : parts);
    if (glb.empty()) throw IoError(path.string(), "is more than a GLB file holds", "save it as .ply");
    return glb;
  }
  if (extension == ".ply") return detail::write_ply(merged(parts));
  if (extension == ".obj") return detail::write_obj(merged(parts));
  if (extension == ".drc") return encode_draco(parts, path.string());
  throw InputError(path.string(), "cannot save as \"" + extension + "\"", "use one of .ply .obj .glb .drc");
}

}  // namespace

void save(const std::filesystem::path& path, const Mesh& mesh) {
  save_scene(path, {Placed{path.stem().string(), &mesh, Rigid{}}});
}

Mesh as_kept(const Mesh& mesh, const std::string& name) {
  const std::string bytes = encode_draco({Placed{name, &mesh, Rigid{}}}, name);
  try {
    return detail::clean(detail::decode_draco(bytes, name), name).mesh;
  } catch (const InputError&) {
    throw InputError(name, "has no surface left where it is kept to a millionth of its size",
                     "remove vertices far from the rest");
  }
}

void save_scene(const std::filesystem::path& path, const std::vector<Placed>& parts) {
  write_file(path, encode(path, parts));
}

}  // namespace rejoin::mesh
