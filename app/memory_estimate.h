// How much memory the measurement of a point takes at its peak, predicted from its settings before it starts.
//
//   const MemoryEstimate estimate = estimate_memory({settings, LightKind::point, scene_size, open_edges, true, false});
//   require_memory(estimate, bench.memory_of_program(false), "point 3");   // throws where it would not fit
//
// The prediction is an upper bound that is made of constants per pixel, tap, texel, triangle and vertex. Where one of
// them dominates it is at most estimate_factor times what is taken (tests/memory_test.cpp). A map that lives on a
// graphics card is counted as if it lived here, as it does with llvmpipe.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/memory.h"
#include "scenes/scene.h"
#include "technique/light_frame.h"
#include "technique/light_kind.h"
#include "technique/settings.h"

namespace noonmark {

// The truth of a picture's taps is traced in strips of whole rows that take at most as much, so that memory does not
// grow with the kernel.
inline constexpr size_t most_strip_bytes = size_t{256} << 20;
inline size_t bytes_per_tap(LightKind light) {
  return kind_of_light(light).map_shape() == MapShape::cube ? 1 + sizeof(uint32_t)
                                                            : 1;  // TapTruth; LookupProbe::cube_texel
}

struct MemoryInput {
  const Settings& settings;
  LightKind light = LightKind::directional;
  SceneSize scene;
  uint64_t open_edges = 0;    // raytrace::Tracer::open_edges
  double outside_texels = 0;  // the most texels beside the map that receivers can ask for: outside_texels()
  bool curve = true;          // an exact curve of the error against the bias is read off
  bool pictures = false;      // pictures and EXR files are written
};

struct MemoryShare {
  const char* what;    // "the shadow map"
  const char* remedy;  // which setting lowers it
  double bytes = 0;
};

struct MemoryEstimate {
  std::vector<MemoryShare> shares;
  double bytes() const;  // their sum: the peak of the whole program
  const MemoryShare& largest() const;
};

MemoryEstimate estimate_memory(const MemoryInput& input);

inline constexpr double estimate_factor = 3;

// How many texels beside a flat map the scene reaches, kernel included; a cube has no outside.
double outside_texels(const Scene& scene, const LightFrame& frame, const FilterSettings& filter);

// What an estimate is compared with: what the whole program may hold, with what it holds already. Of the machine's
// memory and the groups' that is so now. Of the address space it is told from what was left when the measurement began,
// less what libraries and threads set aside (`room`), so that no point changes it for those after: the C library keeps
// what was freed.
AvailableMemory memory_of_program(const AvailableMemory& space_at_start, uint64_t room);

bool fits(const MemoryEstimate& estimate, const AvailableMemory& of_program);

// Throws Error(usage) where it does not, naming `point`, the largest share and the setting to change.
void require_memory(const MemoryEstimate& estimate, const AvailableMemory& of_program, const std::string& point);

}  // namespace noonmark
