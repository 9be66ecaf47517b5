// What a lookup outside the map finds, for the two places that must agree with OpenGL's sampler: the exact map's texels
// and the thresholds read off a map.
#pragma once
#include <algorithm>
#include <glm/glm.hpp>

#include "scenes/settings.h"

namespace noonmark {

inline constexpr float border_depth = 1.0f;  // lit

inline bool inside_map(glm::ivec2 texel, int resolution) {
  return texel.x >= 0 && texel.y >= 0 && texel.x < resolution && texel.y < resolution;
}

// The texel that a sampler with this wrap mode reads; {-1, -1} for the border.
inline glm::ivec2 wrapped(glm::ivec2 texel, int resolution, Wrap wrap) {
  if (inside_map(texel, resolution)) return texel;
  switch (wrap) {
    case Wrap::repeat: {
      const auto modulo = [&](int i) { return ((i % resolution) + resolution) % resolution; };
      return {modulo(texel.x), modulo(texel.y)};
    }
    case Wrap::clamp_to_edge:
      return glm::clamp(texel, glm::ivec2(0), glm::ivec2(resolution - 1));
    case Wrap::clamp_to_border:
      break;
  }
  return {-1, -1};
}

}  // namespace noonmark
