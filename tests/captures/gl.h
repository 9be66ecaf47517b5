// What the synthetic program needs besides its scene: matrices, a context without a window, shaders, targets, RenderDoc's capture of a
// frame, and files of NumPy. Matrices are column-major, as OpenGL has them.
#pragma once
#define _GNU_SOURCE
#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <GL/glcorearb.h>
#include <ctype.h>
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  float x, y, z;
} vec;
typedef struct {
  float m[16];
} mat;

static void die(const char* what, const char* more) {
  fprintf(stderr, "synthetic program: %s %s\n", what, more);
  exit(1);
}

static vec minus(vec a, vec b) { return (vec){a.x - b.x, a.y - b.y, a.z - b.z}; }
static vec cross(vec a, vec b) { return (vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
static float dot(vec a, vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static vec unit(vec a) {
  const float l = sqrtf(dot(a, a));
  return (vec){a.x / l, a.y / l, a.z / l};
}
static const mat identity = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
static mat mul(mat a, mat b) {
  mat r = {{0}};
  for (int c = 0; c < 4; c++)
    for (int i = 0; i < 4; i++)
      for (int k = 0; k < 4; k++) r.m[c * 4 + i] += a.m[k * 4 + i] * b.m[c * 4 + k];
  return r;
}
static mat scaling(float x, float y, float z) { return (mat){{x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 0, 0, 0, 1}}; }
static mat moving(float x, float y, float z) { return (mat){{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1}}; }
static mat turning(float deg) {  // about y
  const float c = cosf(deg * 0.01745329252f), s = sinf(deg * 0.01745329252f);
  return (mat){{c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, 0, 0, 0, 1}};
}
static mat looking(vec eye, vec target, vec up) {
  const vec f = unit(minus(target, eye)), s = unit(cross(f, up)), u = cross(s, f);
  return (mat){{s.x, u.x, -f.x, 0, s.y, u.y, -f.y, 0, s.z, u.z, -f.z, 0, -dot(s, eye), -dot(u, eye), dot(f, eye), 1}};
}
// The depth row of both projections, n and f being distances: n becomes `at_n` and f `at_f` (-1 and 1, or 1 and 0 for reversed depth).
static mat parallel(float l, float r, float b, float t, float n, float f, float at_n, float at_f) {
  const float a = (at_f - at_n) / (f - n);
  return (mat){{2 / (r - l), 0, 0, 0, 0, 2 / (t - b), 0, 0, 0, 0, -a, 0, -(r + l) / (r - l), -(t + b) / (t - b),
                at_n - a * n, 1}};
}
static mat perspective(float fov_deg, float aspect, float n, float f, float at_n, float at_f) {  // f may be infinite
  const float g = 1 / tanf(fov_deg / 2 * 0.01745329252f);
  const float b = isinf(f) ? n * (at_n - at_f) : (at_n - at_f) * n * f / (f - n), a = at_f + (isinf(f) ? 0 : b / -f);
  return (mat){{g / aspect, 0, 0, 0, 0, g, 0, 0, 0, 0, -a, -1, 0, 0, b, 0}};
}
static mat inverse(mat a) {  // Gauss and Jordan, in double
  double w[4][8];
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 8; k++) w[i][k] = k < 4 ? a.m[k * 4 + i] : k - 4 == i;
  for (int c = 0; c < 4; c++) {
    int p = c;
    for (int i = c; i < 4; i++)
      if (fabs(w[i][c]) > fabs(w[p][c])) p = i;
    for (int k = 0; k < 8; k++) {
      const double swap = w[c][k];
      w[c][k] = w[p][k];
      w[p][k] = swap;
    }
    for (int k = 7; k >= c; k--) w[c][k] /= w[c][c];
    for (int i = 0; i < 4; i++)
      for (int k = 7; i != c && k >= c; k--) w[i][k] -= w[i][c] * w[c][k];
  }
  mat r;
  for (int i = 0; i < 16; i++) r.m[i] = (float)w[i % 4][4 + i / 4];
  return r;
}

static EGLDisplay display;
static EGLSurface surface;
static void open_context(int width, int height) {
  display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
  if (!eglInitialize(display, 0, 0) || !eglBindAPI(EGL_OPENGL_API)) die("no EGL with OpenGL", "");
  const EGLint wants[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_RED_SIZE, 8,
                          EGL_NONE};
  const EGLint size[] = {EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE};
  const EGLint core[] = {
      EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 0, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  EGLConfig config;
  EGLint found = 0;
  if (!eglChooseConfig(display, wants, &config, 1, &found) || !found) die("EGL has no pbuffer", "");
  surface = eglCreatePbufferSurface(display, config, size);
  if (!eglMakeCurrent(display, surface, surface, eglCreateContext(display, config, EGL_NO_CONTEXT, core)))
    die("no OpenGL 4.0", "");
  unsigned vertex_array;
  glGenVertexArrays(1, &vertex_array);
  glBindVertexArray(vertex_array);
}

static unsigned shader_of(GLenum kind, const char* defines, const char* source) {
  const char* text[] = {"#version 400\n", defines, source};
  const unsigned shader = glCreateShader(kind);
  glShaderSource(shader, 3, text, 0);
  glCompileShader(shader);
  int good;
  char log[2000] = "";
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  glGetShaderInfoLog(shader, sizeof log, 0, log);
  if (!good) die(defines, log);
  return shader;
}
// One file holds all stages. between: the stage between both others, or 0.
static unsigned program_of(const char* defines, const char* source, GLenum between) {
  const GLenum stages[] = {GL_VERTEX_SHADER, GL_FRAGMENT_SHADER, between};
  const char* names[] = {"VERTEX", "FRAGMENT", "BETWEEN"};
  const unsigned program = glCreateProgram();
  for (int i = 0; i < (between ? 3 : 2); i++) {
    char all[4000];
    snprintf(all, sizeof all, "%s#define %s\n", defines, names[i]);
    glAttachShader(program, shader_of(stages[i], all, source));
  }
  glLinkProgram(program);
  int good;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  if (!good) die("a program does not link", defines);
  return program;
}

static unsigned texture_of(GLenum target, int format, int width, int height, GLenum filter) {
  unsigned texture;
  glGenTextures(1, &texture);
  glBindTexture(target, texture);
  const int depth = format == GL_DEPTH_COMPONENT16 || format == GL_DEPTH_COMPONENT24 || format == GL_DEPTH_COMPONENT32F;
  const int stencil = format == GL_DEPTH24_STENCIL8;
  const GLenum layout = depth ? GL_DEPTH_COMPONENT : stencil ? GL_DEPTH_STENCIL : GL_RGBA;
  const GLenum type = stencil ? GL_UNSIGNED_INT_24_8 : GL_FLOAT;
  if (target == GL_TEXTURE_2D_MULTISAMPLE)
    glTexImage2DMultisample(target, 4, format, width, height, 1);
  else if (target == GL_TEXTURE_2D_ARRAY)
    glTexImage3D(target, 0, format, width, height, 3, 0, layout, type, 0);
  else if (target == GL_TEXTURE_CUBE_MAP)
    for (int i = 0; i < 6; i++)
      glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + i, 0, format, width, height, 0, layout, type, 0);
  else
    glTexImage2D(target, 0, format, width, height, 0, layout, type, 0);
  if (target != GL_TEXTURE_2D_MULTISAMPLE) {
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
  return texture;
}
static unsigned framebuffer_of(unsigned colour, unsigned depth, GLenum depth_kind,
                               int layer) {  // of the depth: a layer of an array, a face of a cube
  unsigned framebuffer;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  if (colour) glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, colour, 0);
  if (!colour) glDrawBuffer(GL_NONE);
  if (depth && depth_kind == GL_TEXTURE_CUBE_MAP)
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_CUBE_MAP_POSITIVE_X + (unsigned)layer, depth,
                           0);
  else if (depth && depth_kind == GL_TEXTURE_2D_ARRAY)
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, depth, 0, layer);
  else if (depth)
    glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, depth, 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) die("a framebuffer is not complete", "");
  return framebuffer;
}

// RenderDoc's own interface, if the program runs under it: calls 19 and 21 of version 1.1.2 begin and end the capture of a frame.
static void** renderdoc(void) {
  void *library = dlopen("librenderdoc.so", RTLD_NOW | RTLD_NOLOAD), **calls = 0;
  int (*get)(int, void**) = library ? (int (*)(int, void**))dlsym(library, "RENDERDOC_GetAPI") : 0;
  return get && get(10102, (void**)&calls) ? calls : 0;
}

static void write_npy(const char* path, const float* rows, int width,
                      int height) {  // the first row of `rows` is the lowest, of the file the top one
  FILE* file = fopen(path, "wb");
  if (!file) die("cannot write", path);
  char head[118];
  snprintf(head, sizeof head, "{'descr': '<f4', 'fortran_order': False, 'shape': (%d, %d), }", height, width);
  fwrite("\x93NUMPY\x01\x00\x76\x00", 1, 10, file);
  fprintf(file, "%-117s\n", head);
  for (int y = height - 1; y >= 0; y--) fwrite(rows + y * width, sizeof *rows, (size_t)width, file);
  if (fclose(file)) die("cannot write", path);
}
