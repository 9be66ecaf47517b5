#version 450 core
// The scene's vertices for cube_layers.geom, which projects them.
layout(location = 0) in vec3 position;  // world, metres
out vec3 vertex_m;

void main() { vertex_m = position; }
