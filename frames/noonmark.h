/* The C interface of Noonmark's judge: how right are the shadows of a frame?

     noonmark_scene *scene = noonmark_scene_load("room.glb");
     noonmark_frame frame;
     noonmark_frame_init(&frame, sizeof frame);
     frame.width = 1280; frame.height = 720; frame.visibility = pixels; ...
     noonmark_verdict *verdict = noonmark_judge(scene, &frame);
     printf("%g\n", noonmark_number(verdict, "frame_error"));
     noonmark_verdict_free(verdict);
     noonmark_scene_free(scene);

   No call throws or ends the program. A call that fails returns a verdict whose noonmark_status is not NOONMARK_OK, and whose
   messages say why. Structs carry their size, so a program that was compiled with an older header works with a newer library.
   Calls may run in several threads; one scene may be used by one call at a time. docs/reference/frame.md has the definitions. */
#ifndef NOONMARK_H
#define NOONMARK_H
#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define NOONMARK_API
#else
#define NOONMARK_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noonmark_scene noonmark_scene;
typedef struct noonmark_verdict noonmark_verdict;

/* The same numbers as the program's exit codes. */
enum {
  NOONMARK_OK = 0,
  NOONMARK_WRONG_CALL = 2,    /* an argument or a field is wrong */
  NOONMARK_BAD_FILE = 3,      /* the scene cannot be read, or a check of the delivery failed that was not accepted */
  NOONMARK_NO_DEVICE = 4,     /* no memory, or Embree cannot start */
  NOONMARK_DEFECT = 5         /* a defect of Noonmark */
};

enum { NOONMARK_DIRECTIONAL = 0, NOONMARK_SPOT = 1, NOONMARK_POINT = 2 };

/* Classes of pixels, in noonmark_classes(). */
enum {
  NOONMARK_NONE = 0,
  NOONMARK_PENUMBRA = 1,
  NOONMARK_EDGE = 2,
  NOONMARK_ACNE = 3,
  NOONMARK_CONTACT = 4,
  NOONMARK_LEAK = 5,
  NOONMARK_MISSING = 6    /* a caster that the frame's map lacks; only of a frame.json that names it */
};

/* Noonmark's version, "0.1.0". */
NOONMARK_API const char *noonmark_version(void);

/* A built-in scene by its name, or a .gltf, .glb or .vrm file. It has the status and messages of noonmark_scene_status() and is never
   NULL, but where there is no memory for it. */
NOONMARK_API noonmark_scene *noonmark_scene_load(const char *name);
/* Triangles of a program: positions are vertices x 3 floats in metres, each from -1e9 to 1e9, right-handed and Y up; indices are triangles x 3, counter-
   clockwise seen from outside. Both are copied. */
NOONMARK_API noonmark_scene *noonmark_scene_from_triangles(const float *positions, size_t vertices, const uint32_t *indices,
                                                           size_t triangles);
NOONMARK_API int noonmark_scene_status(const noonmark_scene *scene);
/* Why the status is not NOONMARK_OK, one line; empty if it is. Valid as long as the scene. */
NOONMARK_API const char *noonmark_scene_message(const noonmark_scene *scene);
NOONMARK_API void noonmark_scene_free(noonmark_scene *scene);

/* What is judged. All arrays are row by row, the top row first, and are only read during the call. Numbers have the ranges of
   the same keys of frame.json (docs/reference/frame.md): a call with another number, NaN or infinity is a NOONMARK_WRONG_CALL
   that names it. */
typedef struct noonmark_frame {
  size_t struct_size; /* set by noonmark_frame_init */
  int32_t width, height;
  const float *visibility; /* width x height: 1 lit, 0 shadowed; -1 or NaN: no surface; -2: a surface that is not judged */
  const float *positions;  /* width x height x 3: world positions of the receivers, NaN without a surface; or NULL: by rays */
  double clip_from_world[16]; /* of the camera, column by column, for column vectors */
  int32_t depth_0_to_1;       /* whether clip space has depths from 0 to 1; otherwise -1 to 1 */
  int32_t reversed;           /* whether the near plane has the largest depth */
  int32_t y_down;             /* whether y of clip space grows downwards */
  int32_t light_kind;         /* NOONMARK_DIRECTIONAL ... */
  double light_position[3];   /* spot, point: metres */
  double light_direction[3];  /* directional, spot: the way the light travels, of any length but 0; required */
  double light_cone_deg;      /* spot: the whole angle, up to 180 */
  double light_angular_diameter_deg; /* directional: of a light with a size, up to 90; 0: none */
  double light_radius_m;             /* spot, point: of a light with a size, up to 1e6; 0: none */
  double edge_pixels; /* how near to a true shadow edge an error belongs to the edge; by default 2 */
  double edge_m;      /* the same in metres across the light's rays; 0: by edge_pixels */
  double contact_m;   /* how near an occluder is at a contact; 0: 1% of the scene's diagonal */
  const char *accept; /* names of checks whose failure does not refuse the frame, separated by commas; or NULL */
  int64_t normalised; /* not 0: visibility is the share between the same frame all lit and all dark */
} noonmark_frame;

/* Sets every field to its default. struct_size: sizeof(noonmark_frame), as the caller was compiled. */
NOONMARK_API void noonmark_frame_init(noonmark_frame *frame, size_t struct_size);

/* Never NULL, but where there is no memory for it. */
NOONMARK_API noonmark_verdict *noonmark_judge(noonmark_scene *scene, const noonmark_frame *frame);
NOONMARK_API int noonmark_status(const noonmark_verdict *verdict);
/* A metric by its name: "frame_error", "frame_wrong", "frame_acne", "counted" ... NaN if the verdict has none of this name.
   "ambiguous" is the share of the receivers whose truth rounding decides, as under a light at 1e7 m. They are left out of all others, so
   each of these may be larger or smaller by that much. */
NOONMARK_API double noonmark_number(const noonmark_verdict *verdict, const char *metric);
/* The names of all its metrics: index 0 ... until NULL. */
NOONMARK_API const char *noonmark_number_name(const noonmark_verdict *verdict, size_t index);
/* width x height classes, the top row first; NULL if the frame was not judged. */
NOONMARK_API const uint8_t *noonmark_classes(const noonmark_verdict *verdict);
/* width x height true visibilities, the top row first; NULL if the frame was not judged. */
NOONMARK_API const float *noonmark_truth(const noonmark_verdict *verdict);
/* The counted pixel with the largest error; -1 if there is none. */
NOONMARK_API void noonmark_worst_pixel(const noonmark_verdict *verdict, int32_t *x, int32_t *y);
/* Why the status is not NOONMARK_OK, and what the checks of the delivery found: index 0 ... until NULL. */
NOONMARK_API const char *noonmark_message(const noonmark_verdict *verdict, size_t index);
NOONMARK_API void noonmark_verdict_free(noonmark_verdict *verdict);

#ifdef __cplusplus
}
#endif
#endif
