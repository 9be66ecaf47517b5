#version 450 core
// The linear depth in the map of a point light.
in vec3 place_m;  // world
uniform vec3 light_position;
uniform float light_far_m;

void main() { gl_FragDepth = length(place_m - light_position) / light_far_m; }
