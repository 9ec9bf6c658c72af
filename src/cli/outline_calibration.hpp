/// Files around rejoin outline calibrate: known joins in, parameters out and in again.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "outline/calibrate.hpp"
#include "outline/outline.hpp"

namespace rejoin::cli {

/// Joins of known pieces from a JSON file: an assembly ("fragments": {NAME: {"pose": 3 x 3}}, "joins": [{"a", "b"}]), or the
/// truth of a made set ("to_world" for "pose", joins as [a, b, length]).  Names that no piece has are passed over, and
/// joins of a piece that lies upside down against the other, which the multiscale method never compares.
/// \throws IoError   it cannot be read
/// \throws InputError no JSON, a matrix is broken, or no join is left
std::vector<outline::KnownJoin> read_known_joins(const std::string& path,
                                                 const std::vector<outline::Piece>& pieces);

/// Schema "rejoin.outline-calibration/1".
/// \param resolution  outline::told_resolution() of the pieces
std::string calibration_json(const std::vector<outline::CalibratedLevel>& levels,
                             std::optional<double> resolution);

/// Sets step and levels from a file that calibration_json() made.
/// \throws IoError   it cannot be read
/// \throws InputError it is something else
void read_calibration(const std::string& path, outline::MultiscaleOptions& options);

/// What to say of a calibration that was made with pieces of another resolution or unit: its steps are more than twice, or less
/// than half of, what these pieces would have, or the files of both tell dots an inch that differ by more than a tenth.
/// \throws InputError 100 times as much, or less
std::optional<std::string> doubt_calibration(const std::string& path,
                                             const outline::MultiscaleOptions& options,
                                             const std::vector<outline::Piece>& pieces);

}  // namespace rejoin::cli
