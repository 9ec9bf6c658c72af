// One work group compares the two maps of one pose and writes one record.  Comes after compare.glsl.

layout(local_size_x = LOCAL_SIZE) in;

// Layers 2 k and 2 k + 1 hold A and B of pose k.
layout(binding = 0) uniform sampler2DArray maps;
layout(std430, binding = 2) writeonly buffer Records { uvec4 records[]; };

uniform uint resolution;   // pixels of a map's side

int side = int(resolution);
int layer = 2 * int(gl_WorkGroupID.x);

float depth_a(ivec2 pixel) { return texelFetch(maps, ivec3(pixel, layer), 0).x; }
float depth_b(ivec2 pixel) { return texelFetch(maps, ivec3(side - 1 - pixel.x, pixel.y, layer + 1), 0).x; }

void main() {
  const Record record = compare(side);
  if (gl_LocalInvocationIndex == 0u) {
    records[gl_WorkGroupID.x] =
        uvec4(floatBitsToUint(record.sum), record.overlap, record.covered_a, record.covered_b);
  }
}
