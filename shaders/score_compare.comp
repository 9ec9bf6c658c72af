// One work group compares the two maps of one pose, as score_draw.comp left them, writes one record and leaves the maps empty.
// Comes after rasterise.glsl.

shared uint unfinished;

void main() {
  const uint pose = first_pose + gl_WorkGroupID.x;
  const uint pixels = uint(side * side);
  map_base = gl_WorkGroupID.x * 2u * pixels;
  if (gl_LocalInvocationIndex == 0u) unfinished = records[pose].y == kUnfinished ? 1u : 0u;
  const Record record = compare(side);
  synchronize();
  for (uint p = gl_LocalInvocationIndex; p < 2u * pixels; p += LOCAL_SIZE) maps[map_base + p] = kEmpty;
  if (!loops_work()) atomicOr(unfinished, 1u);
  synchronize();
  if (gl_LocalInvocationIndex == 0u) {
    const uint overlap = unfinished != 0u ? kUnfinished : record.overlap;
    records[pose] = uvec4(floatBitsToUint(record.sum), overlap, record.covered_a, record.covered_b);
  }
}
