// Draws fragments into depth maps in a buffer with atomic minima.  Comes after compare.glsl.
//
// Coverage is decided in exact integers on a grid of 2^SUBPIXEL_BITS steps a pixel, as the CPU rasteriser does
// (src/zbuffer/detail/fixed_triangle.hpp): both draw the same pixels.
//
// Defined before: LOCAL_SIZE, SUBPIXEL_BITS, REACH, LARGE_PIXELS, LARGE_LIST, TEAM_SIZE.

layout(local_size_x = LOCAL_SIZE) in;

// Corner c of triangle t of a mesh: component k at first + (3 c + k) count + t, so that neighbouring invocations read
// neighbouring words.  Mesh units, relative to the mesh's origin.
layout(std430, binding = 0) readonly buffer Meshes { float corners[]; };
// Three rows a fragment, two fragments a pose: (x, y in pixels, depth in mesh units) = rows * (corner, 1).
layout(std430, binding = 1) readonly buffer Poses { vec4 rows[]; };
layout(std430, binding = 2) buffer Records { uvec4 records[]; };
layout(std430, binding = 3) coherent buffer Maps { uint maps[]; };   // two a pose, from the first pose of the dispatch on

uniform uvec3 mesh_a;   // first word, count of triangles, how many of them (the first) need not be drawn where they look away
uniform uvec3 mesh_b;
uniform uint probe_steps;   // a few
uniform uint resolution;    // pixels of a map's side
uniform uint first_pose;    // of the dispatch

int side = int(resolution);
uint map_base;   // word of A's map at the pose of this work group

const uint kEmpty = 0xffffffffu;
const uint kUnfinished = 0xffffffffu;   // in place of the overlap: the driver cut the work short
// A box of up to so many grid steps a side keeps every edge function within 31 bits.
const int kNarrow = 31 * 1024;
const int kSubpixels = 1 << SUBPIXEL_BITS;

shared uint large[LARGE_LIST];   // triangles of many pixels, drawn by a team of invocations each
shared uint large_count;   // 0 before and after draw()

// Floats, negative ones included, in the order of unsigned integers.
uint ordered(float depth) {
  const uint bits = floatBitsToUint(depth);
  return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

float depth_of(uint key) {
  return key == kEmpty ? kNothing : uintBitsToFloat((key & 0x80000000u) != 0u ? key & 0x7fffffffu : ~key);
}

float depth_a(ivec2 pixel) { return depth_of(maps[map_base + uint(pixel.y * side + pixel.x)]); }
float depth_b(ivec2 pixel) {
  return depth_of(maps[map_base + uint(side * side + pixel.y * side + side - 1 - pixel.x)]);
}

void synchronize() {
  memoryBarrier();
  barrier();
}

// Corners on the grid, and the pixels of the triangle's box.
struct Triangle {
  ivec2 p, q, r;
  vec3 depths;
  ivec2 low;    // first pixel
  ivec2 size;   // <= 0 where no pixel centre is in the box
  bool narrow;  // edge functions fit into 32 bits
};

vec3 corner(uvec3 mesh, uint triangle, uint which, vec4 x, vec4 y, vec4 z) {
  const uint at = mesh.x + 3u * which * mesh.y + triangle;
  const vec3 p = vec3(corners[at], corners[at + mesh.y], corners[at + 2u * mesh.y]);
  precise vec3 placed = ((vec3(x.x, y.x, z.x) * p.x + vec3(x.y, y.y, z.y) * p.y) + vec3(x.z, y.z, z.z) * p.z) +
                        vec3(x.w, y.w, z.w);
  return placed;
}

Triangle triangle_of(uvec3 mesh, uint index, vec4 x, vec4 y, vec4 z) {
  const vec3 p = corner(mesh, index, 0u, x, y, z);
  const vec3 q = corner(mesh, index, 1u, x, y, z);
  const vec3 r = corner(mesh, index, 2u, x, y, z);
  Triangle t;
  t.depths = vec3(p.z, q.z, r.z);
  const vec2 farthest = max(abs(p.xy), max(abs(q.xy), abs(r.xy)));
  if (!(max(farthest.x, farthest.y) < REACH)) {
    t.size = ivec2(0);
    return t;
  }
  t.p = ivec2(roundEven(p.xy * float(kSubpixels)));
  t.q = ivec2(roundEven(q.xy * float(kSubpixels)));
  t.r = ivec2(roundEven(r.xy * float(kSubpixels)));
  const ivec2 low = min(t.p, min(t.q, t.r));
  const ivec2 high = max(t.p, max(t.q, t.r));
  const int centre = kSubpixels / 2;
  t.low = max((low + (centre - 1)) >> SUBPIXEL_BITS, ivec2(0));   // the first centre at or above low
  t.size = min((high - centre) >> SUBPIXEL_BITS, ivec2(side - 1)) - t.low + 1;
  t.narrow = max(high.x - low.x, high.y - low.y) <= kNarrow;
  return t;
}

void keep_nearest(uint at, float depth) { atomicMin(maps[at], ordered(depth)); }

// 1 where a pixel centre on the edge a -> b belongs to the other triangle at that edge.
int bias_of(ivec2 along) { return along.y < 0 || (along.y == 0 && along.x < 0) ? 0 : 1; }

int edge_at(ivec2 start, ivec2 along, ivec2 point) {
  return along.x * (point.y - start.y) - along.y * (point.x - start.x);
}

// Twice the area of a narrow triangle, above 0 where it runs counter-clockwise.
int area_of(Triangle t) {
  const ivec2 pq = t.q - t.p;
  const ivec2 pr = t.r - t.p;
  return pq.x * pr.y - pr.x * pq.y;
}

void draw_narrow(Triangle t, uint map) {
  const int area = area_of(t);
  if (area == 0) return;
  if (area < 0) {   // seen from behind
    const ivec2 swap = t.q;
    t.q = t.r;
    t.r = swap;
    t.depths = t.depths.xzy;
  }
  const ivec3 dx = ivec3(t.r.x - t.q.x, t.p.x - t.r.x, t.q.x - t.p.x);   // of the edges opposite p, q, r
  const ivec3 dy = ivec3(t.r.y - t.q.y, t.p.y - t.r.y, t.q.y - t.p.y);
  const ivec3 bias = ivec3(bias_of(ivec2(dx.x, dy.x)), bias_of(ivec2(dx.y, dy.y)), bias_of(ivec2(dx.z, dy.z)));
  const ivec2 centre = t.low * kSubpixels + kSubpixels / 2;
  ivec3 row = ivec3(edge_at(t.q, ivec2(dx.x, dy.x), centre), edge_at(t.r, ivec2(dx.y, dy.y), centre),
                    edge_at(t.p, ivec2(dx.z, dy.z), centre)) - bias;
  const vec2 rise = (t.depths.yz - t.depths.x) / float(abs(area));
  const ivec3 step_x = -dy * kSubpixels;
  const ivec3 step_y = dx * kSubpixels;
  ivec3 inside = row;
  ivec2 pixel = ivec2(0);
  while (pixel.y < t.size.y) {
    if ((inside.x | inside.y | inside.z) >= 0) {
      const vec2 weights = vec2(inside.yz + bias.yz);
      keep_nearest(map + uint((t.low.y + pixel.y) * side + t.low.x + pixel.x), t.depths.x + dot(weights, rise));
    }
    inside += step_x;
    if (++pixel.x == t.size.x) {
      pixel = ivec2(0, pixel.y + 1);
      row += step_y;
      inside = row;
    }
  }
}

double edge_far(ivec2 start, ivec2 end, ivec2 point) {
  const dvec2 along = dvec2(end) - dvec2(start);
  const dvec2 to = dvec2(point) - dvec2(start);
  return along.x * to.y - along.y * to.x;
}

// Every `stride`-th pixel of the box from `first`, in doubles: exact for triangles of any size.
void draw_wide(Triangle t, uint map, int first, int stride) {
  double area = edge_far(t.p, t.q, t.r);
  if (area == 0.0) return;
  if (area < 0.0) {
    const ivec2 swap = t.q;
    t.q = t.r;
    t.r = swap;
    t.depths = t.depths.xzy;
    area = -area;
  }
  const dvec3 bias = dvec3(bias_of(t.r - t.q), bias_of(t.p - t.r), bias_of(t.q - t.p));
  const dvec2 rise = (dvec2(t.depths.yz) - double(t.depths.x)) / area;
  for (int k = first; k < t.size.x * t.size.y; k += stride) {
    const ivec2 pixel = t.low + ivec2(k % t.size.x, k / t.size.x);
    const ivec2 centre = pixel * kSubpixels + kSubpixels / 2;
    const dvec3 weights = dvec3(edge_far(t.q, t.r, centre), edge_far(t.r, t.p, centre), edge_far(t.p, t.q, centre));
    if (weights.x >= bias.x && weights.y >= bias.y && weights.z >= bias.z) {
      const float depth = float(double(t.depths.x) + weights.y * rise.x + weights.z * rise.y);
      keep_nearest(map + uint(pixel.y * side + pixel.x), depth);
    }
  }
}

// Draws the `part`-th of so many parts of a mesh.
void draw(uvec3 mesh, uint row, uint map, uint part, uint parts) {
  const vec4 x = rows[row];
  const vec4 y = rows[row + 1u];
  const vec4 z = rows[row + 2u];
  const bool front_is_positive = dot(cross(x.xyz, y.xyz), z.xyz) < 0.0;
  for (uint index = part * LOCAL_SIZE + gl_LocalInvocationIndex; index < mesh.y; index += parts * LOCAL_SIZE) {
    const Triangle t = triangle_of(mesh, index, x, y, z);
    if (t.size.x <= 0 || t.size.y <= 0) continue;
    if (index < mesh.z && t.narrow && (area_of(t) > 0) != front_is_positive) continue;   // looks away, or has no area
    if (!t.narrow || t.size.x * t.size.y > LARGE_PIXELS) {
      const uint place = atomicAdd(large_count, 1u);
      if (place < LARGE_LIST) {
        large[place] = index;
        continue;
      }
    }
    if (t.narrow) {
      draw_narrow(t, map);
    } else {
      draw_wide(t, map, 0, 1);
    }
  }
  synchronize();
  const uint listed = min(large_count, LARGE_LIST);
  for (uint k = gl_LocalInvocationIndex / TEAM_SIZE; k < listed; k += LOCAL_SIZE / TEAM_SIZE) {
    draw_wide(triangle_of(mesh, large[k], x, y, z), map, int(gl_LocalInvocationIndex % TEAM_SIZE), TEAM_SIZE);
  }
  synchronize();
  if (gl_LocalInvocationIndex == 0u) large_count = 0u;
  synchronize();
}

// llvmpipe leaves every loop of an invocation for good once that invocation has gone round 65,535 times in all, and
// says nothing.  A short loop at the end shows whether it has happened.
bool loops_work() {
  uint steps = 0u;
  for (uint k = 0u; k < probe_steps; ++k) ++steps;
  return steps == probe_steps;
}
