#include "report/run_report.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>

#include "core/error.hpp"
#include "core/files.hpp"
#include "mesh/surface.hpp"
#include "report/assembly_gaps.hpp"
#include "report/convergence.hpp"
#include "report/detail/page_files.hpp"
#include "report/detail/page_json.hpp"
#include "report/join_pictures.hpp"

namespace rejoin::report {
namespace {

constexpr double kBytesPerFace = 5.5;  ///< of a packed surface as base64, seen on scans
constexpr double kGapReach = 0.02;     ///< of the median diameter: what is farther apart does not touch
constexpr double kBase64 = 4.0 / 3.0;

void require_valid(const RunReport& report) {
  const std::size_t n = report.fragments.size();
  for (const ReportPair& pair : report.pairs) {
    if (pair.a < n && pair.b < n && pair.a != pair.b) continue;
    throw InputError(report.title, "pair of fragments " + std::to_string(pair.a) + " and " +
                                       std::to_string(pair.b) + " cannot be shown, there are " +
                                       std::to_string(n) + " fragments");
  }
}

double median_diameter(const std::vector<ReportFragment>& fragments) {
  std::vector<double> diameters;
  for (const ReportFragment& fragment : fragments) {
    if (!fragment.mesh.vertices.empty()) diameters.push_back(mesh::diameter(fragment.mesh));
  }
  if (diameters.empty()) return 1;
  std::nth_element(diameters.begin(), diameters.begin() + static_cast<long>(diameters.size() / 2),
                   diameters.end());
  return diameters[diameters.size() / 2];
}

std::vector<mesh::Mesh> simplified(const std::vector<ReportFragment>& fragments, std::size_t faces) {
  std::vector<mesh::Mesh> meshes;
  meshes.reserve(fragments.size());
  for (const ReportFragment& fragment : fragments) meshes.push_back(mesh::simplify(fragment.mesh, faces));
  return meshes;
}

/// Gaps of every fragment's vertices; empty lists for those that are not placed.
std::vector<std::vector<float>> gaps_of(const std::vector<ReportFragment>& fragments,
                                        const std::vector<mesh::Mesh>& meshes, double reach,
                                        const Context& context) {
  std::vector<PlacedSurface> placed;
  std::vector<std::size_t> numbers;
  for (std::size_t k = 0; k < fragments.size(); ++k) {
    if (!fragments[k].pose || meshes[k].faces.empty()) continue;
    placed.push_back({&meshes[k], *fragments[k].pose, fragments[k].group});
    numbers.push_back(k);
  }
  std::vector<std::vector<float>> result(fragments.size());
  std::vector<std::vector<float>> gaps = assembly_gaps(placed, reach, context);
  for (std::size_t k = 0; k < gaps.size(); ++k) result[numbers[k]] = std::move(gaps[k]);
  return result;
}

std::size_t total_bytes(const std::vector<detail::PackedMesh>& meshes) {
  return std::accumulate(meshes.begin(), meshes.end(), std::size_t{0},
                         [](std::size_t sum, const detail::PackedMesh& mesh) { return sum + mesh.bytes(); });
}

/// Surfaces with as many faces as the budget permits.
void pack_surfaces(detail::PageData& data, const RunReportOptions& options, const Context& context) {
  const std::vector<ReportFragment>& fragments = data.report->fragments;
  const double reach = kGapReach * median_diameter(fragments);
  const double share =
      static_cast<double>(options.geometry_bytes) / std::max<std::size_t>(1, fragments.size());
  double faces = std::min(static_cast<double>(options.fragment_faces), share / kBytesPerFace);
  constexpr int kAttempts = 4;
  for (int attempt = 0; attempt < kAttempts && !context.cancelled(); ++attempt) {
    const std::vector<mesh::Mesh> meshes =
        simplified(fragments, static_cast<std::size_t>(std::max(64.0, faces)));
    const std::vector<std::vector<float>> gaps = gaps_of(fragments, meshes, reach, context);
    data.gap_scale = gap_scale(gaps, reach);
    data.meshes.assign(fragments.size(), {});
    for (std::size_t k = 0; k < meshes.size(); ++k) {
      if (!meshes[k].faces.empty()) data.meshes[k] = detail::pack(meshes[k], gaps[k], data.gap_scale);
    }
    const double bytes = kBase64 * static_cast<double>(total_bytes(data.meshes));
    if (bytes <= static_cast<double>(options.geometry_bytes)) return;
    faces *= 0.9 * static_cast<double>(options.geometry_bytes) / bytes;
  }
}

/// B's coordinates -> A's: where the assembly puts them if it stands on the joint, else the pair's own pose.
std::optional<Rigid> pose_of(const RunReport& report, const ReportPair& pair) {
  const auto& a = report.fragments[pair.a];
  const auto& b = report.fragments[pair.b];
  if (a.mesh.faces.empty() || b.mesh.faces.empty()) return std::nullopt;
  if (pair.used && a.pose && b.pose) return inverse(*a.pose) * *b.pose;
  return pair.pose;
}

/// The pairs that get pictures: those of the assembly first, then the best others, which have a third of the pictures at least, as the user
/// has to judge those by eye.
std::vector<std::size_t> pictured_pairs(const detail::PageData& data, std::size_t count) {
  std::vector<std::size_t> used;
  std::vector<std::size_t> others;
  for (const std::size_t k : data.listed) {
    const ReportPair& pair = data.report->pairs[k];
    if (!pair.pictures.empty() || pose_of(*data.report, pair)) (pair.used ? used : others).push_back(k);
  }
  const std::size_t left = count - std::min(count, used.size());
  others.resize(std::min(others.size(), std::max(left, count / 3)));
  used.resize(std::min(used.size(), count - others.size()));
  used.insert(used.end(), others.begin(), others.end());
  return used;
}

std::vector<ReportPicture> drawn(const RunReport& report, const ReportPair& pair) {
  const mesh::Mesh& a = report.fragments[pair.a].mesh;
  const mesh::Mesh& b = report.fragments[pair.b].mesh;
  const double resolution = std::max(mesh::resolution(a), mesh::resolution(b));
  return join_pictures(make_joint(a, b, *pose_of(report, pair), glm::dvec3(0.0), resolution));
}

void draw_pictures(detail::PageData& data, const RunReportOptions& options, const Context& context) {
  const RunReport& report = *data.report;
  data.pictures.assign(report.pairs.size(), {});
  const std::vector<std::size_t> pairs = pictured_pairs(data, options.pictured_joins);
  double bytes = 0;
  for (std::size_t k = 0; k < pairs.size() && !context.cancelled(); ++k) {
    context.report("pictures", static_cast<double>(k) / static_cast<double>(pairs.size()));
    const ReportPair& pair = report.pairs[pairs[k]];
    std::vector<ReportPicture> pictures = pair.pictures.empty() ? drawn(report, pair) : pair.pictures;
    for (const ReportPicture& picture : pictures) bytes += kBase64 * static_cast<double>(picture.jpeg.size());
    if (bytes > static_cast<double>(options.picture_bytes)) return;
    data.pictures[pairs[k]] = std::move(pictures);
  }
}

std::string page(const RunReport& report, const detail::PageFiles& files, const std::string& json) {
  std::string html = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  html +=
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data: blob:; "
      "script-src '";
  html.append(files.script_hash).append("' 'wasm-unsafe-eval'; style-src '").append(files.style_hash);
  html += "'; base-uri 'none'; form-action 'none'\">\n";
  html += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  html += "<meta name=\"color-scheme\" content=\"light dark\">\n<title>" + escaped(report.title) +
          "</title>\n<style>";
  html.append(files.style).append("</style>\n</head>\n<body>\n");
  html += "<noscript>This page needs JavaScript, which it brings along; nothing is loaded.</noscript>\n";
  html += "<script type=\"application/json\" id=\"report\">" + json + "</script>\n<script>";
  html.append(files.script).append("</script>\n</body>\n</html>\n");
  return html;
}

}  // namespace

std::vector<std::size_t> listed_pairs(const RunReport& report, std::size_t count) {
  std::vector<std::size_t> order(report.pairs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return report.pairs[a].score > report.pairs[b].score;
  });
  std::vector<bool> has_best(report.fragments.size(), false);
  std::size_t others = 0;
  std::erase_if(order, [&](std::size_t k) {
    const ReportPair& pair = report.pairs[k];
    const bool best = pair.comparison != Comparison::Failed && (!has_best[pair.a] || !has_best[pair.b]);
    if (best) has_best[pair.a] = has_best[pair.b] = true;
    return !pair.used && others++ >= count && !best;
  });
  return order;
}

bool write_run_report(const RunReport& report, const std::filesystem::path& path, const Context& context,
                      const RunReportOptions& options) {
  require_valid(report);
  const detail::PageFiles files = detail::page_files();
  if (files.script.empty()) {
    throw BackendError("report", "this program was built without the page's viewer",
                       "build it with -DREJOIN_VIEWER=ON, which needs node and npm");
  }
  detail::PageData data;
  data.report = &report;
  data.listed = listed_pairs(report, options.listed_pairs);
  pack_surfaces(data, options, context);
  draw_pictures(data, options, context);
  if (context.cancelled()) return false;
  write_file(path, page(report, files, detail::page_json(data)));
  return true;
}

}  // namespace rejoin::report
