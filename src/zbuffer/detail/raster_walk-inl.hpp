/// Small triangles that walk the pixels of their boxes, a vector lane each (compiled once an instruction set).

#if defined(REJOIN_ZBUFFER_RASTER_WALK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef REJOIN_ZBUFFER_RASTER_WALK_INL
#undef REJOIN_ZBUFFER_RASTER_WALK_INL
#else
#define REJOIN_ZBUFFER_RASTER_WALK_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "zbuffer/detail/canvas.hpp"
#include "zbuffer/detail/raster_kernel.hpp"

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
    float& pixel = map[fragments.index[k]];
    pixel = nearest(pixel, fragments.depth[k]);
  }
  fragments.count = 0;
}

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

/// An edge function of each of a vector of triangles.
struct WalkEdge {
  HWY_ALIGN std::int32_t start[kSoupBlock];   ///< E at the first pixel of the box
  HWY_ALIGN std::int32_t row[kSoupBlock];     ///< E grows by with a row
  HWY_ALIGN std::int32_t column[kSoupBlock];  ///< E falls by with a column
  HWY_ALIGN std::int32_t least[kSoupBlock];   ///< Edge::least()
};

/// A vector of small triangles that are ready to walk the pixels of their boxes in step: all are at the k-th row and
/// column of their box at once.
struct Walk {
  WalkEdge edges[3];                         ///< the k-th lies opposite of corner k
  HWY_ALIGN float depth[kSoupBlock];         ///< of corner 0
  HWY_ALIGN float rise[2][kSoupBlock];       ///< of the depth with the functions of edges 1 and 2
  HWY_ALIGN std::int32_t index[kSoupBlock];  ///< in the map, of the first pixel of the box
  HWY_ALIGN std::int32_t
      more_columns[kSoupBlock];  ///< of the box, that follow the first and lie on the map; < 0: none
  HWY_ALIGN std::int32_t more_rows[kSoupBlock];
  int last_column;  ///< that any of the triangles has
  int last_row;
  bool clipped;  ///< Not all of the triangles lie on the map as a whole.
};

/// Collects the pixels that the triangles cover.  Outside of its whole box a triangle covers nothing, so a lane may walk on
/// there until all are done; only where a box was clipped it has to be stopped.
template <bool kClipped>
HWY_INLINE void take_walk(const Walk& walk, int width, Fragments& to) {
  const Floats df;
  const Ints d;
  const auto at = [&](const std::int32_t* values) HWY_ATTR { return hn::Load(d, values); };
  const auto& [edge0, edge1, edge2] = walk.edges;
  auto row0 = hn::Sub(at(edge0.start), at(edge0.least)), row1 = at(edge1.start), row2 = at(edge2.start);
  const auto least1 = at(edge1.least), least2 = at(edge2.least);
  const auto column0 = at(edge0.column), column1 = at(edge1.column), column2 = at(edge2.column);
  const auto next0 = at(edge0.row), next1 = at(edge1.row), next2 = at(edge2.row);
  const auto z0 = hn::Load(df, walk.depth), rise1 = hn::Load(df, walk.rise[0]),
             rise2 = hn::Load(df, walk.rise[1]);
  auto row_index = at(walk.index);
  const int last_row = walk.last_row, last_column = walk.last_column;
  std::size_t count = to.count;
  for (int j = 0; j <= last_row; ++j) {
    auto e0 = row0, e1 = row1, e2 = row2, index = row_index;
    for (int i = 0; i <= last_column; ++i) {
      auto outside = hn::Or3(e0, hn::Sub(e1, least1), hn::Sub(e2, least2));
      if constexpr (kClipped) {
        outside = hn::Or3(outside, hn::Sub(at(walk.more_columns), hn::Set(d, i)),
                          hn::Sub(at(walk.more_rows), hn::Set(d, j)));
      }
      const auto inside = hn::Gt(outside, hn::Set(d, -1));
      const auto depth =
          hn::Add(z0, hn::Add(hn::Mul(hn::ConvertTo(df, e1), rise1), hn::Mul(hn::ConvertTo(df, e2), rise2)));
      hn::StoreU(hn::BitCast(Unsigneds(), to_front(index, inside)), Unsigneds(), to.index + count);
      hn::StoreU(to_front(depth, inside), df, to.depth + count);
      count += hn::CountTrue(d, inside);
      e0 = hn::Sub(e0, column0);
      e1 = hn::Sub(e1, column1);
      e2 = hn::Sub(e2, column2);
      index = hn::Add(index, hn::Set(d, 1));
    }
    row0 = hn::Add(row0, next0);
    row1 = hn::Add(row1, next1);
    row2 = hn::Add(row2, next2);
    row_index = hn::Add(row_index, hn::Set(d, width));
  }
  to.count = count;
}

}  // namespace rejoin::zbuffer::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
