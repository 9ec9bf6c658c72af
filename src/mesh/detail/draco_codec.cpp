#include "mesh/detail/draco_codec.hpp"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <utility>

#include "core/error.hpp"
#include "mesh/detail/colour.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr int kPositionBits = 20;
constexpr int kNormalBits = 12;
constexpr int kColourBits = 8;

[[noreturn]] void damaged(const std::string& name, const std::string& why) {
  throw InputError(name, "Draco data cannot be decoded (" + why + ")", "export the scan again");
}

const draco::PointAttribute* find(const draco::PointCloud& cloud, draco::GeometryAttribute::Type type,
                                  const std::optional<int>& unique_id) {
  if (unique_id) return cloud.GetAttributeByUniqueId(static_cast<std::uint32_t>(*unique_id));
  return cloud.GetNamedAttribute(type);
}

/// First N components of every point's value.
template <int N, class T>
std::vector<glm::vec<N, T>> values_of(const draco::PointCloud& cloud, const draco::PointAttribute& attribute,
                                      const std::string& name) {
  if (attribute.num_components() < N) damaged(name, "an attribute has too few components");
  std::vector<glm::vec<N, T>> values(cloud.num_points());
  for (std::uint32_t i = 0; i < cloud.num_points(); ++i) {
    const draco::AttributeValueIndex at = attribute.mapped_index(draco::PointIndex(i));
    if (at.value() >= attribute.size() || !attribute.ConvertValue<T>(at, N, &values[i].x)) {
      damaged(name, "an attribute lacks values");
    }
  }
  return values;
}

std::vector<glm::u8vec3> colours_of(const draco::PointCloud& cloud, const draco::PointAttribute& attribute,
                                    const std::string& name) {
  // Draco itself takes normalised bytes to 0 .. 1.
  const bool bytes = attribute.data_type() == draco::DT_UINT8 && !attribute.normalized();
  std::vector<glm::u8vec3> colours;
  for (const glm::dvec3& value : values_of<3, double>(cloud, attribute, name)) {
    colours.push_back(to_bytes(value * (bytes ? 1.0 : 255.0)));
  }
  return colours;
}

std::unique_ptr<draco::PointCloud> decode(std::string_view bytes, const std::string& name, bool& is_mesh) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  const auto type = draco::Decoder::GetEncodedGeometryType(&buffer);
  if (!type.ok()) throw InputError(name, "is not Draco data (no DRACO header)", "check the file's format");
  is_mesh = type.value() == draco::TRIANGULAR_MESH;
  draco::Decoder decoder;
  try {
    if (is_mesh) {
      auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
      if (!mesh.ok()) damaged(name, mesh.status().error_msg_string());
      return std::move(mesh).value();
    }
    auto cloud = decoder.DecodePointCloudFromBuffer(&buffer);
    if (!cloud.ok()) damaged(name, cloud.status().error_msg_string());
    return std::move(cloud).value();
  } catch (const std::bad_alloc&) {
    damaged(name, "it promises more than memory holds");
  } catch (const std::length_error&) {
    damaged(name, "it promises more than memory holds");
  }
}

/// A new attribute with one value a point.
int add_attribute(draco::PointCloud& cloud, draco::GeometryAttribute::Type type, draco::DataType data,
                  std::size_t size, std::size_t count) {
  draco::GeometryAttribute attribute;
  attribute.Init(type, nullptr, 3, data, type == draco::GeometryAttribute::COLOR, static_cast<int64_t>(size),
                 0);
  return cloud.AddAttribute(attribute, true, static_cast<std::uint32_t>(count));
}

template <class Values>
void fill(draco::PointCloud& cloud, int attribute, const Values& values) {
  for (std::uint32_t i = 0; i < values.size(); ++i) {
    cloud.attribute(attribute)->SetAttributeValue(draco::AttributeValueIndex(i), &values[i].x);
  }
}

void fill_attributes(draco::PointCloud& cloud, const Soup& soup, bool doubles) {
  const std::size_t count = soup.points.size();
  cloud.set_num_points(static_cast<std::uint32_t>(count));
  if (doubles) {
    fill(cloud,
         add_attribute(cloud, draco::GeometryAttribute::POSITION, draco::DT_FLOAT64, sizeof(glm::dvec3),
                       count),
         soup.points);
  } else {
    const std::vector<glm::vec3> points(soup.points.begin(), soup.points.end());
    fill(
        cloud,
        add_attribute(cloud, draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, sizeof(glm::vec3), count),
        points);
  }
  if (!soup.normals.empty()) {
    fill(cloud,
         add_attribute(cloud, draco::GeometryAttribute::NORMAL, draco::DT_FLOAT32, sizeof(glm::vec3), count),
         soup.normals);
  }
  if (!soup.colours.empty()) {
    fill(cloud,
         add_attribute(cloud, draco::GeometryAttribute::COLOR, draco::DT_UINT8, sizeof(glm::u8vec3), count),
         soup.colours);
  }
}

}  // namespace

Soup decode_draco(std::string_view bytes, const std::string& name, const DracoAttributes& attributes) {
  bool is_mesh = false;
  const std::unique_ptr<draco::PointCloud> cloud = decode(bytes, name, is_mesh);
  const draco::PointAttribute* position =
      find(*cloud, draco::GeometryAttribute::POSITION, attributes.position);
  const draco::PointAttribute* normal = find(*cloud, draco::GeometryAttribute::NORMAL, attributes.normal);
  const draco::PointAttribute* colour = find(*cloud, draco::GeometryAttribute::COLOR, attributes.colour);
  if (position == nullptr) damaged(name, "it has no positions");
  Soup soup;
  soup.points = values_of<3, double>(*cloud, *position, name);
  if (normal != nullptr) soup.normals = values_of<3, float>(*cloud, *normal, name);
  if (colour != nullptr) soup.colours = colours_of(*cloud, *colour, name);
  if (attributes.place) {
    const draco::PointAttribute* place =
        cloud->GetAttributeByUniqueId(static_cast<std::uint32_t>(*attributes.place));
    if (place != nullptr) soup.places = values_of<2, double>(*cloud, *place, name);
  }
  if (!is_mesh) return soup;
  const auto& mesh = static_cast<const draco::Mesh&>(*cloud);
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
    const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(f));
    soup.add_triangle(face[0].value(), face[1].value(), face[2].value());
  }
  return soup;
}

Soup read_drc(const Source& source) {
  return decode_draco(source.bytes, source.name);
}

std::string encode_draco(const Soup& soup, bool far_from_origin, const std::string& name) {
  draco::Encoder encoder;
  encoder.SetSpeedOptions(5, 5);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, kNormalBits);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::COLOR, kColourBits);
  if (far_from_origin) {
    encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
  } else {
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, kPositionBits);
  }
  draco::EncoderBuffer buffer;
  draco::Status status;
  if (soup.sizes.empty()) {
    draco::PointCloud cloud;
    fill_attributes(cloud, soup, far_from_origin);
    if (far_from_origin) encoder.SetEncodingMethod(draco::POINT_CLOUD_SEQUENTIAL_ENCODING);
    status = encoder.EncodePointCloudToBuffer(cloud, &buffer);
  } else {
    draco::Mesh mesh;
    fill_attributes(mesh, soup, far_from_origin);
    for (std::size_t i = 0; i + 2 < soup.corners.size(); i += 3) {
      mesh.AddFace({draco::PointIndex(soup.corners[i]), draco::PointIndex(soup.corners[i + 1]),
                    draco::PointIndex(soup.corners[i + 2])});
    }
    status = encoder.EncodeMeshToBuffer(mesh, &buffer);
  }
  if (!status.ok())
    throw IoError(name, "Draco encoding failed (" + status.error_msg_string() + ")", "save as PLY");
  return {buffer.data(), buffer.size()};
}

}  // namespace rejoin::mesh::detail
