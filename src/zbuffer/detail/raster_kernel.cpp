#include "zbuffer/detail/raster_kernel.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "zbuffer/detail/drawable.hpp"
#include "zbuffer/detail/fixed_triangle.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "zbuffer/detail/raster_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "zbuffer/detail/raster_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace rejoin::zbuffer::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Longest side of the box of a triangle, in grid steps, for which edge functions fit into 32 bits.
constexpr int kNarrow = 1 << 15;
static_assert(kSmall * kSubpixels < kNarrow);

/// Corners closer to the map's origin than this many pixels are rounded to the grid by one addition.
constexpr float kNear = 4000.0F;
/// A float of this size has steps of 1: whoever adds a smaller number has the nearest integer in the lowest bits.
constexpr float kRounder = 12582912.0F;
constexpr std::int32_t kRounderBits = 0x4B400000;
static_assert(kNear * kSubpixels < kRounder / 3);

/// One corner of each of a vector of triangles, on the grid of fixed_triangle.hpp.
struct Corner {
  IntV x, y;  ///< kRounderBits more than they are: it cancels in differences
  FloatV z;
};

/// The same operations in the same order as Projection.
HWY_INLINE FloatV row_of(const Projection& p, int r, FloatV x, FloatV y, FloatV z) {
  const Floats d;
  const auto sum = hn::Add(hn::Mul(hn::Set(d, p.linear[0][r]), x), hn::Mul(hn::Set(d, p.linear[1][r]), y));
  return hn::Add(hn::Add(sum, hn::Mul(hn::Set(d, p.linear[2][r]), z)), hn::Set(d, p.offset[r]));
}

template <bool kAllNear>
HWY_INLINE IntV to_grid(FloatV steps) {
  const Ints d;
  if constexpr (kAllNear) return hn::BitCast(d, hn::Add(steps, hn::Set(Floats(), kRounder)));
  return hn::Add(hn::NearestInt(steps), hn::Set(d, kRounderBits));
}

/// \param p  to grid steps in x and y
template <bool kAllNear>
HWY_INLINE Corner corner_of(const float* at, const Projection& p) {
  const Floats d;
  const auto x = hn::LoadU(d, at);
  const auto y = hn::LoadU(d, at + kSoupBlock);
  const auto z = hn::LoadU(d, at + 2 * kSoupBlock);
  return {to_grid<kAllNear>(row_of(p, 0, x, y, z)), to_grid<kAllNear>(row_of(p, 1, x, y, z)),
          row_of(p, 2, x, y, z)};
}

/// First pixel whose centre is not below the grid coordinate; last one not above it.
HWY_INLINE IntV first_centre(IntV low) {
  return hn::ShiftRight<10>(hn::Add(low, hn::Set(Ints(), kSubpixels / 2 - 1 - kRounderBits)));
}
HWY_INLINE IntV last_centre(IntV high) {
  return hn::ShiftRight<10>(hn::Sub(high, hn::Set(Ints(), kSubpixels / 2 + kRounderBits)));
}
/// Grid coordinate of the centre.
HWY_INLINE IntV centre_in(IntV pixel) {
  return hn::Add(hn::ShiftLeft<10>(pixel), hn::Set(Ints(), kSubpixels / 2 + kRounderBits));
}
static_assert(kSubpixels == 1 << 10);

/// -1 where the edge's least() is 0, else 0; for edges shorter than kNarrow.
HWY_INLINE IntV holds_zero(IntV dx, IntV dy) {
  return hn::ShiftRight<31>(hn::Add(hn::ShiftLeft<16>(dy), dx));
}
static_assert(kNarrow <= 1 << 15);

/// Draws the triangles of `lanes` one by one.
HWY_NOINLINE void draw_alone(const Corner (&corners)[3], IntM lanes, const Canvas& canvas) {
  const Floats df;
  const Ints d;
  HWY_ALIGN std::int32_t x[3][kSoupBlock];
  HWY_ALIGN std::int32_t y[3][kSoupBlock];
  HWY_ALIGN float z[3][kSoupBlock];
  HWY_ALIGN std::int32_t chosen[kSoupBlock];
  for (int k = 0; k < 3; ++k) {
    hn::Store(hn::Sub(corners[k].x, hn::Set(d, kRounderBits)), d, x[k]);
    hn::Store(hn::Sub(corners[k].y, hn::Set(d, kRounderBits)), d, y[k]);
    hn::Store(corners[k].z, df, z[k]);
  }
  hn::Store(hn::VecFromMask(d, lanes), d, chosen);
  for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
    if (chosen[k] == 0) continue;
    FixedTriangle triangle{
        {x[0][k], x[1][k], x[2][k]}, {y[0][k], y[1][k], y[2][k]}, {z[0][k], z[1][k], z[2][k]}, 0};
    if (orient(triangle)) fill(triangle, canvas);
  }
}

/// Pixels whose centres lie in the triangles' boxes and on the map.
struct Boxes {
  IntV left, top;
  IntV more_columns, more_rows;  ///< that follow the first; negative: none
  IntM visible;                  ///< has pixels
  IntM fits;                     ///< can be drawn by a Walk
  IntM whole;                    ///< lies on the map as a whole
};

HWY_INLINE Boxes boxes_of(const Corner& a, const Corner& b, const Corner& c, const Canvas& canvas) {
  const Ints d;
  const auto low_x = hn::Min(hn::Min(a.x, b.x), c.x), high_x = hn::Max(hn::Max(a.x, b.x), c.x);
  const auto low_y = hn::Min(hn::Min(a.y, b.y), c.y), high_y = hn::Max(hn::Max(a.y, b.y), c.y);
  const auto left = first_centre(low_x), top = first_centre(low_y);
  const auto right = last_centre(high_x), bottom = last_centre(high_y);
  const auto last_column = hn::Set(d, canvas.width - 1), last_row = hn::Set(d, canvas.height - 1);
  const auto not_negative = [&](IntV v) HWY_ATTR { return hn::Gt(v, hn::Set(d, -1)); };
  Boxes box;
  box.left = hn::Max(left, hn::Zero(d));
  box.top = hn::Max(top, hn::Zero(d));
  box.more_columns = hn::Sub(hn::Min(right, last_column), box.left);
  box.more_rows = hn::Sub(hn::Min(bottom, last_row), box.top);
  box.visible = not_negative(hn::Or(box.more_columns, box.more_rows));
  const auto extent = hn::Max(hn::Sub(high_x, low_x), hn::Sub(high_y, low_y));
  box.fits = hn::And(hn::Lt(hn::Max(box.more_columns, box.more_rows), hn::Set(d, kSmall)),
                     hn::Lt(extent, hn::Set(d, kNarrow)));
  box.whole =
      not_negative(hn::Or(hn::Or3(left, top, hn::Sub(last_column, right)), hn::Sub(last_row, bottom)));
  return box;
}

/// Counter-clockwise triangles.
struct Shapes {
  IntV dx1, dy1, dx2, dy2;  ///< of edges 1 and 2
  IntV area2;               ///< twice the area; <= 0: not to be drawn
  FloatV z0, z1, z2;
};

template <bool kOneSided>
HWY_INLINE Shapes shapes_of(const Corner& a, const Corner& b, const Corner& c) {
  const Floats df;
  const Ints d;
  Shapes t{.dx1 = hn::Sub(a.x, c.x),
           .dy1 = hn::Sub(a.y, c.y),
           .dx2 = hn::Sub(b.x, a.x),
           .dy2 = hn::Sub(b.y, a.y),
           .area2 = hn::Zero(d),
           .z0 = a.z,
           .z1 = b.z,
           .z2 = c.z};
  t.area2 = hn::Sub(hn::Mul(t.dx1, t.dy2), hn::Mul(t.dx2, t.dy1));
  if constexpr (kOneSided) return t;
  const auto clockwise = hn::Lt(t.area2, hn::Zero(d));
  const auto flip = [&](IntV& p, IntV& q) HWY_ATTR {
    const auto kept = p;
    p = hn::IfThenElse(clockwise, hn::Neg(q), p);
    q = hn::IfThenElse(clockwise, hn::Neg(kept), q);
  };
  flip(t.dx1, t.dx2);
  flip(t.dy1, t.dy2);
  t.z1 = hn::IfThenElse(hn::RebindMask(df, clockwise), c.z, b.z);
  t.z2 = hn::IfThenElse(hn::RebindMask(df, clockwise), b.z, c.z);
  t.area2 = hn::Abs(t.area2);
  return t;
}

HWY_INLINE void put_edge(IntV start, IntV dx, IntV dy, WalkEdge& to) {
  const Ints d;
  hn::Store(start, d, to.start);
  hn::Store(hn::ShiftLeft<10>(dx), d, to.row);
  hn::Store(hn::ShiftLeft<10>(dy), d, to.column);
  hn::Store(hn::Add(hn::Set(d, 1), holds_zero(dx, dy)), d, to.least);
}

/// \param from_x, from_y  from corner 0 to the first pixel of the box
/// \param chosen          the others of the vector are not drawn
HWY_INLINE void put_walk(const Shapes& t, IntV from_x, IntV from_y, const Boxes& box, IntM chosen, int width,
                         Walk& to) {
  const Floats df;
  const Ints d;
  const auto start1 = hn::Sub(hn::Mul(t.dx1, from_y), hn::Mul(t.dy1, from_x));
  const auto start2 = hn::Sub(hn::Mul(t.dx2, from_y), hn::Mul(t.dy2, from_x));
  const auto start0 = hn::Sub(hn::Sub(t.area2, start1), start2);
  // Those not chosen stay outside of edge 0 wherever they walk.
  put_edge(hn::IfThenElse(chosen, start0, hn::Set(d, -1)),
           hn::IfThenElseZero(chosen, hn::Neg(hn::Add(t.dx1, t.dx2))),
           hn::IfThenElseZero(chosen, hn::Neg(hn::Add(t.dy1, t.dy2))), to.edges[0]);
  put_edge(start1, t.dx1, t.dy1, to.edges[1]);
  put_edge(start2, t.dx2, t.dy2, to.edges[2]);
  // Weights are exact integers over the area, so a depth never leaves the range of the corners' depths by
  // more than rounding, however thin the triangle.
  const auto inverse = hn::Div(hn::Set(df, 1.0F), hn::ConvertTo(df, t.area2));
  hn::Store(t.z0, df, to.depth);
  hn::Store(hn::Mul(hn::Sub(t.z1, t.z0), inverse), df, to.rise[0]);
  hn::Store(hn::Mul(hn::Sub(t.z2, t.z0), inverse), df, to.rise[1]);
  hn::Store(hn::Add(hn::Mul(box.top, hn::Set(d, width)), box.left), d, to.index);
  const auto more_columns = hn::IfThenElse(chosen, box.more_columns, hn::Set(d, -1));
  const auto more_rows = hn::IfThenElse(chosen, box.more_rows, hn::Set(d, -1));
  hn::Store(more_columns, d, to.more_columns);
  hn::Store(more_rows, d, to.more_rows);
  to.last_column = hn::GetLane(hn::MaxOfLanes(d, more_columns));
  to.last_row = hn::GetLane(hn::MaxOfLanes(d, more_rows));
  to.clipped = !hn::AllTrue(d, hn::Or(box.whole, hn::Not(chosen)));
}

/// Draws vectors of triangles into one map.
class Drawing {
 public:
  Drawing(const Projection& to_steps, const Canvas& canvas) : to_steps_(to_steps), canvas_(canvas) {}

  /// \param at  x of the first corner of the first triangle of a vector; `second` and `third` floats behind it lie those
  ///            of the others
  /// \tparam kAllNear   no corner is farther from the map's origin than kNear
  /// \tparam kOneSided  only triangles whose corners come counter-clockwise are drawn
  template <bool kAllNear, bool kOneSided>
  HWY_INLINE void add(const float* at, std::size_t second, std::size_t third) {
    const Ints d;
    const Corner a = corner_of<kAllNear>(at, to_steps_);
    const Corner b = corner_of<kAllNear>(at + second, to_steps_);
    const Corner c = corner_of<kAllNear>(at + third, to_steps_);
    const Boxes box = boxes_of(a, b, c, canvas_);
    if (!hn::AllTrue(d, hn::Or(box.fits, hn::Not(box.visible)))) {
      draw_alone({a, b, c}, hn::AndNot(box.fits, box.visible), canvas_);
    }
    const Shapes shapes = shapes_of<kOneSided>(a, b, c);
    const auto small = hn::And(hn::And(box.fits, box.visible), hn::Gt(shapes.area2, hn::Zero(d)));
    if (hn::AllFalse(d, small)) return;
    put_walk(shapes, hn::Sub(centre_in(box.left), a.x), hn::Sub(centre_in(box.top), a.y), box, small,
             canvas_.width, walks_[waiting_++]);
    if (waiting_ == kWalks) take_walks();
  }

  /// Draws what still waits.
  HWY_INLINE void finish() {
    take_walks();
    flush(fragments_, canvas_.depth);
  }

 private:
  HWY_NOINLINE void take_walks() {
    for (std::size_t k = 0; k < waiting_; ++k) {
      if (walks_[k].clipped) {
        take_walk<true>(walks_[k], canvas_.width, fragments_);
      } else {
        take_walk<false>(walks_[k], canvas_.width, fragments_);
      }
      if (fragments_.count >= Fragments::kEnough) flush(fragments_, canvas_.depth);
    }
    waiting_ = 0;
  }

  /// Triangles are made ready a few vectors before they walk: how far they walk is known early then, and mispredicting it
  /// costs little.
  static constexpr std::size_t kWalks = 4;

  const Projection to_steps_;
  const Canvas canvas_;
  std::size_t waiting_ = 0;
  Walk walks_[kWalks];
  Fragments fragments_;
};

const char* target_name() {
  return hwy::TargetName(HWY_TARGET);
}

Projection in_steps(Projection projection) {
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 3; ++column) projection.linear[column][row] *= kSubpixels;
    projection.offset[row] *= kSubpixels;
  }
  return projection;
}

template <bool kAllNear, bool kOneSided>
HWY_INLINE void draw_block(const float* block, bool mirrored, Drawing& drawing) {
  constexpr std::size_t kCorner = 3 * kSoupBlock;
  const std::size_t second = mirrored || !kOneSided ? kCorner : 2 * kCorner;
  for (std::size_t lane = 0; lane < kSoupBlock; lane += hn::Lanes(Floats())) {
    drawing.add<kAllNear, kOneSided>(block + lane, second, 3 * kCorner - second);
  }
}

template <bool kAllNear>
void draw_blocks(const TriangleSoup& soup, const Projection& projection, const Canvas& canvas) {
  Drawing drawing(in_steps(projection), canvas);
  const Gaze gaze = gaze_of(projection);
  const bool looks = gaze.along != glm::vec3(0.0F);
  const float* block = soup.blocks.data();
  for (const TriangleSoup::Cone& cone : soup.cones) {
    const bool looks_away = glm::dot(cone.axis, gaze.along) > cone.sine;
    if (!looks) {
      draw_block<kAllNear, false>(block, false, drawing);
    } else if (!looks_away) {
      draw_block<kAllNear, true>(block, gaze.mirrored, drawing);
    }
    block += 9 * kSoupBlock;
  }
  for (const float* end = soup.blocks.data() + soup.blocks.size(); block != end; block += 9 * kSoupBlock) {
    draw_block<kAllNear, false>(block, false, drawing);
  }
  drawing.finish();
}

void draw_near(const TriangleSoup& soup, const Projection& projection, const Canvas& canvas) {
  draw_blocks<true>(soup, projection, canvas);
}

void draw_far(const TriangleSoup& soup, const Projection& projection, const Canvas& canvas) {
  draw_blocks<false>(soup, projection, canvas);
}

}  // namespace rejoin::zbuffer::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rejoin::zbuffer::detail {
namespace {

HWY_EXPORT(draw_near);
HWY_EXPORT(draw_far);
HWY_EXPORT(target_name);

/// Whether all corners lie in a box around the origin.  A pose that is not finite is nowhere.
bool is_within(float pixels, const mesh::Box& box) {
  return box.low.x > -pixels && box.low.y > -pixels && box.high.x < pixels && box.high.y < pixels &&
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
  const mesh::Box box = projected(soup.box, projection);
  if (is_within(HWY_STATIC_DISPATCH(kNear), box)) {
    HWY_DYNAMIC_DISPATCH(draw_near)(soup, projection, canvas);
  } else if (is_within(kReach / 2,
                       box)) {  // half of it leaves room for the rounding of points inside the box
    HWY_DYNAMIC_DISPATCH(draw_far)(soup, projection, canvas);
  } else {
    draw_one_by_one(soup, projection, canvas);
  }
}

std::string instruction_set() {
  return HWY_DYNAMIC_DISPATCH(target_name)();
}

}  // namespace rejoin::zbuffer::detail
#endif
