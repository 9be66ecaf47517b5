// The scene's triangles, each with its number.
in vec3 position;
in float number;
uniform mat4 clip_from_world;
flat out float shown;

void main() {
  gl_Position = clip_from_world * vec4(position, 1.0);
  shown = number;
}
