#include "scenes/receivers.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "scenes/camera_frame.h"
#include "scenes/nearest_in_triangle.h"
#include "scenes/view_matrix.h"

namespace noonmark {
namespace {

// What all pixels that show a triangle share.
struct SeenTriangle {
  glm::dvec3 a{}, b{}, c{}, cross{};
  glm::vec3 normal{};
  double area = 0, area2 = 0, size = 0;  // area of the parallelogram, its square and its root
  uint32_t primitive = no_primitive;

  SeenTriangle() = default;
  SeenTriangle(const Scene& scene, uint32_t shown) : primitive(shown) {
    const glm::uvec3 t = scene.triangles[shown];
    a = scene.positions[t.x], b = scene.positions[t.y], c = scene.positions[t.z];
    cross = glm::cross(b - a, c - a);
    area = glm::length(cross);
    area2 = area * area;
    size = std::sqrt(area);
    normal = glm::vec3(cross * (1 / area));
  }
};

// view: has pixel_ray().
template <class View>
ReceiverImage resolve(const Scene& scene, const View& view, const Image<uint32_t>& primitives) {
  const int width = primitives.width, height = primitives.height;
  ReceiverImage receivers{Image<glm::vec3>(width, height, glm::vec3(0)), Image<glm::vec3>(width, height, glm::vec3(0)),
                          primitives};
  tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const tbb::blocked_range<int>& rows) {
    SeenTriangle seen;  // of the pixel before: most pixels show the same one
    for (int y = rows.begin(); y != rows.end(); ++y) {
      for (int x = 0; x < width; ++x) {
        const uint32_t primitive = primitives.at(x, y);
        if (primitive == no_primitive) continue;
        if (primitive != seen.primitive) seen = SeenTriangle(scene, primitive);
        const auto& [a, b, c, cross, normal, area, area2, size, of] = seen;
        const Ray ray = view.pixel_ray(x, y, width, height);
        const double slope = glm::dot(cross, ray.direction);
        if (!(area > 0)) {  // no normal, so nothing to light: a sliver that the rasteriser still drew
          receivers.primitive.at(x, y) = no_primitive;
          continue;
        }
        // Seen edge-on, the plane gives no point, or one so far away that nothing of it is left in double. Then the
        // ray's point beside the triangle's first corner will do.
        double along = glm::dot(cross, a - ray.origin) / slope;
        if (!(glm::length(along * ray.direction) < 0x1p26 * (glm::length(a - ray.origin) + size)))
          along = glm::dot(a - ray.origin, ray.direction) / glm::dot(ray.direction, ray.direction);
        glm::dvec3 met = ray.origin + along * ray.direction;
        met -= cross * (glm::dot(met - a, cross) / area2);  // onto the plane
        const glm::dvec3 point = nearest_in_triangle(met, a, b, c);
        receivers.position.at(x, y) = glm::vec3(point);
        receivers.normal.at(x, y) = slope > 0 ? -normal : normal;
      }
    }
  });
  return receivers;
}

}  // namespace

std::vector<uint32_t> unseen_backs(const Scene& scene, const Camera& camera) {
  std::vector<uint32_t> bits((scene.single_sided.size() + 31) / 32);
  bool any = false;
  for (size_t t = 0; t < scene.single_sided.size(); ++t) {
    if (!scene.single_sided[t]) continue;
    const glm::uvec3 corner = scene.triangles[t];
    const glm::dvec3 a = scene.positions[corner.x], b = scene.positions[corner.y], c = scene.positions[corner.z];
    const glm::dvec3 to_viewer =
        camera.projection == Projection::perspective ? camera.eye_m - a : camera.eye_m - camera.target_m;
    if (glm::dot(glm::cross(b - a, c - a), to_viewer) > 0) continue;
    bits[t / 32] |= 1u << (t % 32);
    any = true;
  }
  return any ? bits : std::vector<uint32_t>();
}

ReceiverImage resolve_receivers(const Scene& scene, const Camera& camera, const Image<uint32_t>& primitives) {
  return resolve(scene, make_camera_frame(camera, primitives.width, primitives.height), primitives);
}

ReceiverImage resolve_receivers(const Scene& scene, const ViewMatrix& view, const Image<uint32_t>& primitives) {
  return resolve(scene, view, primitives);
}

}  // namespace noonmark
