// The colour of each cause, defined once for the report's charts and legends and for the PNG of the classes. Warm
// colours mean falsely dark, cool ones falsely lit, greys and pinks neither. The hues are Okabe and Ito's ("Color
// Universal Design", 2008) and two of Paul Tol's. They differ under the common colour-vision deficiencies, on a white
// and on a near-black page.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "base/srgb.h"
#include "compare/results/quantities.h"

namespace noonmark {

struct CauseColor {
  std::string_view name;  // the metric that measures the cause
  uint8_t r, g, b;        // sRGB
  std::string_view label;
};

inline constexpr std::array<CauseColor, 13> cause_colors{{
    {"acne", 213, 94, 0, "Acne (too dark)"},
    {"peter_panning", 0, 114, 178, "Peter Panning (too light)"},
    {"aliasing_dark", 230, 159, 0, "Aliasing, too dark"},
    {"aliasing_light", 86, 180, 233, "Aliasing, too light"},
    {"coverage_dark", 170, 51, 119, "Coverage, too dark"},
    {"coverage_light", 0, 158, 115, "Coverage, too light"},
    {"filter", 150, 155, 162, "Filter (blur by design)"},
    {"displacement", 136, 84, 56, "Displacement (moved lookup)"},
    {"precision", 204, 121, 167, "Precision"},
    {"undecided", 240, 228, 66, "Undecided (truth of a tap unsure)"},
    {"light_size", 202, 186, 60, "Light size"},
    {"aliasing", 158, 170, 117, "Aliasing"},  // for dark and light together
    {"coverage", 0, 158, 115, "Coverage"},    // for dark and light together
}};

// The colour of a pixel in a class picture that has no cause.
inline constexpr std::array<CauseColor, 5> pixel_state_colors{{
    {"lit", 240, 240, 238, "Right, lit"},
    {"shadowed", 128, 130, 134, "Right, shadowed"},
    {"attached", 74, 76, 82, "Faces away from the light"},
    {"ambiguous", 255, 250, 200, "Ambiguous truth, left out"},
    {"background", background_srgb[0], background_srgb[1], background_srgb[2], "No surface"},
}};

// The classes of flicker (compare/ladder/flicker.h), by the metrics that measure them.
inline constexpr std::array<CauseColor, 4> flicker_colors{{
    {"flicker_grid", 230, 159, 0, "Grid moved"},
    {"flicker_depth", 204, 121, 167, "Depth re-rounded"},
    {"flicker_kernel", 0, 114, 178, "Kernel turned"},
    {"flicker_coverage", 0, 158, 115, "Edge of the map"},
}};

// cause_colors, followed by the causes that rungs brought at these points (PointRecord::causes), whose texts the rows refer
// to. Of frames of another renderer they are known only if a frame came with its own map.
inline std::vector<CauseColor> causes_of(std::span<const PointRecord> points) {
  std::vector<CauseColor> causes;
  if (!judges_frames(points) || knows_causes(points)) causes.assign(cause_colors.begin(), cause_colors.end());
  for (const RungCause* cause : brought_causes(points))
    causes.push_back({cause->name, cause->color[0], cause->color[1], cause->color[2], cause->label});
  return causes;
}

constexpr const CauseColor* find_color(std::string_view name) {
  for (const CauseColor& color : cause_colors)
    if (color.name == name) return &color;
  for (const CauseColor& color : pixel_state_colors)
    if (color.name == name) return &color;
  return nullptr;
}

}  // namespace noonmark
