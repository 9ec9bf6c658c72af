#include "report/similarity_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/canvas.hpp"
#include "report/colour_scale.hpp"

namespace rejoin::report {
namespace {

constexpr int kSquare = 860;  ///< about the side of all cells together, pixels
constexpr int kLeastCell = 3;
constexpr int kMostCell = 40;
constexpr int kLeastNames = 170;  ///< room for names, left and above
constexpr int kMostNames = 360;
constexpr int kNameMargin = 16;
constexpr int kTitle = 40;
constexpr int kScale = 250;  ///< room for the scale on the right
constexpr int kFoot = 104;
constexpr int kLeastHeight = 260;
constexpr double kNameHeight = 10.0;
constexpr Colour kNothing{234, 234, 236};
constexpr Colour kUsed{214, 40, 40};

/// The cells' place in the picture.
struct Grid {
  int count = 0;
  int cell = 1;
  int names = kLeastNames;

  int x(std::size_t column) const { return names + static_cast<int>(column) * cell; }
  int y(std::size_t row) const { return kTitle + names + static_cast<int>(row) * cell; }
  int side() const { return count * cell; }
  /// Every how many pieces a name has room.
  std::size_t stride() const { return static_cast<std::size_t>(std::ceil((kNameHeight + 3.0) / cell)); }
};

/// A name that reads upwards, ending at (x, y).
void draw_upwards(Image& image, int x, int y, const std::string& text, const TextStyle& style) {
  Image label(static_cast<int>(std::ceil(text_width(text, style))) + 2, static_cast<int>(2.0 * style.height),
              kPaper);
  draw_text(label, 0, 1.4 * style.height, text, style);
  Image turned(label.height, label.width, kPaper);
  for (int row = 0; row < label.height; ++row) {
    for (int column = 0; column < label.width; ++column)
      turned.at(row, label.width - 1 - column) = label.at(column, row);
  }
  paste(image, turned, x - static_cast<int>(1.4 * style.height), y - label.width);
}

void draw_names(Image& image, const Grid& grid, const std::vector<outline::Piece>& pieces) {
  const TextStyle left{kNameHeight, kInk, Align::Right};
  const TextStyle above{kNameHeight, kInk};
  for (std::size_t i = 0; i < pieces.size(); i += grid.stride()) {
    const double middle = 0.5 * (grid.cell + kNameHeight);
    const std::string name = fitted(pieces[i].name, above, grid.names - kNameMargin);
    draw_text(image, grid.names - 6, grid.y(i) + middle, name, left);
    draw_upwards(image, static_cast<int>(grid.x(i) + middle), grid.y(0) - 6, name, above);
  }
}

void draw_cells(Image& image, const Grid& grid, const outline::Assembly& assembly, double top) {
  fill(image, {grid.x(0), grid.y(0), grid.side(), grid.side()}, kNothing);
  const int line = grid.cell >= 8 ? 1 : 0;
  const auto draw = [&](std::size_t row, std::size_t column, double length) {
    if (length > 0.0)
      fill(image, {grid.x(column), grid.y(row), grid.cell - line, grid.cell - line},
           even_colour(length / top));
  };
  const std::size_t count = assembly.similarity.size();
  for (std::size_t row = 0; row < count; ++row) {
    for (std::size_t column = row + 1; column < count; ++column)
      draw(row, column, assembly.similarity[row][column]);
    fill(image, {grid.x(row), grid.y(row), grid.cell - line, grid.cell - line}, kFaint);
  }
  for (const outline::AssemblyJoin& join : assembly.joins) {
    const auto [first, second] = std::minmax(join.a, join.b);
    draw(second, first, join.contact);
    for (int width = 0; width < std::clamp(grid.cell / 8, 1, 3); ++width) {
      const int size = grid.cell - line - 2 * width;
      outline(image, {grid.x(second) + width, grid.y(first) + width, size, size}, kUsed);
    }
  }
}

void draw_legend(Image& image, const Grid& grid, double top) {
  const int right = grid.x(0) + grid.side() + 40;
  const TextStyle text{11, kInk};
  const ColourBar bar{even_colour, 0.0, top, false, "length, files' unit"};
  draw_bar(image, {right, grid.y(0) + 30, 24, std::max(kLeastHeight, grid.side()) - 60}, bar, 11);
  const int foot = image.height - kFoot;
  draw_text(image, 20, foot + 26,
            "above the diagonal: common border of each pair's best candidate, used or not", text);
  outline(image, {20, foot + 40, 14, 14}, kUsed);
  outline(image, {21, foot + 41, 12, 12}, kUsed);
  draw_text(image, 44, foot + 52, "joined in the assembly", text);
  draw_text(image, 20, foot + 78, "below the diagonal: contact of the joins in the assembly; grey: none",
            text);
}

}  // namespace

void write_similarity_picture(const std::filesystem::path& path, const std::vector<outline::Piece>& pieces,
                              const outline::Assembly& assembly) {
  Grid grid{static_cast<int>(pieces.size())};
  grid.cell = std::clamp(kSquare / std::max(1, grid.count), kLeastCell, kMostCell);
  for (const outline::Piece& piece : pieces) {
    const double width = text_width(piece.name, {kNameHeight, kInk});
    grid.names = std::clamp(static_cast<int>(std::ceil(width)) + kNameMargin, grid.names, kMostNames);
  }
  double top = 0.0;
  for (const std::vector<double>& row : assembly.similarity)
    for (const double length : row) top = std::max(top, length);
  for (const outline::AssemblyJoin& join : assembly.joins) top = std::max(top, join.contact);
  if (top <= 0.0) top = 1.0;
  const int width = std::max(820, grid.names + grid.side() + kScale);
  const int height = kTitle + grid.names + std::max(kLeastHeight, grid.side()) + kFoot;
  Image image(width, height, kPaper);
  draw_text(image, 20, 30, "Common borders of the pairs", {15, kInk, Align::Left, true});
  draw_cells(image, grid, assembly, top);
  draw_names(image, grid, pieces);
  draw_legend(image, grid, top);
  write_png(path, image);
}

}  // namespace rejoin::report
