/// A run whose page must withstand anything: a broken block, hostile names, a piece that belongs nowhere.
#pragma once

#include "report/run_report.hpp"

namespace rejoin::report {

/// A wavy block in two placed halves (object 0), a ball alone (object 1) and a ball that is not placed.  One joint is
/// used.  Names hold HTML, JavaScript, quotes, bytes that are no UTF-8, other scripts, and thousands of characters.
RunReport planted_report();

/// `count` fragments of about `faces` faces in a row, each joined to the next.
RunReport long_row(int count, int rings);

}  // namespace rejoin::report
