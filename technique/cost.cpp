#include "technique/cost.h"

#include <algorithm>

#include "technique/bias.h"
#include "technique/filters.h"
#include "technique/lookups.h"
#include "technique/tap_pattern.h"

namespace noonmark {
namespace {

// The sum of the parts that act on the compared depth, each times its amount and held between its floor and its cap.
int compared_operations(const Bias& bias) {
  int count = 0;
  for (const ActivePart& active : bias.compared())
    count += active.part->formula.operations + 1 + !active.part->floor_help.empty() + !active.part->cap_help.empty();
  const int parts = static_cast<int>(bias.compared().size());
  return count + std::max(parts - 1, 0);
}

// Each way times its amount, and its sum with the place: vectors of three numbers.
int moving_operations(const Bias& bias) {
  int count = 0;
  for (const ActivePart& active : bias.moving()) count += active.part->formula.operations + 3 + 3;
  return count;
}

// Of a filter that gives the weights of its texels, as gl/shaders/filter/fetches.glsl computes them: a square of fetches of
// 2 x 2 texels.
int weight_operations(const Filter& filter, int size) {
  const int side = (size + 1) / 2, two_weights = 2 * filter.weight_operations;
  const int blend = 5;  // two sums (written twice there; a compiler makes each once), their product, two divisions
  return side * (two_weights + side * (two_weights + blend));
}

// Of a lookup in a filtered map: the formula, and light-bleed reduction where there is one: a difference, a product, and
// held between 0 and 1.
int filtered_operations(const LookupKind& kind, const LookupSettings& settings) {
  const bool reduced = settings["reduction"] != 0 || settings["reduction_span"] != 0;
  return kind.formulas->operations(settings) + (reduced ? 4 : 0);
}

}  // namespace

LookupCost lookup_cost(const Settings& settings) {
  const Filter& filter = find_filter(settings.filter.kind);
  const TapPattern pattern = tap_pattern(settings);
  const Bias bias(settings.bias);
  const int fetches = pattern.fetches();
  LookupCost cost{fetches, pattern.bilinear() ? 4 * fetches : fetches, 0};
  cost.operations = compared_operations(bias) + moving_operations(bias);
  const int subtractions = bias.compared().empty() ? 0 : 1;
  if (const LookupKind& kind = find_lookup(settings.lookup.kind); !kind.compares()) {
    cost.fetches = 1, cost.texels = 4;
    cost.operations += subtractions + filtered_operations(kind, settings.lookup);
    return cost;
  }
  if (pattern.bilinear()) {
    // One biased depth for all fetches; the sampler compares. The product and the sum of each fetch, and of weights that
    // the shader makes itself also their sum and the division by it.
    cost.operations += subtractions + 2 * fetches;
    if (filter.own_weights) cost.operations += weight_operations(filter, settings.filter.whole("size")) + fetches + 1;
  } else {
    // Each tap: its reference, minus the bias, compared, and counted if there are several.
    const int tap = bias.reference().operations + subtractions + 1;
    cost.operations += fetches * tap + (fetches > 1 ? fetches : 0);
  }
  return cost;
}

int bytes_per_texel(DepthFormat format) { return format == DepthFormat::d16 ? 2 : 4; }

FrameCost frame_cost(const Settings& settings, int tiles, int64_t map_texels, int64_t receivers, int64_t triangles) {
  FrameCost cost;
  const int64_t texel = bytes_per_texel(settings.map.format);
  cost.map_texels = map_texels;
  cost.map_bytes = cost.map_texels * texel;
  cost.map_triangles = tiles * triangles;
  cost.lookup = lookup_cost(settings);
  cost.texel_work = cost.map_texels + receivers * cost.lookup.fetches;
  cost.traffic_bytes = cost.map_bytes + receivers * cost.lookup.texels * texel;
  if (compares(settings)) return cost;
  // The pass that stores reads each texel once, and each of two passes of the blur reads as many as the kernel has.
  // All three write each texel. The passes come and go between two textures. A blur that stores spreads needs no pass before
  // it: it reads the depths themselves.
  const int64_t stored = stored_bytes(settings);
  if (find_lookup(settings.lookup.kind).spread) {
    const int64_t samples = settings.lookup.whole("samples");
    cost.pass_fetches = 2 * map_texels * samples;
    cost.texel_work += 2 * map_texels + cost.pass_fetches;
    cost.map_bytes += 2 * map_texels * stored;
    // Along v one depth for each tap, along u the four texels of a linear fetch.
    cost.traffic_bytes = map_texels * (texel + samples * texel + 2 * stored + 4 * samples * stored) +
                         receivers * cost.lookup.texels * stored;
    return cost;
  }
  // Each halving reads four texels of the level before for each texel that it writes; the blur is that of the last level.
  const TapPattern pattern = tap_pattern(settings);
  const auto width = static_cast<int64_t>(pattern.kernel.size());
  int64_t written = map_texels, halved = 0, level = map_texels;
  for (int block = pattern.block; block > 1; block /= 2) {
    level /= 4;
    halved += level;
  }
  written += halved + 2 * level;
  const int64_t read = 4 * halved + 2 * width * level;
  cost.pass_fetches = map_texels + read;
  cost.texel_work += written + cost.pass_fetches;
  cost.map_bytes += (map_texels + halved + level) * stored;  // the blur's second pass writes where it came from
  cost.traffic_bytes = 2 * map_texels * texel + (written + read) * stored + receivers * cost.lookup.texels * stored;
  return cost;
}

}  // namespace noonmark
