// A cube map whose cube is turned about the light.
uniform mat3 cube_axes;  // columns: the cube's axes, unit, in the world

// A direction of the world along the cube's axes.
vec3 in_cube(vec3 from_light) {
  precise float x = dot(from_light, cube_axes[0]);
  precise float y = dot(from_light, cube_axes[1]);
  precise float z = dot(from_light, cube_axes[2]);
  return vec3(x, y, z);
}
vec3 cube_axis(int axis) { return cube_axes[axis]; }
