#include "fragment_set.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "mesh/load.hpp"

namespace rejoin::bench {
namespace {

Rigid rigid_of(const nlohmann::json& rows) {
  Rigid motion;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) motion.rotation[c][r] = rows.at(r).at(c).get<double>();
    motion.translation[r] = rows.at(r).at(3).get<double>();
  }
  return motion;
}

}  // namespace

FragmentSet read_set(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "truth.json";
  std::ifstream file(path);
  if (!file) throw IoError(path.string(), "cannot be opened", "name a folder with a truth.json");
  FragmentSet set;
  set.folder = folder;
  set.name = std::filesystem::weakly_canonical(folder).filename().string();
  try {
    const nlohmann::json truth = nlohmann::json::parse(file);
    for (const auto& [name, fragment] : truth.at("fragments").items()) {
      set.to_world[name] = rigid_of(fragment.at("to_world"));
    }
    for (const auto& join : truth.at("joins")) {
      set.joins.push_back(
          {join.at(0).get<std::string>(), join.at(1).get<std::string>(), join.at(2).get<double>()});
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError(path.string(), error.what());
  }
  return set;
}

const match::Fragment& Shelf::get(const std::string& name) {
  const auto known = fragments_.find(name);
  if (known != fragments_.end()) return known->second;
  const std::filesystem::path path = set_.folder / name;
  mesh::Loaded loaded = mesh::load(path);
  return fragments_.emplace(name, match::prepare_as_kept(path.string(), std::move(loaded.mesh), Context()))
      .first->second;
}

}  // namespace rejoin::bench
