// Judges each pixel's lookup as compare/ladder/ladder.h defines it: rungs and causes, as numbers of taps.
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DArray;
#include "light_view.glsl"
#include "own_surface.glsl"

uniform sampler2D place_image;  // of P: (u, v), its depth, and its triangle; -1 without a receiver
uniform sampler2D offsets;      // of each tap, texels
uniform int taps;
uniform int lit_beyond_far;
uniform float program_error_m;  // ray_error_m of the program, where the scene stands
uniform vec2 first_texel_m;     // the place of the map's lower left corner
uniform float near_depth, depth_range;  // metres: where window depth is 0, and to where it is 1

layout(location = 0) out vec4 rungs;   // 1 facing, 2 lit (R1), 4 outside the map, 8 ambiguous (R1 at the error of a ray beside P is another); taps lit at R2, R4 and R5
layout(location = 1) out vec4 causes;  // taps: acne, Peter Panning, aliasing too dark, aliasing too light
layout(location = 2) out vec4 others;  // taps: coverage too dark, coverage too light, lit at the places looked up; N.L

vec2 centre_of(ivec2 texel) { return first_texel_m + (vec2(texel) + 0.5) * light_texel_m[map_layer]; }

// The depth that an exact map holds at a texel inside it.
float exact_depth(vec2 centre, Hit hit) {
  if (hit.face >= 0 && hit.depth < near_depth) hit = first_hit(centre, near_depth);
  return hit.face < 0 ? 1.0 : clamp((hit.depth - near_depth) / depth_range, 0.0, 1.0);
}

void main() {
  rungs = causes = others = vec4(0.0);
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 place = texelFetch(place_image, pixel, 0);
  Receiver receiver = receiver_at(pixel);
  others.w = receiver.surface.n_dot_l;
  if (place.w < 0.0 || !(receiver.surface.n_dot_l > 0.0)) return;
  int own = int(place.w);
  vec2 p = place.xy;
  vec3 position = texelFetch(position_image, pixel, 0).xyz;
  vec3 moved = looked_up(position, receiver.surface) - position;
  vec2 looked_up_at = p + vec2(dot(moved, light_right), dot(moved, light_up));
  bool moves = moved != vec3(0.0), lit_truth = !is_shadowed(own, p), beyond_far = receiver.reference > 1.0;
  float bias = bias_depth(receiver);
  bool outside = beyond_far || !inside_map(ivec2(floor(receiver.map_texels)));
  bool ambiguous = false;
  for (int way = 0; way < 4; ++way) {
    float error = way < 2 ? program_error_m : -program_error_m;
    ambiguous = ambiguous || is_shadowed(own, p + (way % 2 == 0 ? vec2(error, 0.0) : vec2(0.0, error))) == lit_truth;
  }
  rungs.x = 1.0 + (lit_truth ? 2.0 : 0.0) + (outside ? 4.0 : 0.0) + (ambiguous ? 8.0 : 0.0);

  for (int tap = 0; tap < taps; ++tap) {
    vec3 offset = vec3(row(offsets, tap).xy, 0.0);
    vec2 offset_m = offset.xy * light_texel_m[map_layer];
    bool exact_lit = lit_truth;
    if (offset != vec3(0.0)) exact_lit = is_lit_at(own, p, lit_truth, p + offset_m, first_hit(p + offset_m, -infinity));
    bool moved_lit = exact_lit;
    if (moves) {
      vec2 x = looked_up_at + offset_m;
      moved_lit = is_lit_at(own, p, lit_truth, x, first_hit(x, -infinity));
    }
    ivec2 texel = tap_address(receiver.map_texels, receiver.from_light, offset);
    vec2 centre = centre_of(texel);
    Hit hit = first_hit(centre, -infinity);
    bool texel_lit = is_lit_at(own, p, lit_truth, centre, hit);
    bool covered = inside_map(texel) && !beyond_far && !(hit.face >= 0 && hit.depth < near_depth);

    float depth = 1.0;
    if (inside_map(texel)) {
      depth = exact_depth(centre, hit);
    } else if (wrap != 2) {
      vec2 read = centre_of(wrapped(texel));
      depth = exact_depth(read, first_hit(read, -infinity));
    }
    bool always_lit = beyond_far && lit_beyond_far != 0;
    float reference = tap_depth(receiver, offset, texel);
    bool lit = always_lit || !(biased_depth(reference, bias) > depth);
    bool shown = always_lit || tap_lit(reference, bias, texel);

    rungs.y += float(exact_lit);
    rungs.z += float(lit);
    rungs.w += float(shown);
    others.z += float(moved_lit);
    if (lit == moved_lit) continue;
    if (!covered)
      others.xy += lit ? vec2(0.0, 1.0) : vec2(1.0, 0.0);
    else if (lit == texel_lit)
      causes.zw += lit ? vec2(0.0, 1.0) : vec2(1.0, 0.0);
    else
      causes.xy += lit ? vec2(0.0, 1.0) : vec2(1.0, 0.0);
  }
}
