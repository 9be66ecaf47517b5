#include "compare/results/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "compare/results/causes.h"
#include "technique/settings.h"

namespace noonmark {
namespace metric_rows {
namespace {

using enum Metric::Is;

constexpr Metric before_causes[] = {
    {"error", "fraction", "Mean |R5 - R1| over the counted receivers: what the GPU shows compared with the hard truth.",
     plot},
    {"error_soft", "fraction",
     "Mean |R5 - R0|: what the GPU shows compared with the truth for the light with its size.", plot},
    {"wrong", "fraction", "Share of the counted receivers whose R5 differs from R1.", plot},
    {"wrong_patch", "fraction",
     "The largest patch of wrong pixels, as a share of the whole picture: counted receivers that touch at a side or a "
     "corner, and whose R5 and R1 are not on the same side of one half.",
     plot | unbounded},
};

// After the row of a cause.
constexpr std::pair<std::string_view, Metric> beside_causes[] = {
    {"aliasing_light",
     {"aliasing_rms", "fraction",
      "Root mean square of aliasing over the receivers. A filter spreads jagged edges over more pixels, each less "
      "wrong: that lowers this number and leaves the mean as it is.",
      plot | unbounded}},
    {"peter_panning",
     {"peter_panning_lit", "fraction",
      "The part of peter_panning at receivers that are lit in truth. Without a filter and without a normal offset it "
      "is 0; anything else is a defect.",
      plot}},
    {"leak",
     {"leak_largest", "fraction", "Of a map of moments: the largest leak of a receiver, as a share of full light.",
      plot | moments | unbounded}},
    {"over_darkening",
     {"over_darkening_largest", "fraction",
      "Of a map of moments: the largest over-darkening of a receiver, as a share of full light.",
      plot | moments | unbounded}},
    {"undecided",
     {"undecided_taps", "fraction",
      "Weight of the taps whose truth changes within float error, whether they are right or wrong.", plot}},
};

constexpr Metric measured_with_causes[] = {
    {"peter_panning_gap_m", "m",
     "Largest width of a lit gap between an occluder and its shadow, along the light's trace on the surface (at a "
     "corner it is wider than along the wall). Of a map of moments: where Peter Panning lights by a half or more.",
     plot | unbounded},
    {"edge_displacement_texels", "texels",
     "Largest distance from an aliased tap to the true shadow edge, across the light's rays, in texels there.",
     plot | unbounded},
    {"edge_displacement_mean_texels", "texels",
     "Mean over the receivers of the distance from the farthest aliased tap to the true shadow edge, across the "
     "light's rays, in texels there.",
     plot | unbounded},
    {"edge_displacement_pixels", "pixels",
     "Largest distance in the picture from an edge that filter, displacement and aliasing draw to the nearest true "
     "shadow edge (R1) on the same surface. A soft edge lies where it crosses one half.",
     plot | unbounded},
    {"edge_displacement_mean_pixels", "pixels",
     "Mean over the pixels of the drawn edges of their distance in the picture to the nearest true shadow edge on the "
     "same surface.",
     plot | unbounded},
    {"edge_displacement_p95_pixels", "pixels",
     "The distance in the picture to the nearest true shadow edge on the same surface that 95% of the pixels of the "
     "drawn edges do not exceed.",
     plot | unbounded},
    {"receivers", "count", "Number of pixels that see a surface.", number},
    {"facing", "count", "Number of receivers that face the light.", number},
    {"counted", "count",
     "Number of facing receivers that are not ambiguous. Every fraction is a fraction of the counted receivers, unless "
     "its text names others.",
     number},
    {"clipped", "count",
     "Number of pixels that see nothing because the camera's near or far plane cuts the surface off.", number},
    {"culled", "count", "Number of pixels that see nothing but the backs of single-sided faces.", number},
    {"scene_behind", "", "Share of the scene's vertices that lie behind the camera.", number},
    {"attached", "count",
     "Number of receivers that face away from the light. They are dark by shading and are left out of all errors.",
     number},
    {"lit", "fraction", "Share of the counted receivers that the light reaches (R1).", unbounded},
    {"ambiguous", "fraction",
     "Share of the facing receivers whose truth R1 changes within float error. They are left out of all errors.",
     number},
    {"outside", "fraction", "Share of the counted receivers that fall outside the map or beyond its far plane.", plot},
    {"ambiguous_receivers", "count", "Number of facing receivers whose truth R1 changes within float error.", number},
    {"undecided_receivers", "count", "Number of counted receivers with a tap whose truth changes within float error.",
     number},
    {"outside_receivers", "count", "Number of counted receivers outside the map or beyond its far plane.", number},
    {"residual", "",
     "Largest |(R5 - R0) - sum of the signed steps| over all facing receivers. Above 1e-6 it is a defect.", number},
    {"tap_residual", "",
     "Largest |(R4 - R2) - displacement - sum of the causes of the taps, undecided ones included| over all facing "
     "receivers. Above 1e-6 it is a defect.",
     number},
    {"texel_m", "m",
     "w: the width of a texel in the world. Under a spot or point light it grows with the distance; this is its value "
     "at the median counted receiver.",
     number},
    {"nearest_receiver_m", "m",
     "Depth along the view of the nearest counted receiver. Of a cascade: of the nearest that is looked up in it, "
     "wherever its slice begins.",
     number},
    {"farthest_receiver_m", "m", "Depth along the view of the farthest counted receiver, likewise.", number},
    {"map_range_m", "m", "Distance from the map's near plane to its far plane, along the light.", number},
    {"depth_quantum_m", "m",
     "q: one step of the map's depth format, along the light. Of 32f it is the largest step in [0,1], 2^-24 of the "
     "range. Under a spot light steps grow with the distance; this is the largest at a counted receiver.",
     number},
    {"acne_free_bias_law_depth", "depth",
     "The bias that law 1 requires, whatever the alignment of the texel grid: the largest requirement of a lit counted "
     "receiver's own plane (flat maps: k |depth gradient per texel|_1), plus half a quantum. At a crease the "
     "neighbouring face may require more.",
     plot},
    {"acne_free_bias_law_m", "m",
     "The bias that law 1 requires, in metres of depth, for the receiver that requires most metres (directional: k w "
     "|gradient|_1); whatever the alignment of the texel grid.",
     plot},
    {"acne_free_bias_scene_law_depth", "depth",
     "The bias that law 1 requires of every face of the scene that is turned to the light, seen or not. No receiver "
     "requires more.",
     plot},
    {"acne_free_bias_scene_law_m", "m",
     "The bias that law 1 requires of every face of the scene that is turned to the light, in metres of depth.", plot},
    {"counted_area_m2", "m2",
     "Area of the light's plane that the counted receivers cover. Under a spot or point light: the sum of their areas "
     "across their light rays.",
     unbounded},
    {"filter_area_m2", "m2", "The filter's blur as an area of the light's plane instead of a share of the picture.",
     plot | unbounded},
    {"displacement_area_m2", "m2", "Displacement as an area of the light's plane instead of a share of the picture.",
     plot | unbounded},
    {"aliasing_area_m2", "m2",
     "Aliasing, dark and light, as an area of the light's plane instead of a share of the picture.", plot | unbounded},
    {"acne_area_m2", "m2", "Acne as an area of the light's plane instead of a share of the picture.", plot | unbounded},
    {"peter_panning_area_m2", "m2", "Peter Panning as an area of the light's plane instead of a share of the picture.",
     plot | unbounded},
    {"contract", "fraction",
     "Share of the facing receivers at which R4, R5 or the lookup in the tie map is not, bit for bit, what the "
     "technique's definition gives for the numbers read back (where a sampler blends taps: not within its rounding). "
     "Above 0 it is a defect.",
     number},
    {"contract_store", "fraction",
     "Of a map of moments: share of the texels that do not store what the lookup's definition gives for their depth, "
     "within the rounding of map.moments. Above 0 it is a defect.",
     moments},
    {"contract_blur", "fraction",
     "Of a map of moments: share of the sums of the blur that are not the sum of the texels that they read, within the "
     "rounding of map.moments. Above 0 it is a defect.",
     moments},
    {"contract_fetch", "fraction",
     "Of a map of moments: share of the facing receivers that fetch other moments than the texels around them give, "
     "within the rounding of a sampler's weights. Above 0 it is a defect.",
     moments},
    {"contract_lit", "fraction",
     "Of a map of moments: share of the facing receivers whose result is not what the lookup's definition gives for "
     "the moments that they fetched, within the rounding of float arithmetic. Above 0 it is a defect.",
     moments},
    {"below_comparison", "",
     "Of a map of moments: the largest amount by which the exact bound, without bias, floor or reduction, is darker "
     "than the comparison of the same depths (law 13). Above 1e-9 it is a defect. Not of lookups that are no bound "
     "(babylon_esm, babylon_close_esm, three_vsm).",
     moments},
    {"best_reduction", "",
     "Of a map of moments: the lookup.reduction of least error against R1, on the exact map. Measured with a curve, "
     "but not with lookup.reduction_span or a blend band of cascades.",
     plot | moments | unbounded},
    {"best_reduction_error", "fraction", "Of a map of moments: mean |R4 - R1| at best_reduction.",
     plot | moments | unbounded},
    {"reduction_min", "",
     "Of a map of moments: the least lookup.reduction at which the leak is within curve.peter_panning_bound, and "
     "over-darkening and what the reduction darkens are each within curve.acne_bound. Left out if no reduction is. "
     "Measured with a curve.",
     plot | moments | unbounded},
    {"reduction_max", "", "Of a map of moments: the largest such lookup.reduction, at most 0.99.",
     plot | moments | unbounded},
    {"rounding_excess", "",
     "Largest error of the numbers that the lookup computes (address, reference depth, N.L, and what bias and filter "
     "need) against the light's frame in double, as a multiple of the largest error that float arithmetic can make. "
     "Above 1 it is a defect.",
     number},
    {"cascade_choice_excess", "",
     "Of cascades: how far beyond the end of a cascade a receiver lies that the lookup counts to the wrong side of it, "
     "or how far its weight in a blend band is off, as a multiple of the largest error that float arithmetic can make "
     "of it; 0: the choice is exact. Above 1 it is a defect.",
     cascades},
    {"seam_points", "count",
     "Of cascades: the counted receivers in the last 4% of a cascade, over which seams are measured.", cascades},
    {"seam_jump", "fraction",
     "Of cascades: mean |R5 in the next cascade - R5 in its own| over the receivers in the last 4% of a cascade that "
     "is not the last: the step that the picture has there without a blend band. Its parts by cause follow; they can "
     "add up to more than it, because their signs differ.",
     plot | cascades},
    {"seam_filter", "fraction", "Of seam_jump: mean |change| of the blur of the filter.", plot | cascades},
    {"seam_displacement", "fraction", "Of seam_jump: mean |change| of displacement.", plot | cascades},
    {"seam_aliasing", "fraction", "Of seam_jump: mean |change| of aliasing, dark and light together.", plot | cascades},
    {"seam_acne", "fraction", "Of seam_jump: mean |change| of acne.", plot | cascades},
    {"seam_peter_panning", "fraction", "Of seam_jump: mean |change| of Peter Panning.", plot | cascades},
    {"seam_coverage", "fraction",
     "Of seam_jump: mean |change| of coverage, dark and light together: for example where the next map does not hold "
     "the receiver.",
     plot | cascades},
    {"seam_undecided", "fraction", "Of seam_jump: mean |change| of the undecided taps.", plot | cascades},
    {"seam_precision", "fraction", "Of seam_jump: mean |change| of precision.", plot | cascades},
    {"address_error_texels", "texels",
     "Largest distance in the map from the exact place where a receiver is looked up to the texel that the lookup "
     "reads.",
     number},
    {"reference_error_m", "m", "Largest error of the lookup's reference depth, along the light.", number},
    {"map_error_quanta", "",
     "Median |stored - exact| depth of the texels that receivers fall into, in steps of the map's depth format.", plot},
    {"map_excess", "",
     "Median distance along the light of the map's depths from an exact map's, over the texels that receivers fall "
     "into, as a multiple of the most that leaves the map the scene's: a fiftieth of the depths' spread, or rounding.",
     number},
    {"map_bits", "",
     "Bits of the coarsest depth format that could have stored the depths that receivers look up: 16, 24 or 32.",
     number},
    {"shaded_rmse", "",
     "Root mean square difference over the receivers of two shaded frames (Blinn-Phong clay, linear light, 1 is "
     "white): one with the map's shadow (R5), one with the true shadow (R1).",
     plot | unbounded},
    {"flip", "",
     "Mean FLIP over the picture of the two shaded frames as they are shown (8-bit sRGB, 67 pixels per degree): from "
     "0, nobody sees a difference, to 1.",
     plot | unbounded},
    {"map_used", "fraction",
     "Share of the map's texels that hold anything: a depth below 1, as OpenGL draws it. The rest is empty space about "
     "the scene.",
     plot},
    {"map_seen", "fraction",
     "Share of the map's texels that the lookup of some receiver that faces the light reads: what the picture gets of "
     "the map.",
     plot},
    {"undersampled", "fraction",
     "Share of the receivers that face the light where a texel is longer in the picture than a pixel: there the stairs "
     "of a shadow edge can be seen. It needs no edge.",
     plot},
    {"perspective_aliasing", "",
     "Median over the receivers that face the light of the width of a texel over the width of a pixel, both across "
     "their rays (Lloyd et al. 2006): above 1 the map is too coarse for the camera, whatever the surface's slope.",
     plot},
    {"perspective_aliasing_p95", "",
     "What perspective_aliasing is at most at 95% of the receivers: large where the map spends its texels far from the "
     "camera.",
     plot},
    {"truth_by_cells", "fraction",
     "Share of the truth that needed no ray, because a certified square of the light's plane or the lack of "
     "silhouettes answered it. The truth is R1 of each receiver that faces the light, V at the places of its taps, and "
     "the first hit at each texel of the exact map that they read.",
     number},
    {"truth_by_rays", "fraction",
     "Share of the truth that Embree's rays answered; 1 with truth.method = rays, which gives the same verdicts.",
     number},
    {"truth_by_scan", "fraction",
     "Share of the truth that scan conversion in double answered: the texels of a flat map. It is 0 for a cube.",
     number},
    {"texel_work", "count",
     "Cost of the technique, the same on every machine: the texels of the map, each written once, and the texture "
     "instructions of the lookups of all facing receivers.",
     plot},
    {"traffic_bytes", "bytes",
     "Cost of the technique in bytes, the same on every machine: those of the map, each written once, and of the "
     "texels that the lookups read, without a cache.",
     plot},
    {"map_bytes", "bytes", "Memory of the shadow map. A depth of 24 bits takes 4 bytes.", plot},
    {"map_texels", "count", "Number of texels of the shadow map, of a cube on all six faces.", plot},
    {"map_triangles", "count",
     "Number of triangles that the rasteriser gets for the shadow map: those of the scene, once for each face of a "
     "cube.",
     plot},
    {"lookup_fetches", "count", "Number of texture instructions that the lookup of one receiver needs.", plot},
    {"lookup_texels", "count",
     "Number of texels that the texture instructions of one receiver's lookup read: one each, or four where a "
     "comparison sampler blends. Neighbours may read the same ones.",
     plot},
    {"lookup_operations", "count",
     "Number of operations (sum, product, division, root, minimum, maximum, comparison) that the lookup of one "
     "receiver needs for bias, references, weights and their sum. Its place in the map and the addresses of the taps "
     "are not counted.",
     plot},
};

// Each has a median, and the two ends of its interval. They come from measure/pass_times.h.
constexpr std::pair<std::string_view, std::string_view> timed[] = {
    {"map", "the shadow map pass"},
    {"prefilter", "the passes that store and blur a map of moments"},
    {"lookup", "the lookup pass over the picture"},
    {"shadow", "all passes of map and lookup together"}};

constexpr Metric from_frame_to_frame[] = {
    {"flicker", "fraction",
     "Mean |change of R5| from this frame to the next, over the world points that both frames see and whose truth R1 "
     "is the same in both.",
     plot | motion},
    {"flicker_changed", "fraction",
     "Share of the world points over which flicker is taken whose R5 changes at all from this frame to the next.",
     plot | motion},
    {"flicker_cascade", "fraction",
     "The part of flicker that comes when a point goes from one cascade to another; 0 with one map.", motion},
    {"flicker_grid", "fraction", "The part of flicker that comes when the texels move, grow or turn in the world.",
     plot | motion},
    {"flicker_depth", "fraction",
     "The part of flicker that comes when near and far move, so that depths are rounded anew and a bias in window "
     "depth is another one in metres.",
     plot | motion},
    {"flicker_kernel", "fraction",
     "The part of flicker that comes when the filter's kernel turns with the pixel, or grows with the view distance.",
     plot | motion},
    {"flicker_coverage", "fraction",
     "The part of flicker at points that one of the two maps does not hold with all taps of the filter: the map's edge "
     "passes over them.",
     plot | motion},
    {"flicker_truth", "fraction",
     "Share of the world points that both frames see whose truth R1 changes. They are left out of flicker.",
     plot | motion},
    {"flicker_points", "count", "Number of world points over which flicker is taken.", motion},
    {"flicker_outside", "count",
     "Number of world points that face the light in this frame and that the next frame's picture does not hold, or its "
     "camera's near or far plane cuts off. They are left out of flicker.",
     motion},
    {"flicker_hidden", "count",
     "Number of world points that face the light in this frame and lie in the next frame's picture, and that a surface "
     "hides there, or of which its camera sees the back, or of which rounding decides that. They are left out of "
     "flicker.",
     motion},
    {"flicker_unlit", "count",
     "Number of world points that face the light in this frame and that the next frame sees, and that face away from "
     "its light or whose truth there is ambiguous. They are left out of flicker.",
     motion},
    {"flicker_ambiguous", "count",
     "Number of world points of flicker_hidden and flicker_unlit that are there because rounding decides the truth of "
     "the "
     "next frame.",
     motion},
};

// Of the frame that the lights make together, the same at the points of all its lights, but for those that begin with light_.
constexpr Metric of_several_lights[] = {
    {"lights_error", "fraction",
     "Frame of several lights: mean over the counted pixels of |sum of w (R5 - R1)|, where w is the light's share of "
     "the light that reaches the pixel without shadows.",
     plot | lights},
    {"lights_error_soft", "fraction", "Frame of several lights: the same against the truth R0 of lights with a size.",
     plot | lights},
    {"lights_rmse", "",
     "Frame of several lights: root mean square difference over the counted pixels and the three colours of the shaded "
     "frame and the true one (diffuse clay, linear light; white is the light that 95% of the pixels that are lit in "
     "truth do not exceed).",
     plot | lights | unbounded},
    {"lights_flip", "",
     "Frame of several lights: mean FLIP of the shaded frame and the true one, as they are shown (8-bit sRGB, 67 "
     "pixels per degree).",
     plot | lights | unbounded},
    {"light_error", "fraction",
     "This light's part of the frame's error: mean over the frame's counted pixels of w |R5 - R1|.", plot | lights},
    {"light_share", "fraction",
     "light_error as a share of its sum over all lights of the frame. The sum is at least lights_error: at a pixel, "
     "two lights can err against each other.",
     plot | lights | unbounded},
    {"light_weight", "fraction",
     "This light's share of the light without shadows: mean w over the frame's counted pixels.", plot | lights},
    {"lights_counted", "count",
     "Number of counted pixels of the frame: a light reaches them, and the truth of no light that does is ambiguous.",
     lights},
    {"lights_ambiguous", "count",
     "Number of pixels of the frame that a light reaches and that do not count, because the truth of a light that does "
     "is ambiguous.",
     lights},
    {"lights_frame", "count", "The number of the frame of several lights to which the point belongs, from 0.", lights},
};

constexpr Metric over_placements[] = {
    {"reduction_min_worst", "",
     "Of a map of moments without cascades: the least lookup.reduction that is within both bounds of reduction_min at "
     "every placement of the texel grid. Left out if no reduction is.",
     plot | placements | moments | unbounded},
    {"reduction_max_worst", "", "Of a map of moments without cascades: the largest such lookup.reduction.",
     plot | placements | moments | unbounded},
    {"error_worst_shown", "fraction",
     "Mean |R5 - R1| at the placement of the texel grid with the largest error, as OpenGL renders it.",
     plot | placements},
    {"worst_shift_u_texels", "texels",
     "Of a flat map: the shift, along the rows of texels, of the placement with the largest error, from the map of the "
     "settings. Add it to map.shift_u_texels to render that placement.",
     placements},
    {"worst_shift_v_texels", "texels",
     "Of a flat map: the shift, along the columns of texels, of the placement with the largest error, from the map of "
     "the settings. Add it to map.shift_v_texels to render that placement.",
     placements},
    {"worst_turn_x_deg", "deg",
     "Of a point light's cube: the x component of map.turn_deg of the placement with the largest error. Set all three "
     "components to render that placement.",
     placements},
    {"worst_turn_y_deg", "deg",
     "Of a point light's cube: the y component of map.turn_deg of the placement with the largest error.", placements},
    {"worst_turn_z_deg", "deg",
     "Of a point light's cube: the z component of map.turn_deg of the placement with the largest error.", placements},
    {"placement_disagreements", "count",
     "Number of taps at which the truth of all placements differs from the ladder's own, at the placements that are "
     "rendered too; of a map of moments, number of sums over its receivers. Above 0 it is a defect.",
     placements},
};

// Sizes are means over the counted receivers of the frame: those with a surface in the scene and in the frame that face the
// light, and whose truth is not ambiguous.
constexpr Metric of_given_frames[] = {
    {"frame_error", "fraction",
     "Mean |V - R0|: the visibility V of another renderer's frame compared with the truth, which is R1 for a light "
     "without a size.",
     plot | frames},
    {"frame_wrong", "fraction",
     "Share of the counted receivers of another renderer's frame whose visibility is off by more than a half. A frame "
     "can be wrong nowhere and grey everywhere: frame_error stands beside it.",
     plot | frames},
    {"frame_penumbra", "fraction",
     "The part of frame_error where the truth is between lit and shadowed, because the light has a size.",
     plot | frames},
    {"frame_missing", "fraction",
     "The part of frame_error where the truth is dark, the frame is too light, and only casters that the frame's map "
     "lacks (not_in_map) are in the light's way.",
     plot | frames},
    {"frame_edge", "fraction",
     "The part of frame_error within the edge distance of a true shadow edge, outside penumbrae.", plot | frames},
    {"frame_acne", "fraction",
     "The part of frame_error where the truth is lit, the frame is too dark, and no true shadow edge is near.",
     plot | frames},
    {"frame_contact", "fraction",
     "The part of frame_error where the truth is dark, the frame is too light, no true shadow edge is near, and the "
     "occluder is nearer to the receiver than the contact distance.",
     plot | frames},
    {"frame_leak", "fraction",
     "The part of frame_error where the truth is dark, the frame is too light, no true shadow edge is near, and the "
     "occluder is further away than the contact distance.",
     plot | frames},
    {"frame_lookup", "fraction",
     "Of a frame with its own map: mean |frame - R5|, the part that the declared lookup of that map does not show.",
     plot | frames},
    {"frame_map", "fraction",
     "Of a frame with its own map: mean |R5 - R4| if that map is not the scene's; 0 if it is, and the mean is "
     "precision.",
     plot | frames},
    {"frame_lookup_differs", "fraction",
     "Of a frame with its own map: share of receivers at which the frame is off from R5 by more than a half.",
     plot | frames},
};

// Mean, worst and best over the placements of the texel grid of each of these.
constexpr std::string_view placed[] = {"error",    "wrong",          "acne",           "peter_panning",
                                       "aliasing", "aliasing_dark",  "aliasing_light", "aliasing_rms",
                                       "coverage", "coverage_dark",  "coverage_light", "undecided",
                                       "leak",     "over_darkening", "reduction"};

bool only_of_moments(std::string_view cause) {
  return std::any_of(std::begin(cause_rows), std::end(cause_rows),
                     [&](const CauseRow& row) { return row.name == cause && is_of_moments(row); });
}

struct MetricTable {
  std::deque<std::string> texts;  // of the rows that are made here
  std::vector<Metric> rows;
};

const MetricTable& table() {
  static const MetricTable made = [] {
    MetricTable t;
    t.rows.assign(std::begin(before_causes), std::end(before_causes));
    for (const CauseRow& cause : cause_rows) {
      t.rows.push_back({cause.name, "fraction", cause.help, is_of_moments(cause) ? plot | moments : plot});
      for (const auto& [name, row] : beside_causes)
        if (name == cause.name) t.rows.push_back(row);
    }
    t.rows.insert(t.rows.end(), std::begin(measured_with_causes), std::end(measured_with_causes));
    const auto text = [&](const std::string& made_text) -> std::string_view { return t.texts.emplace_back(made_text); };
    for (const auto& [name, what] : timed) {
      const std::string stem(name);
      const unsigned is = name == "prefilter" ? moments : number;
      t.rows.push_back({text(stem + "_ms"), "ms",
                        text("Time of " + std::string(what) +
                             ", the median of nine samples: time of the GPU, or CPU time of the process if the "
                             "renderer is software. Measured only if times are asked for (key times of the "
                             "experiment)."),
                        is | plot});
      t.rows.push_back({text(stem + "_low_ms"), "ms",
                        text("The lower end of the interval of " + stem +
                             "_ms: the second smallest sample. The interval holds the true median with 96%; two times "
                             "differ only if their intervals do not overlap."),
                        is});
      t.rows.push_back({text(stem + "_high_ms"), "ms",
                        text("The upper end of the interval of " + stem + "_ms: the second largest sample."), is});
    }
    for (std::string_view name : placed)
      for (const auto& [ending, what] :
           {std::pair("mean", "Mean"), std::pair("worst", "Largest"), std::pair("best", "Least")}) {
        t.rows.push_back(
            {text(std::string(name) + "_" + ending), "fraction",
             text(std::string(what) + " over the placements of the texel grid (map.placements) of " +
                  std::string(name) + ", on the exact map" +
                  (std::string_view(ending) == "worst" ? ". The largest of all placements may be a tenth more." : ".")),
             plot | placements | (only_of_moments(name) ? moments : number) |
                 (name == "aliasing_rms" ? unbounded : number)});
      }
    t.rows.insert(t.rows.end(), std::begin(over_placements), std::end(over_placements));
    t.rows.insert(t.rows.end(), std::begin(from_frame_to_frame), std::end(from_frame_to_frame));
    t.rows.insert(t.rows.end(), std::begin(of_several_lights), std::end(of_several_lights));
    t.rows.insert(t.rows.end(), std::begin(of_given_frames), std::end(of_given_frames));
    return t;
  }();
  return made;
}

}  // namespace
}  // namespace metric_rows

std::span<const Metric> metrics_table() { return metric_rows::table().rows; }

bool is_of_lights(std::string_view name) {
  return std::any_of(metrics_table().begin(), metrics_table().end(),
                     [&](const Metric& metric) { return metric.name == name && metric.of_lights; });
}

const Metric& find_metric(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Metric& metric : metrics_table()) {
    if (metric.name == name) return metric;
    names.push_back(metric.name);
  }
  refuse_metric(name, names);
}

void refuse_metric(std::string_view name, std::span<const std::string_view> names) {
  // Metrics that were there in versions before 1.0, and what is the same.
  constexpr std::pair<std::string_view, std::string_view> gone[] = {{"pcf_error", "error"},
                                                                    {"pcf_error_soft", "error_soft"}};
  for (const auto& [old, same] : gone)
    if (name == old)
      throw Error(ErrorKind::usage,
                  fmt::format("there is no metric '{}' any more: it was '{}' at every point; write that", old, same));
  const std::string near = nearest_name(name, names);
  throw Error(ErrorKind::usage, fmt::format("there is no metric '{}'{} (noonmark settings lists the metrics)", name,
                                            near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
}

}  // namespace noonmark
