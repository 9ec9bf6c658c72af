/// One picture that shows what a match found.
#pragma once

#include <string>
#include <vector>

#include "match/match.hpp"
#include "report/image.hpp"
#include "report/joint.hpp"

namespace rejoin::report {

/// What is written above the panels.
struct SheetLabels {
  std::string name_a;
  std::string name_b;
  match::Verdict verdict = match::Verdict::NoJoin;
  match::Candidate candidate;
  std::string backend;  ///< "raster (AVX2)"
};

/// The line of figures above the panels: those of the candidate, as in the JSON of the run.
std::string figures_line(const SheetLabels& labels);

/// 2000 x 1300: the fragments opened, joined from three sides; the broken faces coloured by gap, how often
/// each gap
/// occurs, a cut through the joint.
Image draw_match_sheet(const Joint& joint, const SheetLabels& labels);

}  // namespace rejoin::report
