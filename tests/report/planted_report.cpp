#include "planted_report.hpp"

#include "planted.hpp"
#include "report/join_pictures.hpp"

namespace rejoin::report {
namespace {

ReportFragment fragment(std::string name, mesh::Mesh mesh) {
  ReportFragment result;
  result.name = std::move(name);
  result.path = "scans/" + result.name;
  result.faces = mesh.faces.size();
  result.diameter = mesh::diameter(mesh);
  result.mesh = std::move(mesh);
  return result;
}

void place(ReportFragment& fragment, const Rigid& pose, int group, double confidence) {
  fragment.pose = pose;
  fragment.group = group;
  fragment.confidence = confidence;
}

}  // namespace

RunReport planted_report() {
  const Planted pair = planted_pair();
  RunReport report;
  report.title = "A <b>run</b> & \"more\"</title><script>window.hacked = 1</script>";
  report.fragments.push_back(fragment(
      "</script><script>window.hacked = 2</script><img src=x onerror=window.hacked=3>.ply", pair.a.surface));
  report.fragments.push_back(fragment(
      "\xd7\xa9\xd7\x91\xd7\xa8 \xe2\x80\xae\xff\xfe'\"`${window.hacked=4}\n\t.ply", pair.b.surface));
  report.fragments.push_back(fragment(std::string(5000, 'W') + "<!--.ply", ball(0.5F, 20)));
  report.fragments.push_back(
      fragment("\xe7\xa2\x8e\xe7\x89\x87 \xf0\x9f\x8f\xba constructor __proto__.ply", ball(0.4F, 20)));
  place(report.fragments[0], {axis_rotation({0, 0, 1}, 0.4), {1000, 2000, 3000}}, 0, 0.95);
  place(report.fragments[1], *report.fragments[0].pose * pair.pose, 0, 0.7);
  place(report.fragments[2], Rigid{}, 1, 1.0);
  report.fragments[3].reason = "no joint <i>was</i> sure enough";
  report.pairs.push_back(
      {0, 1, 0.97, "join", true, pair.pose, {{"median <gap>", 0.01}, {"ray-cast slope", 1.0 / 0.0}}, {}});
  report.pairs.push_back({2, 3, 0.4, "unsure", false, std::nullopt, {{"median gap", 0.2}}, {}});
  report.pairs.push_back({3, 0, 0.02, "no join", false, std::nullopt, {}, {}});
  report.parameters = {{"seed", "1"}, {"<script>window.hacked = 5</script>", "javascript:window.hacked=6"}};
  report.warnings = {"<svg onload=window.hacked=7> has no faces"};
  report.constraints.must_not_join = {{2, 0}};
  report.constraints.pinned = {{2, {glm::dmat3(1.0), {0.1, -2, 3e12}}}};
  return report;
}

RunReport long_row(int count, int rings) {
  const mesh::Mesh piece = ball(1, rings);
  std::vector<ReportPicture> pictures;
  RunReport report;
  report.title = "row";
  for (int k = 0; k < count; ++k) {
    report.fragments.push_back(fragment("ball " + std::to_string(k), piece));
    place(report.fragments.back(), {glm::dmat3(1.0), {1.99 * k, 0, 0}}, 0, 0.9);
    if (k == 0) continue;
    const auto a = static_cast<std::size_t>(k - 1);
    const Rigid pose{glm::dmat3(1.0), {1.99, 0, 0}};
    report.pairs.push_back({a, a + 1, 0.9, "join", true, pose, {{"median gap", 0.1}}, {}});
    // All joints look the same.
    if (k == 1)
      pictures = join_pictures(make_joint(piece, piece, pose, glm::dvec3(0.0), mesh::resolution(piece)));
    report.pairs.back().pictures = pictures;
  }
  return report;
}

}  // namespace rejoin::report
