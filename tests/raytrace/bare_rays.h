// The floor of the benchmarks: robust rays in packets of 16, without any decision about what they meet. The packets are filled
// before, and Embree is told that their rays are alike, so that no faster way is left out.
//
//   const BareRays rays(device, scene);
//   const BareRays::Packets packets(list);
//   rays.cast(packets);
#pragma once
#include <algorithm>
#include <limits>
#include <type_traits>
#include <vector>

#include "raytrace/embree_compat.h"
#include "raytrace/embree_scene.h"
#include "raytrace/packets.h"

namespace noonmark::raytrace {

class BareRays {
 public:
  struct Ray {
    glm::vec3 origin, direction;
  };

  // The device must outlive it.
  BareRays(const EmbreeDevice& device, const Scene& scene) : scene_(rtcNewScene(device.get())) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    const auto fill = [&](RTCBufferType type, RTCFormat format, const auto& items) {
      std::copy(items.begin(), items.end(),
                static_cast<typename std::decay_t<decltype(items)>::value_type*>(
                    rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(items[0]), items.size())));
    };
    fill(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, scene.positions);
    fill(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, scene.triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~BareRays() { rtcReleaseScene(scene_); }
  BareRays(const BareRays&) = delete;
  BareRays& operator=(const BareRays&) = delete;

  class Packets {
   public:
    explicit Packets(const std::vector<Ray>& rays)
        : count_(rays.size()), packets_((count_ + packet_size - 1) / packet_size) {
      for_each_packet(count_, [&](size_t first, int n) {
        RTCRay16& packet = packets_[first / packet_size].rays;
        for (int i = 0; i < packet_size; ++i) {
          const Ray& ray = rays[first + static_cast<size_t>(i < n ? i : 0)];
          packet.org_x[i] = ray.origin.x, packet.org_y[i] = ray.origin.y, packet.org_z[i] = ray.origin.z;
          packet.dir_x[i] = ray.direction.x, packet.dir_y[i] = ray.direction.y, packet.dir_z[i] = ray.direction.z;
          packet.tnear[i] = 1e-3f, packet.tfar[i] = std::numeric_limits<float>::infinity();
          packet.time[i] = 0, packet.mask[i] = ~0u, packet.id[i] = static_cast<unsigned>(i), packet.flags[i] = 0;
        }
      });
    }

   private:
    friend class BareRays;
    struct alignas(64) Packet {
      RTCRay16 rays;
    };
    size_t count_;
    std::vector<Packet> packets_;
  };

  void cast(const Packets& packets) const {
    for_each_packet(packets.count_, [&](size_t first, int n) {
      alignas(64) int valid[packet_size];
      for (int i = 0; i < packet_size; ++i) valid[i] = i < n ? -1 : 0;
      Packets::Packet packet = packets.packets_[first / packet_size];  // Embree writes into it
      embree::Context context;
      embree::occluded16(valid, scene_, context, packet.rays, true);
    });
  }

 private:
  RTCScene scene_;
};

}  // namespace noonmark::raytrace
