// The receivers of a picture: for every pixel the visible surface point at its centre. One receiver image serves every
// technique and the truth, so that nothing but the shadow can differ between the renderers.
//
//   ReceiverImage receivers = resolve_receivers(
//       scene, camera, renderer.render_primitives(camera, 1280, 720, unseen_backs(scene, camera)));
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "scenes/image.h"
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

// The triangles that are single-sided and turn their backs to the camera, or are seen edge-on: bit t % 32 of word t /
// 32 is triangle t. Empty where there is none.
std::vector<uint32_t> unseen_backs(const Scene& scene, const Camera& camera);

// primitives: what the rasteriser saw at each pixel's centre (index into scene.triangles, or no_primitive).
// P is where the ray through the pixel's centre meets the primitive's plane, in double, moved to the nearest point of
// the triangle where the rasteriser's snapping put it outside, then rounded to float: so P never leaves its primitive
// by more than half a float's last place per axis, which an interpolated position does.
ReceiverImage resolve_receivers(const Scene& scene, const Camera& camera, const Image<uint32_t>& primitives);

}  // namespace noonmark
