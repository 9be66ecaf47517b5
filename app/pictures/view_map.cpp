#include "app/pictures/view_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "app/pictures/view_colors.h"

namespace noonmark {
namespace {

constexpr int largest_side =
    1024;  // the longer side of the picture of one map, in pixels; of each of several half of it
constexpr int largest_cell = 512;
constexpr float outside_cross = 2;  // not a window depth

// The cell of a face in the cross, and the world directions of right and up in its picture.
struct CrossCell {
  int column, row;
  glm::dvec3 right, up;
};
constexpr int cross_columns = 4, cross_rows = 3;
const std::array<CrossCell, 6>& cross_cells() {
  static const std::array<CrossCell, 6> cells = {{{2, 1, {0, 0, -1}, {0, 1, 0}},
                                                  {0, 1, {0, 0, 1}, {0, 1, 0}},
                                                  {1, 0, {1, 0, 0}, {0, 0, -1}},
                                                  {1, 2, {1, 0, 0}, {0, 0, 1}},
                                                  {1, 1, {1, 0, 0}, {0, 1, 0}},
                                                  {3, 1, {-1, 0, 0}, {0, 1, 0}}}};
  return cells;
}

// The least of the texels in [first, last) of each pixel. Pixel k of n covers texels from k N / n on.
struct Span {
  int first, last;
};
Span covered(int pixel, int pixels, int texels) {
  const auto at = [&](int k) { return static_cast<int>(static_cast<long>(k) * texels / pixels); };
  return {at(pixel), std::max(at(pixel + 1), at(pixel) + 1)};
}

// The arguments of std::min have this order so that a NaN is kept, which is drawn black.
Image<float> shrunk(const MapRows& map, glm::ivec2 texels, int longest) {
  const double scale = std::min(1.0, longest / static_cast<double>(std::max(texels.x, texels.y)));
  const glm::ivec2 size = glm::max(glm::ivec2(glm::round(scale * glm::dvec2(texels))), glm::ivec2(1));
  Image<float> out(size.x, size.y, 1);
  constexpr int most_texels = 1 << 22;  // that are read at a time: 16 MiB
  const int at_a_time = std::max(1, static_cast<int>(most_texels / texels.x * scale));
  for (int first = 0; first < size.y; first += at_a_time) {
    const int end = std::min(size.y, first + at_a_time), first_row = covered(first, size.y, texels.y).first;
    const Image<float> rows = map(first_row, covered(end - 1, size.y, texels.y).last - first_row);
    for (int y = first; y < end; ++y)
      for (int x = 0; x < size.x; ++x) {
        const Span across = covered(x, size.x, texels.x), along = covered(y, size.y, texels.y);
        float nearest = rows.at(across.first, along.first - first_row);
        for (int j = along.first; j < along.last; ++j)
          for (int i = across.first; i < across.last; ++i) nearest = std::min(nearest, rows.at(i, j - first_row));
        out.at(x, size.y - 1 - y) = nearest;  // row 0 of the picture is the highest v
      }
  }
  return out;
}

// The whole map, small enough for a picture.
Image<float> map_depths(const StoredMap& map, int longest) {
  return map.frame.map_shape() == MapShape::cube
             ? cube_cross(map.rows, map.frame.resolution, largest_cell, outside_cross)
             : shrunk(map.rows, map.frame.map_size(), longest);
}

// Each map painted by paint(depth, frame), in a row.
template <class Paint>
Image<Color> in_a_row(std::span<const StoredMap> maps, const std::vector<Image<float>>& depths, const Paint& painted) {
  constexpr int gap = 8;
  int width = -gap, height = 0;
  for (const Image<float>& depth : depths) {
    width += depth.width + gap;
    height = std::max(height, depth.height);
  }
  Image<Color> picture(width, height, paper);
  int left = 0;
  for (size_t k = 0; k < maps.size(); ++k) {
    const Image<float>& depth = depths[k];
    for (int y = 0; y < depth.height; ++y)
      for (int x = 0; x < depth.width; ++x)
        if (depth.at(x, y) != outside_cross) picture.at(left + x, y) = painted(depth.at(x, y), maps[k].frame);
    left += depth.width + gap;
  }
  return picture;
}

std::vector<Image<float>> depths_of(std::span<const StoredMap> maps) {
  std::vector<Image<float>> depths;
  for (const StoredMap& map : maps)
    depths.push_back(map_depths(map, maps.size() == 1 ? largest_side : largest_side / 2));
  return depths;
}

}  // namespace

Image<float> cube_cross(const MapRows& map, int resolution, int cell, float outside) {
  cell = std::min(cell, resolution);
  Image<float> cross(cross_columns * cell, cross_rows * cell, outside);
  for (int face = 0; face < 6; ++face) {
    const CrossCell& to = cross_cells()[static_cast<size_t>(face)];
    const CubeFace& from = cube_face(face);
    const Image<float> texels = map(face * resolution, resolution);
    // Both have the same two axes of the world, so one of each pair of products is 0, the other 1 or -1.
    const glm::ivec2 x_step(glm::dot(to.right, from.right), glm::dot(to.right, from.up));
    const glm::ivec2 y_step(glm::dot(to.up, from.right), glm::dot(to.up, from.up));
    for (int y = 0; y < cell; ++y)
      for (int x = 0; x < cell; ++x) {
        const Span across = covered(x, cell, resolution), along = covered(y, cell, resolution);
        float nearest = std::numeric_limits<float>::infinity();
        for (int b = along.first; b < along.last; ++b)
          for (int a = across.first; a < across.last; ++a) {
            // Converts from the face's middle in half texels, and back.
            const glm::ivec2 twice = (2 * a + 1 - resolution) * x_step + (2 * b + 1 - resolution) * y_step;
            const glm::ivec2 texel = (twice + resolution - 1) / 2;
            nearest = std::min(nearest, texels.at(texel.x, texel.y));
          }
        cross.at(to.column * cell + x, (to.row + 1) * cell - 1 - y) = nearest;
      }
  }
  return cross;
}

Color stored_grey(double window_depth) {
  return window_depth == window_depth
             ? Color(static_cast<uint8_t>(std::lround(255 * std::clamp(window_depth, 0.0, 1.0))))
             : Color(0);
}

Image<Color> stored_picture(std::span<const StoredMap> maps) {
  return in_a_row(maps, depths_of(maps),
                  [](float depth, const LightFrame&) { return stored_grey(static_cast<double>(depth)); });
}

Image<Color> map_picture(std::span<const StoredMap> maps) {
  const std::vector<Image<float>> depths = depths_of(maps);
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  const auto metres = [](float d, const LightFrame& frame) {
    return frame.tile(0).depth_of_window(static_cast<double>(d));
  };
  for (size_t k = 0; k < maps.size(); ++k)
    for (const float d : depths[k].pixels) {
      if (!(d < 1)) continue;
      nearest = std::min(nearest, metres(d, maps[k].frame));
      farthest = std::max(farthest, metres(d, maps[k].frame));
    }
  const double span = farthest > nearest ? farthest - nearest : 1;
  return in_a_row(maps, depths, [&](float depth, const LightFrame& frame) {
    return depth >= 1 ? named_color("background") : depth_grey((metres(depth, frame) - nearest) / span);
  });
}

}  // namespace noonmark
