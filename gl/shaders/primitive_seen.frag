#version 450 core
// As primitive.frag, but for triangles that the camera does not see: what lies behind them is seen.
layout(location = 0) out uint primitive;
layout(std430, binding = 0) readonly buffer Unseen {
  uint unseen[];  // bit t % 32 of word t / 32: triangle t
};

void main() {
  uint triangle = uint(gl_PrimitiveID);
  if ((unseen[triangle / 32u] >> (triangle % 32u) & 1u) != 0u) discard;
  primitive = triangle;
}
