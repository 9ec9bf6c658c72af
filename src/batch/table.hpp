/// pairs.csv.
#pragma once

#include <filesystem>

#include "store/run.hpp"

namespace rejoin::batch {

/// Name of the table in the run's folder.
inline constexpr const char* kTableName = "pairs.csv";

/// Writes all pairs, ranked: a,b,score,verdict,stage,evidence,error (RFC 4180; names as they are).  The same database content gives the same
/// bytes.
/// \throws IoError the file cannot be written   \throws StoreError the database cannot be read
void write_table(const store::Run& run, const std::filesystem::path& file);

}  // namespace rejoin::batch
