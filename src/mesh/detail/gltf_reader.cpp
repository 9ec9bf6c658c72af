#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>

#include "core/error.hpp"
#include "core/files.hpp"
#include "mesh/detail/colour.hpp"
#include "mesh/detail/draco_codec.hpp"
#include "mesh/detail/gltf_model.hpp"
#include "mesh/detail/text.hpp"
#include "mesh/files.hpp"
#include "picture/texture.hpp"

namespace rejoin::mesh::detail {
namespace {

/// Nodes within nodes: each takes a piece of the stack, and files come from anywhere.
constexpr int kDeepest = 1000;

/// Numbers of an accessor, `width` a row.
struct Table {
  std::vector<double> values;
  std::size_t width = 0;

  std::size_t rows() const { return width == 0 ? 0 : values.size() / width; }
  glm::dvec3 triple(std::size_t row) const {
    return {values[width * row], values[width * row + 1], values[width * row + 2]};
  }
};

template <class T>
double value_at(const unsigned char* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return static_cast<double>(value);
}

double component_at(const unsigned char* at, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return normalized ? std::max(value_at<std::int8_t>(at) / 127.0, -1.0) : value_at<std::int8_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return value_at<std::uint8_t>(at) / (normalized ? 255.0 : 1.0);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return normalized ? std::max(value_at<std::int16_t>(at) / 32767.0, -1.0) : value_at<std::int16_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return value_at<std::uint16_t>(at) / (normalized ? 65535.0 : 1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return value_at<std::uint32_t>(at);
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return value_at<float>(at);
    default:
      return value_at<double>(at);
  }
}

class GltfReader {
 public:
  explicit GltfReader(const Source& source)
      : name_(source.name), folder_(source.path.parent_path()), file_(read_gltf_model(source)) {}

  Soup read() {
    visited_.assign(model_.nodes.size(), false);
    if (model_.scenes.empty()) {
      // A file without a scene is a store of meshes: take them all.
      for (const tinygltf::Mesh& mesh : model_.meshes) read_mesh(mesh, glm::dmat4(1.0));
    } else {
      const int wanted = std::max(model_.defaultScene, 0);
      if (static_cast<std::size_t>(wanted) >= model_.scenes.size())
        fail(fmt::format("scene {} does not exist", wanted));
      for (const int node : model_.scenes[static_cast<std::size_t>(wanted)].nodes)
        read_node(node, glm::dmat4(1.0), 0);
    }
    // What only some parts have is made up for the others; clean-up sees the zero normals.
    if (!soup_.normals.empty()) soup_.normals.resize(soup_.points.size(), glm::vec3(0.0F));
    if (!soup_.colours.empty()) soup_.colours.resize(soup_.points.size(), glm::u8vec3(255));
    return std::move(soup_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(name_, "glTF " + problem, "export it again");
  }

  static glm::dmat4 transform_of(const tinygltf::Node& node) {
    glm::dmat4 transform(1.0);
    if (node.matrix.size() == 16) {
      for (int i = 0; i < 16; ++i) transform[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
      return transform;
    }
    if (node.rotation.size() == 4) {
      const double x = node.rotation[0];
      const double y = node.rotation[1];
      const double z = node.rotation[2];
      const double w = node.rotation[3];
      transform[0] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0};
      transform[1] = {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0};
      transform[2] = {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0};
    }
    for (int k = 0; k < 3 && node.scale.size() == 3; ++k)
      transform[k] *= node.scale[static_cast<std::size_t>(k)];
    if (node.translation.size() == 3) {
      transform[3] = {node.translation[0], node.translation[1], node.translation[2], 1};
    }
    return transform;
  }

  void read_node(int index, const glm::dmat4& parent, int depth) {
    if (depth > kDeepest) fail(fmt::format("node {} lies deeper than {} nodes", index, kDeepest));
    if (index < 0 || static_cast<std::size_t>(index) >= model_.nodes.size())
      fail(fmt::format("node {} does not exist", index));
    // Nodes form trees: a second visit is a loop, or the start of one.
    if (visited_[static_cast<std::size_t>(index)]) fail(fmt::format("node {} has two parents", index));
    visited_[static_cast<std::size_t>(index)] = true;
    const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(index)];
    const glm::dmat4 transform = parent * transform_of(node);
    if (node.mesh >= 0) {
      if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size())
        fail(fmt::format("mesh {} does not exist", node.mesh));
      read_mesh(model_.meshes[static_cast<std::size_t>(node.mesh)], transform);
    }
    for (const int child : node.children) read_node(child, transform, depth + 1);
  }

  void read_mesh(const tinygltf::Mesh& mesh, const glm::dmat4& transform) {
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
      const bool lines =
          mode == TINYGLTF_MODE_LINE || mode == TINYGLTF_MODE_LINE_LOOP || mode == TINYGLTF_MODE_LINE_STRIP;
      if (lines) continue;
      const auto draco = primitive.extensions.find(kDracoExtension);
      const GltfTexture texture = texture_of(primitive);
      Soup part = draco != primitive.extensions.end() ? read_draco(draco->second, texture.places)
                                                      : read_primitive(primitive, mode, texture.places);
      paint(part, texture);
      append(std::move(part), transform);
    }
  }

  GltfTexture texture_of(const tinygltf::Primitive& primitive) const {
    const auto material = static_cast<std::size_t>(primitive.material);
    const auto& textures = file_.textures.of_material;
    return primitive.material >= 0 && material < textures.size() ? textures[material] : GltfTexture{};
  }

  /// Gives the points the colours of the picture that lies on the part.
  void paint(Soup& part, const GltfTexture& use) {
    if (use.image < 0 || part.places.empty()) return;
    const picture::Texture* texture = picture_of(use.image);
    if (texture == nullptr) return;
    const double cosine = std::cos(use.rotation);
    const double sine = std::sin(use.rotation);
    std::vector<glm::u8vec3> colours;
    colours.reserve(part.points.size());
    for (std::size_t i = 0; i < part.points.size(); ++i) {
      const glm::dvec2 place = use.scale * part.places[i];
      const glm::dvec2 turned{cosine * place.x + sine * place.y, cosine * place.y - sine * place.x};
      glm::dvec3 linear = to_linear(texture->at(turned + use.offset)) * use.factor;
      if (!part.colours.empty()) linear *= to_linear(part.colours[i]);
      colours.push_back(to_srgb(linear));
    }
    part.colours = std::move(colours);
  }

  /// nullptr if it cannot be read, which is noted.  The last one is kept: parts of one picture mostly come together.
  const picture::Texture* picture_of(int image) {
    if (image != image_) {
      image_ = image;
      picture_.reset();
      try {
        picture_.emplace(image_bytes(image), fmt::format("image {}", image));
      } catch (const Error& error) {
        soup_.notes.push_back(fmt::format("is left without the colours of a texture ({})", error.what()));
      }
    }
    return picture_ ? &*picture_ : nullptr;
  }

  std::string image_bytes(int number) const {
    if (static_cast<std::size_t>(number) >= file_.textures.images.size())
      fail(fmt::format("image {} does not exist", number));
    const GltfImage& image = file_.textures.images[static_cast<std::size_t>(number)];
    if (image.uri.starts_with("data:")) {
      std::vector<unsigned char> bytes;
      std::string kind;
      if (!tinygltf::DecodeDataURI(&bytes, kind, image.uri, 0, false))
        fail(fmt::format("image {} cannot be decoded", number));
      return {bytes.begin(), bytes.end()};
    }
    if (!image.uri.empty()) return read_named_file(folder_ / percent_decoded(image.uri));
    const std::span<const unsigned char> bytes = view_bytes(image.view);
    return {bytes.begin(), bytes.end()};
  }

  /// \param places  number of the TEXCOORD that is read
  Soup read_draco(const tinygltf::Value& extension, int places) const {
    if (!extension.IsObject()) fail("a Draco primitive has no data");
    const tinygltf::Value& view = extension.Get("bufferView");
    if (!view.IsInt()) fail("a Draco primitive names no bufferView");
    const tinygltf::Value& attributes = extension.Get("attributes");
    const auto number = [&](const char* key) -> std::optional<int> {
      if (!attributes.IsObject() || !attributes.Has(key) || !attributes.Get(key).IsInt()) return std::nullopt;
      return attributes.Get(key).Get<int>();
    };
    const std::span<const unsigned char> bytes = view_bytes(view.Get<int>());
    Soup soup = decode_draco({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name_,
                             {number("POSITION"), number("NORMAL"), number("COLOR_0"),
                              number(fmt::format("TEXCOORD_{}", places).c_str())});
    for (glm::u8vec3& colour : soup.colours) colour = to_srgb(glm::dvec3(colour) / 255.0);
    return soup;
  }

  /// \param places  number of the TEXCOORD that is read
  Soup read_primitive(const tinygltf::Primitive& primitive, int mode, int places) const {
    const auto attribute = [&](const std::string& key) {
      const auto found = primitive.attributes.find(key);
      return found == primitive.attributes.end() ? Table{} : read_accessor(found->second);
    };
    Soup soup;
    const Table positions = attribute("POSITION");
    if (positions.width < 3) fail("a primitive has no POSITION");
    for (std::size_t i = 0; i < positions.rows(); ++i) soup.points.push_back(positions.triple(i));
    const Table normals = attribute("NORMAL");
    if (normals.width == 3 && normals.rows() == positions.rows()) {
      for (std::size_t i = 0; i < normals.rows(); ++i) soup.normals.emplace_back(normals.triple(i));
    }
    const Table colours = attribute("COLOR_0");
    if (colours.width >= 3 && colours.rows() == positions.rows()) {
      for (std::size_t i = 0; i < colours.rows(); ++i) soup.colours.push_back(to_srgb(colours.triple(i)));
    }
    const Table on_picture = attribute(fmt::format("TEXCOORD_{}", places));
    if (on_picture.width == 2 && on_picture.rows() == positions.rows()) {
      for (std::size_t i = 0; i < on_picture.rows(); ++i)
        soup.places.emplace_back(on_picture.values[2 * i], on_picture.values[2 * i + 1]);
    }
    if (mode != TINYGLTF_MODE_POINTS) add_faces(soup, primitive.indices, mode);
    return soup;
  }

  void add_faces(Soup& soup, int accessor, int mode) const {
    std::vector<std::uint32_t> indices;
    if (accessor >= 0) {
      for (const double value : read_accessor(accessor).values) indices.push_back(to_index(value));
    } else {
      for (std::uint32_t i = 0; i < soup.points.size(); ++i) indices.push_back(i);
    }
    if (mode == TINYGLTF_MODE_TRIANGLES) {
      for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
        soup.add_triangle(indices[i], indices[i + 1], indices[i + 2]);
      return;
    }
    for (std::size_t i = 0; i + 2 < indices.size(); ++i) {
      const bool odd = i % 2 == 1;
      if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
        soup.add_triangle(indices[0], indices[i + 1], indices[i + 2]);
      } else {
        soup.add_triangle(indices[i], indices[i + (odd ? 2 : 1)], indices[i + (odd ? 1 : 2)]);
      }
    }
  }

  std::span<const unsigned char> view_bytes(int index) const {
    if (index < 0 || static_cast<std::size_t>(index) >= model_.bufferViews.size())
      fail(fmt::format("bufferView {} does not exist", index));
    const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(index)];
    if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model_.buffers.size())
      fail(fmt::format("buffer {} does not exist", view.buffer));
    const std::vector<unsigned char>& data = model_.buffers[static_cast<std::size_t>(view.buffer)].data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
      fail(fmt::format("bufferView {} reaches beyond its buffer of {} bytes", index, data.size()));
    }
    return {data.data() + view.byteOffset, view.byteLength};
  }

  Table read_accessor(int index) const {
    if (index < 0 || static_cast<std::size_t>(index) >= model_.accessors.size())
      fail(fmt::format("accessor {} does not exist", index));
    const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
    if (accessor.sparse.isSparse) fail(fmt::format("accessor {} is sparse, which is not supported", index));
    const std::span<const unsigned char> bytes = view_bytes(accessor.bufferView);
    const int stride = accessor.ByteStride(model_.bufferViews[static_cast<std::size_t>(accessor.bufferView)]);
    const int component =
        tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
    const int width = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    if (stride <= 0 || component <= 0 || width <= 0)
      fail(fmt::format("accessor {} has an unknown type", index));
    const std::size_t row = static_cast<std::size_t>(component) * static_cast<std::size_t>(width);
    const std::size_t step = static_cast<std::size_t>(stride);
    const std::size_t room = bytes.size() - std::min(bytes.size(), accessor.byteOffset);
    const std::size_t fitting = room < row ? 0 : (room - row) / step + 1;
    if (accessor.count > fitting) {
      fail(fmt::format("accessor {} promises {} values but its bufferView holds {}", index, accessor.count,
                       fitting));
    }
    Table table;
    table.width = static_cast<std::size_t>(width);
    table.values.reserve(accessor.count * table.width);
    for (std::size_t i = 0; i < accessor.count; ++i) {
      const unsigned char* at = bytes.data() + accessor.byteOffset + i * step;
      for (std::size_t k = 0; k < table.width; ++k, at += component) {
        table.values.push_back(component_at(at, accessor.componentType, accessor.normalized));
      }
    }
    return table;
  }

  /// Adds a part at its place in the scene.  A mirroring transform turns the faces round.
  void append(Soup part, const glm::dmat4& transform) {
    const auto first = static_cast<std::uint32_t>(soup_.points.size());
    const glm::dmat3 linear(transform);
    const bool mirrored = glm::determinant(linear) < 0;
    const glm::dmat3 for_normals =
        glm::determinant(linear) != 0 ? glm::transpose(glm::inverse(linear)) : glm::dmat3(1.0);
    if (!part.normals.empty()) soup_.normals.resize(first, glm::vec3(0.0F));
    if (!part.colours.empty()) soup_.colours.resize(first, glm::u8vec3(255));
    for (const glm::dvec3& point : part.points) soup_.points.emplace_back(transform * glm::dvec4(point, 1.0));
    for (const glm::vec3& normal : part.normals) soup_.normals.emplace_back(for_normals * glm::dvec3(normal));
    if (soup_.colours.size() == first)
      soup_.colours.insert(soup_.colours.end(), part.colours.begin(), part.colours.end());
    for (std::size_t i = 0; i + 2 < part.corners.size(); i += 3) {
      std::array<std::uint32_t, 3> face;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t corner = part.corners[i + k];
        // Out of range within the part must stay so in the whole.
        face[k] = corner < part.points.size() ? first + corner : kNoPoint;
      }
      soup_.add_triangle(face[0], face[mirrored ? 2 : 1], face[mirrored ? 1 : 2]);
    }
  }

  std::string name_;
  std::filesystem::path folder_;
  GltfModel file_;
  const tinygltf::Model& model_ = file_.model;
  Soup soup_;
  int image_ = -1;  ///< number of the picture that is kept
  std::optional<picture::Texture> picture_;
  std::vector<bool> visited_;
};

}  // namespace

Soup read_gltf(const Source& source) {
  return GltfReader(source).read();
}

}  // namespace rejoin::mesh::detail
