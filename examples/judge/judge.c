/* Five lines in a renderer's screenshot test: is this frame's acne below 0.05%?
     cc judge.c -lnoonmark -o judge && ./judge
   The frame here is a black one of a built-in scene, which is wrong wherever the light reaches. */
#include <noonmark.h>
#include <stdio.h>
#include <stdlib.h>

int main(void) {
  enum { width = 320, height = 180 };
  /* A camera 6 m above the scene that looks down; orthographic, 12 m x 6.75 m. */
  const double camera[16] = {2 / 12., 0, 0, 0, 0, 0, -2 / 20., 0, 0, -2 / 6.75, 0, 0, 0, 0, -0.4, 1};
  noonmark_frame frame;
  noonmark_verdict *verdict;
  noonmark_scene *scene = noonmark_scene_load("plate");
  float *visibility = calloc((size_t)width * height, sizeof *visibility);
  size_t i;
  int status;
  if (!visibility) return 4;

  noonmark_frame_init(&frame, sizeof frame);
  frame.width = width;
  frame.height = height;
  frame.visibility = visibility;
  for (i = 0; i < 16; ++i) frame.clip_from_world[i] = camera[i];
  frame.light_direction[0] = 0.5;
  frame.light_direction[1] = -1;
  frame.accept = "shaded,match,intensity";
  verdict = noonmark_judge(scene, &frame);

  status = noonmark_status(verdict);
  for (i = 0; noonmark_message(verdict, i); ++i) printf("%s\n", noonmark_message(verdict, i));
  for (i = 0; noonmark_number_name(verdict, i); ++i)
    printf("%s = %g\n", noonmark_number_name(verdict, i), noonmark_number(verdict, noonmark_number_name(verdict, i)));
  if (status == NOONMARK_OK && !(noonmark_number(verdict, "frame_acne") <= 0.0005)) status = 1;
  noonmark_verdict_free(verdict);
  noonmark_scene_free(scene);
  free(visibility);
  return status;
}
