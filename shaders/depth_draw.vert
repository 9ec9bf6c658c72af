// Places one fragment's corners in the tile of its pose; one instance a pose.

layout(location = 0) in vec3 corner;   // mesh units, relative to the mesh's origin
// (x, y in pixels, depth in mesh units) = rows * (corner, 1)
layout(location = 1) in vec4 row_x;
layout(location = 2) in vec4 row_y;
layout(location = 3) in vec4 row_depth;

uniform uvec2 tiling;        // tiles in a row of the target, pixels of the target's side
uniform uint resolution;     // pixels of a tile's side
uniform uint first_tile;

noperspective out float depth;
flat out ivec2 tile;         // first pixel

void main() {
  const vec4 at = vec4(corner, 1.0);
  const uint index = first_tile + uint(gl_InstanceID);
  const uvec2 origin = uvec2(index % tiling.x, index / tiling.x) * resolution;
  const vec2 pixel = vec2(origin) + vec2(dot(row_x, at), dot(row_y, at));
  depth = dot(row_depth, at);
  tile = ivec2(origin);
  // No depth test and z = 0: nothing is cut off in front or behind, the blending takes the nearest.
  gl_Position = vec4(pixel * (2.0 / float(tiling.y)) - 1.0, 0.0, 1.0);
}
