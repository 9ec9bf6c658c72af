#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/error.hpp"
#include "core/json_depth.hpp"
#include "outline/detail/readers.hpp"

namespace rejoin::outline::detail {
namespace {

using nlohmann::json;

constexpr const char* kGeoJsonMend = "give a GeoJSON file with Polygon or MultiPolygon geometries";

/// What a feature is called: by its property "name", in small letters or not, else by its id; empty: nothing.
std::string label_of(const json& feature) {
  const auto text = [](const json& value) {
    return value.is_string() ? value.get<std::string>() : value.is_number() ? value.dump() : "";
  };
  if (feature.contains("properties") && feature["properties"].is_object()) {
    for (const auto& [key, value] : feature["properties"].items())
      if ((key == "name" || key == "Name" || key == "NAME") && !text(value).empty()) return text(value);
  }
  return feature.contains("id") ? text(feature["id"]) : "";
}

class GeoJsonReader {
 public:
  explicit GeoJsonReader(const std::string& path) : path_(path) {}

  /// \pre its JSON is no deeper than kDeepestJson: this calls itself
  void read(const json& value) {
    const bool typed = value.is_object() && value.contains("type") && value["type"].is_string();
    const std::string type = typed ? value["type"].get<std::string>() : "";
    if (type == "FeatureCollection") return read_all(value, "features");
    if (type == "GeometryCollection") return read_all(value, "geometries");
    if (type == "Feature" && value.contains("geometry")) {
      label_ = label_of(value);
      read(value["geometry"]);
      label_.clear();
      return;
    }
    if (type == "Polygon") return add(member(value, "coordinates"));
    if (type == "MultiPolygon") {
      for (const json& polygon : member(value, "coordinates")) add(polygon);
    }
  }

  std::vector<Rings> result;

 private:
  void read_all(const json& value, const char* name) {
    for (const json& each : member(value, name)) read(each);
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(path_, fmt::format("polygon {}: {}", result.size() + 1, problem), kGeoJsonMend);
  }

  const json& member(const json& value, const char* name) const {
    if (!value.contains(name) || !value[name].is_array()) fail(fmt::format("\"{}\" is missing", name));
    return value[name];
  }

  void add(const json& polygon) {
    if (!polygon.is_array()) fail("it has no ring");
    if (polygon.empty()) return;  // GeoJSON's word for no polygon
    Rings rings;
    rings.y_up = true;
    rings.place = fmt::format("polygon {}", result.size() + 1);
    rings.label = label_;
    for (const json& ring : polygon) rings.rings.push_back(points(ring));
    result.push_back(std::move(rings));
  }

  std::vector<glm::dvec2> points(const json& ring) const {
    if (!ring.is_array()) fail("a ring is no list");
    std::vector<glm::dvec2> result_points;
    result_points.reserve(ring.size());
    for (const json& point : ring) {
      if (!point.is_array() || point.size() < 2 || !point[0].is_number() || !point[1].is_number())
        fail(fmt::format("point {} is no pair of numbers", result_points.size() + 1));
      result_points.emplace_back(point[0].get<double>(), point[1].get<double>());
    }
    return result_points;
  }

  const std::string& path_;
  std::string label_;  // of the feature that is read
};

/// Whether the file says that its coordinates are longitude and latitude: "urn:ogc:def:crs:OGC:1.3:CRS84", "EPSG:4326".
bool says_degrees(const json& file) {
  const json::json_pointer name("/crs/properties/name");
  if (!file.contains(name) || !file[name].is_string()) return false;
  const std::string crs = file[name].get<std::string>();
  return crs.ends_with("CRS84") || crs.ends_with(":4326");
}

/// Whether they may be longitudes and latitudes, as those of a file without "crs" are by the standard (RFC 7946, section 4), and hardly
/// anything else: a piece that is less than one across is none in millimetres.
bool may_be_degrees(const std::vector<Rings>& pieces) {
  return std::ranges::all_of(pieces, [](const Rings& piece) {
    const std::vector<glm::dvec2>& border = piece.rings[0];
    if (border.empty()) return false;
    glm::dvec2 low = border[0];
    glm::dvec2 high = border[0];
    for (const glm::dvec2& p : border) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    const glm::dvec2 most(180.0, 90.0);
    return glm::all(glm::lessThanEqual(-most, low)) && glm::all(glm::lessThanEqual(high, most)) &&
           glm::all(glm::lessThan(high - low, glm::dvec2(1.0)));
  });
}

/// How to begin what is told of degrees; nullptr: they are none.
const char* opening_of_degrees(const json& file, const std::vector<Rings>& pieces) {
  if (says_degrees(file)) return "degrees are";
  const bool silent = !file.contains("crs") || file["crs"].is_null();
  return silent && may_be_degrees(pieces) ? "if its coordinates are degrees, as without a \"crs\", they are"
                                          : nullptr;
}

}  // namespace

std::vector<Rings> read_geojson(const std::string& path, const std::string& text,
                                std::vector<std::string>& notes) {
  if (json_depth(text) > kDeepestJson)
    throw InputError(path, fmt::format("its JSON is nested deeper than {}", kDeepestJson), kGeoJsonMend);
  const json value = json::parse(text, nullptr, false);
  if (value.is_discarded()) throw InputError(path, "is no JSON, or cut short", kGeoJsonMend);
  GeoJsonReader reader(path);
  reader.read(value);
  if (reader.result.empty()) throw InputError(path, "holds no polygon", kGeoJsonMend);
  const char* opening = opening_of_degrees(value, reader.result);
  if (opening == nullptr) return std::move(reader.result);
  if (std::optional<std::string> doubt = doubt_degrees(path, reader.result[0].rings[0], opening))
    notes.push_back(std::move(*doubt));
  return std::move(reader.result);
}

}  // namespace rejoin::outline::detail
