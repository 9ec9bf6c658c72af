// The depth of a pixel; the blending keeps the smallest.

noperspective in float depth;
flat in ivec2 tile;

uniform uint resolution;

out float nearest;

void main() {
  const ivec2 pixel = ivec2(gl_FragCoord.xy) - tile;
  // What sticks out of a tile must not appear in its neighbour.
  if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(resolution)))) discard;
  nearest = depth;
}
