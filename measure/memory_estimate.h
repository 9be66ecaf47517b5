// Predicts from a point's settings the peak memory of its measurement, before the measurement starts.
//
//   const MemoryEstimate estimate =
//       estimate_memory({settings, LightKind::point, scene_size(scene), open_edges, outside_texels, true, false});
//   require_memory(estimate, bench.memory_of_program(false), "point 3");   // throws if it would not fit
//
// The prediction is an upper bound, made of constants per pixel, tap, texel, triangle and vertex. If one of these
// dominates, the prediction is at most estimate_factor times the memory used (tests/app/memory_test.cpp). A map on a
// graphics card is counted as if it was in main memory, as it is with llvmpipe.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/memory.h"
#include "scenes/scene.h"
#include "scenes/scene_size.h"
#include "technique/light_frame.h"
#include "technique/light_kind.h"
#include "technique/settings.h"
#include "technique/technique.h"

namespace noonmark {

// The truth of a picture's taps is kept for the next points if it takes at most this much. Otherwise it is traced in
// strips of whole rows that take a sixteenth of it, so that memory does not grow with the kernel.
inline constexpr size_t most_kept_tap_bytes = size_t{256} << 20;
inline constexpr size_t strips_in_kept_taps = 16;
inline size_t bytes_per_tap(LightKind light) {
  return kind_of_light(light).map_shape() == MapShape::cube ? 1 + sizeof(uint32_t)
                                                            : 1;  // TapTruth; LookupProbe::cube_texel
}

// The most bytes of a map on the device that is kept for the next lookup. A larger one is drawn or uploaded again when it
// is looked up again, so that never more than one of them takes memory; of several maps, all at once.
inline constexpr size_t most_kept_map_bytes = size_t{128} << 20;

// The most pixels of a picture whose receivers stay on the device while the point's numbers are computed, 90 MB of them. Those
// of a larger one are uploaded again for the next lookup.
inline constexpr size_t most_kept_pixels = size_t{1} << 21;

// The most bytes of a point's maps and taps that are kept while a small picture is drawn, which needs its own.
inline constexpr size_t most_beside_live_bytes = size_t{128} << 20;

struct MemoryInput {
  const Settings& settings;
  LightKind light = LightKind::directional;
  SceneSize scene;
  uint64_t open_edges = 0;    // raytrace::Tracer::open_edges
  double outside_texels = 0;  // the most texels beside the map that receivers can look up: outside_texels()
  bool curve = true;          // an exact curve of the error against the bias is measured
  bool pictures = false;      // pictures and EXR files are written
};

struct MemoryShare {
  const char* what;    // "the shadow map"
  const char* remedy;  // which setting lowers it
  double bytes = 0;
};

struct MemoryEstimate {
  std::vector<MemoryShare> shares;  // what the point needs
  // The maps and taps that are kept while the small picture for the page is drawn, because the next point may use them. Only
  // where there is room for them.
  double waiting = 0;
  double needed() const;                               // the sum of the shares
  double bytes() const { return needed() + waiting; }  // the peak of the whole program
  const MemoryShare& largest() const;
};

MemoryEstimate estimate_memory(const MemoryInput& input);

inline constexpr double estimate_factor = 3;

// The number of texels beside a flat map that the scene reaches, including the kernel. 0 for a cube, which has no
// outside.
double outside_texels(const Scene& scene, const Technique& technique);

// The memory that the whole program may hold, including what it already holds; an estimate is compared with it. The
// limits of the machine and of control groups are read now. The limit of the address space is computed from the space
// that was free when the measurement began, minus the space that libraries and threads reserve (`room`). So earlier
// points do not change it, although the C library keeps freed memory.
AvailableMemory memory_of_program(const AvailableMemory& space_at_start, uint64_t room);

// Whether there is room for what the point needs; and for what waits for the next one too.
bool fits(const MemoryEstimate& estimate, const AvailableMemory& of_program);
bool fits_waiting(const MemoryEstimate& estimate, const AvailableMemory& of_program);

// Throws Error(usage) if the estimate does not fit, with `point`, the largest share and the setting to change.
void require_memory(const MemoryEstimate& estimate, const AvailableMemory& of_program, const std::string& point);

}  // namespace noonmark
