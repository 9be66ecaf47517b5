#version 450 core
// The scene's vertices, for the receiver pass and the depth pass.
layout(location = 0) in vec3 position;  // world, metres
uniform mat4 clip_from_world;
uniform vec2 cell;  // of a snapped map: the cell of the grid that is drawn (LightFrame::snapped_cells); else 0

void main() {
  gl_Position = clip_from_world * vec4(position, 1.0);
  gl_Position.xy -= 2.0 * cell;
}
