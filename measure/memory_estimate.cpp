#include "measure/memory_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "compare/ladder/bias_curves.h"
#include "compare/ladder/flicker.h"
#include "compare/ladder/live_picture.h"
#include "compare/ladder/picture_stack.h"
#include "compare/ladder/placement_counts.h"
#include "compare/ladder/reduction_window.h"
#include "gl/renderer.h"
#include "raytrace/tracer.h"
#include "technique/lookups.h"
#include "technique/tap_pattern.h"

namespace noonmark {
namespace {

// Bytes of what several stages hold together, or what is made of a measurement. What one stage allocates stands beside it. Found
// by counting the arrays that are alive at the same time, and compared with the peak (VmHWM) of runs in which one of them
// dominates, on Debian 12 with llvmpipe. The measured numbers are in brackets.
constexpr double program = 260e6;  // libraries, OpenGL's compiler, one empty picture [125e6]
constexpr double per_pixel = 260;  // receivers, truth, probe, ladder, on both sides of OpenGL [236]
// Of each cascade but the first: its probe, its truth, and the ladder of its receivers before it is joined.
constexpr double per_cascade_pixel = 130;
// Of a lookup in a filtered map: four more causes, and what is kept of each receiver for curve.over.
constexpr double per_filtered_pixel = 16 + 16 + 80;
// Pictures that are painted and encoded side by side, after much of the above has been freed: 3 bytes and the encoded ones
// on each thread, and rows of the EXR files [7 on 2 threads].
constexpr double per_picture_pixel = 60;
// Per byte of the scene's parts. point.json lists each part in up to 135 bytes and its name; the part itself has 40
// bytes, and those of a long name.
constexpr double per_listed_part_byte = 3.5;

}  // namespace

double MemoryEstimate::needed() const {
  return std::accumulate(shares.begin(), shares.end(), 0.0,
                         [](double sum, const MemoryShare& share) { return sum + share.bytes; });
}

const MemoryShare& MemoryEstimate::largest() const {
  return *std::max_element(shares.begin(), shares.end(),
                           [](const MemoryShare& a, const MemoryShare& b) { return a.bytes < b.bytes; });
}

MemoryEstimate estimate_memory(const MemoryInput& input) {
  const Settings& s = input.settings;
  const double pixels = static_cast<double>(s.view.width_px) * s.view.height_px;
  const double faces = kind_of_light(input.light).tiles(s.map);
  // Of cascades of different sizes all are taken for the largest.
  const double widest = s.cascades.count > 1 && !s.cascades.resolutions.empty()
                            ? *std::max_element(s.cascades.resolutions.begin(), s.cascades.resolutions.end())
                            : s.map.resolution;
  const double texels = widest * widest * s.map.rows() / s.map.resolution * faces;
  const TapPattern pattern = tap_pattern(s);
  const double taps = pixels * pattern.taps;
  const double asked = std::min(taps, texels);
  const bool cube = kind_of_light(input.light).map_shape() == MapShape::cube;
  const bool kept_map = texels * sizeof(float) <= static_cast<double>(most_kept_map_bytes);
  const double map = gl::map_bytes(texels, kept_map, cube) + asked * raytrace::bytes_per_asked_texel;
  double scene = raytrace::truth_bytes(s, input.light, input.scene, input.open_edges);
  if (input.pictures) scene += per_listed_part_byte * static_cast<double>(input.scene.part_bytes);
  const double filtered = !pattern.blurred ? 0
                                           : gl::moment_bytes(s, texels, asked, pixels) +
                                                 pixels * (per_filtered_pixel + ReductionWindow::shown_bytes());
  const double maps = s.cascades.count;
  if (maps > 1) scene += pixels * sizeof(double) * maps;  // ReceiverTruth::share
  const double curve = input.curve && curve_part(s) ? bias_curve_bytes(taps, pattern.bilinear()) : 0;
  const double all_taps = taps * static_cast<double>(bytes_per_tap(input.light)), row = all_taps / s.view.height_px;
  const double strip =
      all_taps <= most_kept_tap_bytes ? all_taps : std::max<double>(most_kept_tap_bytes / strips_in_kept_taps, row);
  // The lists of texels beside the map are freed when the curve is made, except those that later strips read.
  const double outside = raytrace::bytes_per_outside_texel * std::min(taps, input.outside_texels);
  const double beside = strip < all_taps ? curve + outside : std::max(curve, outside);
  const double side = s.map.placements;
  double placements = 0;
  if (side > 1) {                                           // of each map
    placements = placement_count_bytes(side * side) + map;  // the worst placement is rendered too
    if (kind_of_light(input.light).placements_form_lattice() && !pattern.blurred)
      placements += raytrace::placement_bytes(pixels, side, static_cast<double>(input.scene.triangles));
    else  // measured one by one, beside the point itself: a probe, an exact map and taps each
      placements += strip + pixels * (per_pixel + (pattern.blurred ? ReductionWindow::receiver_bytes() : 0));
  }
  placements *= maps;
  // A snapped map is drawn cell by cell and then put in order; the next frame of a motion has maps of its own.
  const double more_maps = texels * sizeof(float) * ((s.map.snap ? 1 : 0) + (s.view.motion.any() ? maps : 0));
  const double motion = s.view.motion.any() ? pixels * flicker_bytes_per_pixel : 0;
  const double kept = maps * (strip + map + filtered) + more_maps;
  double live = 0;
  if (input.pictures && maps == 1) {
    const double live_pixels = std::min<double>(pixels, most_live_width_px * most_live_height_px);
    const double answers = why_no_live_picture(s).empty() ? live_answer_bytes(pattern.taps) : stacked_answer_bytes;
    live = live_pixels * (per_pixel + answers);  // a receiver as above, and its answers
  }
  return {
      {
          {"the live picture", "lower filter.size, or set pictures = \"none\"", live},
          {"the placements of the map's grid", "lower map.placements", placements},
          {"the program itself", "use a machine with more memory, or raise its limit", program},
          {"the scene", "use a scene with fewer triangles (scene.name, scene.mesh)", scene},
          {"the picture", "lower view.width_px and view.height_px",
           pixels * (per_pixel + (maps - 1) * per_cascade_pixel + (input.pictures ? per_picture_pixel : 0)) + motion},
          {"the taps",
           curve > outside ? "lower filter.size, view.width_px or view.height_px, or set curve.enabled = false"
                           : "lower filter.size, view.width_px or view.height_px, or widen map.extent_m",
           maps * (strip + outside) + beside - outside},
          {"the shadow map",
           maps > 1 ? "lower map.resolution, cascades.resolutions or cascades.count" : "lower map.resolution",
           maps * map + more_maps},
          {"the map of moments", "lower map.resolution, or set map.moments = 16f", maps * filtered},
      },
      input.pictures && kept <= static_cast<double>(most_beside_live_bytes) ? kept : 0};
}

double outside_texels(const Scene& scene, const Technique& technique) {
  const LightFrame& frame = technique.frame;
  if (frame.map_shape() == MapShape::cube) return 0;
  const TapPattern& pattern = technique.taps;
  double reach = 1;
  for (int variant = 0; variant < pattern.variants; ++variant)
    for (int tap = 0; tap < pattern.taps; ++tap) {
      const glm::vec3 o = glm::abs(pattern.offset(variant, tap));
      reach = std::max<double>({reach, o.x, o.y});
    }
  reach += pattern.block - 1;
  const double inside = static_cast<double>(frame.resolution) * frame.rows;
  glm::dvec2 low(0), high(frame.tile_size());
  if (const auto tan_cone = frame.light().tan_half_cone(frame)) {  // no lookup lies beyond the cone
    const double beside = frame.resolution * std::max(0.0, *tan_cone / frame.tan_half_fov - 1) / 2;
    low -= beside;
    high += beside;
  } else {
    for (const glm::vec3& p : scene.positions) {
      const glm::dvec2 at = frame.map_texels(frame.to_light(p));
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
  }
  const glm::dvec2 size = high - low + 2 * (reach + 1);
  return std::max(0.0, size.x * size.y - inside);
}

AvailableMemory memory_of_program(const AvailableMemory& space_at_start, uint64_t room) {
  AvailableMemory memory = free_memory();
  const uint64_t held = resident_bytes();
  if (memory.bytes < UINT64_MAX - held) {
    memory.bytes += held;
    memory.limit += fmt::format(", with {} that the program holds already", bytes_text(static_cast<double>(held)));
  }
  if (space_at_start.bytes == UINT64_MAX) return memory;
  const uint64_t left = space_at_start.bytes > room ? space_at_start.bytes - room : 0;
  const uint64_t space = left + static_cast<uint64_t>(program);
  if (space >= memory.bytes) return memory;
  return {space, fmt::format("{}, minus the space that libraries and threads reserve", space_at_start.limit)};
}

bool fits(const MemoryEstimate& estimate, const AvailableMemory& of_program) {
  return estimate.needed() <= static_cast<double>(of_program.bytes);
}

bool fits_waiting(const MemoryEstimate& estimate, const AvailableMemory& of_program) {
  return estimate.waiting > 0 && estimate.bytes() <= static_cast<double>(of_program.bytes);
}

void require_memory(const MemoryEstimate& estimate, const AvailableMemory& of_program, const std::string& point) {
  if (fits(estimate, of_program)) return;
  const MemoryShare& most = estimate.largest();
  throw Error(ErrorKind::usage, fmt::format("{} would take about {} of memory, {} of it for {}, and {}; {}", point,
                                            bytes_text(estimate.needed()), bytes_text(most.bytes), most.what,
                                            of_program.text(), most.remedy));
}

}  // namespace noonmark
