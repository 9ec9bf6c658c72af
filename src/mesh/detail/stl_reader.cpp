// A reader of its own: OpenMesh's merges vertices within an absolute tolerance, which depends on the scale.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstring>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "mesh/detail/text.hpp"

namespace rejoin::mesh::detail {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");

constexpr std::size_t kHeader = 84;
constexpr std::size_t kRecord = 50;

std::uint64_t promised_triangles(const std::string& bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof(count));
  return count;
}

/// A word of the format, which writers put in capitals or not.
std::string lower(std::string_view word) {
  std::string result(word);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

/// Behind a byte order mark and blank lines, if any.
bool starts_as_text(const std::string& bytes) {
  const std::string_view text(bytes);
  const std::size_t first = text.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  return first != std::string_view::npos && lower(text.substr(first, 5)) == "solid";
}

/// Whether a text names facets near its start.
bool has_facets(const std::string& bytes) {
  return lower(std::string_view(bytes).substr(0, 4096)).find("facet") != std::string::npos;
}

/// The word "solid" starts many binary files too: the length tells.
bool is_binary(const std::string& bytes) {
  if (bytes.size() < kHeader) return false;
  if (bytes.size() == kHeader + kRecord * promised_triangles(bytes)) return true;
  return !starts_as_text(bytes) || !has_facets(bytes);
}

Soup read_binary(const Source& source) {
  const std::uint64_t count = promised_triangles(source.bytes);
  const std::uint64_t there = (source.bytes.size() - kHeader) / kRecord;
  if (there < count) {
    throw IoError(source.name,
                  fmt::format("its header promises {} triangles but the file ends after {}", count, there),
                  "check that it is an STL file, copy or export it again");
  }
  Soup soup;
  soup.points.reserve(3 * count);
  for (std::uint64_t i = 0; i < count; ++i) {
    std::array<float, 12> values;
    std::memcpy(values.data(), source.bytes.data() + kHeader + kRecord * i, sizeof(values));
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    for (std::size_t k = 3; k < 12; k += 3) soup.points.emplace_back(values[k], values[k + 1], values[k + 2]);
    soup.add_triangle(first, first + 1, first + 2);
  }
  return soup;
}

Soup read_text(const Source& source) {
  TextLines lines(source);
  Soup soup;
  std::uint32_t size = 0;
  bool ended = false;
  while (lines.next_line()) {
    const std::string keyword = lower(lines.next_word());
    ended = keyword == "endsolid";
    if (keyword == "vertex") {
      soup.corners.push_back(static_cast<std::uint32_t>(soup.points.size()));
      soup.points.push_back(lines.next_triple());
      ++size;
    } else if (keyword == "endloop") {
      if (size < 3) lines.fail(fmt::format("a facet of {} corners", size));
      soup.sizes.push_back(size);
      size = 0;
    } else if (keyword != "solid" && keyword != "facet" && keyword != "outer" && keyword != "endfacet" &&
               !ended) {
      lines.fail(fmt::format("unexpected \"{}\"", keyword.substr(0, 20)));
    }
  }
  if (!ended)
    throw IoError(source.name, fmt::format("ends in line {} before endsolid", lines.number()),
                  "copy or export the file again");
  return soup;
}

}  // namespace

Soup read_stl(const Source& source) {
  if (is_binary(source.bytes)) return read_binary(source);
  if (!starts_as_text(source.bytes))
    throw InputError(source.name, "is not an STL file", "check the file's format");
  return read_text(source);
}

}  // namespace rejoin::mesh::detail
