#include "report/numbered_picture.hpp"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "report/canvas.hpp"

namespace rejoin::report {
namespace {

constexpr int kPanel = 480;
constexpr int kTop = 64;
constexpr double kRoom = 7;  // pixels from its number to a part's border, for a number in every view

struct View {
  glm::dvec3 back;
  glm::dvec3 up;
};

constexpr double kLift = 0.3;  // the eye is a little above, so that edges between faces can be seen

std::array<View, 6> six_sides() {
  const glm::dvec3 x(1, 0, 0);
  const glm::dvec3 y(0, 1, 0);
  const glm::dvec3 z(0, 0, 1);
  return {{{glm::normalize(z + kLift * y), y},
           {glm::normalize(x + kLift * y), y},
           {glm::normalize(y + kLift * x), -z},
           {glm::normalize(-z + kLift * y), y},
           {glm::normalize(-x + kLift * y), y},
           {glm::normalize(-y - kLift * x), z}}};
}

/// Upper left corner of a view, pixels.
glm::ivec2 corner_of(int panel) {
  const int row = panel / 3;
  return {(panel % 3) * kPanel, kTop + row * kPanel};
}

/// The number on a bright rim, so that it can be read on any colour.
void draw_number(Image& image, const glm::dvec2& at, int number) {
  constexpr double kHalf = 6;  // of the height of a digit
  constexpr double kRim = 2;
  const std::string text = std::to_string(number);
  for (const glm::dvec2 d :
       {glm::dvec2(-1, 0), {1, 0}, {0, -1}, {0, 1}, {-0.7, -0.7}, {-0.7, 0.7}, {0.7, -0.7}, {0.7, 0.7}}) {
    draw_text(image, at.x + kRim * d.x, at.y + kHalf + kRim * d.y, text,
              {2 * kHalf, Colour(255), Align::Middle, true});
  }
  draw_text(image, at.x, at.y + kHalf, text, {2 * kHalf, kInk, Align::Middle, true});
}

/// Numbers in the views where they have room; else in the one where they have most.
std::vector<std::vector<PartLabel>> chosen_labels(std::vector<std::vector<PartLabel>> views,
                                                  std::size_t parts) {
  std::vector<double> most(parts, 0.0);
  for (const auto& labels : views) {
    for (const PartLabel& label : labels) {
      double& room = most[static_cast<std::size_t>(label.part)];
      room = std::max(room, label.room);
    }
  }
  for (auto& labels : views) {
    const auto cramped = [&](const PartLabel& label) {
      return label.room < kRoom && label.room < most[static_cast<std::size_t>(label.part)];
    };
    labels.erase(std::remove_if(labels.begin(), labels.end(), cramped), labels.end());
  }
  return views;
}

}  // namespace

std::vector<PartLabel> part_labels(const Visibility& seen, const std::vector<int>& part_of_face) {
  // One step of paper all around: the picture's edge is a border, too.
  cv::Mat part(seen.height + 2, seen.width + 2, CV_32SC1, cv::Scalar(-1));
  int last = -1;
  for (int y = 0; y < seen.height; ++y) {
    for (int x = 0; x < seen.width; ++x) {
      const auto pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(seen.width) + static_cast<std::size_t>(x);
      if (seen.body[pixel] < 0) continue;
      part.at<int>(y + 1, x + 1) = part_of_face[seen.face[pixel]];
      last = std::max(last, part.at<int>(y + 1, x + 1));
    }
  }
  std::vector<PartLabel> labels;
  for (int number = 0; number <= last; ++number) {
    const cv::Mat mask = part == number;
    cv::Mat room;
    cv::distanceTransform(mask, room, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    double most = 0;
    cv::Point at;
    cv::minMaxLoc(room, nullptr, &most, nullptr, &at);
    if (most > 0) labels.push_back({number, at.x - 1, at.y - 1, most});
  }
  return labels;
}

Image numbered_picture(const mesh::Mesh& surface, const NumberedPicture& what) {
  Body body;
  body.mesh = &surface;
  body.face_colours.reserve(what.part_of_face.size());
  for (const int part : what.part_of_face) body.face_colours.push_back(what.colour(part));
  const std::vector<Body> bodies{body};
  const Scene scene(bodies);
  Image image(3 * kPanel, kTop + 2 * kPanel, kPaper);
  draw_text(image, 16, 28, fitted(what.title, {15, kInk, Align::Left, true}, 3 * kPanel - 32),
            {15, kInk, Align::Left, true});
  draw_text(image, 16, 52, what.subtitle, {12, kFaint, Align::Left, false});
  RenderOptions options;
  options.width = options.height = kPanel;
  options.relief = 0.8;
  std::vector<std::vector<PartLabel>> labels;
  for (const View& view : six_sides()) {
    const int panel = static_cast<int>(labels.size());
    const Camera camera = scene.overview(view.back, view.up);
    const glm::ivec2 corner = corner_of(panel);
    paste(image, scene.render(camera, options), corner.x, corner.y);
    labels.push_back(part_labels(scene.look(camera, kPanel, kPanel), what.part_of_face));
  }
  const int last = *std::ranges::max_element(what.part_of_face);
  labels = chosen_labels(std::move(labels), static_cast<std::size_t>(last) + 1);
  for (int panel = 0; panel < static_cast<int>(labels.size()); ++panel) {
    for (const PartLabel& label : labels[static_cast<std::size_t>(panel)]) {
      draw_number(image, glm::dvec2(corner_of(panel) + glm::ivec2(label.x, label.y)) + 0.5,
                  what.first + label.part);
    }
  }
  return image;
}

}  // namespace rejoin::report
