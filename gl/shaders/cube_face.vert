#version 450 core
// The scene's vertices for one face of a cube map.
layout(location = 0) in vec3 position;  // world, metres
uniform mat4 clip_from_world;
out vec3 place_m;

void main() {
  precise vec4 clip = clip_from_world * vec4(position, 1.0);
  gl_Position = clip;
  place_m = position;
}
