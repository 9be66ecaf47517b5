#include "raytrace/embree_scene.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/address_space.h"
#include "base/error.h"
#include "raytrace/vertex_rounding.h"
#include "scenes/nearest_in_triangle.h"

namespace noonmark {
namespace {

struct ShadowContext : embree::Context {
  const EmbreeScene* scene = nullptr;
  const ShadowRay* rays = nullptr;
  std::span<const uint32_t> unseen;      // empty: none
  std::vector<uint32_t>* all = nullptr;  // where all_hits() collects
};

// code: as rtcGetDeviceError had it, which forgets it.
[[noreturn]] void device_failed(RTCError code, const std::string& what) {
  if (code == RTC_ERROR_OUT_OF_MEMORY)
    throw Error(ErrorKind::device, what + ": memory has run out; choose a smaller scene, or a machine with more");
  throw Error(ErrorKind::device,
              what + " (Embree error " + std::to_string(static_cast<int>(code)) + "); run noonmark doctor");
}

}  // namespace

float largest_coordinate(const Scene& scene) {
  glm::vec3 largest(0);
  for (const glm::vec3& p : scene.positions) largest = glm::max(largest, glm::abs(p));
  return std::max({largest.x, largest.y, largest.z});
}

EmbreeDevice::EmbreeDevice() {
  // avx2: every x86 machine of the last decade has it, and packets of 16 gain little from a wider set. If the machine
  // lacks it, Embree uses the widest set that the machine has.
  for (const char* isa : {"avx2", "avx", "sse4.2", "sse2", ""}) {
    // Subdivision surfaces have a cache of 128 MB, which triangles never use; and where its allocation fails, Embree
    // 3.13 keeps its lock, so that the device's release waits for ever.
    const std::string config = std::string("tessellation_cache_size=0") + (*isa ? ",isa=" : "") + isa;
    device_.reset(rtcNewDevice(config.c_str()));
    if (device_ && rtcGetDeviceError(device_.get()) == RTC_ERROR_NONE) {
      isa_ = *isa ? isa : "default";
      return;
    }
  }
  device_failed(rtcGetDeviceError(nullptr), "cannot start Embree");
}

std::string EmbreeDevice::version() const {
  const auto part = [&](RTCDeviceProperty property) {
    return std::to_string(rtcGetDeviceProperty(device_.get(), property));
  };
  return part(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + "." + part(RTC_DEVICE_PROPERTY_VERSION_MINOR) + "." +
         part(RTC_DEVICE_PROPERTY_VERSION_PATCH);
}

EmbreeScene::EmbreeScene(const EmbreeDevice& device, const Scene& scene, std::vector<uint32_t> kept)
    : device_(device), scene_(scene), kept_(std::move(kept)) {
  embree_.reset(rtcNewScene(device.get()));
  rtcSetSceneFlags(embree_.get(), RTC_SCENE_FLAG_ROBUST);
  const size_t count = kept_.empty() ? scene.triangles.size() : kept_.size();
  if (count == 0) {  // no ray meets an empty scene, and Embree has no buffers of size 0
    rtcCommitScene(embree_.get());
    return;
  }
  // An allocation that fails within the build ends the program or never returns. Measured with Embree 3.13.5: at most
  // 48 bytes a triangle in the buffers and 123 while it builds; a small scene takes 1.2 kB. Threads may start in it.
  const size_t threads = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  require_address_space(count * 256 + (uint64_t{1} << 22) + threads * address_space_of_a_thread,
                        "Embree's tree of the scene");
  RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                           scene.positions.size());
  void* indices =
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), count);
  if (!vertices || !indices) {
    rtcReleaseGeometry(geometry);
    device_failed(rtcGetDeviceError(device.get()),
                  "Embree cannot hold the scene's " + std::to_string(count) + " triangles");
  }
  std::memcpy(vertices, scene.positions.data(), scene.positions.size() * sizeof(glm::vec3));
  auto* triangles = static_cast<glm::uvec3*>(indices);
  for (size_t i = 0; i < count; ++i) triangles[i] = scene.triangles[kept_.empty() ? i : kept_[i]];
  rtcSetGeometryOccludedFilterFunction(geometry, filter);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(embree_.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(embree_.get());
  if (const RTCError error = rtcGetDeviceError(device.get()); error != RTC_ERROR_NONE)
    device_failed(error, "Embree cannot build the scene");

  // Float's relative error is 2^-24; at grazing angles the plane distance amplifies it. 2^-12 of the scene's size
  // leaves a factor of 4096 for that, and deciding a hit in double that did not need it costs time but no truth.
  near_distance_ = largest_coordinate(scene) * 0x1p-12f;
}

void EmbreeScene::first_hits(int count, const LightRay* starts, uint32_t* primitives) const {
  device_.count_rays(count);
  alignas(64) RTCRayHit16 rays;
  alignas(64) int valid[packet_size];
  for (int i = 0; i < packet_size; ++i) {
    valid[i] = i < count ? -1 : 0;
    const LightRay& start = starts[i < count ? i : 0];
    rays.ray.org_x[i] = start.origin.x;
    rays.ray.org_y[i] = start.origin.y;
    rays.ray.org_z[i] = start.origin.z;
    rays.ray.dir_x[i] = start.direction.x;
    rays.ray.dir_y[i] = start.direction.y;
    rays.ray.dir_z[i] = start.direction.z;
    rays.ray.tnear[i] = 0;
    rays.ray.tfar[i] = std::numeric_limits<float>::infinity();
    rays.ray.time[i] = 0;
    rays.ray.mask[i] = ~0u;
    rays.ray.id[i] = static_cast<unsigned>(i);
    rays.ray.flags[i] = 0;
    rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  embree::Context context;
  embree::intersect16(valid, embree_.get(), context, rays);
  for (int i = 0; i < count; ++i) {
    const bool hit = rays.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
    primitives[i] = !hit ? no_primitive : kept_.empty() ? rays.hit.primID[i] : kept_[rays.hit.primID[i]];
  }
}

namespace {

RTCRayHit single_ray(glm::vec3 origin, glm::vec3 direction, float tnear) {
  RTCRayHit ray{};
  ray.ray = {origin.x,    origin.y,    origin.z,
             tnear,       direction.x, direction.y,
             direction.z, 0,           std::numeric_limits<float>::infinity(),
             ~0u,         0,           0};
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return ray;
}

}  // namespace

uint32_t EmbreeScene::first_hit(const LightRay& start) const {
  device_.count_rays(1);
  RTCRayHit ray = single_ray(start.origin, start.direction, 0);
  embree::Context context;
  embree::intersect(embree_.get(), context, ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return no_primitive;
  return kept_.empty() ? ray.hit.primID : kept_[ray.hit.primID];
}

void EmbreeScene::all_hits(const LightRay& start, std::vector<uint32_t>& primitives) const {
  device_.count_rays(1);
  RTCRay ray = single_ray(start.origin, start.direction, 0).ray;
  ShadowContext context;
  context.scene = this;
  context.all = &primitives;  // the filter lets none of them stop the ray
  embree::occluded(embree_.get(), context, ray);
}

uint32_t EmbreeScene::occluded(int count, const ShadowRay* starts, std::span<const uint32_t> unseen) const {
  device_.count_rays(count);
  alignas(64) RTCRay16 rays;
  alignas(64) int valid[packet_size];
  for (int i = 0; i < packet_size; ++i) {
    valid[i] = i < count ? -1 : 0;
    const ShadowRay& start = starts[i < count ? i : 0];
    rays.org_x[i] = start.origin.x;
    rays.org_y[i] = start.origin.y;
    rays.org_z[i] = start.origin.z;
    rays.dir_x[i] = start.direction.x;
    rays.dir_y[i] = start.direction.y;
    rays.dir_z[i] = start.direction.z;
    rays.tnear[i] = 0;
    rays.tfar[i] = start.reach + near_distance_;  // is_occluder() looks closer
    rays.time[i] = 0;
    rays.mask[i] = ~0u;
    rays.id[i] = static_cast<unsigned>(i);
    rays.flags[i] = 0;
  }
  ShadowContext context;
  context.scene = this;
  context.rays = starts;
  context.unseen = unseen;
  embree::occluded16(valid, embree_.get(), context, rays);
  uint32_t mask = 0;
  for (int i = 0; i < count; ++i) mask |= rays.tfar[i] < 0 ? 1u << i : 0u;
  return mask;
}

double EmbreeScene::occluder_distance(const ShadowRay& start) const {
  float tnear = 0;
  for (;;) {
    device_.count_rays(1);
    RTCRayHit ray = single_ray(start.origin, start.direction, tnear);
    embree::Context context;
    embree::intersect(embree_.get(), context, ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID || ray.ray.tfar > start.reach + near_distance_)
      return std::numeric_limits<double>::infinity();
    const uint32_t primitive = kept_.empty() ? ray.hit.primID : kept_[ray.hit.primID];
    if (is_occluder(start, primitive, ray.ray.tfar)) return ray.ray.tfar;
    // On by the rounding of the scene's size: at t = 0 the next float above is no step at all.
    tnear = std::max(std::nextafter(ray.ray.tfar, std::numeric_limits<float>::infinity()),
                     ray.ray.tfar + near_distance_ * 0x1p-12f);
  }
}

namespace {

// A query for the nearest triangle. Embree calls visit() for each triangle whose box is within the query's radius. The
// distance is computed in double; the radius is a float, so it is rounded up.
struct NearestQuery {
  const Scene& scene;
  const std::vector<uint32_t>& kept;
  glm::dvec3 p;
  double equal_m;
  const std::function<bool(uint32_t)>& preferred;
  double least = std::numeric_limits<double>::infinity(), least_preferred = least;
  EmbreeScene::Nearest any{}, wanted{};

  bool visit(uint32_t primitive, float& radius) {
    const glm::uvec3 t = scene.triangles[primitive];
    const glm::dvec3 point = nearest_of_triangle(p, scene.positions[t.x], scene.positions[t.y], scene.positions[t.z]);
    const double distance = glm::length(point - p);
    if (distance < least_preferred && preferred(primitive)) {
      least_preferred = distance;
      wanted = {primitive, point};
    }
    if (!(distance < least)) return false;
    least = distance;
    any = {primitive, point};
    radius = std::nextafter(static_cast<float>(least + equal_m), std::numeric_limits<float>::infinity());
    return true;
  }
};

}  // namespace

EmbreeScene::Nearest EmbreeScene::nearest(glm::dvec3 p, double equal_m,
                                          const std::function<bool(uint32_t)>& preferred) const {
  NearestQuery asked{scene_, kept_, p, equal_m, preferred};
  RTCPointQuery query{};
  const glm::vec3 at(p);
  query.x = at.x;
  query.y = at.y;
  query.z = at.z;
  query.radius = std::numeric_limits<float>::infinity();
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(
      embree_.get(), &query, &context,
      [](RTCPointQueryFunctionArguments* arguments) {
        NearestQuery& to = *static_cast<NearestQuery*>(arguments->userPtr);
        const uint32_t hit = arguments->primID;
        return to.visit(to.kept.empty() ? hit : to.kept[hit], arguments->query->radius);
      },
      &asked);
  return asked.least_preferred <= asked.least + equal_m ? asked.wanted : asked.any;
}

bool EmbreeScene::is_occluder(const ShadowRay& ray, uint32_t primitive, float distance) const {
  if (primitive == ray.own) return false;
  const bool near_start = !(distance > near_distance_ && distance > 2 * ray.own_distance),
             near_end = !(distance < ray.reach - near_distance_);
  if (!near_start && !near_end) return true;
  // Hits near an end of the ray are decided in double. The distance to the other triangle's plane is compared with the
  // distances to the receiver's own plane and to the light. A lamp that is fixed exactly to a ceiling is not behind it.
  const glm::uvec3 t = scene_.triangles[primitive];
  const glm::dvec3 a = scene_.positions[t.x], b = scene_.positions[t.y], c = scene_.positions[t.z];
  const glm::dvec3 cross = glm::cross(b - a, c - a);
  const double slope = glm::dot(cross, glm::dvec3(ray.direction));
  if (slope == 0) return false;
  // Both distances have double's rounding error, which grows where a plane is edge-on. The tolerance is 2^-48 of the
  // coordinates divided by the cosine: 16 times that error.
  const auto rounding = [&](glm::dvec3 from) {
    return 0x1p-48 * (glm::length(from) + glm::length(a)) * glm::length(cross) / std::abs(slope);
  };
  if (near_end && !(glm::dot(cross, a - ray.end) / slope < -rounding(ray.end))) return false;
  if (!near_start) return true;
  const glm::dvec3 origin(ray.origin);
  const double exact = glm::dot(cross, a - origin) / slope;
  return exact > ray.own_distance + rounding(origin) && !may_be_one_plane(scene_, primitive, ray.own);
}

void EmbreeScene::filter(const RTCFilterFunctionNArguments* arguments) {
  // Called for the queries of occluded() and all_hits() only; intersect queries have no filter.
  const auto* context = static_cast<const ShadowContext*>(reinterpret_cast<const embree::Context*>(arguments->context));
  const EmbreeScene& scene = *context->scene;
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const unsigned hit = RTCHitN_primID(arguments->hit, arguments->N, i);
    const uint32_t primitive = scene.kept_.empty() ? hit : scene.kept_[hit];
    if (context->all) {
      context->all->push_back(primitive);
      arguments->valid[i] = 0;
      continue;
    }
    const unsigned lane = RTCRayN_id(arguments->ray, arguments->N, i);
    const float distance = RTCRayN_tfar(arguments->ray, arguments->N, i);
    const bool unseen = !context->unseen.empty() && (context->unseen[primitive / 32] >> (primitive % 32) & 1u);
    if (unseen || !scene.is_occluder(context->rays[lane], primitive, distance)) arguments->valid[i] = 0;
  }
}

}  // namespace noonmark
