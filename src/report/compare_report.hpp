/// What `rejoin compare` tells: table, JSON, picture.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "match/compare.hpp"
#include "report/image.hpp"

namespace rejoin::report {

/// What write_compare_outputs() calls its picture.
inline constexpr const char* kComparisonPicture = "compare.png";

/// Lines of at most 100 columns: the errors at the pose, what their difference comes from, how they agree
/// over the grid.
std::string compare_table(const match::Comparison& comparison);

/// \param path_a, path_b  as the user gave them
/// \return {"schema": "rejoin.compare/1", ...}; numbers that do not exist (no overlap) are null
std::string compare_json(const match::Comparison& comparison, const std::string& path_a,
                         const std::string& path_b);

/// Differences of depth and of slope difference, drawn against cast and coarse against full, and both errors
/// over the grid.
Image draw_comparison(const match::Comparison& comparison, const std::string& name_a,
                      const std::string& name_b);

/// Writes compare.png and compare.json.
/// \return the files
/// \throws IoError the folder or a file cannot be written
std::vector<std::filesystem::path> write_compare_outputs(const std::filesystem::path& folder,
                                                         const match::Comparison& comparison,
                                                         const std::string& path_a,
                                                         const std::string& path_b);

}  // namespace rejoin::report
