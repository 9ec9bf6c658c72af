#include "cli/assemble_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <map>
#include <pugixml.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <system_error>

#include "cli/json_values.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/utf8.hpp"
#include "core/version.hpp"
#include "mesh/save.hpp"
#include "report/assembly_picture.hpp"
#include "report/fragment_colours.hpp"

namespace rejoin::cli {
namespace {

/// Bytes of a fragment's name in a file's: file systems take 255, and a file on its way has a few more.
constexpr std::size_t kLongestName = 200;

constexpr const char* kProject = "assembled.mlp";
constexpr const char* kPicture = "assembled.png";
constexpr const char* kMatrices = "cloudcompare";

constexpr std::array kModels{kProject, mesh::kAssembledGlb, mesh::kAssembledPly, kPicture};

using nlohmann::ordered_json;

/// Four rows of four numbers, as CloudCompare and MeshLab read them, with all their digits: coordinates of maps need more than
/// twelve.
std::string matrix_text(const Rigid& pose) {
  std::string text;
  for (int row = 0; row < 3; ++row) {
    text += fmt::format("{} {} {} {}\n", pose.rotation[0][row], pose.rotation[1][row], pose.rotation[2][row],
                        pose.translation[row]);
  }
  return text + "0 0 0 1\n";
}

/// For an attribute's value in XML; control characters that XML knows no way to write become '?', and bytes of folders' names that
/// are no UTF-8 U+FFFD.
std::string xml_text(const std::string& text) {
  std::string result;
  for (const char c : valid_utf8(text)) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\t':
      case '\n':
      case '\r':  // as they are, they would be read as blanks
        result += fmt::format("&#{};", static_cast<int>(c));
        break;
      default:
        result += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return result;
}

ordered_json left_out(const std::string& reason) {
  return {{"pose", nullptr}, {"group", -1}, {"reason", reason}};
}

ordered_json joins_json(const AssembleInput& input, const assembly::Result& result) {
  ordered_json joins = ordered_json::array();
  for (const assembly::Join& join : result.joins) {
    joins.push_back({{"a", input.names[join.a]},
                     {"b", input.names[join.b]},
                     {"score", join.score},
                     {"contact", join.contact_area},
                     {"gap_median", join.gap_median},
                     {"found_by", join.found ? "contact" : "match"}});
  }
  return joins;
}

std::vector<std::string> with_names(const std::vector<std::string>& texts,
                                    const std::vector<std::string>& names) {
  std::vector<std::string> result;
  result.reserve(texts.size());
  for (const std::string& text : texts) result.push_back(cli::with_names(text, names));
  return result;
}

/// As the user's file has them, and what became of them.
ordered_json constraints_json(const AssembleInput& input, const NamedConstraints& constraints,
                              const assembly::Result& result) {
  const auto pairs = [](const NamedConstraints::Pairs& list) {
    ordered_json json = ordered_json::array();
    for (const auto& [a, b] : list) json.push_back({a, b});
    return json;
  };
  ordered_json poses = ordered_json::object();
  for (const auto& [name, pose] : constraints.poses) poses[name] = to_json(pose);
  std::vector<std::string> problems = input.left_out;
  std::ranges::copy(with_names(result.warnings, input.names), std::back_inserter(problems));
  return {{"must_join", pairs(constraints.must_join)},
          {"must_not_join", pairs(constraints.must_not_join)},
          {"poses", poses},
          {"problems", problems}};
}

std::vector<report::PlacedFragment> placed_fragments(const AssembleInput& input,
                                                     const assembly::Result& result) {
  std::vector<report::PlacedFragment> placed;
  std::map<std::size_t, std::size_t> number;  // among the placed
  for (std::size_t k = 0; k < input.names.size(); ++k) {
    const assembly::Placement& placement = result.placements[k];
    if (placement.group < 0) continue;
    number[k] = placed.size();
    placed.push_back({input.names[k], &input.fragments[k].coarse, placement.pose, placement.group});
  }
  std::vector<std::pair<std::size_t, std::size_t>> joins;
  joins.reserve(result.joins.size());
  for (const assembly::Join& join : result.joins) joins.emplace_back(number.at(join.a), number.at(join.b));
  const std::vector<report::Colour> colours = report::fragment_colours(placed.size(), joins);
  for (std::size_t k = 0; k < placed.size(); ++k) placed[k].colour = colours[k];
  return placed;
}

}  // namespace

std::string with_names(const std::string& text, const std::vector<std::string>& names) {
  static const std::regex kNumber(R"(\{(\d+)\})");
  std::string result;
  auto last = text.cbegin();
  for (std::sregex_iterator hit(text.begin(), text.end(), kNumber), end; hit != end; ++hit) {
    result.append(last, (*hit)[0].first);
    result += names.at(std::stoul((*hit)[1]));
    last = (*hit)[0].second;
  }
  return result.append(last, text.cend());
}

std::string reason_of(const AssembleInput& input, const assembly::Result& result, std::size_t fragment) {
  const std::string reason = with_names(result.placements[fragment].reason, input.names);
  std::string missing = store::told(input.remains, input.names[fragment]);
  if (!store::is_searched(input.remains, input.names[fragment])) return missing;
  return missing.empty() ? reason : reason + "; " + missing;
}

std::vector<std::string> warnings_of(const AssembleInput& input, const assembly::Result& result) {
  std::vector<std::string> list = input.warnings;
  const std::string missing = store::told(input.remains);
  if (!missing.empty()) list.push_back(missing);
  std::ranges::copy(input.left_out, std::back_inserter(list));
  for (const auto* texts : {&result.warnings, &result.doubts})
    for (const std::string& text : with_names(*texts, input.names)) list.push_back(text);
  return list;
}

std::string assembly_json(const AssembleInput& input, const NamedConstraints& constraints,
                          const assembly::Result& result) {
  ordered_json fragments = ordered_json::object();
  ordered_json unplaced = ordered_json::array();
  for (std::size_t k = 0; k < input.names.size(); ++k) {
    const assembly::Placement& placement = result.placements[k];
    if (placement.group < 0) {
      unplaced.push_back(input.names[k]);
      fragments[input.names[k]] = left_out(reason_of(input, result, k));
    } else {
      fragments[input.names[k]] = {{"pose", to_json(placement.pose)},
                                   {"group", placement.group},
                                   {"confidence", placement.confidence}};
    }
    fragments[input.names[k]]["scan"] = input.hashes[k];
  }
  for (const auto& [name, reason] : input.bad) {
    unplaced.push_back(name);
    fragments[name] = left_out(reason);
  }
  return text_of({{"schema", "rejoin.assembly/1"},
                  {"fragments", fragments},
                  {"joins", joins_json(input, result)},
                  {"unplaced", unplaced},
                  {"groups", result.groups},
                  {"pairs_missing", input.remains.missing},
                  {"results", input.results},
                  {"constraints", constraints_json(input, constraints, result)},
                  {"doubts", with_names(result.doubts, input.names)},
                  {"warnings", warnings_of(input, result)},
                  {"interrupted", result.cancelled},
                  {"version", kVersion}});
}

std::string meshlab_project(const AssembleInput& input, const assembly::Result& result) {
  std::string text = "<!DOCTYPE MeshLabDocument>\n<MeshLabProject>\n <MeshGroup>\n";
  for (std::size_t k = 0; k < input.names.size(); ++k) {
    const assembly::Placement& placement = result.placements[k];
    if (placement.group < 0) continue;
    const std::string path = std::filesystem::absolute(input.paths[k]).lexically_normal().string();
    text += fmt::format(
        "  <MLMesh label=\"{}\" filename=\"{}\">\n   <MLMatrix44>\n{}</MLMatrix44>\n  </MLMesh>\n",
        xml_text(input.names[k]), xml_text(path), matrix_text(placement.pose));
  }
  return text + " </MeshGroup>\n <RasterGroup/>\n</MeshLabProject>\n";
}

/// What a file's name has room for of a fragment's.
std::string shortened(const std::string& name) {
  if (name.size() <= kLongestName) return name;
  std::size_t end = kLongestName;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0) == 0x80)
    --end;  // no half of a UTF-8 letter
  return name.substr(0, end);
}

/// The fragment's name, or its beginning and a number.
std::string matrix_name(const std::string& name, std::size_t number) {
  if (name.size() <= kLongestName) return name + ".txt";
  return fmt::format("{}~{}.txt", shortened(name), number);
}

/// The same without a number.
std::string stem_of_matrix(const std::string& file) {
  std::string stem = file.substr(0, file.size() - std::min(file.size(), std::string(".txt").size()));
  return stem.size() > kLongestName ? stem.substr(0, stem.rfind('~')) : stem;
}

/// Sixteen numbers and nothing else.
bool is_matrix(const std::filesystem::path& file) {
  constexpr std::uintmax_t kLongest = 1024;
  std::error_code problem;
  if (file.extension() != ".txt" || !std::filesystem::is_regular_file(file, problem)) return false;
  if (std::filesystem::file_size(file, problem) > kLongest || problem) return false;
  std::istringstream text(read_file(file));
  int numbers = 0;
  for (double value = 0; text >> value;) ++numbers;
  return numbers == 16 && text.eof();
}

std::vector<std::filesystem::path> matrices_in(const std::filesystem::path& folder) {
  std::error_code problem;
  std::vector<std::filesystem::path> files;
  for (std::filesystem::directory_iterator entry(folder, problem), end; !problem && entry != end;
       entry.increment(problem)) {
    if (is_matrix(entry->path())) files.push_back(entry->path());
  }
  return files;
}

/// Names of the fragments that an assembly's project places, as far as its matrices' names have them; none if there is no project.
std::set<std::string> placed_by(const std::filesystem::path& project) {
  pugi::xml_document document;
  std::set<std::string> names;
  if (!document.load_file(project.c_str())) return names;
  for (const pugi::xml_node& layer : document.child("MeshLabProject").child("MeshGroup").children("MLMesh"))
    names.insert(shortened(layer.attribute("label").as_string()));
  return names;
}

bool has_models(const std::filesystem::path& folder) {
  return std::ranges::any_of(kModels, [&](const char* name) {
    std::error_code ignored;
    return std::filesystem::exists(folder / name, ignored);
  });
}

void remove_earlier(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& made) {
  std::error_code ignored;
  const std::set<std::string> placed = placed_by(folder / kProject);
  for (const auto& file : matrices_in(folder / kMatrices)) {
    if (placed.count(stem_of_matrix(file.filename().string())) != 0) std::filesystem::remove(file, ignored);
  }
  if (!made.empty()) return;
  for (const char* name : kModels) std::filesystem::remove(folder / name, ignored);
}

void require_models_of_assembly(const std::filesystem::path& folder) {
  if (!matrices_in(folder / kMatrices).empty()) return;
  for (const char* name : kModels) {
    std::error_code ignored;
    if (!std::filesystem::exists(folder / name, ignored)) continue;
    throw IoError((folder / name).string(), "is of no earlier rejoin assemble and would be lost",
                  "give --out another folder, or rename the file");
  }
}

std::vector<std::filesystem::path> model_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files(kModels.size());
  std::ranges::transform(kModels, files.begin(), [&](const char* name) { return folder / name; });
  return files;
}

std::vector<std::filesystem::path> make_models(const std::filesystem::path& folder,
                                               const AssembleInput& input, const assembly::Result& result) {
  std::vector<std::filesystem::path> files;
  if (result.groups == 0) return files;
  files.push_back(folder / kProject);  // first, for it names the matrices
  write_file(files.back(), meshlab_project(input, result));
  files.push_back(folder / kMatrices);
  require_writable_folder(files.back());
  std::vector<mesh::Placed> parts;
  for (std::size_t k = 0; k < input.names.size(); ++k) {
    const assembly::Placement& placement = result.placements[k];
    if (placement.group < 0) continue;
    parts.push_back({input.names[k], &input.fragments[k].surface, placement.pose});
    write_file(files.back() / matrix_name(input.names[k], k), matrix_text(placement.pose));
  }
  for (const char* name : {mesh::kAssembledGlb, mesh::kAssembledPly}) {
    files.push_back(folder / name);
    mesh::save_scene(files.back(), parts);
  }
  files.push_back(folder / kPicture);
  report::write_assembly_picture(files.back(), placed_fragments(input, result));
  return files;
}

}  // namespace rejoin::cli
