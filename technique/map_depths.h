// The window depths of a map at the texels of a set: of the map that OpenGL drew, of the exact map, of the tie map. They
// share the set of the texels that the lookup's taps read, and so the number of a texel.
//
//   MapDepths exact(texels, 1);            // texels: a std::shared_ptr<const TexelSet>
//   exact.depth[texels->index({12, 7})] = 0.5f;
//   exact.at({12, 7});                     // 0.5
//   exact.at({0, 0});                      // 1, if {0, 0} is not in the set
#pragma once
#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "base/image.h"
#include "technique/texel_set.h"

namespace noonmark {

struct MapDepths {
  // The depth of texels of which nothing is known, so that nobody computes with it unnoticed.
  static constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

  std::shared_ptr<const TexelSet> texels;
  std::vector<float> depth;  // by TexelSet::index
  float elsewhere = unknown;

  MapDepths() = default;
  // fill: at the texels of the set, until it is overwritten.
  MapDepths(std::shared_ptr<const TexelSet> set, float others, float fill = 0)
      : texels(std::move(set)), depth(texels->count(), fill), elsewhere(others) {}
  // Of all texels of an image.
  explicit MapDepths(const Image<float>& map) {
    const auto all = std::make_shared<TexelSet>(glm::ivec2(map.width, map.height));
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x) all->add({x, y});
    all->close();
    *this = MapDepths(all, unknown);
    for (int y = 0; y < map.height; ++y)
      texels->each_in_row(y, [&](int x, size_t index) { depth[index] = map.at(x, y); });
  }

  glm::ivec2 size() const { return texels->size(); }
  float operator[](size_t index) const { return depth[index]; }
  float at(glm::ivec2 texel) const { return texels->has(texel) ? depth[texels->index(texel)] : elsewhere; }

  // Writes a row of the image; it has size().x places.
  void copy_row(int y, float* row) const {
    std::fill_n(row, size().x, elsewhere);
    texels->each_in_row(y, [&](int x, size_t index) { row[x] = depth[index]; });
  }
};

}  // namespace noonmark
