#include "report/detail/page_files.hpp"

namespace rejoin::report::detail {

PageFiles page_files() {
  return {};
}

}  // namespace rejoin::report::detail
