/// The search's course as a picture.
#pragma once

#include <string>
#include <string_view>

#include "match/match.hpp"

namespace rejoin::report {

/// Text made safe for XML: &, <, >, quotes escaped, control characters and invalid UTF-8 replaced.
std::string escaped(std::string_view text);

/// SVG: best energy and temperature of every chain against evaluations.  A search without chains shows the
/// scores of its
/// candidates by rank instead, so that the file always tells something.
/// \param title  plain text; escaped here
std::string convergence_svg(const match::Result& result, const std::string& title);

}  // namespace rejoin::report
