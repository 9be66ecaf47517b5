#version 450 core
// Draws all six faces of a cube map in one pass: each triangle is emitted once for each layer.
layout(triangles) in;
layout(triangle_strip, max_vertices = 18) out;
in vec3 vertex_m[];
uniform mat4 clip_from_world[6];
out vec3 place_m;

void main() {
  for (int face = 0; face < 6; ++face) {
    for (int corner = 0; corner < 3; ++corner) {
      precise vec4 clip = clip_from_world[face] * vec4(vertex_m[corner], 1.0);
      gl_Layer = face;
      gl_Position = clip;
      place_m = vertex_m[corner];
      EmitVertex();
    }
    EndPrimitive();
  }
}
