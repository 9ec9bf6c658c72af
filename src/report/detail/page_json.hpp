/// The page's data.
#pragma once

#include <string>
#include <vector>

#include "report/detail/page_geometry.hpp"
#include "report/run_report.hpp"

namespace rejoin::report::detail {

/// What is worked out for the page from a report.
struct PageData {
  const RunReport* report = nullptr;  ///< not owned, not null
  std::vector<PackedMesh> meshes;     ///< one a fragment; without vertices where it has no surface
  double gap_scale = 1;               ///< mesh units
  std::vector<std::size_t> listed;    ///< indices of the pairs that are given with all figures, best first
  std::vector<std::vector<ReportPicture>> pictures;  ///< one list a pair of the report
};

/// {"schema": "rejoin.report/1", ...} without "<" anywhere, so that it can stand in a page whatever texts it holds.
/// Bytes that are no UTF-8 become U+FFFD; numbers that do not exist become null.
std::string page_json(const PageData& data);

/// Scores of all pairs as bytes, row after row above the diagonal: 0 .. 253 for score 0 .. 1, 254 = failed, 255 = not
/// compared.
std::vector<std::uint8_t> score_triangle(const RunReport& report);

}  // namespace rejoin::report::detail
