#include "scenes/foliage.h"

#include <cmath>
#include <numbers>

#include "scenes/shapes.h"

namespace noonmark {

AlphaMask frond_mask() {
  AlphaMask mask{48, 96, {}, MaskWrap::clamp, MaskWrap::clamp, MaskFilter::nearest, 1, 0.5};
  for (int j = 0; j < mask.height; ++j) {
    for (int i = 0; i < mask.width; ++i) {
      const double along = (j + 0.5) / mask.height, aside = std::abs((i + 0.5) / mask.width - 0.5) * 2;
      const double reach =
          0.95 * std::pow(std::sin(std::numbers::pi * (0.06 + 0.92 * along)), 0.8) * (1 - 0.45 * along);
      const double leaflet = 11 * (along - 0.16 * aside);  // leaflets point forward
      const bool leaf = aside < reach && leaflet - std::floor(leaflet) < 0.62 && along > 0.1;
      mask.alpha.push_back(leaf || aside < 0.05 ? 255 : 0);
    }
  }
  return mask;
}

// Five cards around a middle, each leaning outwards, each at another height.
std::vector<std::array<std::array<glm::vec3, 3>, 2>> frond_cards() {
  constexpr double width_m = 0.9, length_m = 1.8;
  std::vector<std::array<std::array<glm::vec3, 3>, 2>> cards;
  for (int k = 0; k < 5; ++k) {
    const double turn = 2 * std::numbers::pi * (k + 0.13) / 5, lean = (28 + 9 * k) * std::numbers::pi / 180;
    const glm::dvec3 out(std::cos(turn), 0, std::sin(turn)), across(-std::sin(turn), 0, std::cos(turn));
    const glm::dvec3 along = std::cos(lean) * out + std::sin(lean) * glm::dvec3(0, 1, 0);
    const glm::dvec3 foot = 0.12 * out + glm::dvec3(0, 0.05 + 0.04 * k, 0) - width_m / 2 * across;
    const auto at = [&](double u, double v) { return glm::vec3(foot + u * width_m * across + v * length_m * along); };
    auto& card = cards.emplace_back();
    for (size_t half = 0; half < 2; ++half)
      for (size_t corner = 0; corner < 3; ++corner)
        card[half][corner] = at(frond_coordinates[half][corner].x, frond_coordinates[half][corner].y);
  }
  return cards;
}

Scene foliage(const SceneSettings& settings) {
  Scene scene;
  add_quad(scene, "floor", {-4, 0, -4}, {0, 0, 8}, {8, 0, 0});
  const MaskCutter cutter(frond_mask());
  MaskCutter::Pieces pieces;
  for (const auto& card : frond_cards()) {
    const size_t first = scene.triangles.size();
    for (size_t half = 0; half < 2; ++half) {
      if (settings.masks)
        cutter.cut(card[half], frond_coordinates[half], pieces);
      else
        pieces = {{card[half].begin(), card[half].end()}, {{0, 1, 2}}};
      const auto base = static_cast<uint32_t>(scene.positions.size());
      scene.positions.insert(scene.positions.end(), pieces.positions.begin(), pieces.positions.end());
      for (const glm::uvec3& t : pieces.triangles) scene.triangles.push_back(base + t);
    }
    scene.parts.push_back(
        {"frond", static_cast<uint32_t>(first), static_cast<uint32_t>(scene.triangles.size() - first)});
  }
  scene.camera = {.eye_m = {2.4, 2.6, 3.6}, .target_m = {0, 0.55, 0}, .fov_y_deg = 45};
  scene.light = {.position_m = {-2.5, 5, 1.5}, .target_m = {0, 0, 0}};
  scene.map = MapVolume{.extent_m = 7, .near_m = 1, .far_m = 9};
  return scene;
}

}  // namespace noonmark
