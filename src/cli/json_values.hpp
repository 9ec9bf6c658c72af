/// The project's values as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/rigid.hpp"

namespace rejoin::cli {

nlohmann::ordered_json to_json(const glm::dvec3& v);

/// 4 x 4, row major.
nlohmann::ordered_json to_json(const Rigid& pose);

/// The inverse of to_json(Rigid); nullopt if it is no 4 x 4 matrix of numbers, no proper rigid motion (products of columns to 0.002, as
/// matrices come with three decimals; the rotation is then made orthonormal), or shifts along an axis by more than 1e13.
std::optional<Rigid> rigid_from_json(const nlohmann::ordered_json& rows);

/// What to tell of a value that rigid_from_json() refuses, behind its name: "is no ..." or "shifts ..."; how far it is from a rotation where that is why.
std::string why_no_rigid(const nlohmann::ordered_json& rows);

/// Whether rigid_from_json() refuses a matrix because it scales, shears or mirrors.
bool is_no_rotation(const nlohmann::ordered_json& rows);

/// The text of a JSON file; whether it is JSON is for the parser to say.
/// \param mend  what to do about one that is nested without end
/// \throws IoError it cannot be read   \throws InputError it is nested deeper than kDeepestJson
std::string read_json_text(const std::string& path, const std::string& mend);

/// Where a text stops being JSON, as "line 3, column 14".  \pre it is none
std::string json_fault(const std::string& text);

/// The file's text.  A path may be no UTF-8, but JSON must be: such bytes are replaced.
std::string text_of(const nlohmann::ordered_json& json);

}  // namespace rejoin::cli
