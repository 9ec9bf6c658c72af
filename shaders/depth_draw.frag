// The depth of a pixel; the blending keeps the smallest.

noperspective in float depth;

out float nearest;

void main() { nearest = depth; }
