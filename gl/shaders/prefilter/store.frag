#version 450 core
// What the texels of a filtered map store, from the depths of the shadow map.
#include "shaders/words.glsl"
#include <lookup>
#include "shaders/prefilter/format.glsl"

layout(binding = 2) uniform sampler2DArray shadow_map;  // nearest, no comparison
uniform int layer;
layout(location = 0) out vec4 stored;

void main() { stored = in_format(stored_texel(texelFetch(shadow_map, ivec3(gl_FragCoord.xy, layer), 0).r)); }
