#include "technique/filters.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/find_row.h"
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

// The parameters.

constexpr KindParameter size{.setting = "filter.size",
                             .unit = "taps",
                             .type = ValueType::integer,
                             .min = 1,
                             .max = 31,
                             .initial = 3,
                             .help = "taps along each side; an odd number."};

std::string even_size(const FilterSettings& s) {
  if (s.whole("size") % 2 != 0) return "";
  return fmt::format(
      "filter.size = {} is even; the filter {} has an odd number of taps on a side, so that one is at the receiver",
      s["size"], s.kind);
}

// For kernels that are defined for three sizes only.
std::string not_3_5_7(const FilterSettings& s) {
  const std::string even = even_size(s);
  if (!even.empty() || (s.whole("size") >= 3 && s.whole("size") <= 7)) return even;
  return fmt::format("filter.size = {}: the filter {} has a size of 3, 5, 7", s["size"], s.kind);
}

constexpr KindParameter step_texels{.setting = "filter.step_texels",
                                    .unit = "texels",
                                    .max = 64,
                                    .initial = 1,
                                    .help = "distance from one tap to the next."};

constexpr KindParameter sigma_texels{.setting = "filter.sigma_texels",
                                     .unit = "texels",
                                     .min = 0.1,
                                     .max = 64,
                                     .initial = 1,
                                     .help = "standard deviation of the weights."};

constexpr KindParameter radius_texels{
    .setting = "filter.radius_texels", .unit = "texels", .max = 256, .initial = 2, .help = "radius of the disk."};

constexpr KindParameter rotate{.setting = "filter.rotate",
                               .unit = "",
                               .type = ValueType::flag,
                               .help = "the disk is rotated by a different angle at each pixel."};

constexpr KindParameter number_of_taps{.setting = "filter.taps",
                                       .unit = "taps",
                                       .type = ValueType::integer,
                                       .min = 1,
                                       .max = 64,
                                       .initial = 16,
                                       .help = "number of taps."};

constexpr KindParameter offset_m{
    .setting = "filter.offset_m",
    .unit = "m",
    .max = 1e3,
    .initial = 0.1,
    .help = "the taps lie at -offset, -offset/2, 0 and offset/2 along each axis of the world."};

constexpr std::string_view disks[] = {"fixed", "view_distance"};
constexpr KindParameter disk{
    .setting = "filter.disk",
    .unit = "",
    .type = ValueType::choice,
    .help =
        "radius of the disk. fixed: filter.radius_m; view_distance: (1 + distance to the camera / far) / 25 metres.",
    .choices = disks};

constexpr KindParameter radius_m{.setting = "filter.radius_m",
                                 .unit = "m",
                                 .max = 1e3,
                                 .initial = 0.05,
                                 .help = "factor of the 20 directions (1,1,1), (1,1,0) and so on."};

std::string disk_follows_view(const FilterSettings& s) {
  return disks[s.whole("disk")] == "view_distance" ? "with filter.disk = view_distance" : "";
}

// The filters.

// The taps of a filter whose formula gives the weight of each texel.
template <double (*weight)(int, double, int)>
TapPattern weighted(const FilterSettings& settings) {
  return weighted_texels(settings.whole("size"), weight);
}

std::vector<Filter> make_filters() {
  return {
      {.name = "none",
       .help = "one nearest tap",
       .law = "k = ½; aliasing w·(a/4 + b²/12a) for each metre of edge (law 5)",
       .map = FilterMap::any,
       .shader = "none",
       .taps = none_taps,
       .blur = [](const FilterSettings&) { return equal_weights(1); }},
      {.name = "box",
       .help = "percentage-closer filtering (PCF), mean of N x N nearest taps",
       .law = "k = r·step + ½; blur Σ wᵢ·|oᵢ·n| (law 7)",
       .shader = "box",
       .taps = box_taps,
       .reads = {{&size, even_size}, {&step_texels}},
       .blur = [](const FilterSettings& s) { return equal_weights(s.whole("size")); }},
      {.name = "hardware",
       .help = "hardware PCF, one linear fetch of a comparison sampler (2 x 2 texels)",
       .law = "k = 1; half of the blur of 3 × 3",
       .shader = "bilinear",
       .taps = hardware_taps,
       .blended = true},
      {.name = "gaussian",
       .help = "Gaussian mean of N x N linear fetches of a comparison sampler",
       .law = "k = r + 1; blur Σ wᵢ·|oᵢ·n| (law 7)",
       .shader = "bilinear",
       .taps = gaussian_taps,
       .reads = {{&size, even_size}, {&sigma_texels}},
       .blended = true,
       .blur = [](const FilterSettings& s) { return gaussian_weights(s.whole("size"), s["sigma_texels"]); }},
      {.name = "poisson",
       .help = "mean of 16 nearest taps in a disk",
       .law = "k from the tap furthest up the slope",
       .shader = "mean",
       .taps = poisson_taps,
       .reads = {{&radius_texels}, {&rotate}}},
      {.name = "castano",
       .help = "Castano's kernel of N x N comparisons, N = 3, 5 or 7, in 4, 9 or 16 fetches",
       .law = "k = (N + 1) / 2; blur ¾, 1 and 29/26 texels along them",
       .shader = "fetches",
       .taps = weighted<filter_formulas::castano_weight>,
       .reads = {{&size, not_3_5_7}},
       .blended = true,
       .own_weights = true,
       .weight_operations = 5},
      {.name = "tent",
       .help = "a tent whose base is N texels wide, integrated over each texel, N = 3, 5 or 7, in 4, 9 or 16 fetches",
       .law = "k = (N + 1) / 2; blur N/6 + (3N − 1)/(6N²) texels along them",
       .shader = "fetches",
       .taps = weighted<filter_formulas::tent_weight>,
       .reads = {{&size, not_3_5_7}},
       .blended = true,
       .own_weights = true,
       .weight_operations = 17},
      {.name = "vogel",
       .help = "mean of filter.taps nearest taps along a spiral in a disk",
       .law = "k from the tap furthest up the slope",
       .shader = "mean",
       .taps = vogel_taps,
       .reads = {{&number_of_taps}, {&radius_texels}, {&rotate}}},
      {.name = "cube_grid",
       .help = "mean of 4 x 4 x 4 taps around the receiver",
       .law = "k from the tap furthest up the slope; not centred on the receiver",
       .map = FilterMap::cube,
       .shader = "mean",
       .taps = cube_grid_taps,
       .reads = {{&offset_m}}},
      {.name = "cube_disk",
       .help = "mean of taps in 20 directions",
       .law = "k from the tap furthest up the slope",
       .map = FilterMap::cube,
       .shader = "mean",
       .taps = cube_disk_taps,
       .reads = {{&disk}, {&radius_m, nullptr, disk_follows_view}}},
  };
}

}  // namespace

std::span<const KindParameter* const> FilterTable::parameters() {
  static const std::vector<const KindParameter*> all = parameters_of(filters());
  return all;
}

std::span<const Filter> filters() {
  static const std::vector<Filter> all = make_filters();
  return all;
}

const Filter& find_filter(std::string_view name) { return find_row(filters(), name, "filter"); }

}  // namespace noonmark
