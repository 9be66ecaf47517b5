// The first hits of the rays of a small picture. The time grows linearly with the number of triangles.
//
//   FirstHits hits = first_hits(scene, make_camera_frame(camera, 32, 32), 32, Backs::seen);
//   if (hits.depth.at(x, y) != FirstHits::nothing && hits.back.at(x, y)) print("a back");
//
// For questions about a scene as a whole: no rasteriser, ray tracer or OpenGL is needed.
#pragma once
#include <cstdint>
#include <limits>

#include "base/image.h"
#include "scenes/camera_frame.h"
#include "scenes/scene.h"

namespace noonmark {

struct FirstHits {
  static constexpr float nothing = std::numeric_limits<float>::infinity();
  Image<float> depth;           // along the view, to a millionth of it; `nothing` where nothing is met
  Image<uint8_t> back;          // whether the ray comes from behind the triangle
  Image<uint8_t> single_sided;  // of the triangle's material
  uint64_t asked = 0;           // number of intersections of a ray with a triangle that were computed; most of the time
};

enum class Backs {
  seen,
  seen_of_double_sided,  // backs of single-sided triangles are not there
};

// rays: along each edge of the picture. Near and far of the camera mean nothing here.
FirstHits first_hits(const Scene& scene, const CameraFrame& frame, int rays, Backs backs);

}  // namespace noonmark
