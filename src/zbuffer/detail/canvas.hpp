/// Where the backends draw.
#pragma once

namespace rejoin::zbuffer::detail {

/// A row-major map under construction; pixels that nothing covers hold a value that no depth is below.
struct Canvas {
  float* depth;
  int width;
  int height;
};

}  // namespace rejoin::zbuffer::detail
