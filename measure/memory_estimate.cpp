#include "measure/memory_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "compare/ladder/live_picture.h"
#include "compare/ladder/picture_stack.h"
#include "compare/ladder/receiver_taps.h"
#include "compare/ladder/reduction_window.h"
#include "raytrace/tracer.h"
#include "scenes/scene_size.h"
#include "technique/casters.h"
#include "technique/lookups.h"
#include "technique/tap_pattern.h"

namespace noonmark {
namespace {

// Bytes. Found by counting the arrays that are alive at the same time, and compared with the peak (VmHWM) of runs in
// which one of them dominates, on Debian 12 with llvmpipe. The measured numbers are in brackets.
constexpr double program = 260e6;  // libraries, OpenGL's compiler, one empty picture [125e6]
constexpr double per_pixel = 260;  // receivers, truth, probe, ladder, on both sides of OpenGL [236]
// Pictures that are painted and encoded side by side, after much of the above has been freed: 3 bytes and the encoded ones
// on each thread, and rows of the EXR files [7 on 2 threads].
constexpr double per_picture_pixel = 60;
// Of the map on the device. If it is small, the exact map, the tie map and, of a cube, the texture with which it is
// probed are beside it; a large one is alone. The set of the texels that are asked for takes 2 bits of each.
constexpr double per_kept_texel = 14, per_index_texel = 4, per_large_texel = 5;  // [12.6] [4] [4.3]
constexpr double per_band_texel = 12, most_bands = 60e6;                         // a map is uploaded and read in bands
// For each tap in the batch whose thresholds are being listed (batch_taps): a threshold of the error and one of its
// cause, 4 bytes each, and again while they are sorted. Not every tap has both; the difference covers the growth of the
// lists.
constexpr double per_curve_tap = 16;
constexpr double per_blended_tap = 56;  // with a weight of 8 each
// For each tap, the sums over different thresholds: 12 bytes for the error, 12 for the cause, 12 while strips are
// joined. The total is limited to 28 million of them, because differences of float depths repeat: 52 million taps had
// 1.6 million different ones, 885 million taps had 10.5 million.
constexpr double per_summed_tap = 2, most_sums = 1e9;  // [1.1]
// For each texel that a tap reads: its first hit, its depth in three maps and the error of one.
constexpr double per_asked_texel = 26;    // [24]
constexpr double per_outside_texel = 32;  // texels beside the map: two lists of 16 bytes while they are made
constexpr double per_open_edge = 240;     // as a shadow's edge: the edge, its pieces, the cells that list it [220]
constexpr double per_closed_edge = 70;    // a third of them may be such edges too, if the light sees a fold
// Certified squares of the light's plane (raytrace/light_cells.h), which are made where receivers lie: under 192 MiB.
constexpr double per_cell_pixel = 40, most_cells = 202e6;  // [11, FlightHelmet at 1280 x 720]
constexpr double per_kept_triangle = 150;                  // the second tree for the rays, without the culled faces
// As scan conversion reads it, and in lists of tiles, while the first hits of a map are found.
constexpr double per_raster_triangle = 130;  // [112]
// The scene as a second light sees it (400), and through the lattice of the last placements (260).
constexpr double per_light_triangle = 660;
// Per byte of the scene's parts. point.json lists each part in up to 135 bytes and its name; the part itself has 40
// bytes, and those of a long name.
constexpr double per_listed_part_byte = 3.5;
// All placements of the map's grid: where each placement looks up, the points of the lattice that are held at a time with
// their tiles, and the sums by cause, placement and bias of each thread and of the whole.
// Placements that form no lattice are measured one by one, beside the point itself: a probe, an exact map and taps each.
// Of a map of moments also the receivers of a ReductionWindow, in a list of up to twice their size and a copy of it.
constexpr double per_listed_receiver = 4.0 * sizeof(ReductionWindow::Receiver);
constexpr double per_placed_pixel = 8, per_lattice_triangle = 260, per_placement = 10 * 8 * 512.0 * 12;
constexpr double lattice_points = 9e6 * 28;
constexpr double per_grid_cell = 8;  // the grid that lists a shadow's edges, for each face of the map
// The live picture, which is drawn beside the point's own images: for each of its pixels a receiver as above and an
// answer for each threshold, which are two for each tap (compare/ladder/live_picture.h), in a list that grows by doubling.
// A stack of pictures (compare/ladder/picture_stack.h) has an answer for each picture in its place.
constexpr double per_live_answer = 2 * sizeof(LiveAnswer), per_stacked_answer = 2 * sizeof(PictureStack::Answer);
// Of each cascade but the first: its probe, its truth, and the ladder of its receivers before it is joined.
constexpr double per_cascade_pixel = 130;
// Of the flicker to the next frame: four lookups and what is booked of them, which pixels see a receiver and which light
// reaches it there, and the receivers as they are uploaded again.
constexpr double per_flicker_pixel = 90;
// Of a lookup in a map of moments: four more causes, the moments that each receiver fetches, on both sides of OpenGL and kept for
// curve.over, and what another reduction would give, also of what OpenGL shows, in a list of up to twice its size.
constexpr double per_moment_pixel = 16 + 32 + 16 + 80 + 2 * sizeof(ReductionWindow::Shown);
constexpr double per_asked_moments = 3 * 16;  // as they are read back, of two maps one after the other
constexpr double least_grid_cells = 256 * 256, most_grid_cells = 2048 * 2048;

// asked: the texels that taps read.
double map_bytes(double texels, double asked, bool cube) {
  const bool kept = texels * sizeof(float) <= static_cast<double>(most_kept_map_bytes);
  const double each = kept ? per_kept_texel + (cube ? per_index_texel : 0) : per_large_texel;
  return texels * each + std::min(texels * per_band_texel, most_bands) + asked * per_asked_texel;
}

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
  const double map =
      map_bytes(texels, std::min(taps, texels), kind_of_light(input.light).map_shape() == MapShape::cube);

  const double edges = 3.0 * static_cast<double>(input.scene.triangles);
  const double open = std::min(edges, static_cast<double>(input.open_edges));
  double scene = scene_bytes(input.scene) + per_open_edge * open + per_closed_edge * (edges - open);
  scene += per_grid_cell * faces * std::clamp(16 * edges, least_grid_cells, most_grid_cells);
  if (s.map.cull != CulledFaces::none) scene += per_kept_triangle * static_cast<double>(input.scene.triangles);
  // The scene once more with moved vertices: its triangles, its places in the light's frame, and a tree of its own.
  if (moves_casters(s.map, Bias(s.bias)))
    scene += scene_bytes(input.scene) + per_kept_triangle * static_cast<double>(input.scene.triangles);

  if (kind_of_light(input.light).map_shape() == MapShape::flat)
    scene += per_raster_triangle * static_cast<double>(input.scene.triangles);
  const bool two_lights = input.scene.triangles <= raytrace::most_triangles_of_two_lights;
  if (kind_of_light(input.light).rays().have_one_direction())
    scene += (two_lights ? 2 : 1) * std::min(per_cell_pixel * pixels, most_cells);
  if (two_lights) scene += per_light_triangle * static_cast<double>(input.scene.triangles);
  if (input.pictures) scene += per_listed_part_byte * static_cast<double>(input.scene.part_bytes);

  double moments = 0;
  if (reads_moments(s)) {
    const LookupKind& kind = find_lookup(s.lookup.kind);
    const double each = (s.map.moments == MomentFormat::f32 ? 4 : 2) * kind.channels;
    const double stored = kind.spread ? 4 * kind.channels : each;  // what a blur of spreads reads has 32 bits
    const double level = texels / (pattern.block * pattern.block), halved = (texels - level) / 3;  // of all levels
    moments = 2 * (texels * stored + (halved + 2 * level) * each) + std::min(taps, texels) * per_asked_moments +
              pixels * per_moment_pixel;
  }
  const double maps = s.cascades.count;
  if (maps > 1) scene += pixels * sizeof(double) * maps;  // ReceiverTruth::share
  double curve = 0;
  if (input.curve && curve_part(s))
    curve = std::min<double>(taps, batch_taps) * (pattern.bilinear() ? per_blended_tap : per_curve_tap) +
            std::min(taps * per_summed_tap, most_sums);
  const double all_taps = taps * static_cast<double>(bytes_per_tap(input.light)), row = all_taps / s.view.height_px;
  const double strip =
      all_taps <= most_kept_tap_bytes ? all_taps : std::max<double>(most_kept_tap_bytes / strips_in_kept_taps, row);
  // The lists of texels beside the map are freed when the curve is made, except those that later strips read.
  const double outside = per_outside_texel * std::min(taps, input.outside_texels);
  const double beside = strip < all_taps ? curve + outside : std::max(curve, outside);
  const double side = s.map.placements;
  double placements = 0;
  if (side > 1) {                                    // of each map
    placements = side * side * per_placement + map;  // the worst placement is rendered too
    if (kind_of_light(input.light).placements_form_lattice() && !reads_moments(s))
      placements += lattice_points + pixels * per_placed_pixel * side +
                    per_lattice_triangle * static_cast<double>(input.scene.triangles);
    else
      placements += strip + pixels * (per_pixel + (reads_moments(s) ? per_listed_receiver : 0));
  }
  placements *= maps;
  // A snapped map is drawn cell by cell and then put in order; the next frame of a motion has maps of its own.
  const double more_maps = texels * sizeof(float) * ((s.map.snap ? 1 : 0) + (s.view.motion.any() ? maps : 0));
  const double motion = s.view.motion.any() ? pixels * per_flicker_pixel : 0;
  const double kept = maps * (strip + map + moments) + more_maps;
  double live = 0;
  if (input.pictures && maps == 1) {
    const double live_pixels = std::min<double>(pixels, most_live_width_px * most_live_height_px);
    const double answers =
        why_no_live_picture(s).empty() ? per_live_answer * (2.0 * pattern.taps + 1) : per_stacked_answer * most_stacked;
    live = live_pixels * (per_pixel + sizeof(std::vector<LiveAnswer>) + answers);
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
          {"the map of moments", "lower map.resolution, or set map.moments = 16f", maps * moments},
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
