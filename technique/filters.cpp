#include "technique/filters.h"

#include <stdexcept>

#include "technique/filters/patterns.h"

namespace noonmark {

#include "filter_declarations.inc"

namespace filter_formulas {

#define precise
using real = double;
using glm::abs, glm::clamp;
#include "filter_formulas.inc"
#undef precise

}  // namespace filter_formulas

namespace {

using Names = std::vector<std::string_view>;

// The taps of a filter whose formula gives the weight of each texel.
template <double (*weight)(int, double, int)>
TapPattern weighted(const FilterSettings& settings) {
  return weighted_texels(settings.size, weight);
}

std::vector<Filter> make_filters() {
  return {
      {.name = "none", .help = "one nearest tap", .map = FilterMap::any, .shader = "none", .taps = none_taps},
      {.name = "box",
       .help = "mean of N x N nearest taps",
       .shader = "box",
       .taps = box_taps,
       .reads = Names{"filter.size", "filter.step_texels"}},
      {.name = "hardware",
       .help = "one linear fetch of a comparison sampler (2 x 2 texels)",
       .shader = "bilinear",
       .taps = hardware_taps,
       .blended = true},
      {.name = "gaussian",
       .help = "Gaussian mean of N x N linear fetches of a comparison sampler",
       .shader = "bilinear",
       .taps = gaussian_taps,
       .reads = Names{"filter.size", "filter.sigma_texels"},
       .blended = true},
      {.name = "poisson",
       .help = "mean of 16 nearest taps in a disk",
       .shader = "mean",
       .taps = poisson_taps,
       .reads = Names{"filter.radius_texels", "filter.rotate"}},
      {.name = "castano",
       .help = "Castano's kernel of N x N comparisons, N = 3, 5 or 7, in 4, 9 or 16 fetches",
       .shader = "fetches",
       .taps = weighted<filter_formulas::castano_weight>,
       .reads = Names{"filter.size"},
       .blended = true,
       .sizes = {3, 5, 7},
       .own_weights = true},
      {.name = "tent",
       .help = "a tent whose base is N texels wide, integrated over each texel, N = 3, 5 or 7, in 4, 9 or 16 fetches",
       .shader = "fetches",
       .taps = weighted<filter_formulas::tent_weight>,
       .reads = Names{"filter.size"},
       .blended = true,
       .sizes = {3, 5, 7},
       .own_weights = true},
      {.name = "vogel",
       .help = "mean of filter.taps nearest taps along a spiral in a disk",
       .shader = "mean",
       .taps = vogel_taps,
       .reads = Names{"filter.taps", "filter.radius_texels", "filter.rotate"}},
      {.name = "cube_grid",
       .help = "mean of 4 x 4 x 4 taps around the receiver",
       .map = FilterMap::cube,
       .shader = "mean",
       .taps = cube_grid_taps,
       .reads = Names{"filter.offset_m"}},
      {.name = "cube_disk",
       .help = "mean of taps in 20 directions",
       .map = FilterMap::cube,
       .shader = "mean",
       .taps = cube_disk_taps,
       .reads = Names{"filter.disk", "filter.radius_m"}},
  };
}

}  // namespace

std::span<const Filter> filters() {
  static const std::vector<Filter> all = make_filters();
  return all;
}

const Filter& find_filter(std::string_view name) {
  for (const Filter& filter : filters())
    if (filter.name == name) return filter;
  throw std::logic_error("there is no filter '" + std::string(name) + "'");
}

}  // namespace noonmark
