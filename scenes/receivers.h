// The receivers of a picture: for every pixel, the visible surface point at its centre. Every technique and the truth
// use the same receiver image, so only the shadow can differ between the renderers.
//
//   ReceiverImage receivers = resolve_receivers(
//       scene, camera, renderer.render_primitives(camera, 1280, 720, unseen_backs(scene, camera)));
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "base/image.h"
#include "scenes/scene.h"

namespace noonmark {

inline constexpr uint32_t no_primitive = 0xffffffffu;

struct ReceiverImage {
  Image<glm::vec3> position;  // P, world, metres; float, because the shader reads it as float. Background: 0
  Image<glm::vec3> normal;    // N, unit, geometric, on the viewer's side of the surface. Background: 0
  Image<uint32_t> primitive;  // index into Scene::triangles, or no_primitive
  int width() const { return primitive.width; }
  int height() const { return primitive.height; }
};

// The single-sided triangles of which the camera sees the back or the edge: bit t % 32 of word t / 32 is triangle t.
// Empty if there is none.
std::vector<uint32_t> unseen_backs(const Scene& scene, const Camera& camera);

// primitives: what the rasteriser saw at each pixel's centre (index into scene.triangles, or no_primitive).
// P is the point where the ray through the pixel's centre meets the primitive's plane, computed in double. If the
// rasteriser's snapping has put it outside the triangle, it is moved to the nearest point of the triangle. Then it is
// rounded to float. So P leaves its primitive by at most half a float's last place per axis; an interpolated position
// would leave it further.
ReceiverImage resolve_receivers(const Scene& scene, const Camera& camera, const Image<uint32_t>& primitives);

}  // namespace noonmark
