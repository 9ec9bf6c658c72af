/// A mark in PNG files that tells those which this program wrote from the user's own.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace rejoin {

/// The picture with the program's name in it (a tEXt chunk "Software" after the header).
/// \pre png  is a whole PNG file
std::string marked_png(std::string_view png);

/// Whether a file's bytes, its first few dozen are enough, are those of marked_png().
bool is_marked_png(std::string_view bytes);

/// The same for a file; one that is not there or cannot be read is none.
bool is_marked_png_file(const std::filesystem::path& file);

}  // namespace rejoin
