// The scene of the synthetic program: its objects, lights and camera, each as the options say.
#pragma once
#include "gl.h"

enum {
  WIDTH = 160,
  HEIGHT = 90,
  MAP = 256,
  FLOOR = 0,
  BOX,
  TALL,
  TURNED,
  FLOATING,
  PLATE,
  ARM,
  HOLES,
  OUTSIDE,
  AWAY,
  OBJECTS
};
static const unsigned RESTART = 0xffffffff;  // begins a new strip
static char** options;                       // the features and faults of the command line
static int has(const char* name) {
  for (int i = 0; options[i]; i++)
    if (!strcmp(options[i], name)) return 1;
  return 0;
}
static int any(const char* a, const char* b) { return has(a) || has(b); }

// ---- the scene: vertices of position, normal, coordinates, weight; an object is a range of indices and its model matrix
static float vertices[4000];
static unsigned indices[2000];
static int vertex_count, index_count;
static struct object {
  int first, count;
  mat model;
  vec albedo;
  int instances;
} objects[OBJECTS];

static void quad(vec o, vec u, vec v, float weight0,
                 float weight1) {  // o, o + u, o + u + v, o + v, counter-clockwise from outside
  const vec n = unit(cross(u, v)), p[4] = {o,
                                           {o.x + u.x, o.y + u.y, o.z + u.z},
                                           {o.x + u.x + v.x, o.y + u.y + v.y, o.z + u.z + v.z},
                                           {o.x + v.x, o.y + v.y, o.z + v.z}};
  for (int i = 0; i < 4; i++) {
    const float one[9] = {p[i].x, p[i].y, p[i].z, n.x, n.y, n.z, i == 1 || i == 2, i > 1, i > 1 ? weight1 : weight0};
    memcpy(vertices + 9 * (vertex_count + i), one, sizeof one);
  }
  const unsigned triangles[2][6] = {{0, 1, 2, 0, 2, 3}, {0, 2, 1, 0, 3, 2}}, strip[5] = {0, 1, 3, 2, RESTART};
  for (int i = 0; i < (has("strips") ? 5 : 6); i++) {
    const unsigned at = has("strips") ? strip[i] : triangles[has("clockwise")][i];
    indices[index_count++] = at == RESTART ? at : (unsigned)vertex_count + at;
  }
  vertex_count += 4;
}
static void column(int parts) {  // a unit cube on y = 0, of several parts one above the other
  quad((vec){-.5f, 0, .5f}, (vec){0, 0, -1}, (vec){1, 0, 0}, 0, 0);
  for (int k = 0; k < parts; k++) {
    const float y = (float)k / parts, h = 1.f / parts;
    quad((vec){-.5f, y, .5f}, (vec){1, 0, 0}, (vec){0, h, 0}, y, y + h);
    quad((vec){.5f, y, .5f}, (vec){0, 0, -1}, (vec){0, h, 0}, y, y + h);
    quad((vec){.5f, y, -.5f}, (vec){-1, 0, 0}, (vec){0, h, 0}, y, y + h);
    quad((vec){-.5f, y, -.5f}, (vec){0, 0, 1}, (vec){0, h, 0}, y, y + h);
  }
  quad((vec){-.5f, 1, .5f}, (vec){1, 0, 0}, (vec){0, 0, -1}, 1, 1);
}
static void object(int which, int first, mat model, vec albedo) {
  objects[which] = (struct object){first, index_count - first, has("multidraw") ? identity : model, albedo,
                                   which == BOX && any("instanced", "multidraw") ? 3 : 1};
}
static void make_scene(void) {
  quad((vec){-4, 0, 4}, (vec){8, 0, 0}, (vec){0, 0, -8}, 0, 0);
  object(FLOOR, 0, mul(moving(.4f, 0, -.3f), turning(25)), (vec){.7f, .7f, .65f});
  int first = index_count;
  column(1);
  object(BOX, first, mul(moving(-.9f, 0, .4f), scaling(.8f, .7f, .8f)), (vec){.8f, .3f, .2f});
  object(TALL, first, mul(moving(.9f, 0, -.8f), scaling(.5f, 1.8f, .5f)), (vec){.3f, .6f, .3f});
  object(TURNED, first, mul(moving(.7f, 0, 1.3f), mul(turning(35), scaling(.7f, .5f, .7f))), (vec){.4f, .4f, .8f});
  object(FLOATING, first, mul(moving(-1.6f, .8f, -1.2f), mul(turning(20), scaling(.6f, .6f, .6f))),
         (vec){.8f, .8f, .3f});
  object(OUTSIDE, first, mul(moving(5.2f, .3f, .6f), mul(turning(15), scaling(1.2f, 4.f, 1.2f))), (vec){.5f, .5f, .5f});
  first = index_count;
  quad((vec){-.5f, 0, .5f}, (vec){1, 0, 0}, (vec){0, 0, -1}, 0, 0);
  object(PLATE, first, mul(moving(-.2f, .9f, -1.9f), scaling(1.1f, 1, .9f)), (vec){.6f, .6f, .6f});
  first = index_count;
  column(4);
  object(ARM, first, mul(moving(1.8f, 0, .3f), scaling(.35f, 1.5f, .35f)), (vec){.8f, .5f, .6f});
  first = index_count;
  quad((vec){-.5f, 0, 0}, (vec){1, 0, 0}, (vec){0, 1, 0}, 0, 0);
  object(HOLES, first, mul(moving(0, has("gone"), 1.2f), mul(turning(30), scaling(1.1f, 1.1f, 1))),
         (vec){.3f, .7f, .4f});
  first = index_count;
  quad((vec){.5f, 0, 0}, (vec){-1, 0, 0}, (vec){0, 1, 0}, 0, 0);  // the camera sees its back
  object(AWAY, first, mul(moving(-.6f, 0, -2.9f), scaling(2, 2.2f, 1)), (vec){.6f, .4f, .2f});
}
static int drawn(int which, int for_map) {  // is the object drawn in this pass
  if (has("multidraw")) return which == FLOOR || which == BOX;
  if (which == ARM) return has("skinned");
  if (which == HOLES) return has("masked");
  if (which == AWAY) return has("backs");
  if (which == OUTSIDE) return has("outside") && for_map;
  return !(which == TALL && for_map && has("culled"));
}

// ---- lights and camera
static struct light {
  const char* kind;
  vec way, colour;  // directional: towards the light; otherwise its place
  mat map[6], lookup[6];
  unsigned texture, framebuffers[6];
  int maps;
  float bias;  // of window depth
} lights[2];
static int light_count;
static float at_near, at_far;
static mat camera_view, camera_projection;

static void place_light(struct light* l, const char* kind, int frame) {
  l->kind = kind;
  if (!strcmp(kind, "directional")) {
    const float a = .04f * frame;  // moves, so that the last frame's matrix is another
    l->way = unit((vec){3 * cosf(a) - 2 * sinf(a), 3.2f, 2 * cosf(a) + 3 * sinf(a)});
    l->colour = (vec){1, .9f, .7f};
    const vec eye = {7 * l->way.x, 7 * l->way.y, 7 * l->way.z};
    const mat view = looking(eye, (vec){0, 0, 0}, (vec){0, 1, 0});
    l->maps = any("cascades-atlas", "cascades-array") ? 3 : 1;
    l->bias = has("small") ? .0003f : has("large") ? .04f : has("normal-offset") ? 1.75f * 10 / MAP : .005f;
    for (int k = 0; k < l->maps; k++) {
      const float e = has("beyond")  ? 2
                      : l->maps == 1 ? 5
                                     : (float[]){1.5f, 2.8f, 5.5f}[k],
                  z = l->maps == 1 ? 0 : (float[]){1.6f, .8f, 0}[k];
      const vec c = {view.m[8] * z, view.m[9] * z, 0};  // the cascades follow the view, from near to far
      l->map[k] = mul(parallel(c.x - e, c.x + e, c.y - e, c.y + e, 1, 14, at_near, at_far), view);
    }
  } else {
    const int cube = !strcmp(kind, "point");
    l->way = cube ? (vec){-.3f, 2.6f, .5f} : (vec){2 + .1f * frame, 4.2f, 1.8f};
    l->colour = (vec){.5f, .7f, 1};
    l->maps = cube ? 6 : 1;
    l->bias = cube ? .0006f : .001f;
    const vec ways[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}, down = {0, -1, 0};
    for (int k = 0; k < l->maps; k++) {
      const vec aim =
          cube ? (vec){l->way.x + ways[k].x, l->way.y + ways[k].y, l->way.z + ways[k].z} : (vec){-.2f, 0, -.2f};
      const mat view = looking(l->way, aim, cube ? (k == 2 ? ways[4] : k == 3 ? ways[5] : down) : (vec){0, 1, 0});
      l->map[k] = mul(perspective(cube ? 90 : 75, 1, cube ? .1f : .8f, 12, at_near, at_far), view);
    }
  }
}
static void place_all(int frame) {
  at_near = has("reversed") ? 1 : -1;
  at_far = has("reversed") ? 0 : 1;
  light_count = any("two", "other-map") ? 2 : 1;
  place_light(&lights[0], any("spot", "vertex-bias") ? "spot" : has("point") ? "point" : "directional", frame);
  if (light_count == 2) place_light(&lights[1], "spot", frame);
  if (any("polygon-offset", "vertex-bias")) lights[0].bias = 0;  // it is in the map
  camera_view = looking((vec){.1f, 2.6f, 4.4f}, (vec){0, .25f, 0}, (vec){0, 1, 0});
  const float aspect = (float)WIDTH / HEIGHT;
  camera_projection = has("orthographic")
                          ? parallel(-2.3f * aspect, 2.3f * aspect, -2.3f, 2.3f, .5f, 15, at_near, at_far)
                          : perspective(45, aspect, .2f, has("infinite") ? INFINITY : 40, at_near, at_far);
}
