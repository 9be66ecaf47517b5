// Colours and labels for legends, charts, pages and pictures: of the causes, of pixels without a cause, of the classes of
// flicker.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "base/srgb.h"
#include "compare/results/causes.h"
#include "compare/results/quantities.h"

namespace noonmark {

struct CauseColor {
  std::string_view name;  // the metric that measures the cause
  uint8_t r, g, b;        // sRGB
  std::string_view label;
};

// Of the causes (compare/results/causes.h), in the order of legends.
inline constexpr auto cause_colors = [] {
  std::array<CauseColor, cause_rows.size()> colors{};
  for (size_t i = 0; i < colors.size(); ++i) {
    const CauseRow& row = causes_as_in_legends[i];
    colors[i] = {row.name, row.color[0], row.color[1], row.color[2], row.label};
  }
  return colors;
}();

// The colour of a pixel in a class picture that has no cause.
inline constexpr std::array<CauseColor, 5> pixel_state_colors{{
    {"lit", 240, 240, 238, "Right, lit"},
    {"shadowed", 128, 130, 134, "Right, shadowed"},
    {"attached", 74, 76, 82, "Faces away from the light"},
    {"ambiguous", 255, 250, 200, "Ambiguous truth, left out"},
    {"background", background_srgb[0], background_srgb[1], background_srgb[2], "No surface"},
}};

// The classes of flicker (compare/ladder/flicker.h), by the metrics that measure them.
inline constexpr std::array<CauseColor, 5> flicker_colors{{
    {"flicker_cascade", 240, 228, 66, "Another cascade"},
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
