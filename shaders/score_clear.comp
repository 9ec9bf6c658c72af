// Empties all depth maps.  Comes after rasterise.glsl.

void main() {
  const uint step_size = gl_NumWorkGroups.x * LOCAL_SIZE;
  for (uint p = gl_GlobalInvocationID.x; p < uint(maps.length()); p += step_size) maps[p] = kEmpty;
}
