/// By what the results of a run are known again.
#pragma once

#include <string>

#include "store/run.hpp"

namespace rejoin::store {

/// A hash of all pairs that are done, by name, and what came of them, but for seconds: equal where a run is as it was, and hardly ever
/// where pairs were done anew with other options, layouts or painted breaks and came out otherwise.
/// \return 16 hexadecimal digits   \throws StoreError the database cannot be read
std::string results_hash(const Run& run);

}  // namespace rejoin::store
