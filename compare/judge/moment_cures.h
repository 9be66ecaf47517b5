// What may help at a point of a filtered map, in words. `noonmark render` and the report say the same.
//
//   if (const std::string cures = cures_of_reduction(point); !cures.empty()) print("what may help: " + cures);
#pragma once
#include <span>
#include <string>

#include "compare/results/records.h"
#include "technique/settings.h"

namespace noonmark {

// Of a point of which no reduction is usable (why_no_usable_reduction): what may help, as the end of a sentence: "a larger
// lookup.moment_bias; or a smaller blur or a finer map". Otherwise empty.
std::string cures_of_reduction(const PointRecord& point);

// If more than half of the point's error is the rounding of its moments: a clause that says so and names what may help. Otherwise
// empty.
std::string cures_of_precision(const PointRecord& point);

// The deviation of the depths that a blurred texel and its linear fetch hold of a plane, in texels by the tangent of the slope
// (law 17). Of the weights of a blur; or of the blur of these settings, whose lookup reads moments, in texels of the map also
// where a level of it is blurred (lookup.level). In double.
double blur_deviation_texels(std::span<const double> weights);
double blur_deviation_texels(const Settings& settings);

}  // namespace noonmark
