#pragma once
#include <chrono>
#include <cstdint>

#include "raytrace/embree_scene.h"
#include "technique/evidence.h"

namespace noonmark::raytrace {

// Adds to a stage what happens from here to the end of the scope: its time, and the rays that the device's scenes cast.
class StageWatch {
 public:
  // stage: may be null. Both must outlive it.
  StageWatch(StageTime* stage, const EmbreeDevice& device)
      : stage_(stage), device_(device), rays_before_(device.rays()) {}
  ~StageWatch() {
    if (!stage_) return;
    stage_->milliseconds +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    stage_->rays += device_.rays() - rays_before_;
  }
  StageWatch(const StageWatch&) = delete;
  StageWatch& operator=(const StageWatch&) = delete;

 private:
  StageTime* stage_;
  const EmbreeDevice& device_;
  uint64_t rays_before_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace noonmark::raytrace
