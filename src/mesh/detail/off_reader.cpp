// A reader of its own: OpenMesh's does not tell a file that is cut short from a whole one.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"
#include "mesh/detail/colour.hpp"
#include "mesh/detail/text.hpp"

namespace rejoin::mesh::detail {
namespace {

class OffReader {
 public:
  explicit OffReader(const Source& source) : source_(source), lines_(source) {}

  Soup read() {
    read_header();
    for (vertex_ = 0; vertex_ < vertices_; ++vertex_) read_vertex();
    for (face_ = 0; face_ < faces_; ++face_) read_face();
    if (soup_.colours.size() != soup_.points.size()) soup_.colours.clear();
    return std::move(soup_);
  }

 private:
  /// "OFF", perhaps with C (colours) and N (normals) before it, then the counts on the same line or the next.
  void read_header() {
    if (!lines_.next_line())
      throw InputError(source_.name, "is not an OFF file (has no line)", "check the file's format");
    std::string_view word = lines_.next_word();
    const std::string_view prefix = word.ends_with("OFF") ? word.substr(0, word.size() - 3) : "?";
    if (prefix.find_first_not_of("CN") != std::string_view::npos) {
      throw InputError(source_.name, "is not a three-dimensional OFF file (does not start with \"OFF\")",
                       "check the file's format");
    }
    has_normals_ = prefix.find('N') != std::string_view::npos;
    has_colours_ = prefix.find('C') != std::string_view::npos;
    word = lines_.next_word();
    if (word == "BINARY")
      throw InputError(source_.name, "is a binary OFF file", "save it as text OFF or as PLY");
    if (word.empty()) {
      if (!lines_.next_line()) ended("counts");
      word = lines_.next_word();
    }
    vertices_ = count_of(word);
    faces_ = count_of(lines_.next_word());
    // Every vertex and face takes a line of at least six and two characters.
    if (vertices_ > source_.bytes.size() / 6 || faces_ > source_.bytes.size() / 2) {
      throw IoError(source_.name,
                    fmt::format("its header promises {} vertices and {} faces but the file has only {} bytes",
                                vertices_, faces_, source_.bytes.size()),
                    "copy or export the file again");
    }
  }

  std::size_t count_of(std::string_view word) const {
    const std::optional<long long> count = to_integer(word);
    if (!count || *count < 0) lines_.fail("the numbers of vertices and faces expected");
    return static_cast<std::size_t>(*count);
  }

  [[noreturn]] void ended(const std::string& where) const {
    throw IoError(source_.name, "ends before " + where, "copy or export the file again");
  }

  void read_vertex() {
    if (!lines_.next_line()) ended(fmt::format("vertex {} of {}", vertex_, vertices_));
    soup_.points.push_back(lines_.next_triple());
    if (has_normals_) soup_.normals.emplace_back(lines_.next_triple());
    if (!has_colours_) return;
    std::array<std::string_view, 3> words;
    for (std::string_view& word : words) word = lines_.next_word();
    // Whole numbers are 0 .. 255, the others 0 .. 1.
    const bool whole =
        std::all_of(words.begin(), words.end(), [](std::string_view w) { return to_integer(w).has_value(); });
    glm::dvec3 colour;
    for (int k = 0; k < 3; ++k) {
      const std::optional<double> value = to_number(words[static_cast<std::size_t>(k)]);
      if (!value) return;
      colour[k] = *value * (whole ? 1.0 : 255.0);
    }
    soup_.colours.push_back(to_bytes(colour));
  }

  void read_face() {
    if (!lines_.next_line()) ended(fmt::format("face {} of {}", face_, faces_));
    const std::size_t size = count_of(lines_.next_word());
    for (std::size_t k = 0; k < size; ++k) {
      const std::string_view word = lines_.next_word();
      const std::optional<long long> index = to_integer(word);
      if (!index) lines_.fail(fmt::format("face {} has {} vertex indices instead of {}", face_, k, size));
      soup_.corners.push_back(*index >= 0 && *index < kNoPoint ? static_cast<std::uint32_t>(*index)
                                                               : kNoPoint);
    }
    soup_.sizes.push_back(static_cast<std::uint32_t>(size));
  }

  const Source& source_;
  TextLines lines_;
  Soup soup_;
  std::size_t vertices_ = 0;
  std::size_t faces_ = 0;
  std::size_t vertex_ = 0;
  std::size_t face_ = 0;
  bool has_normals_ = false;
  bool has_colours_ = false;
};

}  // namespace

Soup read_off(const Source& source) {
  return OffReader(source).read();
}

}  // namespace rejoin::mesh::detail
