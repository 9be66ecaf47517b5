// A cube map whose faces are square to the world's axes.
vec3 in_cube(vec3 from_light) { return from_light; }
vec3 cube_axis(int axis) { return vec3(axis == 0, axis == 1, axis == 2); }
