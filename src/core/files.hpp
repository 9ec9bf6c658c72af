/// Files that the program reads and writes.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>

namespace rejoin {

/// The path that stands for the standard output in write_file() and require_writable_file().
inline constexpr std::string_view kStdout = "-";

/// Whether write_file() writes to the standard output: under its device's name too, for where that leads to a file, the file would be
/// replaced and not written to.
bool is_stdout(const std::filesystem::path& path);

/// The name's ending in lower case, with its dot: ".ply"; empty if it has none.
std::string extension_of(const std::filesystem::path& path);

/// All bytes of a file, or of a pipe until it ends.  \throws IoError it is a folder or cannot be read; with the system's reason
std::string read_file(const std::filesystem::path& path);

/// The same of a file that another one names: one that never ends, as a pipe that nobody writes to, is refused.
/// \throws IoError also of a pipe or device
std::string read_named_file(const std::filesystem::path& path);

/// Finds out now, before the long work, whether the file can be written then; leaves no trace.
/// \throws IoError it cannot
void require_writable_file(const std::filesystem::path& path);

/// For inputs whose names go into results: JSON, models and pages must be UTF-8, where two names could not be told apart; a line of a
/// table ends at a line end, and XML has no control characters.
/// \throws InputError the file's own name, without its folder, is no UTF-8 or holds a control character
void require_tellable_name(const std::filesystem::path& path);

/// Makes the folder with its parents, and finds out whether files can be made in it.
/// \throws IoError it cannot be made, is no folder, or refuses files
void require_writable_folder(const std::filesystem::path& folder);

/// The same for a folder whose old content would be taken for part of the new.
/// \throws IoError also if it holds anything
void require_empty_folder(const std::filesystem::path& folder);

/// The file appears whole or not at all, whatever ends the program or the machine (written beside, flushed to the disk and
/// renamed), with the mode of one that it replaces; a device or pipe is written to directly, and through a link what it leads to.
/// \throws IoError also if one that is there may not be written to
void write_file(const std::filesystem::path& path, std::string_view content);

/// The same for content that is too long for memory.
/// \param write  what it throws goes on, and leaves no file
void write_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// Gives a file that was made in full elsewhere on this disk the name of one that may be there, as write_file() does.
/// \throws IoError it cannot
void replace_file(const std::filesystem::path& made, const std::filesystem::path& path);

}  // namespace rejoin
