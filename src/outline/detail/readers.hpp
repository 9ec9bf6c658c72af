/// One reader for each text format of outlines.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rejoin::outline::detail {

/// Closed polygons of one piece as they stand in a file: the border, then its holes; not yet mended.
struct Rings {
  std::vector<std::vector<glm::dvec2>> rings;
  std::string place;  ///< of the border in the file, "polygon 3", for messages
  bool y_up = false;
  std::string label = {};  ///< Outline::label
};

/// y points up, but where the first line calls it "y_down".
/// \param notes  gets what is doubtful, for the user
/// \throws InputError a line is no point, or the first of several columns counts them
std::vector<Rings> read_csv(const std::string& path, const std::string& text,
                            std::vector<std::string>& notes);

/// What is hidden, drawn twice or the page's background is left out.
/// \param notes  gets what was left out, and what the drawing has that is not read
/// \throws InputError broken XML, broken path data, or no closed shape
std::vector<Rings> read_svg(const std::string& path, const std::string& text,
                            std::vector<std::string>& notes);

/// Units of a drawing's coordinates that are an inch by its width; 0: that has no physical unit.
/// \throws InputError broken XML, or its width is no length
double svg_units_an_inch(const std::string& path, const std::string& text);

/// What to say of an outline in degrees, longitude first; nullopt: at the equator they are lengths, or these are none.
/// \param opening  of the sentence, up to its verb
std::optional<std::string> doubt_degrees(const std::string& path, const std::vector<glm::dvec2>& points,
                                         const char* opening = "degrees are");

/// \param notes  gets doubt_degrees() where the file's "crs" says that its coordinates are such; as a question where it has none and all
///               polygons are smaller than a degree, for millimetres have the numbers of larger ones
/// \throws InputError broken JSON, or no polygon in it
std::vector<Rings> read_geojson(const std::string& path, const std::string& text,
                                std::vector<std::string>& notes);

/// A text without the characters of `away` at its ends.
inline std::string_view trimmed(std::string_view text, std::string_view away) {
  const std::size_t begin = text.find_first_not_of(away);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(away) + 1 - begin);
}

}  // namespace rejoin::outline::detail
