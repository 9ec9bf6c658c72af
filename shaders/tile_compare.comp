// One work group compares the two tiles of one pose and writes one record.  Comes after compare.glsl.

layout(local_size_x = LOCAL_SIZE) in;

layout(binding = 0) uniform sampler2D tiles;
layout(std430, binding = 2) writeonly buffer Records { uvec4 records[]; };

uniform uvec2 tiling;        // tiles in a row of the target, pixels of the target's side
uniform uint resolution;     // pixels of a tile's side

// A's tiles come first, then as many of B.
ivec2 origin_of(uint tile) { return ivec2(uvec2(tile % tiling.x, tile / tiling.x) * resolution); }

int side = int(resolution);
ivec2 origin_a = origin_of(gl_WorkGroupID.x);
ivec2 origin_b = origin_of(gl_WorkGroupID.x + gl_NumWorkGroups.x);

float depth_a(ivec2 pixel) { return texelFetch(tiles, origin_a + pixel, 0).x; }
float depth_b(ivec2 pixel) { return texelFetch(tiles, origin_b + ivec2(side - 1 - pixel.x, pixel.y), 0).x; }

void main() {
  const Record record = compare(side);
  if (gl_LocalInvocationIndex == 0u) {
    records[gl_WorkGroupID.x] =
        uvec4(floatBitsToUint(record.sum), record.overlap, record.covered_a, record.covered_b);
  }
}
