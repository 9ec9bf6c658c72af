#include "cli/layout.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <pugixml.hpp>
#include <sstream>

#include "cli/assemble_constraints.hpp"
#include "cli/json_values.hpp"
#include "cli/pose_file.hpp"
#include "core/error.hpp"

namespace rejoin::cli {
namespace {

using nlohmann::ordered_json;

constexpr const char* kLayoutMend = "see \"A rough layout\" in docs/box-of-sherds.md";
constexpr const char* kNoScale =
    "in MeshLab, take back what scales or mirrors (Reset Matrix), lay the piece again with turns and shifts "
    "alone and save the project";

class LayoutReader {
 public:
  LayoutReader(const std::string& path, const batch::Scans& scans)
      : path_(path),
        scans_(scans),
        names_(batch::names_of(scans)),
        text_(read_json_text(path, kLayoutMend)) {}

  LaidScans read() {
    const std::size_t first = text_.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
    if (first != std::string::npos && text_[first] == '<') {
      read_project();
    } else {
      read_json();
    }
    if (laid_.layout.size() < 2) refuse_too_few();
    return laid_;
  }

 private:
  [[noreturn]] void fail(const std::string& problem, const char* mend = kLayoutMend) const {
    throw InputError(path_, problem, mend);
  }

  [[noreturn]] void refuse_too_few() const {
    const std::string lays =
        fmt::format("lays {} of the folder's scans{}",
                    laid_.layout.empty() ? "none" : "only " + laid_.layout.begin()->first,
                    laid_.warnings.empty() ? "" : " as they are now");
    fail(lays, laid_.warnings.empty() ? "lay two or more beside each other"
                                      : "assemble the scans as they are, or leave --layout out");
  }

  /// \param mend  of a matrix that is no pose
  void lay(const std::string& name, const ordered_json& rows, const char* mend) {
    if (std::find(names_.begin(), names_.end(), name) == names_.end())
      fail(fmt::format("lays \"{}\", which is no scan of the folder", name),
           "take it out, or hide it in MeshLab");
    const std::optional<Rigid> pose = rigid_from_json(rows);
    if (!pose) fail(fmt::format("the matrix of \"{}\" {}", name, why_no_rigid(rows)), mend);
    if (!laid_.layout.emplace(name, *pose).second)
      fail(fmt::format("lays \"{}\" twice", name), "leave one of the two");
  }

  void read_project() {
    pugi::xml_document document;
    const pugi::xml_parse_result parsed = document.load_buffer(text_.data(), text_.size());
    if (!parsed)
      fail(fmt::format("is no MeshLab project: {} at byte {}", parsed.description(), parsed.offset),
           "save it again");
    const pugi::xml_node project = document.child("MeshLabProject");
    if (!project) fail("is no MeshLab project");
    for (const pugi::xml_node& layer : project.child("MeshGroup").children("MLMesh")) {
      if (std::string(layer.attribute("visible").as_string("1")) == "0") continue;
      const std::string file = layer.attribute("filename").as_string();
      lay(name_in(file), pose_of(layer, name_in(file)));
    }
  }

  void lay(const std::string& name, const ordered_json& rows) {
    lay(name, rows, is_no_rotation(rows) ? kNoScale : "save the project again");
  }

  /// The fragment that a path leads to: the last of its parts that is one's name, for a scan may go by its folder's; else its last.
  std::string name_in(const std::string& path) const {
    const auto last_of = [](const std::string& of) { return of.substr(of.find_last_of("/\\") + 1); };
    for (std::string rest = path; !rest.empty();) {
      std::string part = last_of(rest);
      if (std::find(names_.begin(), names_.end(), part) != names_.end()) return part;
      rest.resize(rest.size() - std::min(rest.size(), part.size() + 1));
    }
    return last_of(path);
  }

  /// A layer without a matrix was not moved.
  ordered_json pose_of(const pugi::xml_node& layer, const std::string& name) const {
    const pugi::xml_node matrix = layer.child("MLMatrix44");
    if (!matrix) return to_json(Rigid{});
    const std::string text = matrix.text().as_string();
    ordered_json rows = rows_of_numbers(text);
    if (rows.is_discarded() && has_decimal_commas(text))
      fail(fmt::format("the matrix of \"{}\" {}", name, kDecimalCommas), kPointsMend);
    return rows;
  }

  void read_json() {
    const ordered_json json = ordered_json::parse(text_, nullptr, false);
    if (json.is_discarded())
      fail(fmt::format("is neither a MeshLab project nor JSON ({})", json_fault(text_)));
    if (json.is_object() && json.contains("schema")) {
      read_assembly(json);
      return;
    }
    const assembly::Constraints constraints = read_constraints({path_, text_}, names_).constraints;
    if (!constraints.must_join.empty() || !constraints.must_not_join.empty())
      fail("says which pairs must or must not join, which no search by a layout heeds",
           "leave its \"poses\" alone here, and give the rest to rejoin assemble --constraints");
    for (const auto& [number, pose] : constraints.pinned) laid_.layout.emplace(names_[number], pose);
  }

  void read_assembly(const ordered_json& json) {
    if (json["schema"] != "rejoin.assembly/1" || !json.contains("fragments") ||
        !json["fragments"].is_object())
      fail("is no assembly (schema rejoin.assembly/1)");
    for (const auto& [name, fragment] : json["fragments"].items()) {
      if (!fragment.is_object() || !fragment.contains("pose") || fragment["pose"].is_null()) continue;
      if (fragment.value("group", ordered_json(0)) != 0)
        continue;  // beside the first object, for the eye alone
      if (is_of_another_scan(name, fragment)) {
        laid_.warnings.push_back(fmt::format(
            "{}: the place of {} is left out, as the scan is another than the one that was assembled", path_,
            name));
        continue;
      }
      lay(name, fragment["pose"], "make it again with rejoin assemble");
    }
  }

  /// The origin of a scan that was exported again may lie elsewhere, and its pose with it.
  bool is_of_another_scan(const std::string& name, const ordered_json& fragment) const {
    const auto scan = scans_.find(name);
    if (scan == scans_.end() || !fragment.contains("scan") || !fragment["scan"].is_string()) return false;
    const std::string now = batch::hash_if_readable(scan->second);
    return now != store::kUnreadable && now != fragment["scan"].get<std::string>();
  }

  const std::string& path_;
  const batch::Scans& scans_;
  std::vector<std::string> names_;
  std::string text_;
  LaidScans laid_;
};

}  // namespace

LaidScans read_layout(const std::string& path, const batch::Scans& scans) {
  return LayoutReader(path, scans).read();
}

}  // namespace rejoin::cli
