#include "zbuffer/detail/raster_kernel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "zbuffer/detail/drawable.hpp"
#include "zbuffer/detail/fixed_triangle.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "zbuffer/detail/raster_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rejoin::zbuffer::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kSoupBlock>;
using Ints = hn::Rebind<std::int32_t, Floats>;
using Unsigneds = hn::RebindToUnsigned<Ints>;
using FloatV = hn::Vec<Floats>;
using IntV = hn::Vec<Ints>;
using IntM = hn::Mask<Ints>;

/// A triangle whose covered box is at most this many pixels wide and high is drawn together with others, one
/// lane each; the others are drawn alone.
constexpr int kSmall = 24;
/// Longest side of the box of a triangle, in grid steps, for which edge functions fit into 32 bits.
constexpr int kNarrow = 1 << 15;
static_assert(kSmall * kSubpixels < kNarrow);

/// Pixels that small triangles cover and that the map does not know yet.  They wait for those of other triangles, so that
/// nothing reads them right after they were written, and that the end of the loop over them is mispredicted once for many.
struct Fragments {
  static constexpr std::size_t kEnough = 1024;
  /// A vector of triangles yields at most kSmall^2 times its lanes, and another vector may be written behind the last.
  static constexpr std::size_t kRoom = kEnough + (kSmall * kSmall + 1) * kSoupBlock;

  std::size_t count = 0;
  HWY_ALIGN std::uint32_t index[kRoom];
  HWY_ALIGN float depth[kRoom];
};

HWY_INLINE void flush(Fragments& fragments, float* map) {
#pragma GCC unroll 4
  for (std::size_t k = 0; k < fragments.count; ++k) {
    // By value, so that the compiler takes a minimum instead of a branch that nothing can predict.
    float& pixel = map[fragments.index[k]];
    const float before = pixel;
    const float depth = fragments.depth[k];
    pixel = depth < before ? depth : before;
  }
  fragments.count = 0;
}

/// A vector of triangles on the grid of fixed_triangle.hpp.
struct Corners {
  IntV x0, y0, x1, y1, x2, y2;
  FloatV z0, z1, z2;
};

/// Pixels whose centres lie in the triangles' boxes and on the canvas: first column and row, and how many
/// more follow (negative: none).
struct Boxes {
  IntV left, top, more_columns, more_rows;
};

/// The same operations in the same order as Projection.
HWY_INLINE FloatV row_of(const Projection& p, int r, FloatV x, FloatV y, FloatV z) {
  const Floats d;
  const auto sum = hn::Add(hn::Mul(hn::Set(d, p.linear[0][r]), x), hn::Mul(hn::Set(d, p.linear[1][r]), y));
  return hn::Add(hn::Add(sum, hn::Mul(hn::Set(d, p.linear[2][r]), z)), hn::Set(d, p.offset[r]));
}

HWY_INLINE void corner_of(const float* at, const Projection& p, IntV& x, IntV& y, FloatV& z) {
  const Floats d;
  const auto grid = hn::Set(d, static_cast<float>(kSubpixels));
  const auto vx = hn::LoadU(d, at);
  const auto vy = hn::LoadU(d, at + kSoupBlock);
  const auto vz = hn::LoadU(d, at + 2 * kSoupBlock);
  x = hn::NearestInt(hn::Mul(row_of(p, 0, vx, vy, vz), grid));
  y = hn::NearestInt(hn::Mul(row_of(p, 1, vx, vy, vz), grid));
  z = row_of(p, 2, vx, vy, vz);
}

/// First pixel whose centre is not below the grid coordinate; last one not above it.
HWY_INLINE IntV first_centre(IntV low) {
  return hn::ShiftRight<10>(hn::Add(low, hn::Set(Ints(), kSubpixels / 2 - 1)));
}
HWY_INLINE IntV last_centre(IntV high) {
  return hn::ShiftRight<10>(hn::Sub(high, hn::Set(Ints(), kSubpixels / 2)));
}
static_assert(kSubpixels == 1 << 10);

// Moves the chosen lanes to the front.  Highway's own way copies a table of 1 KB to the stack at every call where the
// processor has no instruction for it: two thirds of the time of a depth map.
#if HWY_TARGET <= HWY_AVX3 || HWY_HAVE_SCALABLE || HWY_TARGET == HWY_SCALAR
template <class V>
HWY_INLINE V to_front(V vector, IntM chosen) {
  return hn::Compress(vector, hn::RebindMask(hn::DFromV<V>(), chosen));
}
#else
static_assert(hn::MaxLanes(Ints()) <= 8);

/// Row m: the lanes whose bits are set in m, then the others.
constexpr auto kFrontLanes = [] {
  std::array<std::array<std::uint8_t, 8>, 256> rows{};
  for (unsigned m = 0; m < rows.size(); ++m) {
    std::size_t place = 0;
    for (const unsigned wanted : {1U, 0U}) {
      for (unsigned lane = 0; lane < 8; ++lane) {
        if (((m >> lane) & 1U) == wanted) rows[m][place++] = static_cast<std::uint8_t>(lane);
      }
    }
  }
  return rows;
}();

template <class V>
HWY_INLINE V to_front(V vector, IntM chosen) {
  const Ints d;
  std::uint8_t bits[8];
  hn::StoreMaskBits(d, chosen, bits);
  const auto lanes = hn::LoadU(hn::Rebind<std::uint8_t, Ints>(), kFrontLanes[bits[0]].data());
  return hn::TableLookupLanes(vector, hn::IndicesFromVec(hn::DFromV<V>(), hn::PromoteTo(d, lanes)));
}
#endif

/// E at the first pixel of the box of the edge (dx, dy) that starts at (x, y).
HWY_INLINE IntV edge_at(IntV dx, IntV dy, IntV x, IntV y, IntV px, IntV py) {
  return hn::Sub(hn::Mul(dx, hn::Sub(py, y)), hn::Mul(dy, hn::Sub(px, x)));
}

/// Edge::least().
HWY_INLINE IntV least_of(IntV dx, IntV dy) {
  const Ints d;
  const auto zero = hn::Zero(d);
  const auto belongs = hn::Or(hn::Lt(dy, zero), hn::And(hn::Eq(dy, zero), hn::Lt(dx, zero)));
  return hn::IfThenElse(belongs, zero, hn::Set(d, 1));
}

/// Draws the triangles of `small` in step: all visit the k-th pixel of their boxes at once.
HWY_INLINE void collect(Corners c, IntV area2, const Boxes& box, IntM small, int width, Fragments& to) {
  const Floats df;
  const Ints d;
  const auto clockwise = hn::Lt(area2, hn::Zero(d));
  const auto flip = [&](auto& p, auto& q, auto mask) HWY_ATTR {
    const auto kept = p;
    p = hn::IfThenElse(mask, q, p);
    q = hn::IfThenElse(mask, kept, q);
  };
  flip(c.x1, c.x2, clockwise);
  flip(c.y1, c.y2, clockwise);
  flip(c.z1, c.z2, hn::RebindMask(df, clockwise));
  area2 = hn::Abs(area2);

  const auto px = hn::Add(hn::ShiftLeft<10>(box.left), hn::Set(d, kSubpixels / 2));
  const auto py = hn::Add(hn::ShiftLeft<10>(box.top), hn::Set(d, kSubpixels / 2));
  const auto dx0 = hn::Sub(c.x2, c.x1), dy0 = hn::Sub(c.y2, c.y1);
  const auto dx1 = hn::Sub(c.x0, c.x2), dy1 = hn::Sub(c.y0, c.y2);
  const auto dx2 = hn::Sub(c.x1, c.x0), dy2 = hn::Sub(c.y1, c.y0);
  auto row1 = edge_at(dx1, dy1, c.x2, c.y2, px, py);
  auto row2 = edge_at(dx2, dy2, c.x0, c.y0, px, py);
  auto row0 = hn::Sub(hn::Sub(area2, row1), row2);
  const auto least0 = least_of(dx0, dy0), least1 = least_of(dx1, dy1), least2 = least_of(dx2, dy2);

  // Weights are exact integers over the area, so a depth never leaves the range of the corners' depths by
  // more than rounding, however thin the triangle.
  const auto inverse = hn::Div(hn::Set(df, 1.0F), hn::ConvertTo(df, area2));
  const auto rise1 = hn::Mul(hn::Sub(c.z1, c.z0), inverse);
  const auto rise2 = hn::Mul(hn::Sub(c.z2, c.z0), inverse);

  // Lanes that are not small get a negative term from the start, so that they never count as inside.
  auto rows_left = hn::IfThenElse(small, box.more_rows, hn::Set(d, -1));
  const auto columns_left = hn::IfThenElse(small, box.more_columns, hn::Set(d, -1));
  auto row_index = hn::Add(hn::Mul(box.top, hn::Set(d, width)), box.left);
  const auto one = hn::Set(d, 1);
  std::size_t count = to.count;
  while (!hn::AllTrue(d, hn::Lt(rows_left, hn::Zero(d)))) {
    auto e0 = row0, e1 = row1, e2 = row2, left = columns_left, index = row_index;
    while (!hn::AllTrue(d, hn::Lt(left, hn::Zero(d)))) {
      const auto outside =
          hn::Or(hn::Or(hn::Or(hn::Sub(e0, least0), hn::Sub(e1, least1)), hn::Sub(e2, least2)),
                 hn::Or(left, rows_left));
      const auto inside = hn::Gt(outside, hn::Set(d, -1));
      const auto depth = hn::Add(
          c.z0, hn::Add(hn::Mul(hn::ConvertTo(df, e1), rise1), hn::Mul(hn::ConvertTo(df, e2), rise2)));
      hn::StoreU(hn::BitCast(Unsigneds(), to_front(index, inside)), Unsigneds(), to.index + count);
      hn::StoreU(to_front(depth, inside), df, to.depth + count);
      count += hn::CountTrue(d, inside);
      e0 = hn::Sub(e0, hn::ShiftLeft<10>(dy0));
      e1 = hn::Sub(e1, hn::ShiftLeft<10>(dy1));
      e2 = hn::Sub(e2, hn::ShiftLeft<10>(dy2));
      left = hn::Sub(left, one);
      index = hn::Add(index, one);
    }
    row0 = hn::Add(row0, hn::ShiftLeft<10>(dx0));
    row1 = hn::Add(row1, hn::ShiftLeft<10>(dx1));
    row2 = hn::Add(row2, hn::ShiftLeft<10>(dx2));
    rows_left = hn::Sub(rows_left, one);
    row_index = hn::Add(row_index, hn::Set(d, width));
  }
  to.count = count;
}

/// Draws the triangles of `lanes` one by one.
HWY_NOINLINE void draw_alone(const Corners& c, IntM lanes, const Canvas& canvas) {
  const Floats df;
  const Ints d;
  HWY_ALIGN std::int32_t xy[6][kSoupBlock];
  HWY_ALIGN float z[3][kSoupBlock];
  HWY_ALIGN std::int32_t chosen[kSoupBlock];
  hn::Store(c.x0, d, xy[0]);
  hn::Store(c.y0, d, xy[1]);
  hn::Store(c.x1, d, xy[2]);
  hn::Store(c.y1, d, xy[3]);
  hn::Store(c.x2, d, xy[4]);
  hn::Store(c.y2, d, xy[5]);
  hn::Store(c.z0, df, z[0]);
  hn::Store(c.z1, df, z[1]);
  hn::Store(c.z2, df, z[2]);
  hn::Store(hn::VecFromMask(d, lanes), d, chosen);
  for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
    if (chosen[k] == 0) continue;
    FixedTriangle triangle{
        {xy[0][k], xy[2][k], xy[4][k]}, {xy[1][k], xy[3][k], xy[5][k]}, {z[0][k], z[1][k], z[2][k]}, 0};
    if (orient(triangle)) fill(triangle, canvas);
  }
}

/// The sides of triangles that are drawn, by the sign of their doubled areas.
enum class Sides { Both, Positive, Negative };

/// Draws one vector of triangles whose first corner's x starts at `at`.
HWY_INLINE void draw_vector(const float* at, Sides sides, const Projection& projection, const Canvas& canvas,
                            Fragments& fragments) {
  const Ints d;
  Corners c;
  corner_of(at, projection, c.x0, c.y0, c.z0);
  corner_of(at + 3 * kSoupBlock, projection, c.x1, c.y1, c.z1);
  corner_of(at + 6 * kSoupBlock, projection, c.x2, c.y2, c.z2);
  const auto low_x = hn::Min(hn::Min(c.x0, c.x1), c.x2), high_x = hn::Max(hn::Max(c.x0, c.x1), c.x2);
  const auto low_y = hn::Min(hn::Min(c.y0, c.y1), c.y2), high_y = hn::Max(hn::Max(c.y0, c.y1), c.y2);
  Boxes box;
  box.left = hn::Max(first_centre(low_x), hn::Zero(d));
  box.top = hn::Max(first_centre(low_y), hn::Zero(d));
  box.more_columns = hn::Sub(hn::Min(last_centre(high_x), hn::Set(d, canvas.width - 1)), box.left);
  box.more_rows = hn::Sub(hn::Min(last_centre(high_y), hn::Set(d, canvas.height - 1)), box.top);
  const auto visible = hn::Gt(hn::Or(box.more_columns, box.more_rows), hn::Set(d, -1));
  if (hn::AllFalse(d, visible)) return;
  const auto extent = hn::Max(hn::Sub(high_x, low_x), hn::Sub(high_y, low_y));
  const auto fits = hn::And(hn::Lt(hn::Max(box.more_columns, box.more_rows), hn::Set(d, kSmall)),
                            hn::Lt(extent, hn::Set(d, kNarrow)));
  if (!hn::AllTrue(d, hn::Or(fits, hn::Not(visible)))) draw_alone(c, hn::AndNot(fits, visible), canvas);
  const auto area2 = hn::Sub(hn::Mul(hn::Sub(c.x1, c.x0), hn::Sub(c.y2, c.y0)),
                             hn::Mul(hn::Sub(c.x2, c.x0), hn::Sub(c.y1, c.y0)));
  const auto zero = hn::Zero(d);
  const auto turned_here = sides == Sides::Both       ? hn::Ne(area2, zero)
                           : sides == Sides::Positive ? hn::Gt(area2, zero)
                                                      : hn::Lt(area2, zero);
  const auto small = hn::And(hn::And(fits, visible), turned_here);
  if (hn::AllFalse(d, small)) return;
  collect(c, area2, box, small, canvas.width, fragments);
  if (fragments.count >= Fragments::kEnough) flush(fragments, canvas.depth);
}

const char* target_name() {
  return hwy::TargetName(HWY_TARGET);
}

void draw_block(const float* block, Sides sides, const Projection& projection, const Canvas& canvas,
                Fragments& fragments) {
  for (std::size_t lane = 0; lane < kSoupBlock; lane += hn::Lanes(Floats())) {
    draw_vector(block + lane, sides, projection, canvas, fragments);
  }
}

void draw_blocks(const TriangleSoup& soup, const Projection& projection, const Canvas& canvas) {
  Fragments fragments;
  const Gaze gaze = gaze_of(projection);
  const bool looks = gaze.along != glm::vec3(0.0F);
  const Sides front = !looks ? Sides::Both : gaze.mirrored ? Sides::Positive : Sides::Negative;
  const float* block = soup.blocks.data();
  for (const TriangleSoup::Cone& cone : soup.cones) {
    const bool looks_away = glm::dot(cone.axis, gaze.along) > cone.sine;
    if (!looks_away) draw_block(block, front, projection, canvas, fragments);
    block += 9 * kSoupBlock;
  }
  for (const float* end = soup.blocks.data() + soup.blocks.size(); block != end; block += 9 * kSoupBlock) {
    draw_block(block, Sides::Both, projection, canvas, fragments);
  }
  flush(fragments, canvas.depth);
}

}  // namespace rejoin::zbuffer::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rejoin::zbuffer::detail {
namespace {

HWY_EXPORT(draw_blocks);
HWY_EXPORT(target_name);

bool within_reach(const TriangleSoup& soup, const Projection& projection) {
  const mesh::Box box = projected(soup.box, projection);
  // Half the reach leaves room for the rounding of points inside the box.  A pose that is not finite is out
  // of reach.
  constexpr float kFar = kReach / 2;
  return box.low.x > -kFar && box.low.y > -kFar && box.high.x < kFar && box.high.y < kFar &&
         std::isfinite(box.low.z) && std::isfinite(box.high.z);
}

void draw_one_by_one(const TriangleSoup& soup, const Projection& projection, const Canvas& canvas) {
  for (std::size_t k = 0; k < soup.block_count() * kSoupBlock; ++k) {
    const float* at = soup.blocks.data() + k / kSoupBlock * 9 * kSoupBlock + k % kSoupBlock;
    glm::vec3 corners[3];
    for (glm::vec3& corner : corners) {
      corner = projection({at[0], at[kSoupBlock], at[2 * kSoupBlock]});
      at += 3 * kSoupBlock;
    }
    if (const auto triangle = snap(corners[0], corners[1], corners[2])) fill(*triangle, canvas);
  }
}

}  // namespace

void draw_soup(const TriangleSoup& soup, const Projection& projection, const Canvas& canvas) {
  if (within_reach(soup, projection)) {
    HWY_DYNAMIC_DISPATCH(draw_blocks)(soup, projection, canvas);
  } else {
    draw_one_by_one(soup, projection, canvas);
  }
}

std::string instruction_set() {
  return HWY_DYNAMIC_DISPATCH(target_name)();
}

}  // namespace rejoin::zbuffer::detail
#endif
