#version 450 core
layout(location = 0) out uint primitive;  // index into Scene::triangles

void main() { primitive = uint(gl_PrimitiveID); }
