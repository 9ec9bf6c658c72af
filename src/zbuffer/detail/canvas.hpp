/// Where the backends draw.
#pragma once

#include <cstring>
#include <span>

namespace rejoin::zbuffer::detail {

/// A row-major map under construction; pixels that nothing covers are NaN.
struct Canvas {
  float* depth;
  int width;
  int height;
};

/// Leaves nothing in a map.  All bytes of this NaN are the same, and the C library writes such as fast as the processor can.
inline void clear(std::span<float> depth) {
  std::memset(depth.data(), 0xFF, depth.size_bytes());
}

/// What a pixel holds once a surface was drawn there.  Of NaN and a depth this takes the depth, in one instruction: the
/// order of the operands matters.
inline float nearest(float before, float depth) {
  return before < depth ? before : depth;
}

}  // namespace rejoin::zbuffer::detail
