/// One self-contained HTML page that tells what a run found.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/context.hpp"
#include "core/rigid.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::report {

/// A fragment of the run, placed or not.  All texts may hold any bytes: the page shows them as text.
struct ReportFragment {
  std::string name;
  std::string path;
  std::size_t faces = 0;      ///< of the scan
  double diameter = 0;        ///< of the scan, mesh units
  mesh::Mesh mesh;            ///< with faces; simplified further for the page; no vertices: has no picture
  std::optional<Rigid> pose;  ///< file coordinates -> common frame; none: not placed
  int group = -1;             ///< object to which it belongs, 0 .. ; -1: not placed
  double confidence = std::numeric_limits<double>::quiet_NaN();  ///< 0 .. 1; NaN: not known
  std::string reason;                                            ///< why it is not placed, a sentence
};

/// A number of a pair, with its unit in the name: "median gap".
struct ReportFigure {
  std::string name;
  double value = 0;  ///< not finite: not measured
};

/// A finished picture.
struct ReportPicture {
  std::string title;
  int width = 0;  ///< pixels
  int height = 0;
  std::vector<std::uint8_t> jpeg;
};

/// What is known of a pair.
enum class Comparison {
  Done,
  Failed,   ///< `verdict` says why; there is no score
  Touches,  ///< not compared: the assembly has put the two together by other joins
};

/// Two fragments that were compared, or touch.
struct ReportPair {
  std::size_t a = 0;  ///< index of the fragment
  std::size_t b = 0;  ///< index of the other; != a
  double score = 0;   ///< 0 .. 1; of the joint that the assembly stands on, if it does
  std::string
      verdict;  ///< "join", "unsure", "no join", "found by contact", or what kept it from being compared
  bool used = false;          ///< the assembly stands on this joint
  std::optional<Rigid> pose;  ///< B's file coordinates -> A's
  std::vector<ReportFigure> figures;
  std::vector<ReportPicture> pictures = {};  ///< filled by write_run_report() for the best pairs where empty
  Comparison comparison = Comparison::Done;
  std::string note =
      {};  ///< where the assembly has the two at another pose than their own search: a sentence on that
};

/// What the user asked the assembly for, as indices of fragments.
struct ReportConstraints {
  std::vector<std::pair<std::size_t, std::size_t>> must_join;
  std::vector<std::pair<std::size_t, std::size_t>> must_not_join;
  std::vector<std::pair<std::size_t, Rigid>> pinned;  ///< file coordinates -> common frame
};

/// All that the page shows.
struct RunReport {
  std::string title;
  std::vector<ReportFragment> fragments;
  std::vector<ReportPair> pairs;  ///< any order; each two fragments at most once
  std::size_t missing_pairs = 0;  ///< that are not compared yet
  std::size_t apart_pairs = 0;    ///< that the user laid too far apart to be searched
  std::vector<std::pair<std::string, std::string>> parameters;  ///< shown as they are, in this order
  std::vector<std::string> warnings;
  ReportConstraints constraints = {};
};

/// The pairs that are listed, best first (equal scores as given): those that the assembly uses, each fragment's best one, and the best
/// `count` of the others.
std::vector<std::size_t> listed_pairs(const RunReport& report, std::size_t count);

struct RunReportOptions {
  std::size_t geometry_bytes = 9'000'000;  ///< for all fragments, in the page
  std::size_t picture_bytes = 14'000'000;  ///< for all pictures of joins, in the page
  std::size_t fragment_faces = 16'000;     ///< a fragment, at most
  std::size_t pictured_joins = 60;         ///< the best pairs that have a pose
  std::size_t listed_pairs = 400;  ///< the best, besides those used; the others stand in the matrix only
};

/// Writes the page; it needs nothing but a browser and opens from disk.  The same report gives the same bytes.
/// \return false if it was cancelled; nothing is written then
/// \throws InputError  a pair names a fragment that is not there, or one fragment twice
/// \throws IoError     the file cannot be written; what was there before stays
/// \throws BackendError the program was built without the page's viewer
bool write_run_report(const RunReport& report, const std::filesystem::path& path, const Context& context,
                      const RunReportOptions& options = {});

}  // namespace rejoin::report
