// Owned Embree device and scene over a scene's triangles, and packets of rays through it. Geometry IDs never leave this
// file: a hit is the index of the triangle in Scene::triangles.
//
// The scene is built with Embree's flag ROBUST, because without it 1 to 15 % of the rays aimed at vertices and edges
// pass through. The instruction set is fixed, because verdicts at silhouettes differ between instruction sets.
#pragma once
#include <tbb/combinable.h>

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "raytrace/embree_compat.h"
#include "scenes/receivers.h"
#include "scenes/scene.h"

namespace noonmark {

inline constexpr int packet_size = 16;

// The largest absolute coordinate of any vertex: what float's rounding is relative to.
float largest_coordinate(const Scene& scene);

class EmbreeDevice {
 public:
  EmbreeDevice();
  RTCDevice get() const { return device_.get(); }
  std::string version() const;
  const std::string& isa() const { return isa_; }

  // The rays that all scenes of this device have cast. Read it while none is cast.
  uint64_t rays() const { return rays_.combine(std::plus<>()); }
  void count_rays(int more) const { rays_.local() += static_cast<uint64_t>(more); }

 private:
  struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  };
  std::unique_ptr<RTCDeviceTy, Release> device_;
  std::string isa_;
  mutable tbb::combinable<uint64_t> rays_{[] { return uint64_t{0}; }};
};

// A ray from the light's side.
struct LightRay {
  glm::vec3 origin{0};
  glm::vec3 direction{0, 0, -1};  // unit, to float's rounding
};

// A shadow ray that starts on a triangle of the scene, `own`. own_distance: the distance along the ray, in units of its
// direction's length, at which the plane of `own` lies, in double. It is not 0, because the receiver's position is
// rounded to float. Faces near the start that may have been one plane with `own` cast no shadow on it
// (raytrace/vertex_rounding.h).
struct ShadowRay {
  glm::vec3 origin{0};
  glm::vec3 direction{0};
  float reach = std::numeric_limits<float>::infinity();  // to the light, in units of the direction's length
  glm::dvec3 end{0};                                     // finite reach: the place on the light, exactly
  uint32_t own = no_primitive;
  double own_distance = 0;
};

class EmbreeScene {
 public:
  // kept: indices of the triangles that take part; empty: all of them. Device and scene must outlive it.
  EmbreeScene(const EmbreeDevice& device, const Scene& scene, std::vector<uint32_t> kept = {});

  // count: 1 ... 16.
  void first_hits(int count, const LightRay* rays, uint32_t* primitives) const;
  uint32_t first_hit(const LightRay& ray) const;

  // Every triangle that the ray meets, in no order.
  void all_hits(const LightRay& ray, std::vector<uint32_t>& primitives) const;

  // Bit i: ray i meets another triangle than its own, beyond its own plane and before the light. count: 1 ... 16.
  // unseen: triangles that stop no ray; bit t % 32 of word t / 32 is triangle t. Empty: every triangle stops rays.
  uint32_t occluded(int count, const ShadowRay* rays, std::span<const uint32_t> unseen = {}) const;

  // occluded() counts a hit further than this from both ends of the ray, and further than twice the ray's own_distance,
  // whatever the triangle is. It decides nearer hits in double.
  double near_distance() const { return near_distance_; }

  // The point of all triangles that is nearest to p. Of points that are at most `equal_m` further away, one on a
  // triangle that is preferred; of these the nearest. no_primitive in an empty scene.
  struct Nearest {
    uint32_t primitive = no_primitive;
    glm::dvec3 point{0};
  };
  Nearest nearest(glm::dvec3 p, double equal_m, const std::function<bool(uint32_t)>& preferred) const;

  // Distance (in units of the direction's length) to the occluder nearest to the receiver; infinity without one.
  double occluder_distance(const ShadowRay& ray) const;

 private:
  static void filter(const RTCFilterFunctionNArguments* arguments);
  bool is_occluder(const ShadowRay& ray, uint32_t primitive, float distance) const;

  struct Release {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };
  const EmbreeDevice& device_;
  const Scene& scene_;
  std::vector<uint32_t> kept_;
  std::unique_ptr<RTCSceneTy, Release> embree_;
  float near_distance_ = 0;  // hits nearer than this to either end are decided in double
};

}  // namespace noonmark
