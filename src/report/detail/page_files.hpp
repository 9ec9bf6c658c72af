/// The viewer's files, embedded when the program is built (cmake/Viewer.cmake).
#pragma once

#include <string_view>

namespace rejoin::report::detail {

/// All empty if the program was built without the viewer.
struct PageFiles {
  std::string_view script;
  std::string_view style;
  std::string_view script_hash;  ///< "sha256-..." for the page's content security policy
  std::string_view style_hash;
};
PageFiles page_files();

}  // namespace rejoin::report::detail
