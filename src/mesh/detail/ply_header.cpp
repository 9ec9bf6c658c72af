#include "mesh/detail/ply_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <sstream>
#include <utility>

#include "core/error.hpp"
#include "core/utf8.hpp"

namespace rejoin::mesh::detail {
namespace {

std::optional<PlyType> type_of(const std::string& name) {
  static const std::array<std::pair<const char*, PlyType>, 16> kNames{{{"char", PlyType::Int8},
                                                                       {"int8", PlyType::Int8},
                                                                       {"uchar", PlyType::Uint8},
                                                                       {"uint8", PlyType::Uint8},
                                                                       {"short", PlyType::Int16},
                                                                       {"int16", PlyType::Int16},
                                                                       {"ushort", PlyType::Uint16},
                                                                       {"uint16", PlyType::Uint16},
                                                                       {"int", PlyType::Int32},
                                                                       {"int32", PlyType::Int32},
                                                                       {"uint", PlyType::Uint32},
                                                                       {"uint32", PlyType::Uint32},
                                                                       {"float", PlyType::Float32},
                                                                       {"float32", PlyType::Float32},
                                                                       {"double", PlyType::Float64},
                                                                       {"float64", PlyType::Float64}}};
  for (const auto& [text, type] : kNames) {
    if (name == text) return type;
  }
  return std::nullopt;
}

/// Reads the header line by line and knows the line for its errors.
class HeaderReader {
 public:
  explicit HeaderReader(const Source& source)
      : source_(source), position_(source.bytes.size() - without_byte_order_mark(source.bytes).size()) {}

  PlyHeader read() {
    bool format_seen = false;
    while (true) {
      std::istringstream words(next_line());
      std::string keyword;
      words >> keyword;
      if (keyword == "end_header") break;
      if (keyword == "format") {
        read_format(words);
        format_seen = true;
      } else if (keyword == "element") {
        read_element(words);
      } else if (keyword == "property") {
        read_property(words);
      } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
        fail("unknown keyword \"" + keyword.substr(0, 20) + "\"");
      }
    }
    if (!format_seen) fail("the header states no format");
    header_.body = position_;
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(source_.name, fmt::format("PLY header line {}: {}", line_, problem),
                     "export the scan again");
  }

  void check_start() const {
    const std::string_view text = without_byte_order_mark(source_.bytes);
    if (!text.starts_with("ply"))
      throw InputError(source_.name, "is not a PLY file (does not start with \"ply\")",
                       "check the file's format");
    if (text.starts_with("ply\r") && !text.starts_with("ply\r\n"))
      throw InputError(source_.name, "the lines of its PLY header end with CR alone, as on old Macs",
                       "export the scan again");
  }

  std::string next_line() {
    if (line_ == 0) check_start();
    const std::size_t end = source_.bytes.find('\n', position_);
    if (end == std::string::npos) fail("the file ends before end_header");
    std::string line = source_.bytes.substr(position_, end - position_);
    position_ = end + 1;
    ++line_;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line_ > 1) return line;
    if (line != "ply") fail("is not \"ply\"");
    return next_line();
  }

  void read_format(std::istringstream& words) {
    std::string name;
    words >> name;
    if (name == "ascii") {
      header_.encoding = PlyHeader::Encoding::Ascii;
    } else if (name == "binary_little_endian") {
      header_.encoding = PlyHeader::Encoding::Little;
    } else if (name == "binary_big_endian") {
      header_.encoding = PlyHeader::Encoding::Big;
    } else {
      fail("unknown format \"" + name.substr(0, 20) + "\"");
    }
  }

  void read_element(std::istringstream& words) {
    PlyElement element;
    std::string count;
    words >> element.name >> count;
    const bool again = std::ranges::any_of(
        header_.elements, [&](const PlyElement& earlier) { return earlier.name == element.name; });
    if (again && (element.name == "vertex" || element.name == "face"))
      fail("a second element \"" + element.name + "\"");
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (count.empty() || error != std::errc{} || end != count.data() + count.size()) {
      fail("the number of " + element.name + " elements is not a number");
    }
    header_.elements.push_back(std::move(element));
  }

  void read_property(std::istringstream& words) {
    if (header_.elements.empty()) fail("a property before any element");
    PlyProperty property{};
    std::string type;
    words >> type;
    if (type == "list") {
      property.list = true;
      words >> type;
      property.count_type = checked_type(type);
      words >> type;
    }
    property.type = checked_type(type);
    words >> property.name;
    if (property.name.empty()) fail("a property without a name");
    header_.elements.back().properties.push_back(std::move(property));
  }

  PlyType checked_type(const std::string& name) const {
    const std::optional<PlyType> type = type_of(name);
    if (!type) fail("unknown type \"" + name.substr(0, 20) + "\"");
    return *type;
  }

  const Source& source_;
  PlyHeader header_;
  std::size_t position_ = 0;
  int line_ = 0;
};

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::Int8:
    case PlyType::Uint8:
      return 1;
    case PlyType::Int16:
    case PlyType::Uint16:
      return 2;
    case PlyType::Int32:
    case PlyType::Uint32:
    case PlyType::Float32:
      return 4;
    case PlyType::Float64:
      return 8;
  }
  return 8;
}

int PlyElement::find(const std::string& property) const {
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == property) return static_cast<int>(i);
  }
  return -1;
}

std::size_t PlyElement::least_bytes(bool ascii) const {
  std::size_t bytes = 0;
  for (const PlyProperty& property : properties) {
    // In text a digit and a separator; the last separator of the file may be missing, which the reader finds
    // itself.
    bytes += ascii ? 2 : property.list ? size_of(property.count_type) : size_of(property.type);
  }
  return bytes;
}

PlyHeader read_ply_header(const Source& source) {
  return HeaderReader(source).read();
}

}  // namespace rejoin::mesh::detail
