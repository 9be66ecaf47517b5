// What the tests of the laws share.
#pragma once
#include <glm/glm.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/measured.h"

namespace noonmark::acceptance {

constexpr double radians(double degrees) { return degrees * std::numbers::pi / 180; }
inline std::string text(double value) { return std::to_string(value); }

// Both bounds of the curve at 0: the window begins at the smallest bias at which no tap has acne.
inline CurveOptions exact_window() {
  CurveOptions options;
  options.acne_bound = options.peter_panning_bound = 0;
  return options;
}

// The mean of a metric over n x n alignments of the map's grid, spaced evenly over one texel.
inline double mean_over_alignments(Workbench& bench, const Settings& settings, const std::string& name, int n = 4) {
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      Settings shifted = settings;
      shifted.map.shift_u_texels = static_cast<double>(i) / n;
      shifted.map.shift_v_texels = static_cast<double>(j) / n;
      sum += metric(bench.measure(shifted, std::nullopt), name);
    }
  return sum / (n * n);
}

// The plate of scene `plate`, 1.6 m x 1.2 m, 4 m above the floor under a light straight above: a rectangle in the
// light's plane, turned by phi against the texels. The camera stands under it and sees its whole shadow.
inline constexpr double plate_a_m = 1.6, plate_b_m = 1.2;
inline Settings plate_from_above(double phi_deg, int resolution, int width = 480, int height = 270) {
  return with({{"scene.phi_deg", text(phi_deg)},
               {"scene.height_m", "4"},
               {"scene.thickness_m", "0.01"},
               {"light.position_m", "0,10,0"},
               {"light.target_m", "0,0,0"},
               {"view.eye_m", "2.87,3,1.16"},
               {"view.target_m", "0.05,0,0.05"},
               {"view.fov_deg", "34"},
               {"map.extent_m", "4"},
               {"map.near_m", "5"},
               {"map.far_m", "11"},
               {"map.resolution", std::to_string(resolution)},
               {"map.format", "32f"},
               {"bias.unit", "m"},
               {"bias.constant", "0.01"}},
              small("plate", width, height));
}

// The area of S xor (S + way), where S is the plate's shadow and `way` is in metres in the light's plane.
inline double plate_moved_area(double phi_deg, glm::dvec2 way) {
  const double c = std::cos(radians(phi_deg)), s = std::sin(radians(phi_deg));
  const double p = std::abs(c * way.x + s * way.y), q = std::abs(-s * way.x + c * way.y);
  return 2 * (plate_a_m * q + plate_b_m * p - p * q);
}

}  // namespace noonmark::acceptance
