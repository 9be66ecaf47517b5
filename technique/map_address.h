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

// The texel that a sampler with this wrap mode reads; {-1, -1} for the border. block: of TapPattern; the edge is then the
// last whole block, and a texel keeps its place in its block.
inline glm::ivec2 wrapped(glm::ivec2 texel, glm::ivec2 size, Wrap wrap, int block = 1) {
  if (inside_map(texel, size)) return texel;
  switch (wrap) {
    case Wrap::repeat: {
      const auto modulo = [](int i, int n) { return ((i % n) + n) % n; };
      return {modulo(texel.x, size.x), modulo(texel.y, size.y)};
    }
    case Wrap::clamp_to_edge: {
      const auto of_block = [&](int i) { return i >= 0 ? i / block : -((block - 1 - i) / block); };
      const glm::ivec2 at(of_block(texel.x), of_block(texel.y));
      return texel + block * (glm::clamp(at, glm::ivec2(0), size / block - 1) - at);
    }
    case Wrap::clamp_to_border:
      break;
  }
  return {-1, -1};
}

// The texels behind one texel of a blurred map: `size` texels of the mip level along each side around `middle`,
// each of which holds block x block texels of the map. The blur reads outside the map by the wrap. Calls
// visit(u, v, texel) for each, with the place in the kernel; for the border, which is one texel of the mip level, once
// with {-1, -1}. map: the size of the map itself.
template <class Visit>
void each_texel_of_blur(glm::ivec2 middle, int size, int block, glm::ivec2 map, Wrap wrap, const Visit& visit) {
  for (int v = 0; v < size; ++v)
    for (int u = 0; u < size; ++u) {
      const glm::ivec2 texel = wrapped(middle + glm::ivec2(u, v) - size / 2, map / block, wrap);
      if (texel.x < 0) {
        visit(u, v, texel);
        continue;
      }
      for (int y = 0; y < block; ++y)
        for (int x = 0; x < block; ++x) visit(u, v, block * texel + glm::ivec2(x, y));
    }
}

}  // namespace noonmark
