// Draws a small scene with a shadow map, has RenderDoc capture one frame of it, and writes what it knows into FOLDER: the visibility of each
// light (visibility-1.npy, as the very shader of the frame has it), and its matrices, lights and biases (known.json).
//   program SHADERS FOLDER [FEATURE or FAULT]...
// A feature or a fault is a define of the shaders (cascades-atlas: CASCADES_ATLAS), and has() asks for it here.
#include "passes.h"

static void write_matrix(FILE* file, const char* name, mat m) {
  fprintf(file, "\"%s\": [", name);
  for (int i = 0; i < 16; i++) fprintf(file, "%.9g%s", m.m[i], i < 15 ? ", " : "]");  // column by column
}
static vec through(mat m, vec p) {
  return (vec){m.m[0] * p.x + m.m[4] * p.y + m.m[8] * p.z + m.m[12],
               m.m[1] * p.x + m.m[5] * p.y + m.m[9] * p.z + m.m[13],
               m.m[2] * p.x + m.m[6] * p.y + m.m[10] * p.z + m.m[14]};
}
static void write_scene(
    const char* path) {  // the triangles of all casters in the world, nine numbers each; of a mask only what is opaque
  static float all[9 * 1000];
  int n = 0;
  for (int i = 0; i < OBJECTS; i++)
    for (int part = 0; part < (i == HOLES ? 16 : objects[i].instances);
         part++) {  // an instance, or a texel of the mask
      if ((!drawn(i, 0) && !drawn(i, 1)) || (i == HOLES && (has("gone") || !opaque(part % 4, part / 4)))) continue;
      const float* place = places + 3 * (i == BOX ? part : 0);
      for (int k = 0; k < corners(&objects[i]); k++) {
        const float* v = corner(&objects[i], k);
        const float w = v[8];
        vec at = {v[0], v[1], v[2]};
        if (i == HOLES) at = (vec){-.5f + (part % 4 + v[6]) / 4, (part / 4 + v[7]) / 4, 0};
        at = through(objects[i].model, at);
        const vec bent = through(bone_of(i), at);
        const float one[3] = {at.x + w * (bent.x - at.x) + place[0], at.y + w * (bent.y - at.y) + place[1],
                              at.z + w * (bent.z - at.z) + place[2]};
        memcpy(all + n, one, sizeof one);
        n += 3;
      }
    }
  write_npy(path, all, 9, n / 9);
}
static void write_known(const char* folder) {
  char path[4000];
  static float pixels[WIDTH * HEIGHT];
  snprintf(path, sizeof path, "%s/triangles.npy", folder);
  write_scene(path);
  for (int i = 0; i < light_count; i++) {
    draw_frame(1, i);
    const struct target* t = &targets[3];
    glBindFramebuffer(GL_READ_FRAMEBUFFER, has("msaa") || has("deferred") ? t->flat_framebuffer : t->framebuffer);
    glReadPixels(0, 0, WIDTH, HEIGHT, GL_RED, GL_FLOAT, pixels);
    snprintf(path, sizeof path, "%s/visibility-%d.npy", folder, i + 1);
    write_npy(path, pixels, WIDTH, HEIGHT);
    if (i || has("msaa")) continue;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, targets[has("deferred") ? 0 : 3].framebuffer);
    glReadPixels(0, 0, WIDTH, HEIGHT, GL_DEPTH_COMPONENT, GL_FLOAT, pixels);
    snprintf(path, sizeof path, "%s/depth.npy", folder);
    write_npy(path, pixels, WIDTH, HEIGHT);
  }
  snprintf(path, sizeof path, "%s/known.json", folder);
  FILE* file = fopen(path, "w");
  if (!file) die("cannot write", path);
  fputs("{", file);
  write_matrix(file, "camera_view", camera_view);
  fputs(", ", file);
  write_matrix(file, "camera_projection", camera_projection);
  float sample[2] = {.5f, .5f};  // where in a pixel, from its lower left, the first sample is
  glBindFramebuffer(GL_FRAMEBUFFER, targets[3].framebuffer);
  if (has("msaa")) glGetMultisamplefv(GL_SAMPLE_POSITION, 0, sample);
  fprintf(file, ", \"sample\": [%.9g, %.9g], \"lights\": [", sample[0], sample[1]);
  for (int i = 0; i < light_count; i++) {
    const struct light* l = &lights[i];
    fprintf(file, "%s{\"kind\": \"%s\", \"way\": [%.9g, %.9g, %.9g], \"bias\": %.9g, \"maps\": [", i ? ", " : "",
            l->kind, l->way.x, l->way.y, l->way.z, l->bias);
    for (int k = 0; k < l->maps; k++) {
      fputs(k ? ", {" : "{", file);
      write_matrix(file, "clip_from_world", l->map[k]);
      fputs("}", file);
    }
    fputs("]}", file);
  }
  fputs("]}\n", file);
  if (fclose(file)) die("cannot write", path);
}

int main(int count, char** arguments) {
  if (count < 3) die("usage: program SHADERS FOLDER [FEATURE or FAULT]...", "");
  options = arguments + 3;
  FILE* file = fopen(arguments[1], "rb");
  if (!file) die("cannot read", arguments[1]);
  source = calloc(1, 100000);
  if (!fread(source, 1, 99999, file)) die("cannot read", arguments[1]);
  fclose(file);
  open_context(WIDTH, HEIGHT);
  make_scene();
  place_all(0);
  make_all();
  glEnable(GL_DEPTH_TEST);
  if (has("reversed")) {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glDepthFunc(GL_GREATER);
    glClearDepth(0);
  }
  void** calls = renderdoc();
  for (int frame = 0; frame < 2; frame++) {
    if (calls && frame == 1) ((void (*)(void*, void*))calls[19])(0, 0);
    draw_frame(frame, -1);
    glFinish();
    if (calls && frame == 1 && !((unsigned (*)(void*, void*))calls[21])(0, 0)) die("RenderDoc took no capture", "");
  }
  write_known(arguments[2]);
  if (glGetError()) die("an OpenGL error", "");
  return 0;
}
