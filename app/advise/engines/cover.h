// The least amounts of an engine's fields that replace a bias which the engine has no field for.
//
//   const auto amounts = least_cover({BiasForm::constant, BiasForm::normal},
//                                    [&](double theta, double phi) { return gain(BiasForm::axes, theta, phi) * 0.02; });
//   // {{0, 0.02 * sqrt(2)}}: a normal offset of sqrt(2) times as much
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "app/advise/engines/engine.h"

namespace noonmark {

// needed: the depth in metres along the light at a slope theta (0 to less than pi / 2) and an azimuth phi (0 to pi / 4, to
// which the others are symmetric), at least 0. The amounts are in the order of the forms, in metres of each form. Their sum
// gives at least the needed depth at every slope and azimuth. One field is taken if one is enough, otherwise two; of
// several ways the one that gives least depth on a plane at 45 degrees, because what is given beyond the needed depth is
// Peter Panning. Nothing if no one and no two of the forms suffice: a constant, say, is less than any multiple of the
// tangent somewhere.
//
// The slopes are a grid of a 1024th of a right angle, and 1e-4 rad from both ends and 1e-6 rad from 90 degrees: a greatest ratio
// between two slopes of the grid is met to 1e-6 of itself, which is less than the last digit that is printed. The azimuths
// are 9: where a polygon factor and an offset by axes are needed together, the worst azimuth lies between two of them, and
// is met to 0.13%.
std::optional<std::vector<double>> least_cover(const std::vector<BiasForm>& forms,
                                               const std::function<double(double theta, double phi)>& needed);

}  // namespace noonmark
