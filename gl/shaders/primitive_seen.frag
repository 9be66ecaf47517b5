#version 450 core
// The shader of primitive.frag, for scenes with triangles that the camera does not see. It discards them, so that the
// surface behind them is visible.
layout(location = 0) out uint primitive;
layout(std430, binding = 0) readonly buffer Unseen {
  uint unseen[];  // triangle t has bit t % 32 of word t / 32
};

void main() {
  uint triangle = uint(gl_PrimitiveID);
  if ((unseen[triangle / 32u] >> (triangle % 32u) & 1u) != 0u) discard;
  primitive = triangle;
}
