#include "report/split_picture.hpp"

#include <fmt/format.h>

#include "core/words.hpp"
#include "mesh/surface.hpp"
#include "report/canvas.hpp"
#include "report/fragment_colours.hpp"
#include "report/numbered_picture.hpp"

namespace rejoin::report {
namespace {

mesh::Mesh surface_of(const mesh::Mesh& piece) {
  if (!piece.is_cloud()) return piece;
  if (!piece.normals.empty()) return mesh::surface_of_cloud(piece);
  mesh::Mesh oriented = piece;
  mesh::estimate_normals(oriented);
  return mesh::surface_of_cloud(oriented);
}

}  // namespace

Image split_picture(const std::string& title, const std::vector<mesh::Mesh>& pieces) {
  NumberedPicture what;
  what.title = title;
  what.subtitle = counted(pieces.size(), "piece") + ", largest first";
  what.first = 1;
  what.colour = [](int part) { return list_colour(static_cast<std::size_t>(part)); };
  mesh::Mesh all;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const mesh::Mesh surface = surface_of(pieces[k]);
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), surface.vertices.begin(), surface.vertices.end());
    for (const glm::uvec3& face : surface.faces) all.faces.push_back(face + first);
    what.part_of_face.resize(all.faces.size(), static_cast<int>(k));
  }
  return numbered_picture(all, what);
}

Image stacked(const std::vector<Image>& images) {
  int height = 0;
  for (const Image& image : images) height += image.height;
  Image all(images.front().width, height, kPaper);
  int top = 0;
  for (const Image& image : images) {
    paste(all, image, 0, top);
    top += image.height;
  }
  return all;
}

}  // namespace rejoin::report
