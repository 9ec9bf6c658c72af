// A reader of its own: OpenMesh's skips lines that it does not understand, so that a damaged file would load
// in part.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/detail/colour.hpp"
#include "mesh/detail/text.hpp"

namespace rejoin::mesh::detail {
namespace {

/// Keywords of the format that say nothing of the surface (Wavefront, Appendix B1 and its superseded statements).  Any other word
/// is damage: behind a vertex that is skipped, faces would take wrong ones.
constexpr auto kSkipped = std::to_array<std::string_view>(
    {"vt",     "vp",     "deg",    "bmat",       "step",      "cstype",   "p",        "l",    "curv",
     "curv2",  "surf",   "parm",   "trim",       "hole",      "scrv",     "sp",       "end",  "con",
     "g",      "s",      "mg",     "o",          "bevel",     "c_interp", "d_interp", "lod",  "maplib",
     "usemap", "usemtl", "mtllib", "shadow_obj", "trace_obj", "ctech",    "stech",    "call", "csh",
     "bsp",    "bzp",    "cdc",    "cdp",        "res"});

class ObjReader {
 public:
  explicit ObjReader(const Source& source) : lines_(source) {}

  Soup read() {
    while (lines_.next_line()) {
      const std::string_view keyword = lines_.next_word();
      if (keyword == "v") {
        read_vertex();
      } else if (keyword == "vn") {
        normals_.emplace_back(lines_.next_triple());
      } else if (keyword == "f" || keyword == "fo") {
        read_face();
      } else if (std::find(kSkipped.begin(), kSkipped.end(), keyword) == kSkipped.end()) {
        lines_.fail(fmt::format("unexpected \"{}\"", keyword.substr(0, 20)));
      }
    }
    check_corners();
    assign_normals();
    if (coloured_ == soup_.points.size()) {
      soup_.colours = std::move(colours_);
    }
    return std::move(soup_);
  }

 private:
  /// "v x y z", then nothing, a weight, or the colour that many scanners append.
  void read_vertex() {
    soup_.points.push_back(lines_.next_triple());
    glm::dvec3 extra(0.0);
    int count = 0;
    while (const std::optional<double> value = lines_.next_number()) {
      if (count < 3) extra[count] = *value;
      ++count;
    }
    if (count < 3) return;
    ++coloured_;
    colours_.push_back(to_bytes(extra * 255.0));
  }

  /// Index of a corner's part: counted from 1, or back from the last one read if negative.
  std::uint32_t index_of(std::string_view text, std::size_t count) const {
    const std::optional<long long> value = to_integer(text);
    if (!value) lines_.fail(fmt::format("\"{}\" is not a vertex index", text.substr(0, 20)));
    const long long index = *value < 0 ? static_cast<long long>(count) + *value : *value - 1;
    return index >= 0 && index < kNoPoint ? static_cast<std::uint32_t>(index) : kNoPoint;
  }

  /// "f v v v", "f v/t ...", "f v//n ..." or "f v/t/n ...".
  void read_face() {
    std::uint32_t size = 0;
    for (std::string_view word = lines_.next_word(); !word.empty(); word = lines_.next_word()) {
      const std::size_t slash = word.find('/');
      const std::size_t second = slash == std::string_view::npos ? slash : word.find('/', slash + 1);
      soup_.corners.push_back(index_of(word.substr(0, slash), soup_.points.size()));
      const bool has_normal = second != std::string_view::npos && second + 1 < word.size();
      corner_normals_.push_back(has_normal ? index_of(word.substr(second + 1), normals_.size()) : kNoPoint);
      ++size;
    }
    if (size < 3) lines_.fail(fmt::format("a face of {} corners", size));
    soup_.sizes.push_back(size);
    face_lines_.push_back(static_cast<std::uint32_t>(lines_.number()));
  }

  /// Vertices may come after the faces that name them.
  void check_corners() const {
    std::size_t corner = 0;
    for (std::size_t face = 0; face < soup_.sizes.size(); ++face) {
      for (std::uint32_t k = 0; k < soup_.sizes[face]; ++k, ++corner) {
        if (soup_.corners[corner] < soup_.points.size()) continue;
        lines_.fail_at(
            face_lines_[face],
            fmt::format("a face refers to a vertex that does not exist (there are {})", soup_.points.size()));
      }
    }
  }

  /// One normal a vertex: the sum over its corners; of a cloud, the normal of the same number.
  void assign_normals() {
    if (soup_.sizes.empty()) {
      if (normals_.size() == soup_.points.size()) soup_.normals = std::move(normals_);
      return;
    }
    if (normals_.empty()) return;
    soup_.normals.assign(soup_.points.size(), glm::vec3(0.0F));
    for (std::size_t i = 0; i < soup_.corners.size(); ++i) {
      if (soup_.corners[i] >= soup_.points.size() || corner_normals_[i] >= normals_.size()) continue;
      soup_.normals[soup_.corners[i]] += normals_[corner_normals_[i]];
    }
  }

  TextLines lines_;
  Soup soup_;
  std::vector<glm::vec3> normals_;
  std::vector<glm::u8vec3> colours_;
  std::vector<std::uint32_t> corner_normals_;
  std::vector<std::uint32_t> face_lines_;
  std::size_t coloured_ = 0;
};

}  // namespace

Soup read_obj(const Source& source) {
  return ObjReader(source).read();
}

}  // namespace rejoin::mesh::detail
