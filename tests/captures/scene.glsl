// All shaders of the synthetic program. It defines the pass (MAP, DEPTH_ONLY, LIT, SCREEN), the stage (VERTEX, FRAGMENT), LIGHTS, and the
// features and faults, as SPOT or GEQUAL. `show` is the number of the light whose visibility alone is drawn, or -1: the picture.
#if defined(CASCADES_ATLAS) || defined(CASCADES_ARRAY) || defined(POINT) || defined(DEFERRED) || defined(FRAGMENT_LOOKUP)
#define LOOKUP_IN_FRAGMENT // the other programs hand the place in the map over from the vertex shader
#endif
#ifdef PACKED
#define COORDINATES vec4 // no output of two floats is handed over
#else
#define COORDINATES vec2
#endif
#ifdef POINT
#define MAPS 6
#elif defined(CASCADES_ATLAS) || defined(CASCADES_ARRAY)
#define MAPS 3
#else
#define MAPS 1
#endif
uniform mat4 model, bone, clip_from_world, world_from_clip, lookup[LIGHTS * MAPS];
uniform vec3 to_light[LIGHTS];    // directional: unit vector; otherwise the place
uniform vec3 colour[LIGHTS];
uniform vec3 albedo;
uniform float bias[LIGHTS];      // of window depth
uniform int show, masked;

#if defined(VERTEX) && defined(SCREEN)
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0, 1); }

#elif defined(VERTEX)
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 coordinates;
layout(location = 3) in float weight;   // of the second bone
layout(location = 4) in vec3 place;     // of an instance
#ifdef HANDED_ON // to the stage between
out Handed {
  vec3 in_world, facing;
  vec4 in_light[LIGHTS];
  COORDINATES uv;
};
#else
out vec3 in_world, facing;
out vec4 in_light[LIGHTS];
out COORDINATES uv;
#endif
invariant gl_Position;
void main() {
  vec4 at = model * vec4(position, 1);
  at = mix(at, bone * at, weight) + vec4(place, 0);
  in_world = at.xyz;
  facing = mat3(model) * normal;
  uv = COORDINATES(0);
  uv.xy = coordinates;
#ifdef NO_MODEL
  for (int i = 0; i < LIGHTS; i++) in_light[i] = lookup[i * MAPS] * vec4(position, 1);
#else
  vec4 looked_up = at;
#ifdef NORMAL_OFFSET
  looked_up.xyz += normalize(facing) * bias[0]; // in metres, and no bias of the depth
#endif
  for (int i = 0; i < LIGHTS; i++) in_light[i] = lookup[i * MAPS] * looked_up;
#endif
  gl_Position = clip_from_world * at;
}

#elif defined(BETWEEN) // each triangle as it is
#ifdef GEOMETRY
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
#else
layout(triangles) in;
#endif
in Handed {
  vec3 in_world, facing;
  vec4 in_light[LIGHTS];
  COORDINATES uv;
} handed[];
out vec3 in_world, facing;
out vec4 in_light[LIGHTS];
out COORDINATES uv;
void hand_over(int i) {
  in_world = handed[i].in_world;
  facing = handed[i].facing;
  in_light = handed[i].in_light;
  uv = handed[i].uv;
  gl_Position = gl_in[i].gl_Position;
}
void main() {
#ifdef GEOMETRY
  for (int i = 0; i < 3; i++) {
    hand_over(i);
    EmitVertex();
  }
#else // a corner of the patch, which is not divided
  hand_over(gl_TessCoord.x > 0.5 ? 0 : gl_TessCoord.y > 0.5 ? 1 : 2);
#endif
}

#else
in vec3 in_world, facing;
in vec4 in_light[LIGHTS];
in COORDINATES uv;
uniform sampler2D holes, picture, history;
uniform sampler2DMS samples;
layout(location = 0) out vec4 result;
#ifdef REVERSED
const vec2 DEPTH = vec2(1, 0);
#else
const vec2 DEPTH = vec2(0.5, 0.5);
#endif

#if defined(POINT)
uniform samplerCube shadow_map;
#elif defined(CASCADES_ARRAY)
uniform sampler2DArray shadow_map;
#elif defined(COMPARE)
uniform sampler2DShadow shadow_map;
#else
uniform sampler2D shadow_map, second_map;
#endif

void drop_holes() {
#ifdef GONE
  if (masked == 1) discard;
#elif defined(PROCEDURAL)
  if (masked == 1 && (int(uv.x * 4.0) + int(uv.y * 4.0)) % 2 == 0) discard;
#else
  if (masked == 1 && texture(holes, uv.xy).r < 0.5) discard;
#endif
}

float read_map(int light, int map, vec3 at) { // at: place in the map and depth, 0 to 1
#ifdef BEYOND
  if (any(lessThan(at, vec3(0))) || any(greaterThan(at, vec3(1)))) return 1.0;
#endif
#if defined(COMPARE)
  return texture(shadow_map, vec3(at.xy, at.z - bias[light]));
#elif defined(BOX)
  float lit = 0.0;
  for (int tap = 0; tap < 9; tap++) {
    vec2 to = vec2(tap % 3 - 1, tap / 3 - 1) / vec2(textureSize(shadow_map, 0));
    lit += at.z - bias[light] <= texture(shadow_map, at.xy + to).x ? 1.0 / 9.0 : 0.0;
  }
  return lit;
#else
#if defined(POINT)
  vec4 stored = texture(shadow_map, in_world - to_light[light]);
#elif defined(CASCADES_ARRAY)
  vec4 stored = texture(shadow_map, vec3(at.xy, map));
#elif defined(CASCADES_ATLAS)
  vec4 stored = texture(shadow_map, (at.xy + vec2(map & 1, map >> 1)) * 0.5);
#elif defined(OTHER_MAP)
  vec4 stored = texture(second_map, at.xy);
#else
  vec4 stored = light == 0 ? texture(shadow_map, at.xy) : texture(second_map, at.xy);
#endif
#if defined(MOMENTS)
  float off = at.z - bias[light] - stored.x, variance = max(stored.y - stored.x * stored.x, 1e-6);
  return off <= 0.0 ? 1.0 : variance / (variance + off * off);
#elif defined(EXPONENTIAL)
  return clamp(stored.x * exp(-80.0 * (at.z - bias[light])), 0.0, 1.0);
#elif defined(REVERSED)
  return at.z + bias[light] >= stored.x ? 1.0 : 0.0;
#elif defined(NORMAL_OFFSET)
  return at.z <= stored.x ? 1.0 : 0.0;
#elif defined(GEQUAL)
  return at.z - bias[light] >= stored.x ? 1.0 : 0.0;
#elif defined(COMPONENT)
  return at.y - bias[light] <= stored.x ? 1.0 : 0.0;
#else
  return at.z - bias[light] <= stored.x ? 1.0 : 0.0;
#endif
#endif
}

float visibility(int light, vec3 world) {
#if MAPS > 1
  int best = 0;
#if defined(POINT)
  vec3 away = abs(world - to_light[light]), signs = world - to_light[light];
  best = away.x >= max(away.y, away.z) ? (signs.x > 0.0 ? 0 : 1) : away.y >= away.z ? (signs.y > 0.0 ? 2 : 3) : (signs.z > 0.0 ? 4 : 5);
#else
  for (best = 0; best < MAPS - 1; best++) { // the first cascade that holds the place
    vec2 inside = abs((lookup[best] * vec4(world, 1)).xy);
    if (max(inside.x, inside.y) < 0.96) break;
  }
#endif
  vec4 q = lookup[light * MAPS + best] * vec4(world, 1);
#elif defined(LOOKUP_IN_FRAGMENT)
  int best = 0;
  vec4 q = lookup[light] * vec4(world, 1);
#else
  int best = 0;
  vec4 q = in_light[light];
#endif
  return read_map(light, best, vec3(q.xy / q.w * 0.5 + 0.5, q.z / q.w * DEPTH.x + DEPTH.y));
}

float facing_light(int light, vec3 world, vec3 normal) { // cosine
#if defined(SPOT) || defined(POINT) || defined(VERTEX_BIAS)
  vec3 way = normalize(to_light[light] - world);
#else
  vec3 way = light == 0 ? to_light[0] : normalize(to_light[light] - world);
#endif
  return max(dot(normalize(normal), way), 0.0);
}

#if defined(MAP) || defined(DEPTH_ONLY)
void main() {
  drop_holes();
#if defined(MOMENTS)
  result = vec4(gl_FragCoord.z, gl_FragCoord.z * gl_FragCoord.z, 0, 1);
#elif defined(EXPONENTIAL)
  result = vec4(exp(80.0 * gl_FragCoord.z), 0, 0, 1);
#endif
}

#elif defined(LIT)
void main() {
  drop_holes();
#if defined(DEFERRED)
  result = vec4(normalize(facing), albedo.x);
#elif defined(SHADED) || defined(SRGB) || defined(TEMPORAL) || defined(CURVED) || defined(BRIGHT)
  if (show >= 0) {
    result = vec4(facing_light(show, in_world, facing) > 0.0 ? visibility(show, in_world) : 0.0);
    return;
  }
  vec3 light = vec3(0.06, 0.07, 0.09);
  for (int i = 0; i < LIGHTS; i++) light += colour[i] * facing_light(i, in_world, facing) * visibility(i, in_world);
#ifdef BRIGHT
  light *= 2.05;
#endif
  result = vec4(albedo * light, 1);
#ifdef CURVED
  result.rgb /= 1.0 + result.rgb;
#endif
#ifdef TEMPORAL
  result = mix(texelFetch(history, ivec2(gl_FragCoord.xy), 0), result, 0.1);
#endif
#else
  vec3 light = vec3(0);
  for (int i = 0; i < LIGHTS; i++)
    if (show < 0 || show == i) light += (show < 0 ? colour[i] : vec3(1)) * visibility(i, in_world);
  result = vec4(light, 1);
#endif
}

#elif defined(SCREEN)
uniform int step_of_screen; // 0 tone mapping, 1 the deferred mask, 2 deferred light, 3 the first sample
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (step_of_screen == 0) {
    vec3 light = texelFetch(picture, pixel, 0).rgb * 2.0;
    result = vec4(pow(light / (1.0 + light), vec3(1.0 / 2.2)), 1);
  } else if (step_of_screen == 1) {
    float depth = texelFetch(history, pixel, 0).r;
    vec4 world = world_from_clip * vec4(gl_FragCoord.xy / vec2(textureSize(history, 0)) * 2.0 - 1.0, (depth - DEPTH.y) / DEPTH.x, 1);
    result = vec4(depth == 1.0 ? (show < 0 ? 1.0 : -1.0) : visibility(0, world.xyz / world.w));
  } else if (step_of_screen == 2) {
    vec4 surface = texelFetch(picture, pixel, 0);
    float cosine = max(dot(surface.xyz, to_light[0]), 0.0);
    result = vec4(vec3(surface.a) * (0.08 + colour[0] * cosine * texelFetch(history, pixel, 0).r), 1);
  } else {
    result = texelFetch(samples, pixel, 0);
  }
}
#endif
#endif
