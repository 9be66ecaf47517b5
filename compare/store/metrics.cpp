#include "compare/store/metrics.h"

#include <string>
#include <vector>

#include "scenes/error.h"
#include "scenes/text.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

constexpr Metric table[] = {
    {"error", "fraction", "Mean |R5 - R1| over the counted receivers: what the GPU showed against the hard truth.",
     true},
    {"error_soft", "fraction", "Mean |R5 - R0|: against the light with its size.", true},
    {"wrong", "fraction", "Share of counted receivers whose R5 differs from R1 at all.", true},
    {"light_size", "fraction", "Mean |R1 - R0|: what a hard shadow misses of the light's size.", true},
    {"filter", "fraction", "Mean |R2 - R1|: the blur that the filter means to make.", true},
    {"displacement", "fraction",
     "Shadows moved by looking receivers up elsewhere (normal_offset): mean |effect| of the moved taps at exact "
     "places.",
     true},
    {"aliasing", "fraction", "Taps that asked elsewhere than they should and were answered truly, dark and light.",
     true},
    {"aliasing_dark", "fraction", "Aliasing that darkens.", true},
    {"aliasing_light", "fraction", "Aliasing that lights.", true},
    {"aliasing_rms", "fraction",
     "Root mean square of aliasing: jagged edges weigh more than as much of it spread over more pixels by a filter, "
     "which leaves the mean as it is.",
     true},
    {"acne", "fraction", "Taps falsely dark without a shadow edge between the pixel and the texel.", true},
    {"peter_panning", "fraction", "Taps falsely lit because the bias reaches past the occluder.", true},
    {"peter_panning_lit", "fraction",
     "The part of it at receivers that are themselves lit: 0 without a filter and a normal offset, a defect otherwise.",
     true},
    {"coverage", "fraction", "Wrong taps outside the map, beyond far, or whose blocker near clips.", true},
    {"coverage_dark", "fraction", "Coverage that darkens.", true},
    {"coverage_light", "fraction", "Coverage that lights.", true},
    {"precision", "fraction", "Mean |R5 - R4|: depth format, rasteriser and arithmetic.", true},
    {"undecided", "fraction",
     "What is wrong at taps whose truth changes within float error: the filter and the causes may share it among them.",
     true},
    {"undecided_taps", "fraction", "Weight of the taps whose truth changes within float error, right or wrong.", true},
    {"peter_panning_gap_m", "m",
     "Widest lit gap along the light's trace between an occluder and its shadow (at a corner, wider than along the "
     "wall).",
     true},
    {"edge_displacement_texels", "texels",
     "Largest distance across the light's rays, in texels there, from an aliased tap to the true edge.", true},
    {"edge_displacement_mean_texels", "texels", "Mean over receivers of that distance, each with its farthest tap's.",
     true},
    {"edge_displacement_pixels", "pixels",
     "Largest distance in the picture from an aliased pixel to where its verdict is true; with a normal offset its "
     "displacement is in it.",
     true},
    {"receivers", "count", "Pixels that see a surface.", false},
    {"facing", "count", "Receivers that face the light.", false},
    {"counted", "count", "Facing receivers that are not ambiguous: the base of every fraction.", false},
    {"clipped", "count", "Pixels that see nothing because the camera's near or far plane cuts the surface off.", false},
    {"culled", "count", "Pixels that see nothing but backs of single-sided faces.", false},
    {"scene_behind", "", "Share of the scene's vertices that lie behind the camera.", false},
    {"attached", "count", "Receivers that face away from the light: dark by shading, left out.", false},
    {"lit", "fraction", "Share of counted receivers that the light reaches (R1).", false},
    {"ambiguous", "fraction",
     "Share of facing receivers whose truth R1 changes within float error; left out of all errors.", false},
    {"outside", "fraction", "Share of counted receivers that fall outside the map or beyond its far plane.", true},
    {"ambiguous_receivers", "count", "Facing receivers whose truth R1 changes within float error.", false},
    {"undecided_receivers", "count", "Counted receivers with a tap whose truth changes within float error.", false},
    {"outside_receivers", "count", "Counted receivers outside the map or beyond its far plane.", false},
    {"residual", "", "Largest |(R5 - R0) - sum of signed steps| over all facing receivers; a defect above 1e-6.",
     false},
    {"tap_residual", "",
     "Largest |(R4 - R2) - displacement - sum of tap classes, undecided ones too| over all facing receivers; a defect "
     "above 1e-6.",
     false},
    {"texel_m", "m",
     "w: the width of one texel; under a spot or point light, where it grows with the distance, at the median counted "
     "receiver.",
     false},
    {"map_range_m", "m", "From the map's near plane to its far plane, along the light.", false},
    {"depth_quantum_m", "m",
     "q: one step of the map's format, along the light; of 32f, the largest step in [0,1], 2^-24 of the range. Under a "
     "spot light, whose steps grow with the distance, at the counted receiver where it is largest.",
     false},
    {"acne_free_bias_law_depth", "depth",
     "What law 1 asks for, whatever the grid's alignment: the largest need of a lit counted receiver's own plane (flat "
     "maps: k |depth gradient per texel|_1), plus half a quantum. At creases the neighbouring face may ask for more.",
     true},
    {"acne_free_bias_law_m", "m",
     "The same in metres of depth, of the receiver that asks for most metres (directional: k w |gradient|_1).", true},
    {"acne_free_bias_scene_law_depth", "depth",
     "The law over every face of the scene that is turned to the light: no receiver needs more.", true},
    {"acne_free_bias_scene_law_m", "m", "The same in metres of depth.", true},
    {"counted_area_m2", "m2",
     "The light's plane as far as counted receivers cover it; under a spot or point light, the sum of their areas "
     "across their rays.",
     false},
    {"filter_area_m2", "m2", "The filter's blur, over the light's plane instead of the picture.", true},
    {"displacement_area_m2", "m2", "Displacement, over the light's plane instead of the picture.", true},
    {"aliasing_area_m2", "m2", "Aliasing, dark and light, over the light's plane instead of the picture.", true},
    {"acne_area_m2", "m2", "Acne over the light's plane instead of the picture.", true},
    {"peter_panning_area_m2", "m2", "Peter Panning over the light's plane instead of the picture.", true},
    {"contract", "fraction",
     "Share of facing receivers whose R4, R5 or lookup on a map of ties is not, bit for bit, what the technique makes "
     "of the numbers read back (where a sampler blends taps: not within its rounding); a defect above 0.",
     false},
    {"rounding_excess", "",
     "Largest error of the lookup's own numbers (address, reference depth, N.L and what bias and filter need) against "
     "the light's frame in double, as a multiple of what float arithmetic can make; a defect above 1.",
     false},
    {"address_error_texels", "texels",
     "Largest distance in the map from the exact place where a receiver is looked up to the texel that the lookup says "
     "it falls into.",
     false},
    {"reference_error_m", "m", "Largest error of the lookup's reference depth, along the light.", false},
    {"map_error_quanta", "",
     "Median |stored - exact| depth of the texels that receivers fall into, in steps of the map's format.", true},
    {"map_bits", "", "Bits of the coarsest depth format that could have stored what receivers look up: 16, 24 or 32.",
     false},
    {"shaded_rmse", "",
     "Root mean square difference of the shaded frames (Blinn-Phong clay, linear light, 1 is white) with the map's "
     "shadow "
     "and with the true one (R5, R1), over the receivers.",
     true},
    {"map_ms", "ms", "Time of the shadow map pass.", true},
    {"lookup_ms", "ms", "Time of the lookup pass over the picture.", true},
    {"shadow_ms", "ms", "Shadow map pass and lookup together: the price of the technique.", true},
};

}  // namespace

std::span<const Metric> metrics_table() { return table; }

const Metric& find_metric(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Metric& metric : table) {
    if (metric.name == name) return metric;
    names.push_back(metric.name);
  }
  const std::string near = nearest_name(name, names);
  throw Error(ErrorKind::usage, "there is no metric '" + std::string(name) + "'" +
                                    (near.empty() ? "" : "; did you mean '" + near + "'?") +
                                    " (noonmark settings lists the metrics)");
}

}  // namespace noonmark
