// Which receivers a camera sees. A ray from the receiver to the eye asks it, as a shadow ray asks a light.
#include <cmath>
#include <limits>

#include "raytrace/packets.h"
#include "raytrace/shadow_start.h"
#include "raytrace/traced_scene.h"
#include "raytrace/tracer.h"

namespace noonmark::raytrace {
namespace {

// A light that stands at the eye, or as far away as an orthographic camera looks from.
LightFrame light_at_eye(const Camera& camera) {
  Light eye;
  eye.kind = camera.projection == Projection::perspective ? LightKind::point : LightKind::directional;
  eye.position_m = camera.eye_m;
  eye.target_m = camera.target_m;
  return kind_of_light(eye.kind).axes(eye);
}

// The ray ends where it leaves what the camera sees: at the near plane. What lies nearer to the eye hides nothing.
class NearPlane {
 public:
  explicit NearPlane(const Camera& camera)
      : camera_(camera), forward_(glm::normalize(camera.target_m - camera.eye_m)), near_m_(camera.near_m.value()) {}

  // False if the ray starts before the plane.
  bool end(ShadowRay& ray) const {
    const glm::dvec3 from(ray.origin);
    const double beyond = glm::dot(from - camera_.eye_m, forward_) - near_m_;
    if (!(beyond > 0)) return false;
    const glm::dvec3 way = camera_.projection == Projection::perspective
                               ? (camera_.eye_m - from) * (beyond / (beyond + near_m_))
                               : -beyond * forward_;
    ray.end = from + way;
    ray.reach = static_cast<float>(glm::length(way));
    return true;
  }

 private:
  Camera camera_;
  glm::dvec3 forward_;
  double near_m_;
};

}  // namespace

SeenReceivers Tracer::seen_by(const ReceiverImage& given, const Camera& camera) const {
  std::optional<ReceiverImage> made;
  const ReceiverImage& receivers = on_first(given, made);
  const LightFrame frame = light_at_eye(camera);
  const ShadowStart start(traced_->scene, receivers, frame);
  const NearPlane near(camera);
  // Rays know only the first of triangles that coincide. It is not there for the camera if none of them is.
  std::vector<uint32_t> unseen = unseen_backs(traced_->scene, camera);
  if (const Adjacency& adjacency = traced_->adjacency; !unseen.empty() && adjacency.any_copies())
    for (uint32_t t = 0; t < adjacency.triangles(); ++t)
      if (const uint32_t first = adjacency.first(t); first != t && !(unseen[t / 32] >> (t % 32) & 1u))
        unseen[first / 32] &= ~(1u << (first % 32));

  std::vector<uint32_t> towards;  // receivers whose shown side faces the camera
  for (size_t i = 0; i < receivers.primitive.size(); ++i)
    if (receivers.primitive[i] != no_primitive &&
        glm::dot(glm::dvec3(receivers.normal[i]), frame.direction_to_light(glm::dvec3(receivers.position[i]))) > 0)
      towards.push_back(static_cast<uint32_t>(i));

  SeenReceivers result{Image<uint8_t>(given.width(), given.height(), 0),
                       Image<uint8_t>(given.width(), given.height(), 0)};
  const double error = LightView(traced_->scene, frame).ray_error_m();
  const glm::dvec2 places[5] = {{0, 0}, {error, 0}, {-error, 0}, {0, error}, {0, -error}};
  for_each_packet(towards.size(), [&](size_t first, int n) {
    uint32_t hidden[5];
    ShadowStart::Across axes[packet_size];
    for (int i = 0; i < n; ++i) axes[i] = start.across(towards[first + static_cast<size_t>(i)]);
    for (int place = 0; place < 5; ++place) {
      ShadowRay rays[packet_size];
      uint32_t before_near = 0;
      for (int i = 0; i < n; ++i) {
        const uint32_t pixel = towards[first + static_cast<size_t>(i)];
        rays[i] = place == 0 ? start.whole(pixel)
                             : start.beside(pixel, places[place].x * axes[i].right + places[place].y * axes[i].up);
        if (!near.end(rays[i])) before_near |= 1u << i;
      }
      hidden[place] = traced_->embree.occluded(n, rays, unseen) | before_near;
    }
    const uint32_t any = hidden[0] | hidden[1] | hidden[2] | hidden[3] | hidden[4],
                   all = hidden[0] & hidden[1] & hidden[2] & hidden[3] & hidden[4];
    for (int i = 0; i < n; ++i) {
      const uint32_t pixel = towards[first + static_cast<size_t>(i)];
      result.seen[pixel] = !(hidden[0] >> i & 1);
      result.ambiguous[pixel] = (any ^ all) >> i & 1;
    }
  });
  return result;
}

}  // namespace noonmark::raytrace
