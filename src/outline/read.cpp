#include "outline/read.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <iterator>
#include <map>
#include <new>
#include <optional>
#include <regex>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/words.hpp"
#include "outline/detail/readers.hpp"
#include "outline/detail/rectangles.hpp"
#include "outline/detail/repeats.hpp"
#include "outline/polygon.hpp"
#include "picture/image_file.hpp"

namespace rejoin::outline {
namespace fs = std::filesystem;
namespace {

constexpr const char* kOtherKind = "is a picture of a kind that is not read";
constexpr const char* kSaveSuch = "save it as png, jpg or tif";

enum class Kind { Picture, Csv, Svg, GeoJson, Unknown };

Kind kind_of(const fs::path& path) {
  if (picture::has_picture_name(path)) return Kind::Picture;
  const std::string ending = extension_of(path);
  if (ending == ".csv" || ending == ".txt") return Kind::Csv;
  if (ending == ".svg") return Kind::Svg;
  if (ending == ".geojson" || ending == ".json") return Kind::GeoJson;
  return Kind::Unknown;
}

/// Whether a file is a picture of a kind that is not read.
bool is_other_picture(const fs::path& path) {
  constexpr std::array<const char*, 18> kKinds = {".webp", ".gif", ".bmp", ".heic", ".jp2", ".avif",
                                                  ".pdf",  ".psd", ".cr2", ".cr3",  ".nef", ".arw",
                                                  ".dng",  ".raf", ".orf", ".rw2",  ".pef", ".xcf"};
  return std::find(kKinds.begin(), kKinds.end(), extension_of(path)) != kKinds.end();
}

std::string read_text(const std::string& path) {
  std::string text = read_file(path);
  if (text.empty()) throw InputError(path, "is empty", "save it again");
  return text;
}

/// \throws InputError much of a hole lies outside the border
void require_inside(const std::vector<glm::dvec2>& border, const std::vector<glm::dvec2>& hole,
                    const std::string& subject) {
  constexpr std::size_t kPlaces = 64;
  constexpr std::size_t kMostOutside = 3;  // a hole may touch the border
  std::size_t outside = 0;
  for (std::size_t i = 0; i < kPlaces; ++i)
    if (!contains(border, hole[i * hole.size() / kPlaces])) ++outside;
  if (outside > kMostOutside)
    throw InputError(subject, "lies outside the border, or across it", "draw it inside the border");
}

/// The outline of a polygon with its holes; a hole that is none is left out with a note.
Outline outline_of(detail::Rings& rings, const std::string& subject, std::vector<std::string>& notes) {
  Outline outline;
  outline.points = mend_polygon(std::move(rings.rings[0]), subject, notes);
  for (std::size_t h = 1; h < rings.rings.size(); ++h) {
    const std::string name = fmt::format("{}, hole {}", subject, h);
    try {
      std::vector<glm::dvec2> hole = mend_polygon(std::move(rings.rings[h]), name, notes);
      require_inside(outline.points, hole, name);
      std::reverse(hole.begin() + 1, hole.end());
      outline.holes.push_back(std::move(hole));
    } catch (const InputError& error) {
      notes.push_back(fmt::format("{} (left out)", error.what()));
    }
  }
  return outline;
}

/// Outlines of one file.
struct Outlines {
  std::vector<Outline> all;
  bool y_up = false;
};

/// What can be used of a file's outlines, largest first.
/// \throws InputError none can
Outlines read_outlines(const std::string& path, Kind kind, std::vector<std::string>& notes) {
  const std::string text = read_text(path);
  // Drawings may be UTF-16.
  if (kind != Kind::Svg && text.find('\0') != std::string::npos)
    throw InputError(path, "is UTF-16, or no text at all", "save it as UTF-8 text");
  std::vector<detail::Rings> all;
  if (kind == Kind::Csv) all = detail::read_csv(path, text, notes);
  if (kind == Kind::Svg) all = detail::read_svg(path, text, notes);
  if (kind == Kind::GeoJson) all = detail::read_geojson(path, text, notes);
  std::vector<Outline> outlines;
  outlines.reserve(all.size());
  const bool y_up = !all.empty() && all[0].y_up;
  std::exception_ptr first_problem;
  for (detail::Rings& rings : all) {
    try {
      outlines.push_back(outline_of(rings, rings.place.empty() ? path : path + ", " + rings.place, notes));
      outlines.back().label = rings.label;
    } catch (const InputError& error) {
      notes.push_back(fmt::format("{} (left out)", error.what()));
      if (!first_problem) first_problem = std::current_exception();
    }
  }
  if (outlines.empty()) std::rethrow_exception(first_problem);
  std::stable_sort(outlines.begin(), outlines.end(), [](const Outline& a, const Outline& b) {
    return signed_area(a.points) > signed_area(b.points);
  });
  return {std::move(outlines), y_up};
}

}  // namespace

bool has_piece_name(const std::string& path) {
  // Other files end in .json as well.
  return kind_of(path) != Kind::Unknown && extension_of(path) != ".json";
}

PieceSet read_pieces(const std::string& path, const ExtractOptions& options) {
  const Kind kind = kind_of(path);
  PieceSet set;
  Outlines outlines;
  if (kind == Kind::Unknown) {
    if (is_other_picture(path)) throw InputError(path, kOtherKind, kSaveSuch);
    throw InputError(path, "is neither a picture nor an outline",
                     "give a png, jpg, tif, csv, svg or geojson file");
  }
  if (kind == Kind::Picture) {
    Extraction found = extract(path, options);
    outlines.all = std::move(found.pieces);
    for (const std::string& note : found.notes) set.notes.push_back(fmt::format("{}: {}", path, note));
  } else {
    outlines = read_outlines(path, kind, set.notes);
  }
  const std::string name = fs::path(path).filename().string();
  set.pieces.reserve(outlines.all.size());
  for (std::size_t i = 0; i < outlines.all.size(); ++i)
    set.pieces.push_back(
        {i == 0 ? name : fmt::format("{}#{}", name, i + 1), path, std::move(outlines.all[i]), outlines.y_up});
  return set;
}

/// Whether a folder's file is none of the user's pieces: hidden (as macOS leaves them beside others), or a picture of results.
bool is_beside_the_pieces(const std::string& name, std::vector<std::string>& results) {
  if (name.starts_with('.')) return true;
  static const std::regex kResult(
      R"((object|joins)_[0-9]+\.png|similarity\.png|pieces\.png|match\.png|joined\.png)");
  if (!std::regex_match(name, kResult)) return false;
  results.push_back(name);
  return true;
}

/// How many files that may be pieces lie in a folder inside the user's, which is not looked into.
std::size_t pieces_inside(const fs::path& folder) {
  std::error_code problem;
  std::size_t count = 0;
  std::vector<std::string> results;
  for (auto entry = fs::directory_iterator(folder, problem); !problem && entry != fs::directory_iterator();
       entry.increment(problem)) {
    const fs::path& path = entry->path();
    if (has_piece_name(path.string()) && extension_of(path) != ".txt" &&
        !is_beside_the_pieces(path.filename().string(), results))
      ++count;
  }
  return count;
}

/// Units of a file's coordinates that it says are an inch; nullopt: it says none, or what cameras write where they know none.
std::optional<double> units_an_inch(const fs::path& file) {
  constexpr double kUnknown = 96.5;  // dots an inch, and below
  if (kind_of(file) == Kind::Svg) {
    try {
      const double units = detail::svg_units_an_inch(file.string(), read_file(file));
      return units > 0.0 ? std::optional(units) : std::nullopt;
    } catch (const InputError&) {  // a width such as "100vw"
      return std::nullopt;
    }
  }
  if (kind_of(file) != Kind::Picture) return std::nullopt;
  const auto header = picture::image_header(read_file(file));
  if (!header || header->dots_per_inch < kUnknown) return std::nullopt;
  return header->dots_per_inch;
}

/// What a file tells, with its name.
using Told = std::pair<double, std::string>;

/// What those of the files tell that tell any.
std::vector<Told> told_by(const std::vector<std::string>& files) {
  std::vector<Told> all;
  for (const fs::path file : files)
    if (const auto units = units_an_inch(file)) all.emplace_back(*units, file.filename().string());
  return all;
}

bool agree(const Told& least, const Told& most) {
  constexpr double kSame = 1.02;
  return most.first < kSame * least.first;
}

std::optional<double> told_resolution(const std::vector<Piece>& pieces) {
  std::vector<std::string> files;
  for (const Piece& piece : pieces)
    if (files.empty() || files.back() != piece.path) files.push_back(piece.path);
  const std::vector<Told> all = told_by(files);
  if (all.empty()) return std::nullopt;
  const auto [least, most] = std::ranges::minmax(all);
  return agree(least, most) ? std::optional(least.first) : std::nullopt;
}

std::optional<std::string> doubt_resolutions(const std::vector<std::string>& files) {
  constexpr std::size_t kNamed = 6;
  const std::vector<Told> all = told_by(files);
  if (all.empty()) return std::nullopt;
  const Told least = std::ranges::min(all);
  const Told most = std::ranges::max(all);
  if (agree(least, most)) return std::nullopt;
  std::vector<Told> finer;
  std::ranges::copy_if(all, std::back_inserter(finer), [&](const Told& told) { return !agree(least, told); });
  std::string scales;
  for (std::size_t k = 0; k < std::min(finer.size(), kNamed); ++k)
    scales += fmt::format("{}{} to {:.4g} %", k > 0 ? ", " : "", finer[k].second,
                          100.0 * least.first / finer[k].first);
  if (finer.size() > kNamed) scales += fmt::format(", and {} more", finer.size() - kNamed);
  return fmt::format(
      "{} says that it has {:.5g} dots or units an inch, {} {:.5g}: pieces fit only at one resolution, so if "
      "that is so, scale {}",
      most.second, most.first, least.second, least.first, scales);
}

std::optional<std::string> doubt_axes(const std::vector<Piece>& pieces) {
  const auto is_up = [](const Piece& piece) { return piece.y_up; };
  const auto up = std::ranges::find_if(pieces, is_up);
  const auto down = std::ranges::find_if_not(pieces, is_up);
  if (up == pieces.end() || down == pieces.end()) return std::nullopt;
  return fmt::format(
      "{} has y up, as maps have, and {} has y down, as pictures have, so that one of "
      "them is mirrored beside the other; save both as one kind, or call the column of a csv that was taken "
      "from a picture y_down",
      up->name, down->name);
}

std::optional<std::string> doubt_units(const std::vector<Piece>& pieces) {
  if (pieces.size() < 3) return std::nullopt;  // which of two has the other unit nobody knows
  const double usual = median_perimeter(pieces);
  const auto length = [](const Piece& piece) { return perimeter(piece.outline.points); };
  const auto longest = std::ranges::max_element(pieces, {}, length);
  if (length(*longest) <= kOtherUnit * usual) return std::nullopt;
  return fmt::format(
      "{} has a border {:.2g} times as long as most others: if its coordinates have another unit, as degrees "
      "beside metres, write all in the same, or take it out",
      longest->name, length(*longest) / usual);
}

namespace {

/// Adds what a file of a folder holds, or why it cannot be used.
/// \return whether it can
bool add_file(const fs::path& file, const ExtractOptions& options, PieceSet& all) {
  const auto unusable = [&](const std::string& reason) {
    all.unusable.push_back({file.filename().string(), reason});
    return false;
  };
  std::error_code ignored;
  if (fs::is_other(file, ignored))  // a pipe would be waited for
    return unusable(file.string() + ": is a pipe or device; take it out of the folder");
  try {
    require_tellable_name(file);
    PieceSet set = read_pieces(file.string(), options);
    std::move(set.pieces.begin(), set.pieces.end(), std::back_inserter(all.pieces));
    std::move(set.notes.begin(), set.notes.end(), std::back_inserter(all.notes));
    return true;
  } catch (const Error& error) {
    return unusable(error.what());
  } catch (const std::bad_alloc&) {
    return unusable(file.string() + ": out of memory; save it smaller");
  } catch (const std::exception& error) {  // of a library, such as OpenCV
    return unusable(fmt::format("{}: cannot be used ({}); save it again", file.string(), error.what()));
  }
}

/// What lies in a folder.
struct Listing {
  std::vector<fs::path> files;                 ///< that may be pieces, in the order of their names
  std::vector<fs::path> others;                ///< pictures of kinds that are not read
  std::map<std::string, std::size_t> folders;  ///< inside it, with how many files of pieces
  std::vector<std::string> results;            ///< names of pictures that are written as results
};

/// What a folder has instead of pieces.
std::string told_skipped(std::vector<std::string> names) {
  if (names.empty()) return "";
  const std::string& first = *std::ranges::min_element(names);
  if (names.size() == 1) return ", but " + first;
  return fmt::format(", but {} and {}", first, counted(names.size() - 1, "other file"));
}

/// \throws IoError, InputError as read_folder()
Listing list_folder(const std::string& folder) {
  std::error_code problem;
  Listing list;
  std::vector<std::string> skipped;
  for (auto entry = fs::directory_iterator(folder, problem); !problem && entry != fs::directory_iterator();
       entry.increment(problem)) {
    std::error_code ignored;
    const std::string name = entry->path().filename().string();
    if (name.starts_with('.') || name == "__MACOSX") continue;
    if (!has_piece_name(name) && fs::is_directory(entry->path(), ignored)) {
      const std::size_t count = pieces_inside(entry->path());
      if (count > 0) list.folders[entry->path().string()] = count;
      continue;
    }
    if (is_other_picture(entry->path())) list.others.push_back(entry->path());
    if (!has_piece_name(entry->path().string())) {
      skipped.push_back(name);
      continue;
    }
    if (!is_beside_the_pieces(entry->path().filename().string(), list.results))
      list.files.push_back(entry->path());
  }
  if (problem)
    throw IoError(folder, "cannot be read (" + problem.message() + ")",
                  "give a folder of pictures or outlines");
  if (list.files.empty() && !list.results.empty()) {
    throw InputError(folder,
                     fmt::format("holds only {} with names that rejoin gives to results ({})",
                                 counted(list.results.size(), "picture"),
                                 *std::min_element(list.results.begin(), list.results.end())),
                     "if they are pieces, rename them");
  }
  std::sort(list.others.begin(), list.others.end());
  if (list.files.empty()) {
    const std::string what = "holds no picture and no outline";
    if (!list.folders.empty())
      throw InputError(folder, what + ", but a folder with some, which is not looked into",
                       "give " + list.folders.begin()->first);
    if (!list.others.empty())
      throw InputError(folder,
                       what + " of a kind that is read, but " + list.others.front().filename().string(),
                       "save such pictures as png, jpg or tif");
    throw InputError(folder, what + told_skipped(std::move(skipped)),
                     "put png, jpg, tif, csv, svg or geojson files there");
  }
  std::sort(list.files.begin(), list.files.end());
  // Raw pictures that lie beside what was made of them.
  std::erase_if(list.others, [&](const fs::path& other) {
    return std::ranges::any_of(list.files, [&](const fs::path& file) { return file.stem() == other.stem(); });
  });
  return list;
}

}  // namespace

PieceSet read_folder(const std::string& folder, const ExtractOptions& options, const Context& context) {
  std::error_code ignored;
  const bool is_file = fs::is_regular_file(folder, ignored);
  if (is_file && kind_of(folder) == Kind::Unknown) read_pieces(folder, options);  // tells why not
  const auto [files, others, folders, results] =
      is_file ? Listing{{folder}, {}, {}, {}} : list_folder(folder);
  PieceSet all;
  if (!results.empty()) {
    all.notes.push_back(fmt::format("{}: {} that rejoin writes as a result ({}) {} no piece and left out",
                                    folder, counted(results.size(), "picture"),
                                    *std::min_element(results.begin(), results.end()),
                                    results.size() == 1 ? "is" : "are"));
  }
  for (const auto& [inside, count] : folders) {
    all.notes.push_back(fmt::format(
        "{}: is a folder with {} of pictures or outlines and is not looked into; move them up, or "
        "give that folder alone",
        inside, counted(count, "file")));
  }
  for (const fs::path& file : others) {
    all.unusable.push_back(
        {file.filename().string(), fmt::format("{}: {}; {}", file.string(), kOtherKind, kSaveSuch)});
  }
  std::vector<std::string> usable;
  for (std::size_t k = 0; k < files.size(); ++k) {
    context.report("reading pieces", static_cast<double>(k) / static_cast<double>(files.size()));
    if (add_file(files[k], options, all)) usable.push_back(files[k].string());
  }
  const auto doubt = doubt_resolutions(usable);
  if (doubt) all.notes.push_back(*doubt);
  if (const auto mirrored = doubt_axes(all.pieces)) all.notes.push_back(*mirrored);
  if (const auto units = doubt_units(all.pieces)) all.notes.push_back(*units);
  if (!options.keep_rectangles) detail::take_out_rectangles(all);
  detail::take_out_repeats(all);
  if (all.pieces.empty()) throw InputError(folder, "holds nothing that can be used", all.unusable[0].reason);
  return all;
}

}  // namespace rejoin::outline
