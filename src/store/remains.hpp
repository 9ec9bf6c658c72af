/// What of a run is still to be compared, or was not searched in full.
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "store/run.hpp"

namespace rejoin::store {

struct Remains {
  std::size_t pairs = 0;       ///< of the fragments that the database knows, copies() left out
  std::size_t missing = 0;     ///< of those; the failed are not missing
  std::size_t pairs_each = 0;  ///< of one fragment with all others
  std::map<std::string, std::size_t> missing_of;  ///< by fragment, where any is missing
  std::map<std::string, std::size_t>
      ended_early_of;     ///< pairs of a fragment that looked hopeless soon, where there are any
  std::size_t apart = 0;  ///< pairs that were not searched, as the layout has them too far apart
  std::map<std::string, std::size_t> apart_of;  ///< of a fragment, where there are any
  std::string shard;                            ///< as Run::shard()
};

/// \throws StoreError the database cannot be read
Remains remains(const Run& run);

/// A sentence without its full stop; empty if nothing is missing and the run is no shard.
std::string told(const Remains& remains);

/// The same of one fragment: "5 of its 8 pairs are not compared yet"; and how many were not searched, or not in full.
std::string told(const Remains& remains, const std::string& fragment);

/// Whether any pair is searched; true of no pairs.
bool is_searched(const Remains& remains);

/// Whether any pair of the fragment is searched; of one that the database does not know, too.
bool is_searched(const Remains& remains, const std::string& fragment);

}  // namespace rejoin::store
