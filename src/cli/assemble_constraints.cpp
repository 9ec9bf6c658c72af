#include "cli/assemble_constraints.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "cli/json_values.hpp"
#include "cli/pose_file.hpp"
#include "core/error.hpp"

namespace rejoin::cli {
namespace {

using nlohmann::ordered_json;
using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
using NamedPairs = NamedConstraints::Pairs;

constexpr const char* kConstraintsMend = "see \"Constraints\" in docs/box-of-sherds.md";

class ConstraintsReader {
 public:
  ConstraintsReader(const ConstraintsFile& file, const std::vector<std::string>& names,
                    const std::map<std::string, std::string>& unusable,
                    const std::map<std::string, std::string>& copies)
      : path_(file.path), text_(file.text), names_(names), unusable_(unusable), copies_(copies) {}

  AskedConstraints read() {
    const ordered_json json = parsed();
    if (json.is_discarded())
      throw InputError(path_, fmt::format("is no JSON ({})", json_fault(text_)), kConstraintsMend);
    if (!json.is_object()) fail("is no JSON object");
    for (const auto& [key, value] : json.items()) {
      if (key != "must_join" && key != "must_not_join" && key != "poses")
        fail(fmt::format("knows no \"{}\"", key));
    }
    assembly::Constraints& constraints = asked_.constraints;
    constraints.must_join = pairs(json, "must_join", asked_.named.must_join);
    constraints.must_not_join = pairs(json, "must_not_join", asked_.named.must_not_join);
    require_no_both();
    constraints.pinned = poses(json);
    return asked_;
  }

 private:
  /// The file's JSON.  The parser keeps the last of equal keys and says nothing, so they are looked for here.
  ordered_json parsed() const {
    std::vector<std::set<std::string>> keys;
    std::optional<std::string> repeated;
    const auto look = [&](int /*depth*/, ordered_json::parse_event_t event, ordered_json& value) {
      if (event == ordered_json::parse_event_t::object_start) keys.emplace_back();
      if (event == ordered_json::parse_event_t::object_end) keys.pop_back();
      if (event == ordered_json::parse_event_t::key && !keys.back().insert(value.get<std::string>()).second)
        repeated = value.get<std::string>();
      return true;
    };
    ordered_json json = ordered_json::parse(text_, look, false);
    if (!json.is_discarded() && repeated) fail(fmt::format("gives \"{}\" twice", *repeated));
    return json;
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(path_, problem, kConstraintsMend);
  }

  /// The fragment that stands for a name: of a copy that of its content.
  const std::string& meant(const std::string& name) const {
    const auto copy = copies_.find(name);
    return copy == copies_.end() ? name : copy->second;
  }

  void require_no_both() const {
    for (const auto& [a, b] : asked_.named.must_join) {
      for (const auto& [c, d] : asked_.named.must_not_join) {
        if (std::minmax(meant(a), meant(b)) == std::minmax(meant(c), meant(d)))
          fail(fmt::format("says that {} and {} must and must not join", a, b));
      }
    }
  }

  /// \return nothing if it is a fragment that cannot be used
  std::optional<std::size_t> number_of(const ordered_json& name, const std::string& place) {
    if (!name.is_string()) fail(place + " is no name of a fragment");
    const std::string fragment = meant(name.get<std::string>());
    const auto unusable = unusable_.find(fragment);
    if (unusable != unusable_.end()) {
      asked_.left_out.push_back(fmt::format("{}: {} is left out, as \"{}\" can have no place ({})", path_,
                                            place, unusable->first, unusable->second));
      return std::nullopt;
    }
    const auto found = std::find(names_.begin(), names_.end(), fragment);
    if (found == names_.end())
      fail(fmt::format("{}: there is no fragment \"{}\"{}", place, name.get<std::string>(),
                       hint_for(name.get<std::string>())));
    return static_cast<std::size_t>(found - names_.begin());
  }

  /// The fragment that was meant where its ending was left out.
  std::string hint_for(const std::string& name) const {
    const auto likely = std::ranges::find_if(
        names_, [&](const std::string& known) { return std::filesystem::path(known).stem() == name; });
    return likely == names_.end() ? "" : fmt::format(" (\"{}\"?)", *likely);
  }

  /// \param named  takes them as they stand there
  Pairs pairs(const ordered_json& json, const std::string& key, NamedPairs& named) {
    Pairs result;
    if (!json.contains(key)) return result;
    if (!json[key].is_array()) fail(fmt::format("\"{}\" is no list of pairs", key));
    for (std::size_t k = 0; k < json[key].size(); ++k) {
      const ordered_json& pair = json[key][k];
      const std::string place = fmt::format("\"{}\"[{}]", key, k);
      if (!pair.is_array() || pair.size() != 2) fail(place + " is no pair of names");
      const auto a = number_of(pair[0], place);
      const auto b = number_of(pair[1], place);
      named.emplace_back(pair[0].get<std::string>(), pair[1].get<std::string>());
      if (meant(named.back().first) == meant(named.back().second))
        fail(place + " names the same fragment twice");
      if (!a || !b) continue;
      result.emplace_back(std::min(*a, *b), std::max(*a, *b));
    }
    return result;
  }

  std::vector<std::pair<std::size_t, Rigid>> poses(const ordered_json& json) {
    std::vector<std::pair<std::size_t, Rigid>> result;
    if (!json.contains("poses")) return result;
    if (!json["poses"].is_object()) fail("\"poses\" is no object of names and matrices");
    for (const auto& [name, rows] : json["poses"].items()) {
      const std::string place = fmt::format("\"poses\".\"{}\"", name);
      const auto number = number_of(name, place);
      const std::optional<Rigid> pose =
          rows.is_string() ? read_pose(std::filesystem::path(path_).parent_path() / rows.get<std::string>())
                           : rigid_from_json(rows);
      if (!pose) fail(fmt::format("{} {}", place, why_no_rigid(rows)));
      asked_.named.poses.emplace_back(name, *pose);
      if (number && !is_given(result, *number, name, *pose)) result.emplace_back(*number, *pose);
    }
    return result;
  }

  /// Whether a pose was given under another name of the scan; it has to be the same.
  bool is_given(const std::vector<std::pair<std::size_t, Rigid>>& poses, std::size_t number,
                const std::string& name, const Rigid& pose) const {
    const auto earlier =
        std::ranges::find(poses, number, [](const auto& numbered) { return numbered.first; });
    if (earlier == poses.end()) return false;
    if (earlier->second.rotation != pose.rotation || earlier->second.translation != pose.translation) {
      const auto same = std::ranges::find(asked_.named.poses, meant(name),
                                          [this](const auto& named) { return meant(named.first); });
      fail(fmt::format("gives {} and {} different poses, but they are the same scan", same->first, name));
    }
    return true;
  }

  const std::string& path_;
  const std::string& text_;
  const std::vector<std::string>& names_;
  const std::map<std::string, std::string>& unusable_;
  const std::map<std::string, std::string>& copies_;
  AskedConstraints asked_;
};

}  // namespace

ConstraintsFile open_constraints(const std::string& path) {
  return {path, read_json_text(path, kConstraintsMend)};
}

AskedConstraints read_constraints(const ConstraintsFile& file, const std::vector<std::string>& names,
                                  const std::map<std::string, std::string>& unusable,
                                  const std::map<std::string, std::string>& copies) {
  return ConstraintsReader(file, names, unusable, copies).read();
}

}  // namespace rejoin::cli
