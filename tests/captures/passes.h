// The passes of a frame of the synthetic program: shadow maps, depth, light, and what fills the screen.
#pragma once
#include "scene.h"

// Of two kinds: that of all objects, and that of those which are drawn as patches.
static unsigned map_program[2], depth_program[2], lit_program[2], screen_program, holes;
static void set(unsigned program, const char* name, int matrices, const float* values) {
  const int at = glGetUniformLocation(program, name);
  if (matrices && at >= 0) glUniformMatrix4fv(at, matrices, 0, values);
}
static void set_vec(unsigned program, const char* name, int i, vec v) {
  char indexed[40];
  snprintf(indexed, sizeof indexed, "%s[%d]", name, i);
  glUniform3f(glGetUniformLocation(program, i < 0 ? name : indexed), v.x, v.y, v.z);
}
static void set_int(unsigned program, const char* name, int value) {
  glUniform1i(glGetUniformLocation(program, name), value);
}
static void bind(int place, GLenum target, unsigned texture) {
  glActiveTexture(GL_TEXTURE0 + (unsigned)place);
  glBindTexture(target, texture);
}

static const float places[] = {0, 0,   0,    .1f, 0,  -1.6f, -1.5f,
                               0, .3f, 1.4f, 0,   .2f};  // of BOX, drawn by instances or by one call for several draws
static int opaque(int x, int y) { return (x + y) & 1; }  // of the mask's texels
static mat bone_of(int which) {                          // bends the arm's upper end
  const mat m = objects[ARM].model;
  return which == ARM ? mul(m, mul(mul(moving(.9f, -.1f, .5f), turning(70)), inverse(m))) : identity;
}
static int indexed(void) { return any("indexed", "multidraw") || has("strips"); }
static int corners(const struct object* o) { return has("strips") ? o->count / 5 * 6 : o->count; }
static const float* corner(const struct object* o, int i) {  // of the corners of its triangles
  const unsigned of_quad[6] = {0, 1, 2, 0, 2, 3};
  return vertices + 9 * (has("strips") ? indices[o->first + i / 6 * 5] + of_quad[i % 6]
                         : indexed()   ? indices[o->first + i]
                                       : (unsigned)(o->first + i));
}

static void draw_objects(const unsigned programs[2], mat clip_from_world, int for_map) {
  unsigned program = programs[0];
  glUseProgram(program);
  set(program, "clip_from_world", 1, clip_from_world.m);
  if (has("multidraw")) {  // floor and boxes in one call
    set(program, "model", 1, identity.m);
    set(program, "bone", 1, identity.m);
    glVertexAttribDivisor(4, 1);
    glEnableVertexAttribArray(4);
    glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, 0, 4, 0);
    glDisableVertexAttribArray(4);
    return;
  }
  for (int i = 0; i < OBJECTS; i++) {
    if (!drawn(i, for_map)) continue;
    const struct object* o = &objects[i];
    const int is_patched = has("patches") && (i == TALL || i == TURNED);
    program = programs[is_patched];
    glUseProgram(program);
    set(program, "clip_from_world", 1, clip_from_world.m);
    set(program, "model", 1, o->model.m);
    set(program, "bone", 1, bone_of(i).m);
    set_vec(program, "albedo", -1, o->albedo);
    set_int(program, "masked", i == HOLES);
    const int instances = o->instances - (for_map && i == BOX && has("culled-instance"));
    if (o->instances > 1) glEnableVertexAttribArray(4);
    const GLenum kind = is_patched ? GL_PATCHES : has("strips") ? GL_TRIANGLE_STRIP : GL_TRIANGLES;
    if (indexed() && o->instances > 1)
      glDrawElementsInstanced(kind, o->count, GL_UNSIGNED_INT, (void*)(sizeof(unsigned) * (size_t)o->first), instances);
    else if (indexed())
      glDrawElementsBaseVertex(kind, o->count, GL_UNSIGNED_INT, (void*)(sizeof(unsigned) * (size_t)o->first), 0);
    else
      glDrawArraysInstanced(kind, o->first, o->count, instances);
    glDisableVertexAttribArray(4);
  }
}

static void draw_maps(void) {
  bind(4, GL_TEXTURE_2D, holes);
  if (has("polygon-offset")) glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(2, 4);
  if (has("sides")) glEnable(GL_CULL_FACE);
  glCullFace(GL_FRONT);
  for (int i = 0; i < light_count; i++)
    for (int k = 0; k < lights[i].maps; k++) {
      struct light* l = &lights[i];
      const int atlas = has("cascades-atlas"), edge = has("half") ? MAP / 2 : MAP;
      glBindFramebuffer(GL_FRAMEBUFFER, l->framebuffers[atlas ? 0 : k]);
      glViewport(atlas ? (k & 1) * MAP : 0, atlas ? (k >> 1) * MAP : 0, edge, edge);
      const float far[4] = {has("exponential") ? 5.54e34f : 1, 1, 0, 1};
      if (!atlas || !k) glClear(GL_DEPTH_BUFFER_BIT);
      if (any("moments", "exponential")) glClearBufferfv(GL_COLOR, 0, far);
      mat shifted = l->map[k];
      if (has("vertex-bias")) {  // all casters away from the light along its axis, in the vertex shader's matrix
        shifted = mul(perspective(75, 1, .8f, 12, at_near, at_far),
                      mul(moving(0, 0, -.1f), looking(l->way, (vec){-.2f, 0, -.2f}, (vec){0, 1, 0})));
      }
      draw_objects(map_program, shifted, 1);
    }
  glDisable(GL_CULL_FACE);
  glDisable(GL_POLYGON_OFFSET_FILL);
}

static void use_lookup(unsigned program, int show) {
  glUseProgram(program);
  mat all[8];
  int n = 0;
  for (int i = 0; i < light_count; i++) {
    for (int k = 0; k < lights[i].maps; k++) all[n++] = lights[i].lookup[k];
    set_vec(program, "to_light", i, lights[i].way);
    set_vec(program, "colour", i, lights[i].colour);
    char name[20];
    snprintf(name, sizeof name, "bias[%d]", i);
    glUniform1f(glGetUniformLocation(program, name), lights[i].bias);
    bind(i,
         has("point")            ? GL_TEXTURE_CUBE_MAP
         : has("cascades-array") ? GL_TEXTURE_2D_ARRAY
                                 : GL_TEXTURE_2D,
         lights[i].texture);
  }
  const mat clip_from_world = mul(camera_projection, camera_view), back = inverse(clip_from_world);
  set(program, "lookup", n, all[0].m);
  set(program, "world_from_clip", 1, back.m);
  set_int(program, "show", show);
  bind(4, GL_TEXTURE_2D, holes);
}
static void screen(int step, unsigned framebuffer, unsigned picture, unsigned history, int show) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glDisable(GL_DEPTH_TEST);
  use_lookup(screen_program, show);
  set_int(screen_program, "step_of_screen", step);
  bind(2, GL_TEXTURE_2D, step == 3 ? 0 : picture);
  bind(3, GL_TEXTURE_2D, history);
  bind(5, GL_TEXTURE_2D_MULTISAMPLE, step == 3 ? picture : 0);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
}

static struct target {
  unsigned colour, depth, framebuffer, flat, flat_framebuffer;
} targets[4];  // picture, last picture, mask, the visibility alone
static unsigned shown_framebuffer;
static void make_target(struct target* t, int colour) {
  const GLenum kind = has("msaa") ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
  t->colour = texture_of(kind, colour, WIDTH, HEIGHT, GL_NEAREST);
  const int depth = has("reversed")  ? GL_DEPTH_COMPONENT32F
                    : has("stencil") ? GL_DEPTH24_STENCIL8
                                     : GL_DEPTH_COMPONENT24;
  t->depth = texture_of(kind, depth, WIDTH, HEIGHT, GL_NEAREST);
  t->framebuffer = framebuffer_of(t->colour, t->depth, kind, 0);
  t->flat = texture_of(GL_TEXTURE_2D, colour, WIDTH, HEIGHT, GL_NEAREST);
  t->flat_framebuffer = framebuffer_of(t->flat, 0, 0, 0);
}

static void draw_frame(int frame, int show) {  // `show`: see scene.glsl
  place_all(has("stale") ? frame - 1 : frame);
  for (int i = 0; i < light_count; i++) memcpy(lights[i].lookup, lights[i].map, sizeof lights[i].map);
  struct light stale[2];
  memcpy(stale, lights, sizeof stale);
  place_all(frame);
  for (int i = 0; i < light_count; i++) memcpy(lights[i].lookup, stale[i].map, sizeof stale[i].map);
  if (has("aspect")) lights[0].lookup[0] = mul(scaling((float)WIDTH / HEIGHT, 1, 1), lights[0].lookup[0]);
  draw_maps();
  const struct target* t = show >= 0 && !has("deferred") ? &targets[3] : &targets[has("temporal") ? frame & 1 : 0];
  const mat clip_from_world = mul(camera_projection, camera_view);
  glBindFramebuffer(GL_FRAMEBUFFER, t->framebuffer);
  glViewport(0, 0, WIDTH, HEIGHT);
  glClearColor(show >= 0 ? -1 : 0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  if (has("srgb")) glEnable(GL_FRAMEBUFFER_SRGB);
  if (has("prepass")) {
    glColorMask(0, 0, 0, 0);
    draw_objects(depth_program, clip_from_world, 0);
    glColorMask(1, 1, 1, 1);
    glDepthFunc(GL_EQUAL);
    glDepthMask(0);
  }
  for (int i = 0; i < 2; i++) use_lookup(lit_program[i], show);
  bind(3, GL_TEXTURE_2D, has("temporal") ? targets[1 - (frame & 1)].colour : 0);
  if (has("backs")) glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glFrontFace(has("clockwise") ? GL_CW : GL_CCW);
  draw_objects(lit_program, clip_from_world, 0);
  glDisable(GL_CULL_FACE);
  glDepthFunc(has("reversed") ? GL_GREATER : GL_LESS);
  glDepthMask(1);
  glDisable(GL_FRAMEBUFFER_SRGB);
  if (has("msaa") && show >= 0) screen(3, t->flat_framebuffer, t->colour, 0, show);
  if (has("msaa") && show < 0) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, t->framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, t->flat_framebuffer);
    glBlitFramebuffer(0, 0, WIDTH, HEIGHT, 0, 0, WIDTH, HEIGHT, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }
  if (has("shaded")) screen(0, shown_framebuffer, t->colour, 0, show);
  if (has("deferred")) {
    screen(1, show >= 0 ? targets[3].flat_framebuffer : targets[2].flat_framebuffer, 0, t->depth, show);
    if (show < 0) screen(2, shown_framebuffer, t->colour, targets[2].flat, show);
  }
}

static char* source;
static unsigned pass_program(const char* pass,
                             GLenum between) {  // each option is a define: cascades-atlas is CASCADES_ATLAS
  char defines[1000];
  int end = snprintf(defines, sizeof defines, "#define LIGHTS %d\n#define %s\n", light_count, pass);
  for (int i = 0; options[i]; i++) {
    char* c = defines + end;
    end += snprintf(c, sizeof defines - (size_t)end, "#define %s\n", options[i]);
    for (c += 8; *c != '\n'; c++) *c = *c == '-' ? '_' : (char)toupper(*c);
  }
  if (between) end += snprintf(defines + end, sizeof defines - (size_t)end, "#define HANDED_ON\n");
  const unsigned program = program_of(defines, source, between);
  glUseProgram(program);
  const char* names[] = {"shadow_map", "second_map", "picture", "history", "holes", "samples"};
  for (int i = 0; i < 6; i++) set_int(program, names[i], i);
  return program;
}
static void make_all(void) {
  unsigned commands[4][5], buffers[4];
  for (int i = 0; i < 4; i++) {
    const struct object* o = &objects[i ? BOX : FLOOR];
    const unsigned one[5] = {(unsigned)o->count, 1, (unsigned)o->first, 0, i ? (unsigned)i - 1 : 0};
    memcpy(commands[i], one, sizeof one);
  }
  if (!indexed()) {  // a vertex for each index
    static float flat[9 * 2000];
    for (int i = 0; i < index_count; i++) memcpy(flat + 9 * i, vertices + 9 * indices[i], 9 * sizeof(float));
    memcpy(vertices, flat, sizeof vertices);
    vertex_count = index_count;
  }
  glPatchParameteri(GL_PATCH_VERTICES, 3);
  if (has("strips")) glEnable(GL_PRIMITIVE_RESTART);
  glPrimitiveRestartIndex(RESTART);
  glGenBuffers(4, buffers);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[0]);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, (long)sizeof(unsigned) * index_count, indices, GL_STATIC_DRAW);
  if (has("multidraw")) {
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, buffers[1]);
    glBufferData(GL_DRAW_INDIRECT_BUFFER, sizeof commands, commands, GL_STATIC_DRAW);
  }
  glBindBuffer(GL_ARRAY_BUFFER, buffers[2]);
  glBufferData(GL_ARRAY_BUFFER, 36L * vertex_count, vertices, GL_STATIC_DRAW);
  const int sizes[4] = {3, 3, 2, 1}, starts[4] = {0, 12, 24, 32};
  for (unsigned i = 0; i < 4; i++) {
    glVertexAttribPointer(i, sizes[i], GL_FLOAT, 0, 36, (void*)(long)starts[i]);
    glEnableVertexAttribArray(i);
  }
  glBindBuffer(GL_ARRAY_BUFFER, buffers[3]);
  glBufferData(GL_ARRAY_BUFFER, sizeof places, places, GL_STATIC_DRAW);
  glVertexAttribPointer(4, 3, GL_FLOAT, 0, 12, 0);
  glVertexAttribDivisor(4, 1);

  float mask[16][4];
  for (int i = 0; i < 64; i++) mask[i / 4][i % 4] = (float)opaque(i / 4 % 4, i / 16);
  holes = texture_of(GL_TEXTURE_2D, GL_RGBA8, 4, 4, GL_NEAREST);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 4, 4, GL_RGBA, GL_FLOAT, mask);
  unsigned char block[8] = {255, 255};  // of S3TC: the colours 0, white, and 1, black, and the two bits of each texel
  for (int i = 0; i < 16; i++) block[4 + i / 4] |= (unsigned char)(!opaque(i % 4, i / 4) << i % 4 * 2);
  if (has("compressed")) glCompressedTexImage2D(GL_TEXTURE_2D, 0, 0x83F0, 4, 4, 0, sizeof block, block);

  const GLenum kind = has("point") ? GL_TEXTURE_CUBE_MAP : has("cascades-array") ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D;
  const int wide = has("cascades-atlas") ? 2 * MAP : MAP, coloured = any("moments", "exponential");
  const int depth = has("depth16")   ? GL_DEPTH_COMPONENT16
                    : has("depth24") ? GL_DEPTH_COMPONENT24
                    : has("stencil") ? GL_DEPTH24_STENCIL8
                                     : GL_DEPTH_COMPONENT32F;
  for (int i = 0; i < light_count; i++) {
    struct light* l = &lights[i];
    const unsigned depths = texture_of(kind, depth, wide, wide, has("compare") ? GL_LINEAR : GL_NEAREST);
    if (has("compare")) glTexParameteri(kind, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    const unsigned colours =
        coloured ? texture_of(kind, has("moments") ? GL_RG32F : GL_R32F, wide, wide, GL_LINEAR) : 0;
    l->texture = coloured ? colours : depths;
    for (int k = 0; k < (has("cascades-atlas") ? 1 : l->maps); k++)
      l->framebuffers[k] = framebuffer_of(colours, depths, kind, k);
  }
  make_target(&targets[0], any("shaded", "temporal") || any("deferred", "curved") ? GL_RGBA16F
                           : any("two", "other-map")                              ? GL_RGBA32F
                           : has("srgb")                                          ? GL_SRGB8_ALPHA8
                           : has("bright")                                        ? GL_RGBA8
                                                                                  : GL_R32F);
  if (has("temporal")) make_target(&targets[1], GL_RGBA16F);
  if (has("deferred")) make_target(&targets[2], GL_R8);
  make_target(&targets[3], GL_R32F);
  shown_framebuffer = framebuffer_of(texture_of(GL_TEXTURE_2D, GL_RGBA8, WIDTH, HEIGHT, GL_NEAREST), 0, 0, 0);
  for (int i = 0; i < 2; i++) {
    const GLenum between = has("geometry") ? GL_GEOMETRY_SHADER : i && has("patches") ? GL_TESS_EVALUATION_SHADER : 0;
    map_program[i] = pass_program("MAP", between);
    depth_program[i] = pass_program("DEPTH_ONLY", between);
    lit_program[i] = pass_program("LIT", between);
  }
  screen_program = pass_program("SCREEN", 0);
}
