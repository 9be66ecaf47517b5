#version 450 core
// The scene's vertices, for the receiver pass and the depth pass.
layout(location = 0) in vec3 position;  // world, metres
uniform mat4 clip_from_world;

void main() { gl_Position = clip_from_world * vec4(position, 1.0); }
