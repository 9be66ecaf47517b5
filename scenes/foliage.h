// The built-in scene `foliage`: cards with a masked frond on them, as games draw plants.
#pragma once
#include <array>
#include <vector>

#include "scenes/alpha_mask.h"
#include "scenes/scene.h"
#include "scenes/scene_settings.h"

namespace noonmark {

// A frond: a stem with leaflets on both sides, 48 x 96 texels, sampled with `nearest`, so that it is cut exactly.
AlphaMask frond_mask();

// The cards before they are cut: the corners of two triangles, whose texture coordinates are frond_coordinates.
std::vector<std::array<std::array<glm::vec3, 3>, 2>> frond_cards();
inline constexpr std::array<std::array<glm::dvec2, 3>, 2> frond_coordinates = {
    {{{{0, 0}, {1, 0}, {1, 1}}}, {{{0, 0}, {1, 1}, {0, 1}}}}};

// settings.masks: whether the cards are cut along their mask, or whole.
Scene foliage(const SceneSettings& settings);

}  // namespace noonmark
