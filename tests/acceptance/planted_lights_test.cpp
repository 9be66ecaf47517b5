// Planted defects of what spot and point lights add: the perspective map, the cube map, and the lookups in them.
#include <algorithm>
#include <utility>

#include "tests/acceptance/planted_defect.h"

namespace noonmark::planted {
namespace {

// 512 texels over 64 degrees, 5 to 20 m from the light: texels of up to 5 cm, and on a slanted floor more.
Settings spot_room(std::initializer_list<acceptance::Assignment> more = {}) {
  return with(more, with({{"map.resolution", "512"}, {"bias.unit", "m"}, {"bias.constant", "0.1"}},
                         small("spot-room", 320, 180)));
}

// 512 texels on each face, 5 to 9 m from the light: texels of 2 cm in the middle of a wall.
Settings point_room(std::initializer_list<acceptance::Assignment> more = {}) {
  return with(more, with({{"map.resolution", "512"}, {"bias.unit", "m"}, {"bias.constant", "0.1"}},
                         small("point-room", 320, 180)));
}

// OpenGL's order of faces is +X -X +Y -Y +Z -Z, one above the other in the image.
Image<float> faces_swapped(const Image<float>& map, int face, int other) {
  Image<float> out = map;
  const int side = map.width;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) std::swap(out.at(x, face * side + y), out.at(x, other * side + y));
  return out;
}

const char* const point = "shaders/light/point.glsl";
const char* const cube = "shaders/map/cube.glsl";
const char* const turned = "shaders/map/cube_turned.glsl";

std::vector<Planted> defects() {
  std::vector<Planted> all;

  // --- A spot light. ------------------------------------------------------------------------------------------------

  // A small version of two mistakes with angles (no glm::radians, or half the angle for the whole one): the map covers
  // 10 % more than the lookup assumes.
  all.push_back({"SpotMapWithTheWrongAngle",
                 spot_room(),
                 {.drawn_map = [](LightFrame& frame, MapSettings&) { frame.tan_half_fov *= 1.1; }},
                 {{"precision", 1e-3, 0.05}, {"map_error_quanta", 2, 1000}},
                 {"contract", "rounding_excess"}});
  all.push_back({"SpotLookupWithTheWrongAngle",
                 spot_room(),
                 {.shaders = patched(projected, "ndc * 0.5 + 0.5", "ndc * vec3(0.45, 0.45, 0.5) + 0.5")},
                 {{"address_error_texels", 1e-3, 20}, {"rounding_excess", 1, 1000}},
                 {"contract", "reference_error_m"}});
  // The reference is the distance along the axis divided by far, but the map holds the depth of the perspective matrix.
  all.push_back({"SpotDepthReadAsLinear",
                 spot_room(),
                 {.shaders = patched(projected, "is_finite(window), window.z,",
                                     "is_finite(window), clip.w / light_far_m[map_layer],")},
                 {{"reference_error_m", 1e-3, 1}, {"rounding_excess", 1, 1000}},
                 {"contract", "address_error_texels"}});
  // The perspective division is left out. This is right only in a directional light's map, where w is 1.
  all.push_back(
      {"SpotWithoutTheDivision",
       spot_room(),
       {.shaders = patched(projected, "clip.xyz / clip.w", "clip.xyz")},
       {{"address_error_texels", 1e-3, 100}, {"reference_error_m", 1e-3, 0.5}, {"rounding_excess", 1, 1000}}});
  // N.L is computed for a directional light instead of a spot light.
  all.push_back(
      {"SpotDirectionOfTheAxis",
       spot_room({{"bias.constant", "0"}, {"bias.slope", "0.3"}, {"bias.slope_floor", "0.02"}}),
       {.shaders = patched("shaders/light/spot.glsl", "normalize(light_position[map_layer] - place_m)", "-light_axis")},
       {{"rounding_excess", 1, 1000}},
       {"contract", "address_error_texels", "reference_error_m"}});

  // --- A point light. -----------------------------------------------------------------------------------------------

  // A face is upside down: first only in the lookup, then in the code that it shares with the probe. In OpenGL, t of +X
  // and of -X runs along -Y.
  all.push_back({"CubeFaceFlippedInTheLookup",
                 point_room(),
                 {.shaders = patched(cube, "textureLod(shadow_map, direction, 0.0)",
                                     "textureLod(shadow_map, abs(direction.x) > max(abs(direction.y), "
                                     "abs(direction.z)) ? direction * vec3(1, -1, 1) : direction, 0.0)")},
                 {{"contract", 0, 0.02}, {"tap_residual", 1e-6, 1}},
                 {"rounding_excess"}});
  all.push_back({"CubeFaceFlippedInTheAddress",
                 point_room(),
                 {.shaders = patched(cube, "return direction;",
                                     "return abs(direction.x) > max(abs(direction.y), abs(direction.z)) ? direction * "
                                     "vec3(1, -1, 1) : direction;")},
                 {{"address_error_texels", 0.1, 100}, {"rounding_excess", 1, 1000}},
                 {"contract", "reference_error_m"}});
  // The distance is divided by near, which is 1 m. So every stored depth is 1, and the whole room is lit.
  all.push_back({"DistanceDividedByNearInTheMap",
                 point_room({{"map.near_m", "1"}}),
                 {.shaders = patched("shaders/distance.frag", "/ light_far_m", "/ min(light_far_m, 1.0)")},
                 {{"precision", 1e-3, 0.05}, {"map_error_quanta", 2, 1000}},
                 {"contract", "rounding_excess"}});
  // The same mistake in the lookup puts all receivers beyond far.
  all.push_back({"DistanceDividedByNearInTheLookup",
                 point_room({{"map.near_m", "1"}}),
                 {.shaders = patched(point, "length(from_light) / light_far_m[map_layer]", "length(from_light) / 1.0")},
                 {{"reference_error_m", 1e-3, 10}, {"rounding_excess", 1, 1000}},
                 {"contract", "address_error_texels"}});
  // The map stores the depth along the axis of the face, as a perspective matrix gives it, instead of the distance.
  all.push_back({"DepthAlongTheAxisInTheMap",
                 point_room(),
                 {.shaders = patched("shaders/distance.frag", "gl_FragDepth = length(place_m - light_position)",
                                     "vec3 way = abs(place_m - light_position);\n  gl_FragDepth = max(way.x, "
                                     "max(way.y, way.z))")},
                 {{"precision", 1e-3, 0.5}, {"map_error_quanta", 2, 1000}},
                 {"contract", "rounding_excess"}});
  all.push_back({"LayersSwapped",
                 point_room(),
                 {.shaders = patched("shaders/cube_layers.geom", "gl_Layer = face;", "gl_Layer = face ^ 1;")},
                 {{"precision", 1e-3, 0.05}, {"map_error_quanta", 2, 1000}},
                 {"contract", "rounding_excess"}});
  // Two of the six passes are swapped: each draws into the face of the other.
  all.push_back({"SixPassesWithTwoFacesSwapped",
                 point_room({{"map.cube_pass", "six_passes"}}),
                 {.edited_map = [](const Image<float>& map) { return faces_swapped(map, 0, 5); }},
                 {{"precision", 1e-3, 0.01}, {"map_error_quanta", 2, 1000}},
                 {"contract", "rounding_excess"}});
  // This is right only for a light in the origin. Here the light is two centimetres beside it.
  all.push_back(
      {"DirectionFromTheOrigin",
       point_room(),
       {.shaders = patched(point, "from_light = place_m - light_position[map_layer]", "from_light = place_m")},
       {{"address_error_texels", 0.1, 0.4}, {"reference_error_m", 1e-3, 0.01}, {"rounding_excess", 1, 1000}},
       {"contract"}});
  // The map is drawn with an earlier position of the light.
  all.push_back({"MapOfTheLightElsewhere",
                 point_room(),
                 {.drawn_map = [](LightFrame& frame, MapSettings&) { frame.origin_m += glm::dvec3(0.25, 0, 0); }},
                 {{"precision", 1e-3, 0.1}, {"map_error_quanta", 2, 1000}},
                 {"contract", "rounding_excess"}});
  // The lookup turns the direction back instead of forth; then the map is drawn without the turn.
  all.push_back({"CubeTurnedTheOtherWay",
                 point_room({{"map.turn_deg", "20,-35,50"}}),
                 {.shaders = patched(turned, "return vec3(x, y, z);", "return cube_axes * from_light;")},
                 {{"address_error_texels", 1e-3, 100}, {"rounding_excess", 1, 1000}},
                 {"contract"}});
  all.push_back({"CubeDrawnWithoutTheTurn",
                 point_room({{"map.turn_deg", "20,-35,50"}}),
                 {.drawn_map = [](LightFrame& frame, MapSettings&) { frame.cube_axes = glm::dmat3(1); }},
                 {{"precision", 1e-3, 0.1}, {"map_error_quanta", 2, 1000}},
                 {"contract", "rounding_excess"}});
  // The lookup reads only 27 of 64 taps.
  all.push_back({"GridOf27TapsReadAs64",
                 point_room({{"filter.kind", "cube_grid"}, {"bias.constant", "0.3"}}),
                 {.shaders = patched("shaders/filter/mean.glsl", "tap < first + taps", "tap < first + 27")},
                 {{"contract", 0, 0.9}, {"tap_residual", 1e-6, 0.57}, {"error", 0.05, 0.4}},
                 {"rounding_excess"}});
  all.push_back(
      {"DiskThatIgnoresTheViewDistance",
       point_room({{"filter.kind", "cube_disk"}, {"filter.disk", "view_distance"}, {"bias.constant", "0.3"}}),
       {.shaders = patched(receiver, "(1.0 + distance(eye_m, position.xyz) / light_far_m[map_layer])", "1.0")},
       {{"rounding_excess", 1, 1000}},
       {"contract", "reference_error_m"}});
  // The disk has the fixed radius of the settings at every pixel.
  all.push_back({"DiskOfFixedRadiusInTheLookup",
                 point_room({{"filter.kind", "cube_disk"}, {"filter.disk", "view_distance"}, {"bias.constant", "0.3"}}),
                 {.asked = [](Settings& s) { s.filter["disk"] = 0; }},
                 {{"contract", 0, 0.01}, {"tap_residual", 1e-6, 0.04}},
                 {"rounding_excess"}});
  return all;
}

class PlantedLightDefect : public testing::TestWithParam<Planted> {};
TEST_P(PlantedLightDefect, MovesItsMetric) { expect_moves(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Each, PlantedLightDefect, testing::ValuesIn(defects()), name_of);

}  // namespace
}  // namespace noonmark::planted
