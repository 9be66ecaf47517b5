#include "compare/results/curve_fields.h"

namespace noonmark {
namespace {

constexpr CurveField fields_of_curves[] = {
    {"parameter", "", "The setting that the curve varies.", &BiasCurve::parameter},
    {"made", "", "How the curve was made.", &BiasCurve::made},
    {"m_per_depth", "m", "Metres along the light for 1 of window depth.", &BiasCurve::m_per_depth},
    {"texels_per_depth", "texels", "Texels of the map for 1 of window depth.", &BiasCurve::texels_per_depth},
    {"acne_bound", "fraction", "The most acne within the usable window.", &BiasCurve::acne_bound},
    {"peter_panning_bound", "fraction", "The most Peter Panning within the usable window.",
     &BiasCurve::peter_panning_bound},
    {"window_min_depth", "depth",
     "Least usable bias: the lower end of the window in which acne and Peter Panning are both within their bounds.",
     &BiasCurve::window_min_depth, true},
    {"window_max_depth", "depth",
     "Largest usable bias: the upper end of the window in which acne and Peter Panning are both within their bounds.",
     &BiasCurve::window_max_depth, true},
    {"best_bias_depth", "depth", "The bias with the least error.", &BiasCurve::best_bias_depth, true},
    {"best_error", "fraction", "Mean |R5 - R1| at the bias with the least error.", &BiasCurve::best_error, true},
    {"flat_min_depth", "depth",
     "Least bias of the interval around the best bias in which the error is within 10% of the least.",
     &BiasCurve::flat_min_depth, true},
    {"flat_max_depth", "depth",
     "Largest bias of the interval around the best bias in which the error is within 10% of the least.",
     &BiasCurve::flat_max_depth, true},
    {"breakpoints", "count", "Biases at which the error changes.", &BiasCurve::breakpoints},
    {"acne_free_bias_depth", "depth",
     "Least amount of the curve's part of the bias that leaves no acne on an exact map.",
     &BiasCurve::acne_free_bias_depth, true},
    {"acne_free_bias_stored_depth", "depth",
     "Least amount of the curve's part that leaves no acne on the GPU's own map, with its format and rasteriser.",
     &BiasCurve::acne_free_bias_stored_depth, true},
    {"placements", "count", "Placements of the texel grid over which the bands and the window below are; 0: none.",
     &BiasCurve::placements},
    {"window_min_worst_depth", "depth",
     "Least bias that is usable at every placement of the texel grid (map.placements), to a sixteenth of an octave.",
     &BiasCurve::window_min_worst_depth, true},
    {"window_max_worst_depth", "depth", "Largest bias that is usable at every placement.",
     &BiasCurve::window_max_worst_depth, true},
    {"acne_free_bias_worst_depth", "depth",
     "Least amount of the curve's part that leaves no acne at any placement, on an exact map.",
     &BiasCurve::acne_free_bias_worst_depth, true},
};

constexpr CurveWidth widths[] = {
    {"window_width_depth", "depth", "Width of the usable bias window; 0 when no bias is good enough.",
     "window_min_depth", "window_max_depth"},
    {"window_width_worst_depth", "depth",
     "Width of the window that is usable at every placement; 0 when no bias is good enough at all of them.",
     "window_min_worst_depth", "window_max_worst_depth", true},
};

constexpr CurveSeries series[] = {
    {"bias_depth", &BiasCurve::bias_depth},
    {"error", &BiasCurve::error},
    {"error_soft", &BiasCurve::error_soft},
    {"wrong", &BiasCurve::wrong},
    {"acne", &BiasCurve::acne},
    {"peter_panning", &BiasCurve::peter_panning},
    {"aliasing_dark", &BiasCurve::aliasing_dark},
    {"aliasing_light", &BiasCurve::aliasing_light},
    {"coverage", &BiasCurve::coverage},
    {"error_mean", &BiasCurve::error_band, &Band::mean},
    {"error_worst", &BiasCurve::error_band, &Band::worst},
    {"error_best", &BiasCurve::error_band, &Band::best},
    {"acne_mean", &BiasCurve::acne_band, &Band::mean},
    {"acne_worst", &BiasCurve::acne_band, &Band::worst},
    {"acne_best", &BiasCurve::acne_band, &Band::best},
    {"peter_panning_mean", &BiasCurve::peter_panning_band, &Band::mean},
    {"peter_panning_worst", &BiasCurve::peter_panning_band, &Band::worst},
    {"peter_panning_best", &BiasCurve::peter_panning_band, &Band::best},
    {"aliasing_mean", &BiasCurve::aliasing_band, &Band::mean},
    {"aliasing_worst", &BiasCurve::aliasing_band, &Band::worst},
    {"aliasing_best", &BiasCurve::aliasing_band, &Band::best},
};

}  // namespace

std::span<const CurveField> curve_fields() { return fields_of_curves; }
std::span<const CurveWidth> curve_widths() { return widths; }
std::span<const CurveSeries> curve_series() { return series; }

}  // namespace noonmark
