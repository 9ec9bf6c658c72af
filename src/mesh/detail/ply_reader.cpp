// A reader of its own: OpenMesh's keeps half of a truncated file, dies of bad_alloc on a header that promises
// more than memory holds, and reads coordinates as floats.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <functional>

#include "core/error.hpp"
#include "mesh/detail/colour.hpp"
#include "mesh/detail/ply_header.hpp"
#include "mesh/detail/text.hpp"

namespace rejoin::mesh::detail {
namespace {

/// Where the reader is, for its errors.
struct Place {
  const std::string* file;
  const PlyElement* element;
  std::size_t index;

  [[noreturn]] void truncated() const {
    throw IoError(
        *file,
        fmt::format("ends in {} {} of the {} that its header promises", element->name, index, element->count),
        "copy or export the file again");
  }
  [[noreturn]] void invalid(const std::string& problem, const char* mend = "export the scan again") const {
    throw InputError(*file, fmt::format("{} {}: {}", element->name, index, problem), mend);
  }
};

class BinaryValues {
 public:
  BinaryValues(const std::string& bytes, std::size_t start, bool big)
      : bytes_(bytes), at_(start), big_(big) {}

  double next(PlyType type, const Place& place) {
    switch (type) {
      case PlyType::Int8:
        return take<std::int8_t>(place);
      case PlyType::Uint8:
        return take<std::uint8_t>(place);
      case PlyType::Int16:
        return take<std::int16_t>(place);
      case PlyType::Uint16:
        return take<std::uint16_t>(place);
      case PlyType::Int32:
        return take<std::int32_t>(place);
      case PlyType::Uint32:
        return take<std::uint32_t>(place);
      case PlyType::Float32:
        return take<float>(place);
      case PlyType::Float64:
        return take<double>(place);
    }
    return 0;
  }

  /// Checks that a list fits, before anything is stored for it.
  void expect(std::size_t count, PlyType type, const Place& place) const {
    if (count > (bytes_.size() - at_) / size_of(type)) place.truncated();
  }

 private:
  template <class T>
  T take(const Place& place) {
    if (bytes_.size() - at_ < sizeof(T)) place.truncated();
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
    if (big_ == (std::endian::native == std::endian::little)) std::reverse(raw.begin(), raw.end());
    at_ += sizeof(T);
    return std::bit_cast<T>(raw);
  }

  const std::string& bytes_;
  std::size_t at_;
  bool big_;
};

class AsciiValues {
 public:
  AsciiValues(const std::string& bytes, std::size_t start)
      : at_(bytes.data() + start), end_(bytes.data() + bytes.size()) {}

  double next(PlyType /*unused*/, const Place& place) {
    while (at_ != end_ && std::isspace(static_cast<unsigned char>(*at_)) != 0) ++at_;
    if (at_ == end_) place.truncated();
    if (*at_ == '+') ++at_;
    double value = 0;
    const auto [end, error] = std::from_chars(at_, end_, value);
    if (error == std::errc::invalid_argument ||
        (end != end_ && std::isspace(static_cast<unsigned char>(*end)) == 0)) {
      const char* stop =
          std::find_if(at_, std::min(end_, at_ + 20), [](unsigned char c) { return std::isspace(c) != 0; });
      const std::string_view word(at_, stop);
      place.invalid(fmt::format("\"{}\" is not a number", word), mend_of_number(word));
    }
    if (error == std::errc::result_out_of_range) value = *to_number({at_, end});
    at_ = end;
    return value;
  }

  void expect(std::size_t count, PlyType /*unused*/, const Place& place) const {
    if (count > static_cast<std::size_t>(end_ - at_)) place.truncated();
  }

 private:
  const char* at_;
  const char* end_;
};

/// Columns of the vertex element that are kept: x y z, nx ny nz, red green blue; -1 where missing.
struct Columns {
  explicit Columns(const PlyElement& vertex) {
    static const std::array<const char*, 9> kNames{"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue"};
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      at[i] = vertex.find(kNames[i]);
      if (i >= 6 && at[i] < 0) at[i] = vertex.find(std::string("diffuse_") + kNames[i]);
    }
    has_normals = std::min({at[3], at[4], at[5]}) >= 0;
    has_colours = std::min({at[6], at[7], at[8]}) >= 0;
    if (!has_colours) return;
    const PlyType type = vertex.properties[static_cast<std::size_t>(at[6])].type;
    real_colours = type == PlyType::Float32 || type == PlyType::Float64;
    if (type == PlyType::Uint16) colour_scale = 255.0 / 65535.0;
  }
  bool has_position() const { return std::min({at[0], at[1], at[2]}) >= 0; }

  std::array<int, 9> at{};
  bool has_normals = false;
  bool has_colours = false;
  bool real_colours = false;
  double colour_scale = 1;
};

/// Reads all values of one element and hands scalars and lists on.
template <class Values>
void read_element(Values& values, Place place, const std::function<void(const std::vector<double>&)>& scalars,
                  const std::function<void(std::size_t property, const std::vector<double>&)>& list) {
  std::vector<double> row(place.element->properties.size());
  std::vector<double> items;
  for (place.index = 0; place.index < place.element->count; ++place.index) {
    for (std::size_t p = 0; p < row.size(); ++p) {
      const PlyProperty& property = place.element->properties[p];
      if (!property.list) {
        row[p] = values.next(property.type, place);
        continue;
      }
      const double count = values.next(property.count_type, place);
      if (!(count >= 0) || count != std::floor(count))
        place.invalid("a list of a negative or fractional length");
      if (count >= kNoPoint) place.truncated();
      values.expect(static_cast<std::size_t>(count), property.type, place);
      items.resize(static_cast<std::size_t>(count));
      for (double& item : items) item = values.next(property.type, place);
      list(p, items);
    }
    scalars(row);
  }
}

template <class Values>
void read_vertices(Values& values, const Place& place, Soup& soup) {
  const Columns columns(*place.element);
  if (!columns.has_position())
    throw InputError(*place.file, "its vertices have no x, y, z", "export the scan again");
  soup.points.reserve(place.element->count);
  std::vector<glm::vec3> colours;  // as written, of real numbers
  const auto triple = [&columns](const std::vector<double>& row, std::size_t first) {
    const auto value = [&](std::size_t i) { return row[static_cast<std::size_t>(columns.at[first + i])]; };
    return glm::dvec3(value(0), value(1), value(2));
  };
  read_element(
      values, place,
      [&](const std::vector<double>& row) {
        soup.points.push_back(triple(row, 0));
        if (columns.has_normals) soup.normals.emplace_back(triple(row, 3));
        if (columns.real_colours) {
          colours.emplace_back(triple(row, 6));
        } else if (columns.has_colours) {
          soup.colours.push_back(to_bytes(triple(row, 6) * columns.colour_scale));
        }
      },
      [](std::size_t, const std::vector<double>&) {});
  float brightest = 0.0F;
  for (const glm::vec3& c : colours) brightest = std::max({brightest, c.x, c.y, c.z});
  const double scale = scale_of_real_colours(brightest);
  for (const glm::vec3& c : colours) soup.colours.push_back(to_bytes(scale * glm::dvec3(c)));
}

/// Which property lists the corners of faces or strips.
/// \throws InputError none does
int corner_list(const Place& place) {
  const PlyElement& element = *place.element;
  const int corners = std::max(element.find("vertex_indices"), element.find("vertex_index"));
  if (element.count > 0 && (corners < 0 || !element.properties[static_cast<std::size_t>(corners)].list)) {
    throw InputError(*place.file, fmt::format("its {} elements have no list of vertex indices", element.name),
                     "export the scan again");
  }
  return corners;
}

template <class Values>
void read_faces(Values& values, const Place& place, Soup& soup) {
  const int corners = corner_list(place);
  soup.sizes.reserve(place.element->count);
  soup.corners.reserve(3 * place.element->count);
  read_element(
      values, place, [](const std::vector<double>&) {},
      [&](std::size_t property, const std::vector<double>& items) {
        if (static_cast<int>(property) != corners) return;
        soup.sizes.push_back(static_cast<std::uint32_t>(items.size()));
        for (const double item : items) soup.corners.push_back(to_index(item));
      });
}

/// Strips of triangles, as old scanners wrote them: each corner makes one with the two before it, every second turned round; a
/// negative index begins a new strip.
template <class Values>
void read_strips(Values& values, const Place& place, Soup& soup) {
  const int corners = corner_list(place);
  read_element(
      values, place, [](const std::vector<double>&) {},
      [&](std::size_t property, const std::vector<double>& items) {
        if (static_cast<int>(property) != corners) return;
        std::size_t first = 0;  // of the strip
        for (std::size_t k = 0; k < items.size(); ++k) {
          if (items[k] < 0) first = k + 1;
          if (items[k] < 0 || k < first + 2) continue;
          const std::size_t turned = (k - first) % 2;
          soup.add_triangle(to_index(items[k - 2 + turned]), to_index(items[k - 1 - turned]),
                            to_index(items[k]));
        }
      });
}

/// A transfer as text puts a carriage return before every line feed, those among the bytes of numbers too.
void require_not_sent_as_text(const Source& source, const PlyHeader& header) {
  constexpr int kEnough = 8;  // of 256 line feeds one follows a carriage return by chance
  int line_feeds = 0;
  for (std::size_t k = source.bytes.find('\n', header.body); k != std::string::npos;
       k = source.bytes.find('\n', k + 1), ++line_feeds) {
    if (source.bytes[k - 1] != '\r') return;
  }
  if (line_feeds < kEnough) return;
  throw InputError(source.name,
                   "is damaged by a transfer as text, which put a byte before each of its line feeds",
                   "transfer it again in binary mode, or zipped");
}

/// The header's promise against the bytes that are there, before memory is asked for.
void check_promise(const Source& source, const PlyHeader& header) {
  const std::size_t body = source.bytes.size() - header.body;
  const bool ascii = header.encoding == PlyHeader::Encoding::Ascii;
  std::size_t left = body + (ascii ? 1 : 0);
  for (const PlyElement& element : header.elements) {
    const std::size_t each = element.least_bytes(ascii);
    if (each > 0 && element.count > left / each) {
      throw IoError(
          source.name,
          fmt::format("its header promises {} {} elements, at least {} bytes each, but only {} bytes follow",
                      element.count, element.name, each, body),
          "copy or export the file again");
    }
    left -= each * element.count;
  }
}

template <class Values>
Soup read_body(const Source& source, const PlyHeader& header, Values values) {
  Soup soup;
  for (const PlyElement& element : header.elements) {
    const Place place{&source.name, &element, 0};
    if (element.name == "vertex") {
      read_vertices(values, place, soup);
    } else if (element.name == "face") {
      read_faces(values, place, soup);
    } else if (element.name == "tristrips") {
      read_strips(values, place, soup);
    } else if (!element.properties.empty()) {
      read_element(
          values, place, [](const std::vector<double>&) {}, [](std::size_t, const std::vector<double>&) {});
    }
  }
  return soup;
}

}  // namespace

Soup read_ply(const Source& source) {
  const PlyHeader header = read_ply_header(source);
  check_promise(source, header);
  if (header.encoding == PlyHeader::Encoding::Ascii) {
    return read_body(source, header, AsciiValues(source.bytes, header.body));
  }
  require_not_sent_as_text(source, header);
  return read_body(source, header,
                   BinaryValues(source.bytes, header.body, header.encoding == PlyHeader::Encoding::Big));
}

}  // namespace rejoin::mesh::detail
