#include "mesh/save.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/error.hpp"
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

[[noreturn]] void fail_writing(const std::string& name) {
  throw IoError(name, fmt::format("cannot be written ({})", std::strerror(errno)),
                "check the folder, its permissions and its space");
}

/// Writes beside the path and renames, so that nobody ever sees half a file.
void write_whole(const std::filesystem::path& path, const std::string& bytes) {
  std::filesystem::path temporary = path;
  temporary += fmt::format(".{}.part", getpid());
  {
    std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
    if (!stream) fail_writing(path.string());
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) {
      const int reason = errno;
      std::error_code ignored;
      std::filesystem::remove(temporary, ignored);
      errno = reason;
      fail_writing(path.string());
    }
  }
  std::error_code error;
  std::filesystem::rename(temporary, path, error);
  if (!error) return;
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  errno = error.value();
  fail_writing(path.string());
}

std::string encode(const std::filesystem::path& path, const std::vector<Placed>& parts) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".glb") return detail::write_glb(parts);
  if (extension == ".ply") return detail::write_ply(merged(parts));
  if (extension == ".obj") return detail::write_obj(merged(parts));
  if (extension == ".drc") {
    const detail::Soup soup = merged(parts);
    return detail::encode_draco(soup, detail::is_far(soup), path.string());
  }
  throw InputError(path.string(), "cannot save as \"" + extension + "\"", "use one of .ply .obj .glb .drc");
}

}  // namespace

void save(const std::filesystem::path& path, const Mesh& mesh) {
  save_scene(path, {Placed{path.stem().string(), &mesh, Rigid{}}});
}

void save_scene(const std::filesystem::path& path, const std::vector<Placed>& parts) {
  write_whole(path, encode(path, parts));
}

}  // namespace rejoin::mesh
