#version 450 core
// Copies floats into a texture of another format, which rounds them as the device does (Renderer::half_rounding()).
layout(binding = 2) uniform sampler2D floats;
layout(location = 0) out float written;

void main() { written = texelFetch(floats, ivec2(gl_FragCoord.xy), 0).r; }
