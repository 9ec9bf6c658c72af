#include "report/join_pictures.hpp"

#include <algorithm>
#include <string>

#include "report/colour_scale.hpp"
#include "report/depth_pictures.hpp"
#include "report/joint_maps.hpp"
#include "report/joint_panels.hpp"
#include "report/section.hpp"

namespace rejoin::report {
namespace {

constexpr int kMapResolution = 192;  ///< a joint of half the view's width still has 100 pixels

ReportPicture picture(std::string title, const Image& image, int quality) {
  return {std::move(title), image.width, image.height, encode_jpeg(image, quality)};
}

/// The map in colours, fitted into side x 1.4 side.
Image fitted_map(const zbuffer::DepthMap& map, const MapWindow& window, int side, const ColourBar& bar) {
  const double zoom = std::min(1.4 * side / window.width, 1.0 * side / window.height);
  return map_pixels(map, window, std::max(1.0, zoom), bar);
}

void add_maps(std::vector<ReportPicture>& pictures, const Joint& joint, const JoinPictureOptions& options) {
  const JointMaps maps = make_maps(joint, kMapResolution);
  if (maps.score.overlap == 0) return;
  const MapWindow window = covered_window({&maps.a, &maps.b}, 3);
  const auto add_heights = [&](const char* title, const zbuffer::DepthMap& map) {
    const auto [near, far] = robust_range(within_joint(map, maps.difference), 0.02);
    const ColourBar bar{even_colour, 0, far > near ? far - near : 1, false, ""};
    pictures.push_back(
        picture(title, fitted_map(heights(map, far), window, options.side, bar), options.quality));
  };
  add_heights("Depth of A, seen from B", maps.a);
  add_heights("Depth of B, mirrored", maps.b);
  const ColourBar bar{difference_colour, 0, difference_scale(maps), false, ""};
  pictures.push_back(picture("Slope difference, bright above " + short_number(bar.high),
                             fitted_map(maps.difference, window, options.side, bar), options.quality));
}

}  // namespace

std::vector<ReportPicture> join_pictures(const Joint& joint, const JoinPictureOptions& options) {
  const PanelOptions panel{options.side * 4 / 3, options.side, options.ambient_rays};
  const std::vector<Body> joined = joined_bodies(joint);
  const Scene scene(joined);
  const JointViews views = choose_views(joint, scene);
  const Eye best{views.best, up_for(joint, views.best)};
  std::vector<ReportPicture> pictures;
  const auto add = [&](const std::string& title, const Image& image) {
    pictures.push_back(picture(title, image, options.quality));
  };
  add("Joined", shaded_panel(scene, joined, best, panel));
  add("Apart, A left", apart_panel(joint, views, panel));
  add("Broken faces by gap: red overlaps, blue gapes by " + short_number(joint.scale) +
          " or more, grey has no contact",
      book_panel(joint, open_book(joint, panel.width, panel.height)));
  add("Cut through the joint", draw_section(joint, panel.width, panel.height));
  add_maps(pictures, joint, options);
  return pictures;
}

}  // namespace rejoin::report
