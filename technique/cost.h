// What a technique asks of a machine in one frame, in numbers that do not depend on the machine: equal work has equal
// cost, on every GPU and in every run. They say nothing about caches, and nothing about time.
//
//   FrameCost cost = frame_cost(settings, frame.tiles, frame.texels(), facing_receivers, triangles);
//   if (cost.texel_work < other.texel_work) print("cheaper");
#pragma once
#include <cstdint>

#include "technique/settings.h"

namespace noonmark {

// For one receiver.
struct LookupCost {
  int fetches = 0;  // texture instructions
  int texels = 0;   // that the fetches read: one each, or four where a comparison sampler blends
  // Additions, products, divisions, roots, exponentials, minima, maxima and choices of the bias, the reference of each
  // tap, the comparisons, the weights and their sum: 1 each, counted in the formulas' text; the row of each formula has
  // its number. A change of sign and an absolute value count nothing, because a GPU does them with the operand of another
  // operation; nor does an operation on constants alone, because a compiler does it. The place in the map, N.L,
  // tan(theta), the depth gradient and the addresses of the taps are not in it: every technique needs the first, and the
  // others are not formulas of this program's rows.
  int operations = 0;
};
LookupCost lookup_cost(const Settings& settings);

struct FrameCost {
  int64_t map_texels = 0;     // of all tiles; each is written at least once, because the map is cleared
  int64_t map_bytes = 0;      // their memory, and that of two textures that a filtered map is made in
  int64_t map_triangles = 0;  // that the rasteriser gets: those of the scene, once for each tile
  LookupCost lookup;          // of each receiver
  int64_t pass_fetches = 0;   // of the passes that filter a map
  // The texels of the map, each written once, and the texture instructions of all receivers; of a filtered map also the
  // texels that its passes write and fetch: what the two fixed-function units of a GPU do for a shadow. Neighbours share texels in a cache, so instructions are counted and not bytes.
  int64_t texel_work = 0;
  int64_t traffic_bytes = 0;  // map_bytes written once, and the texels that the lookups of all receivers read
};

// tiles: of the map, 6 for a cube. receivers: pixels that look up. triangles: of the scene.
FrameCost frame_cost(const Settings& settings, int tiles, int64_t map_texels, int64_t receivers, int64_t triangles);

// Bytes of a texel in the memory of a GPU. A depth of 24 bits takes 4.
int bytes_per_texel(DepthFormat format);

}  // namespace noonmark
