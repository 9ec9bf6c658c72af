// Draws depth maps, which are empty before.  Work group (part, fragment, pose) draws a part of one fragment at one pose, so that a few
// poses keep a whole GPU busy.  Comes after rasterise.glsl.

void main() {
  const uint pose = first_pose + gl_WorkGroupID.z;
  const uint pixels = uint(side * side);
  const bool is_b = gl_WorkGroupID.y == 1u;
  map_base = gl_WorkGroupID.z * 2u * pixels;
  if (gl_LocalInvocationIndex == 0u) large_count = 0u;
  synchronize();
  draw(is_b ? mesh_b : mesh_a, 6u * pose + (is_b ? 3u : 0u), map_base + (is_b ? pixels : 0u), gl_WorkGroupID.x,
       gl_NumWorkGroups.x);
  if (!loops_work()) atomicMax(records[pose].y, kUnfinished);
}
