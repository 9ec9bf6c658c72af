#include <fmt/format.h>

#include <array>
#include <cstring>
#include <limits>
#include <sstream>

#include "core/error.hpp"
#include "core/utf8.hpp"
#include "mesh/detail/colour.hpp"
#include "mesh/detail/gltf_model.hpp"
#include "mesh/detail/writers.hpp"

namespace rejoin::mesh::detail {
namespace {

/// Material colours of the parts of a scene, told apart also by colour-blind eyes (Okabe and Ito 2008).
constexpr std::array<std::array<double, 3>, 7> kPalette{{{0.79, 0.35, 0.04},
                                                         {0.09, 0.46, 0.81},
                                                         {0.01, 0.34, 0.17},
                                                         {0.87, 0.78, 0.05},
                                                         {0.01, 0.17, 0.45},
                                                         {0.67, 0.11, 0.01},
                                                         {0.60, 0.19, 0.38}}};

class GlbBuilder {
 public:
  explicit GlbBuilder(bool scene) : scene_(scene) {
    model_.asset.version = "2.0";
    model_.asset.generator = "rejoin";
    model_.buffers.emplace_back();
    model_.scenes.emplace_back();
    model_.defaultScene = 0;
  }

  void add(const Placed& part) {
    tinygltf::Mesh mesh;
    mesh.name = valid_utf8(part.name);
    mesh.primitives.push_back(primitive_of(*part.mesh));
    tinygltf::Node node;
    node.name = mesh.name;
    node.mesh = static_cast<int>(model_.meshes.size());
    // Vertices stay relative to their origin; the node carries it in double precision.
    const glm::dvec3 shift = part.pose(part.mesh->origin);
    node.matrix.assign(16, 0.0);
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) at(node.matrix, column, row) = part.pose.rotation[column][row];
      at(node.matrix, 3, column) = shift[column];
    }
    node.matrix[15] = 1;
    model_.scenes[0].nodes.push_back(static_cast<int>(model_.nodes.size()));
    model_.nodes.push_back(std::move(node));
    model_.meshes.push_back(std::move(mesh));
  }

  std::string finish() {
    std::ostringstream stream;
    if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model_, stream, false, true)) return {};
    return stream.str();
  }

 private:
  static double& at(std::vector<double>& matrix, int column, int row) {
    return matrix[4 * static_cast<std::size_t>(column) + static_cast<std::size_t>(row)];
  }

  /// Appends rows to the buffer; returns the number of the accessor for them.
  template <class Row>
  int add_accessor(const std::vector<Row>& rows, int component, int type, int target) {
    std::vector<unsigned char>& data = model_.buffers[0].data;
    data.resize((data.size() + 3) / 4 * 4, 0);
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = rows.size() * sizeof(Row);
    view.target = target;
    data.resize(data.size() + view.byteLength);
    std::memcpy(data.data() + view.byteOffset, rows.data(), view.byteLength);
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model_.bufferViews.size());
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = rows.size();
    model_.bufferViews.push_back(std::move(view));
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  int add_positions(const Mesh& mesh) {
    const int index = add_accessor(mesh.vertices, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3,
                                   TINYGLTF_TARGET_ARRAY_BUFFER);
    const Box box = bounds(mesh);
    tinygltf::Accessor& accessor = model_.accessors.back();
    accessor.minValues = {box.low.x, box.low.y, box.low.z};
    accessor.maxValues = {box.high.x, box.high.y, box.high.z};
    return index;
  }

  int add_colours(const Mesh& mesh) {
    std::vector<glm::u16vec4> linear;
    linear.reserve(mesh.colours.size());
    for (const glm::u8vec3& colour : mesh.colours)
      linear.emplace_back(glm::round(to_linear(colour) * 65535.0), 65535);
    const int index = add_accessor(linear, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4,
                                   TINYGLTF_TARGET_ARRAY_BUFFER);
    model_.accessors.back().normalized = true;
    return index;
  }

  tinygltf::Primitive primitive_of(const Mesh& mesh) {
    tinygltf::Primitive primitive;
    primitive.attributes["POSITION"] = add_positions(mesh);
    if (!mesh.normals.empty()) {
      primitive.attributes["NORMAL"] = add_accessor(mesh.normals, TINYGLTF_COMPONENT_TYPE_FLOAT,
                                                    TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
    }
    if (!mesh.colours.empty()) primitive.attributes["COLOR_0"] = add_colours(mesh);
    primitive.mode = mesh.is_cloud() ? TINYGLTF_MODE_POINTS : TINYGLTF_MODE_TRIANGLES;
    if (!mesh.is_cloud()) {
      std::vector<std::uint32_t> corners;
      corners.reserve(3 * mesh.faces.size());
      for (const glm::uvec3& face : mesh.faces) corners.insert(corners.end(), {face.x, face.y, face.z});
      primitive.indices = add_accessor(corners, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                                       TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    }
    primitive.material = add_material(mesh.colours.empty());
    return primitive;
  }

  int add_material(bool coloured) {
    tinygltf::Material material;
    const auto& colour = kPalette[model_.materials.size() % kPalette.size()];
    if (coloured && scene_)
      material.pbrMetallicRoughness.baseColorFactor = {colour[0], colour[1], colour[2], 1.0};
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.roughnessFactor = 0.9;
    material.doubleSided = true;  // scans are often open
    model_.materials.push_back(std::move(material));
    return static_cast<int>(model_.materials.size()) - 1;
  }

  tinygltf::Model model_;
  bool scene_;
};

/// Upper bound of what a GLB of the parts takes.
std::size_t most_bytes_of(const std::vector<Placed>& parts) {
  constexpr std::size_t kJson =
      4096;  // of all that describes a part, but for its name: a fourth of that in truth
  std::size_t bytes = kJson;
  for (const Placed& part : parts) {
    const Mesh& mesh = *part.mesh;
    bytes += kJson + 12 * part.name.size();  // the name twice, and six characters for one that JSON escapes
    bytes += sizeof(glm::vec3) * (mesh.vertices.size() + mesh.normals.size());
    bytes += sizeof(glm::u16vec4) * mesh.colours.size() + sizeof(glm::uvec3) * mesh.faces.size();
  }
  return bytes;
}

}  // namespace

std::string write_glb(const std::vector<Placed>& parts) {
  // tinygltf would write the lengths modulo 2^32.
  if (most_bytes_of(parts) > std::numeric_limits<std::uint32_t>::max()) return {};
  GlbBuilder builder(parts.size() > 1);
  for (const Placed& part : parts) builder.add(part);
  return builder.finish();
}

}  // namespace rejoin::mesh::detail
