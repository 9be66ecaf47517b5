// The colours of the views: greys by the sRGB transfer function, and the palette of lines and scales.
#pragma once
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/pictures/image_file.h"
#include "base/srgb.h"
#include "compare/ladder/ladder.h"
#include "compare/report/cause_colors.h"

namespace noonmark {

inline Color named_color(std::string_view name) {
  const CauseColor* color = find_color(name);
  if (!color) throw std::logic_error("no colour for " + std::string(name));
  return {color->r, color->g, color->b};
}

// The colours that most pixels have. To look each up by its name would take longer than to paint the pixel.
struct PixelColors {
  Color background = named_color("background"), attached = named_color("attached"),
        ambiguous = named_color("ambiguous"), lit = named_color("lit"), shadowed = named_color("shadowed"),
        too_dark = named_color("acne"), too_light = named_color("peter_panning");
};

// Of each index into ladder.causes.
inline std::vector<Color> colors_of_causes(const Ladder& ladder) {
  std::vector<Color> colors;
  for (size_t cause = 0; cause < ladder.built_in(); ++cause)
    colors.push_back(cause == static_cast<size_t>(Cause::none) ? Color(0) : named_color(ladder.causes[cause].name));
  for (const RungCause& brought : ladder.brought) {
    const auto [r, g, b] = brought.color;
    colors.push_back({r, g, b});
  }
  return colors;
}

inline Color grey(double linear) { return Color(srgb_encoded(linear)); }

// A grey for a depth from 0, the nearest, to 1. Steps are even in sRGB, so they look even. NaN is black.
inline Color depth_grey(double depth) {
  return depth == depth ? Color(static_cast<uint8_t>(std::lround(255 * (0.97 - 0.8 * std::clamp(depth, 0.0, 1.0)))))
                        : Color(0);
}

inline constexpr Color paper{12, 12, 14};  // around an unfolded cube

// What faces away from the light, where a grey would be taken for a shadow: a dark blue, which no grey clay has.
inline constexpr Color facing_away{48, 62, 104};

// Lines of the light's frustum, in Okabe and Ito's hues like the causes' colours.
inline constexpr Color near_line{0, 158, 115}, far_line{213, 94, 0}, side_line{0, 114, 178}, cone_line{230, 159, 0},
    light_mark{204, 121, 167};

// A colour for a difference in [0,1], from dark to bright through violet, red and yellow. The order is visible from
// brightness alone. Differences above 1 get the brightest colour. NaN is green, which no difference has.
inline Color difference_color(double value) {
  if (!(value == value)) return {0, 255, 0};
  static constexpr glm::vec3 stops[] = {{4, 4, 12},    {62, 18, 102},  {150, 38, 110},
                                        {224, 80, 74}, {252, 168, 84}, {252, 250, 190}};
  constexpr int intervals = 5;
  const float at = static_cast<float>(std::clamp(value, 0.0, 1.0)) * intervals;
  const int stop = std::min(static_cast<int>(at), intervals - 1);
  return Color(glm::mix(stops[stop], stops[stop + 1], at - static_cast<float>(stop)) + 0.5f);
}

}  // namespace noonmark
