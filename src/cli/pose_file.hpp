/// Poses that a user gives in a file.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/rigid.hpp"

namespace rejoin::cli {

/// The 4 x 4 matrix of a file, row by row: the "pose" of rejoin match's JSON, a bare JSON array of rows, or sixteen numbers as
/// CloudCompare copies and saves them, with commas between them and comments behind "#" or not.
/// \throws IoError it cannot be read   \throws InputError it holds no proper rigid motion, or is an assembly
Rigid read_pose(const std::string& path);

/// The same for a pair, B -> A: the JSON of a match of B and A is turned round, by their files' names, and by their folders where these
/// are the same.
/// \param[out] doubt  what to tell if that JSON is of two other files; empty: nothing
/// \throws InputError also if the JSON is of two files of one name and its folders do not tell which of them is A
Rigid read_pose(const std::string& path, const std::string& path_a, const std::string& path_b,
                std::string& doubt);

/// Sixteen numbers as four rows, as they are in files of poses; a discarded value if the text is anything else.
nlohmann::ordered_json rows_of_numbers(const std::string& text);

/// Whether a text would be rows_of_numbers() if its commas were points, each of its numbers having one at most.
bool has_decimal_commas(const std::string& text);

/// What to tell of such a text, and what to do about it.
inline constexpr const char* kDecimalCommas = "has decimal commas";
inline constexpr const char* kPointsMend = "write its numbers with points as decimal marks";

}  // namespace rejoin::cli
