#include "measure/texel_footprint.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace noonmark {
namespace {

// The point of the plane through p with this normal that the ray meets; it can lie behind the ray's origin.
glm::dvec3 on_plane(const Ray& ray, glm::dvec3 p, glm::dvec3 normal) {
  return ray.origin + ray.direction * (glm::dot(p - ray.origin, normal) / glm::dot(ray.direction, normal));
}

// The smaller singular value of the matrix with these columns.
double least_stretch(glm::dvec2 a, glm::dvec2 b) {
  const double squares = glm::dot(a, a) + glm::dot(b, b), determinant = a.x * b.y - a.y * b.x;
  const double root = std::sqrt(std::max(0.0, squares * squares - 4 * determinant * determinant));
  // (squares - root) / 2 without cancellation.
  return std::abs(determinant) / std::sqrt((squares + root) / 2);
}

// The grid of a map. One of a single tile is the same for all receivers.
struct Grid {
  const LightFrame& frame;
  const KindOfLight& kind;
  std::optional<MapTile> only;
  explicit Grid(const LightFrame* of) : frame(*of), kind(of->light()) {
    if (of->tiles == 1) only = of->tile(0);
  }
  glm::dvec2 texels(const MapTile& tile, glm::dvec3 world) const {
    return tile.texels(kind.place(frame.to_light(world)));
  }
};

double pixel_width_m(const CameraFrame& camera, glm::dvec3 p, int height) {
  const bool perspective = camera.camera.projection == Projection::perspective;
  return 2 * camera.half_height / height * (perspective ? camera.in_axes(p).z : 1);
}

}  // namespace

TexelFootprint texel_footprint(const ReceiverImage& receivers, const CameraFrame& camera, const LightFrame& frame,
                               const Image<uint8_t>& facing) {
  const LightFrame* const only = &frame;
  return texel_footprint(receivers, camera, {&only, 1}, only_map, facing);
}

TexelFootprint texel_footprint(const ReceiverImage& receivers, const CameraFrame& camera,
                               std::span<const LightFrame* const> frames, const MapChoice& choice,
                               const Image<uint8_t>& facing) {
  const int width = receivers.width(), height = receivers.height();
  const auto none = static_cast<float>(std::numeric_limits<double>::quiet_NaN());
  TexelFootprint footprint{{width, height, none}, {width, height, none}};
  const std::vector<Grid> grids(frames.begin(), frames.end());
  const PixelRays rays(camera, width, height);
  tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const tbb::blocked_range<int>& rows) {
    for (int y = rows.begin(); y < rows.end(); ++y)
      for (int x = 0; x < width; ++x) {
        const size_t i = facing.index(x, y);
        if (!facing[i]) continue;
        const Grid& grid = grids[choice.map_of(i)];
        const glm::dvec3 p(receivers.position[i]), normal(receivers.normal[i]), light = grid.frame.to_light(p);
        std::optional<MapTile> there;
        const MapTile& tile = grid.only ? *grid.only : there.emplace(grid.frame.tile_at(light));
        const glm::dvec2 here = tile.texels(grid.kind.place(light));
        const glm::dvec2 right = grid.texels(tile, on_plane(rays.at(x + 1, y), p, normal)) - here,
                         down = grid.texels(tile, on_plane(rays.at(x, y + 1), p, normal)) - here;
        footprint.pixels[i] = static_cast<float>(1 / least_stretch(right, down));
        footprint.perspective[i] = static_cast<float>(tile.texel_m(light) / pixel_width_m(camera, p, height));
      }
  });
  return footprint;
}

std::map<std::string, double> footprint_metrics(const TexelFootprint& footprint) {
  std::vector<float> perspective;
  uint64_t undersampled = 0;
  for (size_t i = 0; i < footprint.pixels.size(); ++i) {
    if (std::isnan(footprint.perspective[i])) continue;
    perspective.push_back(footprint.perspective[i]);
    undersampled += !(footprint.pixels[i] <= 1);
  }
  const auto share_below = [&](double share) {
    if (perspective.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto at =
        perspective.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(perspective.size() - 1));
    std::nth_element(perspective.begin(), at, perspective.end());
    return static_cast<double>(*at);
  };
  const double count = static_cast<double>(perspective.size());
  return {{"undersampled",
           perspective.empty() ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(undersampled) / count},
          {"perspective_aliasing", share_below(0.5)},
          {"perspective_aliasing_p95", share_below(0.95)}};
}

}  // namespace noonmark
