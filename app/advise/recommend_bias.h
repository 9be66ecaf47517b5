// What a search says of settings without a usable bias: the bias that comes nearest, and the pixel that it leaves wrong.
#pragma once
#include <optional>
#include <string>

#include "compare/ladder/bias_curves.h"
#include "measure/workbench.h"

namespace noonmark {

// The shares of the bounds that a search uses up: views that it does not search are a little worse. Of acne it leaves more,
// because another rasteriser, which rounds vertices and depths otherwise, adds acne, and no Peter Panning.
inline constexpr double searched_acne = 0.5, searched_peter_panning = 0.8;
CurveOptions searched_bounds(CurveOptions bounds);
// "50% of the bound on acne and 80% of that on Peter Panning"
std::string searched_text();

// The bias of a curve that comes nearest to the bounds, in bias.unit, and what it leaves: shares of the counted receivers, with
// placements at the worst of them.
struct NearestBias {
  double bias = 0, acne = 0, peter_panning = 0;
};

// The point must have a curve. bounds: of the search.
NearestBias nearest_bias(const PointRecord& point, const CurveOptions& bounds);

// By which multiple of its bound the worse of both causes is left. Infinite if a bound is 0 and the cause is not.
double excess(const NearestBias& nearest, const CurveOptions& bounds);

// Why no bias of the point's curve is usable, in numbers.
std::string why_no_window(const PointRecord& point, const NearestBias& nearest);

// The pixel with most acne and Peter Panning. Without any the point's own worst pixel.
PointRecord::Worst worst_of_bias(const Measurement& m);

// The least resolution from which on one constant bias keeps the bounds at every placement, without a filter, from the phase
// diagram of the settings; the finest that the diagram has, negative, if none does. Empty where a diagram has no meaning.
// Throws Error.
std::optional<int> constant_bias_resolution(Workbench& bench, const Settings& settings, const CurveOptions& bounds);

}  // namespace noonmark
