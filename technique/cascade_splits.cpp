#include "technique/cascade_splits.h"

namespace noonmark {

#include "base/find_row.h"
#include "split_declarations.inc"

std::span<const CascadeSplit> cascade_splits() {
  static const std::vector<CascadeSplit> all = {
      {.name = "practical",
       .help = "between even and logarithmic by cascades.lambda (Zhang et al. 2006)",
       .bounds = practical_bounds,
       .reads = {"cascades.lambda"}},
      {.name = "logarithmic",
       .help = "each slice ends at the same multiple of where it begins, so that at its near and at its far end a "
               "texel is as large in the picture as in every other cascade",
       .bounds = logarithmic_bounds},
      {.name = "exponent",
       .help = "each slice is cascades.exponent times as deep as the one before, the effect of Unreal Engine's "
               "Distribution Exponent",
       .bounds = exponent_bounds,
       .reads = {"cascades.exponent"}},
      {.name = "first_bound",
       .help = "the first slice ends at cascades.first_m, the others are logarithmic from there, as in Bevy",
       .bounds = first_bound_bounds,
       .reads = {"cascades.first_m"}},
      {.name = "manual",
       .help = "as cascades.bounds_m lists them, as in Godot and Unity",
       .bounds = manual_bounds,
       .reads = {"cascades.bounds_m"}},
  };
  return all;
}

const CascadeSplit& find_cascade_split(std::string_view name) {
  return find_row(cascade_splits(), name, "cascade split");
}

}  // namespace noonmark
