// A reader of its own: OpenMesh's skips lines that it does not understand, so that a damaged file would load
// in part.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "core/error.hpp"
#include "core/files.hpp"
#include "mesh/detail/colour.hpp"
#include "mesh/detail/obj_materials.hpp"
#include "mesh/detail/text.hpp"
#include "picture/texture.hpp"

namespace rejoin::mesh::detail {
namespace {

/// Keywords of the format that say nothing of the surface (Wavefront, Appendix B1 and its superseded statements).  Any other word
/// is damage: behind a vertex that is skipped, faces would take wrong ones.
constexpr auto kSkipped = std::to_array<std::string_view>(
    {"vp",    "deg",    "bmat",   "step",       "cstype",    "p",     "l",        "curv",
     "curv2", "surf",   "parm",   "trim",       "hole",      "scrv",  "sp",       "end",
     "con",   "g",      "s",      "mg",         "o",         "bevel", "c_interp", "d_interp",
     "lod",   "maplib", "usemap", "shadow_obj", "trace_obj", "ctech", "stech",    "call",
     "csh",   "bsp",    "bzp",    "cdc",        "cdp",       "res"});

class ObjReader {
 public:
  explicit ObjReader(const Source& source)
      : folder_(source.path.parent_path()), lines_(source), may_be_cut_(ends_within_a_line(source.bytes)) {}

  Soup read() {
    while (lines_.next_line()) {
      const std::string_view keyword = lines_.next_word();
      if (keyword == "v") {
        read_vertex();
      } else if (keyword == "vn") {
        normals_.emplace_back(lines_.next_triple());
      } else if (keyword == "f" || keyword == "fo") {
        read_face();
      } else if (keyword == "vt") {
        read_place();
      } else if (keyword == "mtllib") {
        libraries_.emplace_back(lines_.rest());
      } else if (keyword == "usemtl") {
        uses_.push_back({std::string(lines_.rest()), soup_.corners.size()});
      } else if (std::find(kSkipped.begin(), kSkipped.end(), keyword) == kSkipped.end()) {
        lines_.fail(fmt::format("unexpected \"{}\"", keyword.substr(0, 20)));
      }
    }
    check_corners();
    doubt_end();
    assign_normals();
    if (coloured_ == soup_.points.size()) {
      const double scale = scale_of_real_colours(brightest_);
      soup_.colours.reserve(colours_.size());
      for (const glm::vec3& colour : colours_) soup_.colours.push_back(to_bytes(scale * glm::dvec3(colour)));
    } else {
      paint();
    }
    return std::move(soup_);
  }

 private:
  /// Many writers leave the last line end out; where a copy stopped vertices have no faces, too, as faces come last.
  void doubt_end() {
    if (!may_be_cut_ || soup_.sizes.empty()) return;
    std::vector<bool> used(soup_.points.size(), false);
    for (const std::uint32_t corner : soup_.corners) used[corner] = true;
    const auto unused = std::ranges::count(used, false);
    if (unused == 0) return;
    soup_.notes.push_back(
        fmt::format("ends within a line and has no faces at {} of {} vertices: it may be cut short (copy or "
                    "export it again if faces are missing)",
                    unused, used.size()));
  }

  /// From its corner on, faces are of a material.
  struct Use {
    std::string material;
    std::size_t first_corner;
  };

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
    brightest_ = std::max({brightest_, extra.x, extra.y, extra.z});
    colours_.emplace_back(extra);
  }

  /// "vt u v": a place on the texture, from its lower left corner.
  void read_place() {
    glm::dvec2 place;
    for (int k = 0; k < 2; ++k)
      place[k] = to_number(lines_.next_word()).value_or(std::numeric_limits<double>::quiet_NaN());
    places_.emplace_back(place.x, 1.0 - place.y);
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
      const std::string_view place =
          slash == std::string_view::npos ? "" : word.substr(slash + 1, second - slash - 1);
      corner_places_.push_back(to_integer(place) ? index_of(place, places_.size()) : kNoPoint);
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

  /// Gives the points the colours of the textures that lie on their faces, those that have none white; no colours if there is no
  /// texture.
  void paint() {
    const std::map<std::string, std::filesystem::path> textures = textures_of_libraries();
    std::map<std::filesystem::path, std::vector<std::size_t>> uses;  // of each picture
    for (std::size_t k = 0; k < uses_.size(); ++k) {
      const auto texture = textures.find(uses_[k].material);
      if (texture != textures.end()) uses[texture->second].push_back(k);
    }
    for (const auto& [path, numbers] : uses) {
      try {
        const picture::Texture texture(read_named_file(path), path.string());
        for (const std::size_t k : numbers) paint(uses_[k], end_of(k), texture);
      } catch (const Error& error) {
        soup_.notes.push_back(fmt::format("is left without the colours of a texture ({})", error.what()));
      }
    }
  }

  std::size_t end_of(std::size_t use) const {
    return use + 1 < uses_.size() ? uses_[use + 1].first_corner : soup_.corners.size();
  }

  void paint(const Use& use, std::size_t end, const picture::Texture& texture) {
    if (soup_.colours.empty()) soup_.colours.assign(soup_.points.size(), glm::u8vec3(255));
    for (std::size_t corner = use.first_corner; corner < end; ++corner) {
      const std::uint32_t place = corner_places_[corner];
      if (place < places_.size()) soup_.colours[soup_.corners[corner]] = texture.at(places_[place]);
    }
  }

  std::map<std::string, std::filesystem::path> textures_of_libraries() {
    std::map<std::string, std::filesystem::path> textures;
    if (places_.empty()) return textures;
    for (const std::string& library : libraries_) {
      try {
        auto more = textures_of_materials(folder_, library);
        if (more) {
          textures.merge(*more);
        } else {
          soup_.notes.push_back(fmt::format(
              "names the materials {}, which are not beside it, so that its texture is not known", library));
        }
      } catch (const Error& error) {
        soup_.notes.push_back(fmt::format("is left without its texture ({})", error.what()));
      }
    }
    return textures;
  }

  std::filesystem::path folder_;
  TextLines lines_;
  bool may_be_cut_;
  Soup soup_;
  std::vector<glm::vec3> normals_;
  std::vector<glm::vec3> colours_;  ///< as written
  double brightest_ = 0.0;          ///< of their components
  std::vector<std::uint32_t> corner_normals_;
  std::vector<std::uint32_t> face_lines_;
  std::vector<glm::dvec2> places_;            ///< on the texture, from its upper left corner
  std::vector<std::uint32_t> corner_places_;  ///< one a corner; kNoPoint: none
  std::vector<std::string> libraries_;
  std::vector<Use> uses_;
  std::size_t coloured_ = 0;
};

}  // namespace

Soup read_obj(const Source& source) {
  return ObjReader(source).read();
}

}  // namespace rejoin::mesh::detail
