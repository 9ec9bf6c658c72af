// The slope-difference error of two depth maps, by one work group of LOCAL_SIZE (a power of two) invocations.
// The file after it says how a depth is read.
// papaioannou 2002, eq. (9) in the form at the end of section 3.4.

const float kNothing = 3.0e38;   // background

// Both in A's pixel frame (B already mirrored), depths in mesh units.
float depth_a(ivec2 pixel);
float depth_b(ivec2 pixel);

struct Record {
  float sum;        // sum over S of |Du d1 + Du d2| + |Dv d1 + Dv d2|
  uint overlap;     // N_S
  uint covered_a;   // A_S1
  uint covered_b;   // A_S2
};

shared float partial_sum[LOCAL_SIZE];
shared uint partial_overlap[LOCAL_SIZE];
shared uint partial_a[LOCAL_SIZE];
shared uint partial_b[LOCAL_SIZE];

// Every invocation walks up the columns of its own, and partial sums are joined in a fixed order: the same bits in
// every run.  Valid in invocation 0.
Record compare(int side) {
  Record total = Record(0.0, 0u, 0u, 0u);
  const int me = int(gl_LocalInvocationIndex);
  // Columns are cut into pieces so that all invocations have work; one invocation's pieces lie LOCAL_SIZE apart.
  const int columns = side - 1;
  const int pieces = max(1, LOCAL_SIZE / columns);
  const int rows = (side - 1 + pieces - 1) / pieces;
  for (int item = me; item < columns * pieces; item += LOCAL_SIZE) {
    const int i = item % columns;
    const int first = item / columns * rows;
    const int last = min(first + rows, side - 1);
    float a = depth_a(ivec2(i, first));
    float b = depth_b(ivec2(i, first));
    for (int j = first; j < last; ++j) {
      const float a_above = depth_a(ivec2(i, j + 1));
      const float b_above = depth_b(ivec2(i, j + 1));
      const float a_right = depth_a(ivec2(i + 1, j));
      const float b_right = depth_b(ivec2(i + 1, j));
      const bool in_a = a < kNothing && a_above < kNothing && a_right < kNothing;
      const bool in_b = b < kNothing && b_above < kNothing && b_right < kNothing;
      total.covered_a += uint(in_a);
      total.covered_b += uint(in_b);
      total.overlap += uint(in_a && in_b);
      const float difference = abs((a_right - a) + (b_right - b)) + abs((a_above - a) + (b_above - b));
      total.sum += in_a && in_b ? difference : 0.0;
      a = a_above;
      b = b_above;
    }
  }
  partial_sum[me] = total.sum;
  partial_overlap[me] = total.overlap;
  partial_a[me] = total.covered_a;
  partial_b[me] = total.covered_b;
  for (int half_size = LOCAL_SIZE / 2; half_size > 0; half_size /= 2) {
    memoryBarrierShared();
    barrier();
    if (me < half_size) {
      partial_sum[me] += partial_sum[me + half_size];
      partial_overlap[me] += partial_overlap[me + half_size];
      partial_a[me] += partial_a[me + half_size];
      partial_b[me] += partial_b[me + half_size];
    }
  }
  return Record(partial_sum[0], partial_overlap[0], partial_a[0], partial_b[0]);
}
