#version 450 core
// Writes the index of the triangle that a pixel shows.
layout(location = 0) out uint primitive;  // index into Scene::triangles

void main() { primitive = uint(gl_PrimitiveID); }
