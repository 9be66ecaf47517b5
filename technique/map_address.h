// The texel that a lookup outside the map reads. Two parts of the program use it and must agree with OpenGL's sampler:
// the texels of the exact map, and the thresholds that are read off a map.
#pragma once
#include <algorithm>
#include <glm/glm.hpp>

#include "technique/settings.h"

namespace noonmark {

inline constexpr float border_depth = 1.0f;  // lit

// size: the size of the map's image, LightFrame::map_size(). A cube's texels are always inside.
inline bool inside_map(glm::ivec2 texel, glm::ivec2 size) {
  return texel.x >= 0 && texel.y >= 0 && texel.x < size.x && texel.y < size.y;
}

// Whether all texels between these two lie beside the map, on one side of it.
inline bool beside_map(glm::ivec2 low, glm::ivec2 high, glm::ivec2 size) {
  return high.x < 0 || high.y < 0 || low.x >= size.x || low.y >= size.y;
}

// The texel that a sampler with this wrap mode reads; {-1, -1} for the border.
inline glm::ivec2 wrapped(glm::ivec2 texel, glm::ivec2 size, Wrap wrap) {
  if (inside_map(texel, size)) return texel;
  switch (wrap) {
    case Wrap::repeat: {
      const auto modulo = [](int i, int n) { return ((i % n) + n) % n; };
      return {modulo(texel.x, size.x), modulo(texel.y, size.y)};
    }
    case Wrap::clamp_to_edge:
      return glm::clamp(texel, glm::ivec2(0), size - 1);
    case Wrap::clamp_to_border:
      break;
  }
  return {-1, -1};
}

}  // namespace noonmark
