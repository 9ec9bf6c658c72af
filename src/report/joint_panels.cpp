#include "report/joint_panels.hpp"

#include <algorithm>

#include "report/colour_scale.hpp"

namespace rejoin::report {
namespace {

constexpr double kFov = 18;  ///< degrees, of the shaded views

/// Seen a little from above, so that the pieces look solid.
glm::dvec3 raised(const glm::dvec3& back, const glm::dvec3& up) {
  return glm::normalize(back + 0.35 * up);
}

/// An orthographic camera that looks at the contact, or at the whole fragment where there is none.
Camera page_camera(const Joint& joint, const Body& body, const Book& book, const glm::dvec3& back,
                   const glm::dvec3& right) {
  constexpr double kRoom = 1.12;
  const Area& page = book.a;
  const glm::dvec3 up = glm::cross(back, right);
  if (joint.contact.area <= 0)
    return fit_camera({body}, back, up, static_cast<double>(page.width) / page.height);
  Camera camera;
  camera.target = joint.centre;
  camera.right = right;
  camera.up = up;
  camera.half_height = kRoom / 2 * page.height / book.scale(joint);
  return camera;
}

Image gap_view(const Joint& joint, const Book& book, bool of_a) {
  Body body = joined_bodies(joint)[of_a ? 0 : 1];
  body.vertex_colours = gap_colours(of_a ? joint.gap_a : joint.gap_b, joint.scale);
  RenderOptions options;
  options.width = book.a.width;
  options.height = book.a.height;
  options.ambient_rays = 0;
  options.relief = 0.35;  // enough to see the relief, little enough to read the colours
  const glm::dvec3 back = of_a ? joint.normal : -joint.normal;
  const glm::dvec3 right = book.stacked ? joint.along : of_a ? joint.across : -joint.across;
  return Scene({body}).render(page_camera(joint, body, book, back, right), options);
}

}  // namespace

Image shaded_panel(const Scene& scene, const std::vector<Body>& bodies, const Eye& eye,
                   const PanelOptions& options) {
  RenderOptions render;
  render.width = options.width;
  render.height = options.height;
  render.ambient_rays = options.ambient_rays;
  const double aspect = static_cast<double>(options.width) / options.height;
  return scene.render(fit_camera(bodies, eye.back, eye.up, aspect, kFov), render);
}

Image apart_panel(const Joint& joint, const JointViews& views, const PanelOptions& options) {
  const glm::dvec3 up = up_for(joint, views.across);
  const std::vector<Body> opened = opened_bodies(joint, views.across);
  return shaded_panel(Scene(opened), opened, {raised(views.across, up), up}, options);
}

double Book::scale(const Joint& joint) const {
  const double wide = stacked ? joint.length : joint.width;
  const double high = stacked ? joint.width : joint.length;
  return std::min(a.width / std::max(wide, 1e-30), a.height / std::max(high, 1e-30));
}

Book open_book(const Joint& joint, int width, int height) {
  const Area area{0, 0, width, height};
  Book stacked{true, area, area};
  stacked.a.height = stacked.b.height = height / 2;
  stacked.b.y += height / 2;
  Book beside{false, area, area};
  beside.a.width = beside.b.width = width / 2;
  beside.b.x += width / 2;
  return stacked.scale(joint) >= beside.scale(joint) ? stacked : beside;
}

Image book_panel(const Joint& joint, const Book& book) {
  Image panel(std::max(book.a.x + book.a.width, book.b.x + book.b.width),
              std::max(book.a.y + book.a.height, book.b.y + book.b.height), kPaper);
  paste(panel, gap_view(joint, book, true), book.a.x, book.a.y);
  paste(panel, gap_view(joint, book, false), book.b.x, book.b.y);
  const int width = book.stacked ? book.b.width - 16 : 1;
  const int height = book.stacked ? 1 : book.b.height - 16;
  fill(panel, {book.b.x + (book.stacked ? 8 : 0), book.b.y + (book.stacked ? 0 : 8), width, height},
       {150, 152, 158});
  return panel;
}

std::vector<Colour> gap_colours(const std::vector<float>& gaps, double scale) {
  std::vector<Colour> result(gaps.size());
  std::transform(gaps.begin(), gaps.end(), result.begin(),
                 [&](float gap) { return gap_colour(gap / scale); });
  return result;
}

}  // namespace rejoin::report
