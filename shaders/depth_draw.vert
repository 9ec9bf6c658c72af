// Places a fragment's corners before the reference plane.

layout(location = 0) in vec3 corner;   // mesh units, relative to the mesh's origin

// (x, y in pixels, depth in mesh units) = rows * (corner, 1)
uniform vec4 rows[3];
uniform float resolution;   // pixels of the map's side

noperspective out float depth;

void main() {
  const vec4 at = vec4(corner, 1.0);
  const vec2 pixel = vec2(dot(rows[0], at), dot(rows[1], at));
  depth = dot(rows[2], at);
  // No depth test and z = 0: nothing is cut off in front or behind, the blending takes the nearest.
  gl_Position = vec4(pixel * (2.0 / resolution) - 1.0, 0.0, 1.0);
}
