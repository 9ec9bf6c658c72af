/// Small pictures of one joint for the page of a run.
#pragma once

#include <vector>

#include "report/joint.hpp"
#include "report/run_report.hpp"

namespace rejoin::report {

struct JoinPictureOptions {
  int side = 320;        ///< height of each picture, pixels
  int quality = 82;      ///< JPEG, 1 .. 100
  int ambient_rays = 2;  ///< a sample; most of the time goes into them
};

/// The fragments opened, joined, their broken faces by gap, a cut through the joint, both depth maps and where their
/// slopes differ; without labels, as the page has its own.  The last three are left out where nothing overlaps.
std::vector<ReportPicture> join_pictures(const Joint& joint, const JoinPictureOptions& options = {});

}  // namespace rejoin::report
