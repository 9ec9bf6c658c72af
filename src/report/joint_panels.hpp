/// Pictures of a joint without captions, for the sheet of a match and the page of a run.
#pragma once

#include <vector>

#include "report/canvas.hpp"
#include "report/joint.hpp"
#include "report/views.hpp"

namespace rejoin::report {

/// From where a shaded panel is seen.
struct Eye {
  glm::dvec3 back;  ///< direction towards the eye, unit
  glm::dvec3 up;    ///< roughly up in the picture
};

struct PanelOptions {
  int width = 640;  ///< pixels
  int height = 480;
  int ambient_rays = 4;  ///< as in RenderOptions
};

/// Bodies in perspective, as large as the picture permits.
/// \param scene  made of the same bodies
Image shaded_panel(const Scene& scene, const std::vector<Body>& bodies, const Eye& eye,
                   const PanelOptions& options);

/// The fragments opened like the covers of a book, A left, broken faces turned to the eye.
Image apart_panel(const Joint& joint, const JointViews& views, const PanelOptions& options);

/// Where the two broken faces go: one above the other, or side by side.
struct Book {
  bool stacked = false;
  Area a;
  Area b;

  /// Pixels a mesh unit at which a contact of that length and width fits into one page.
  double scale(const Joint& joint) const;
};

/// The arrangement that shows the contact larger.
Book open_book(const Joint& joint, int width, int height);

/// Both broken faces face on, by gap; what touches lies mirrored about the fold.
Image book_panel(const Joint& joint, const Book& book);

/// The colours of the gaps of one fragment's vertices; grey where there is no contact.
/// \param scale  |gap| of the strongest colours, mesh units
std::vector<Colour> gap_colours(const std::vector<float>& gaps, double scale);

}  // namespace rejoin::report
