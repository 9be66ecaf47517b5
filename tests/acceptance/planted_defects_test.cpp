// Wrong shaders and wrong maps, planted on purpose: each must change the metric that is made for it.
// - A lookup that does not do what its settings say breaks the contract.
// - An address, a reference depth or an N.L that differs from the light frame's gives a rounding_excess above 1.
// - A map that does not hold the casters of the scene causes a precision error, because R4's exact map is right and
//   R5's map is wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/sweep/judging.h"
#include "app/sweep/sweep.h"
#include "base/error.h"
#include "measure/workbench.h"
#include "tests/acceptance/planted_defect.h"
#include "tests/support/kind_thrown.h"

namespace noonmark::planted {
namespace {

Settings offset_cubes() { return cubes({{"bias.constant", "0"}, {"bias.normal_offset", "0.7"}}); }
// The map covers only two fifths of the usual extent, so that many receivers are outside.
Settings narrow() { return cubes({{"map.extent_scale", "0.4"}}); }

Image<float> flipped(const Image<float>& map) {
  Image<float> out(map.width, map.height);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) out.at(x, y) = map.at(x, map.height - 1 - y);
  return out;
}

Image<float> transposed(const Image<float>& map) {
  Image<float> out(map.height, map.width);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) out.at(y, x) = map.at(x, y);
  return out;
}

Image<float> doubled(const Image<float>& map) {
  Image<float> out(2 * map.width, 2 * map.height);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) out.at(x, y) = map.at(x / 2, y / 2);
  return out;
}

// What the map's pass leaves with a viewport of half the map's width and height.
Image<float> in_a_corner(const Image<float>& map) {
  Image<float> out(map.width, map.height, 1);
  for (int y = 0; y < map.height / 2; ++y)
    for (int x = 0; x < map.width / 2; ++x) out.at(x, y) = map.at(2 * x, 2 * y);
  return out;
}

void drop_part(Scene& scene, const std::string& name) {
  const auto part = std::find_if(scene.parts.begin(), scene.parts.end(), [&](const Part& p) { return p.name == name; });
  if (part == scene.parts.end()) throw std::logic_error("the scene has no part " + name);
  const auto first = scene.triangles.begin() + part->first_triangle;
  scene.triangles.erase(first, first + part->triangle_count);
}

const char* const box = "shaders/filter/box.glsl";

std::vector<Planted> defects() {
  std::vector<Planted> all;

  // --- The lookup. R4 runs the same shader, so precision does not change; the contract does. -----------------------

  // A bias of the wrong sign puts every lit receiver behind the depth of its texel, by more than the slope can balance.
  all.push_back({"BiasWithTheWrongSign",
                 cubes(),
                 {.shaders = patched("shaders/compare.glsl", "reference - bias", "reference + bias")},
                 {{"contract", 0, 0.5}, {"tap_residual", 1e-6, 1}, {"error", 0.01, 0.5}}});
  // The same bias, but the technique is defined with it. So the contract is kept, and the error is acne.
  all.push_back({"BiasWithTheWrongSignAsClaimed",
                 cubes(),
                 {.shaders = patched("shaders/compare.glsl", "reference - bias", "reference + bias"),
                  .claimed_bias = [](BiasSettings& bias) { bias["constant"] = -bias["constant"]; }},
                 {{"acne", 0.01, 0.5}, {"error", 0.01, 0.5}},
                 {"contract", "tap_residual", "rounding_excess"}});
  // Ties are too rare to be visible in a picture of this scene. On the tie map every second texel has one.
  const auto or_equal = patched("shaders/compare.glsl", "biased > stored_depth", "biased >= stored_depth");
  all.push_back(
      {"GreaterOrEqualForGreater", cubes(), {.shaders = or_equal}, {{"contract", 0, 0.05}}, {"tap_residual"}});
  // On a plane that is perpendicular to the light, every comparison at bias 0 is a tie. The whole plane becomes dark,
  // except for receivers in texels whose centre lies beyond the rim of the plane.
  all.push_back(
      {"GreaterOrEqualOnAPlaneSquareToTheLight",
       with({{"scene.theta_deg", "0"}, {"bias.constant", "0"}, {"map.format", "32f"}}, small("plane", 160, 90)),
       {.shaders = or_equal},
       {{"contract", 0, 0.99}, {"error", 0, 0.99}, {"tap_residual", 0, 1}}});
  // One of nine taps is dropped. So the lit receivers, four fifths of the picture, become 8/9 lit.
  all.push_back({"WeightsThatSumToEightNinths",
                 cubes_3x3(),
                 {.shaders = patched(box, "if (tap_lit(", "if (!(x == 1 && y == 1) && tap_lit(")},
                 {{"contract", 0, 0.7}, {"tap_residual", 1e-6, 0.111}, {"error", 0.011, 0.8 / 9}}});
  // The loop ends one tap early in x: six of nine taps, moved by half a texel. Lit receivers become 2/3 lit.
  all.push_back({"EvenKernel",
                 cubes_3x3(),
                 {.shaders = patched(box, "x <= radius", "x < radius")},
                 {{"contract", 0, 0.7}, {"tap_residual", 1e-6, 0.333}, {"error", 0.011, 0.8 / 3}}});
  // Only the middle tap is compared without its bias: half of the middle taps have acne.
  all.push_back({"ReferenceNotBiasedInOneBranch",
                 cubes_3x3(),
                 {.shaders = patched(box, "tap_depth(receiver, offset, at), bias,",
                                     "tap_depth(receiver, offset, at), x == 0 && y == 0 ? 0.0 : bias,")},
                 {{"contract", 0, 0.3}, {"tap_residual", 1e-6, 0.111}}});
  // 0.005 m along the axis is 0.0008 of depth. If 0.005 is used as a depth, the bias is six times too large.
  all.push_back({"BiasInMetresTakenForDepth",
                 cubes({{"bias.constant", "0.005"}, {"bias.unit", "m"}}),
                 {.asked = [](Settings& s) { s.bias.unit = BiasUnit::depth; }},
                 {{"contract", 0, 0.1}, {"tap_residual", 1e-6, 1}}});
  all.push_back({"BiasInDepthTakenForMetres",
                 cubes(),
                 {.asked = [](Settings& s) { s.bias.unit = BiasUnit::m; }},
                 {{"contract", 0, 0.1}, {"tap_residual", 1e-6, 1}}});
  all.push_back({"SlopeWithoutItsFloor",
                 cubes({{"bias.constant", "0"}, {"bias.slope", "0.001"}, {"bias.slope_floor", "0.0025"}}),
                 {.asked = [](Settings& s) { s.bias["slope_floor"] = 0; }},
                 {{"contract", 0, 0.1}, {"tap_residual", 1e-6, 1}}});
  // The wrap mode of all maps is wrong; the truth assumes the lit border.
  all.push_back({"WrapRepeatInPlaceOfBorder",
                 narrow(),
                 {.asked = [](Settings& s) { s.map.wrap = Wrap::repeat; }},
                 {{"contract", 0, 0.02}, {"tap_residual", 1e-6, 1}, {"error", 0.005, 0.02}},
                 {"rounding_excess"}});
  all.push_back({"BorderOfDepthZero",
                 narrow(),
                 {.shaders = patched("shaders/map/flat.glsl", "  return textureLod",
                                     "  if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, "
                                     "textureSize(shadow_map, 0).xy))) return 0.0;\n  return textureLod")},
                 {{"contract", 0, 0.15}, {"tap_residual", 1e-6, 1}, {"error", 0.005, 0.15}}});
  // The address is the far corner of the texel, so that the lookup may read the neighbour. The read-back of R5's map
  // has the same fault. R4's map is not read back, because its values are known.
  all.push_back({"HalfTexelOffsetInTheSampler",
                 cubes(),
                 {.shaders = patched("shaders/map/flat.glsl", "vec2(texel) + 0.5", "vec2(texel) + 1.25")},
                 {{"contract", 0, 0.01}, {"tap_residual", 1e-6, 1}}});
  all.push_back({"BeyondFarForgotten",
                 cubes(),
                 {.shaders = patched("shaders/lookup.frag", "lit_beyond_far != 0 &&", "lit_beyond_far == 2 &&")},
                 {{"contract", 0, 0.03}, {"tap_residual", 1e-6, 1}}});

  // The lookup reads the position of the neighbouring pixel; the probe reads the right one.
  all.push_back(
      {"LookupAtTheNextPixel",
       cubes(),
       {.shaders = patched("shaders/lookup.frag", "ivec2(gl_FragCoord.xy)", "ivec2(gl_FragCoord.xy) + ivec2(1, 0)")},
       {{"contract", 0, 0.05}, {"tap_residual", 1e-6, 1}}});

  // --- Code that probe and lookup share. The truth uses the wrong texels too, and the contract is kept. -------------

  const auto half_texel = patched(projected, "window.xy * map_size", "window.xy * map_size - 0.5");
  // The texel is off by half its width in both axes, so true edges are up to sqrt(2) texels away, not sqrt(1/2).
  all.push_back({"HalfTexelOffset",
                 cubes(),
                 {.shaders = half_texel},
                 {{"address_error_texels", 1e-4, 0.49},
                  {"rounding_excess", 1, 1000},
                  {"edge_displacement_texels", std::sqrt(0.5) + 0.01, 1},
                  {"acne", 0.01, 0.05}},
                 {"contract", "tap_residual"}});
  // It also leaves receivers behind the light, which the lookup treats as background.
  all.push_back({"TransposedMatrix",
                 cubes(),
                 {.shaders = patched(projected, "clip_from_world[map_layer] * vec4",
                                     "transpose(clip_from_world[map_layer]) * vec4")},
                 {{"address_error_texels", 1e-4, 50}, {"reference_error_m", 1e-5, 0.5}, {"rounding_excess", 1, 1000}}});
  all.push_back({"FlippedYInTheAddress",
                 cubes(),
                 {.shaders = patched(projected, "precise vec2 map_texels = window.xy",
                                     "precise vec2 map_texels = vec2(window.x, 1.0 - window.y)")},
                 {{"address_error_texels", 1e-4, 100}, {"rounding_excess", 1, 1000}},
                 {"contract", "reference_error_m"}});
  // Both the lookup and the probe read the neighbouring receiver.
  all.push_back({"ReceiverOfTheNextPixel",
                 cubes(),
                 {.shaders = patched(receiver, "texelFetch(position_image, pixel,",
                                     "texelFetch(position_image, pixel + ivec2(1, 0),")},
                 {{"address_error_texels", 1e-4, 5}, {"rounding_excess", 1, 1000}}});
  // 1 - N.L becomes 1 + N.L. On the floor this is 15 times the bias, 0.6 m along the light, which lights a gap of 0.3 m
  // at the foot of the standing cubes.
  all.push_back({"LightNegatedInNDotL",
                 cubes({{"bias.constant", "0"}, {"bias.slope", "0.05"}, {"bias.slope_floor", "0"}}),
                 {.shaders = patched(receiver, "dot(normal, at.to_light)", "-dot(normal, to_light(position.xyz))")},
                 {{"rounding_excess", 1, 1000}, {"peter_panning", 1e-4, 1e-3}},
                 {"contract", "address_error_texels", "reference_error_m"}});
  // Receivers beyond the far plane are treated as if they were on it.
  all.push_back({"ReferenceClamped",
                 cubes(),
                 {.shaders = patched(receiver, "return Receiver(true, view.depth,",
                                     "return Receiver(true, min(view.depth, 1.0),")},
                 {{"reference_error_m", 1e-5, 0.05}, {"rounding_excess", 1, 1000}},
                 {"contract", "address_error_texels"}});
  // The reference is a depth in clip space, [-1, 1]; the map holds [0, 1].
  all.push_back({"ReferenceInClipSpace",
                 cubes(),
                 {.shaders = patched(projected, "is_finite(window), window.z,", "is_finite(window), ndc.z,")},
                 {{"reference_error_m", 1e-5, 1}, {"rounding_excess", 1, 1000}, {"peter_panning", 1e-4, 0.01}},
                 {"contract", "address_error_texels"}});

  // --- The normal offset. It moves address and depth. The contract is blind to code that the probe shares. ---------

  const char* const offset = "technique/bias/normal_offset.glsl";
  all.push_back({"NormalOffsetInwards",
                 offset_cubes(),
                 {.shaders = patched(offset, "return at.normal", "return -at.normal")},
                 {{"rounding_excess", 1, 1000}, {"address_error_texels", 1e-4, 0.3}, {"acne", 1e-3, 0.5}},
                 {"contract"}});
  // The offset is half as large as the setting says.
  all.push_back({"NormalOffsetHalved",
                 offset_cubes(),
                 {.shaders = patched(offset, "return at.normal", "return 0.5 * at.normal")},
                 {{"rounding_excess", 1, 1000}},
                 {"contract"}});
  // The depth is that of the moved place, but the texel is that of the unmoved place ("offset the depth only").
  all.push_back({"NormalOffsetOfTheDepthAlone",
                 offset_cubes(),
                 {.shaders = patched(receiver, "view.depth, view.map_texels,",
                                     "view.depth, seen_by_light(position.xyz).map_texels,")},
                 {{"rounding_excess", 1, 1000}, {"address_error_texels", 1e-4, 0.3}},
                 {"contract", "reference_error_m"}});
  // The truth includes an offset that the lookup does not have.
  all.push_back({"NormalOffsetForgotten",
                 offset_cubes(),
                 {.asked = [](Settings& s) { s.bias["normal_offset"] = 0; }},
                 {{"contract", 0, 0.1}, {"tap_residual", 1e-6, 1}}});

  // --- The map. R4 is right and R5 is wrong. So the whole error is precision. ---------------------------------

  // At half the resolution the floor needs twice the bias that it has.
  all.push_back(
      {"MapOneSizeSmallerThanClaimed",
       cubes(),
       {.drawn_map = [](LightFrame& frame, MapSettings& map) { frame.resolution = frame.rows = map.resolution /= 2; },
        .edited_map = doubled},
       {{"precision", 1e-3, 0.05}, {"map_error_quanta", 2, 1000}},
       {"contract", "rounding_excess"}});
  // The receivers in the shadow of the missing caster are lit, and no others change.
  all.push_back({"MissingCaster",
                 cubes(),
                 {.drawn_scene = [](Scene& scene) { drop_part(scene, "floating cube"); }},
                 {{"precision", 1e-3, 0.01}, {"error", 0.01, 0.02}},
                 {"contract", "rounding_excess", "acne", "peter_panning", "aliasing"}});
  // One quantum of 16 bits is 256 quanta of 24 bits. Rounding to it is off by a quarter of it in the mean: 64 quanta,
  // if the few hundred depths of this picture are spread evenly.
  all.push_back({"Depth16For24",
                 cubes({{"bias.constant", "0"}}),
                 {.drawn_map = [](LightFrame&, MapSettings& map) { map.format = DepthFormat::d16; }},
                 {{"map_error_quanta", 2, 40}, {"map_bits", 24, 16, true}, {"precision", 1e-4, 5e-4}},
                 {"contract"}});
  // Floats are finer than 24 bits only near the light, so the scene lies in the first 1/50 of the map's depth. The
  // verdicts do not change, because the rasteriser computes with no more than 24 bits. But the stored values change.
  const Settings deep =
      cubes({{"map.format", "32f"}, {"map.near_m", "1"}, {"map.far_m", "300"}, {"bias.constant", "0"}});
  all.push_back({"Depth24For32F",
                 deep,
                 {.drawn_map = [](LightFrame&, MapSettings& map) { map.format = DepthFormat::d24; }},
                 {{"map_bits", 32, 24, true}},
                 {"contract"}});
  all.push_back({"Depth32FFor24",
                 cubes({{"map.near_m", "1"}, {"map.far_m", "300"}, {"bias.constant", "0"}}),
                 {.drawn_map = [](LightFrame&, MapSettings& map) { map.format = DepthFormat::d32f; }},
                 {{"map_bits", 24, 32}},
                 {"contract"}});
  // At bias 0 half of every lit slope is dark. With a map of the back faces, all of it is lit.
  all.push_back({"FrontFacesCulled",
                 cubes({{"bias.constant", "0"}}),
                 {.drawn_map = [](LightFrame&, MapSettings& map) { map.cull = CulledFaces::front; }},
                 {{"precision", 1e-3, 0.25}, {"map_error_quanta", 2, 10000}},
                 {"contract"}});
  // Only the wrap mode of the rendered map is wrong.
  all.push_back({"WrapRepeatOfTheRenderedMap",
                 narrow(),
                 {.drawn_map = [](LightFrame&, MapSettings& map) { map.wrap = Wrap::repeat; }},
                 {{"precision", 1e-3, 0.02}, {"contract", 0, 0.02}},
                 {"tap_residual"}});
  // The map's pass has the window's viewport, which is half as wide and high as the map.
  all.push_back({"ViewportForgotten",
                 cubes(),
                 {.edited_map = in_a_corner},
                 {{"precision", 1e-3, 0.02}, {"map_excess", 0.1, 2}},
                 {"contract"}});
  all.push_back({"FlippedYInTheMap",
                 cubes(),
                 {.edited_map = flipped},
                 {{"precision", 1e-3, 0.1}, {"map_error_quanta", 2, 10000}, {"map_excess", 0.1, 1.01}}});
  all.push_back({"TransposedMap",
                 cubes(),
                 {.edited_map = transposed},
                 {{"precision", 1e-3, 0.1}, {"map_error_quanta", 2, 10000}, {"map_excess", 0.1, 1.01}}});
  all.push_back(
      {"TransposedMatrixOfTheMap",
       cubes(),
       {.shaders = patched("shaders/scene.vert", "clip_from_world * vec4", "transpose(clip_from_world) * vec4")},
       {{"precision", 1e-3, 0.03}, {"map_error_quanta", 2, 10000}}});
  all.push_back({"NearAndFarSwapped",
                 cubes(),
                 {.drawn_map = [](LightFrame& frame, MapSettings&) { std::swap(frame.near_m, frame.far_m); }},
                 {{"precision", 1e-3, 0.1}, {"map_error_quanta", 2, 10000}, {"map_excess", 0.1, 1.01}}});
  // The stored depths are half a metre too near: every lit receiver lies behind its own texel.
  all.push_back({"NearPlaneHalfAMetreOff",
                 cubes(),
                 {.drawn_map = [](LightFrame& frame, MapSettings&) { frame.near_m += 0.5; }},
                 {{"precision", 1e-3, 0.5}, {"map_error_quanta", 2, 10000}}});
  // The light has moved by 8 degrees since the map was drawn.
  all.push_back({"MapOfThePreviousLight",
                 cubes(),
                 {.drawn_map =
                      [](LightFrame& frame, MapSettings&) {
                        Settings before = cubes();
                        before.light.position_m = glm::dvec3(-2.6, 4, -0.6);
                        const LightFrame old = make_light_frame(make_scene(before.scene), before);
                        frame.origin_m = old.origin_m, frame.right = old.right, frame.up = old.up;
                        frame.forward = old.forward, frame.ray_direction = old.ray_direction;
                      }},
                 {{"precision", 1e-3, 0.05}, {"map_error_quanta", 2, 10000}}});
  // A polygon offset was left on: the map contains a constant offset that is in no setting.
  all.push_back({"OffsetLeftInTheMap",
                 cubes(),
                 {.edited_map =
                      [](const Image<float>& map) {
                        Image<float> out = map;
                        for (float& depth : out.pixels) depth = std::max(0.0f, depth - 0.002f);
                        return out;
                      }},
                 {{"precision", 1e-3, 0.05}, {"map_error_quanta", 2, 10000}}});
  return all;
}

class PlantedDefect : public testing::TestWithParam<Planted> {};
TEST_P(PlantedDefect, MovesItsMetric) { expect_moves(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Each, PlantedDefect, testing::ValuesIn(defects()), name_of);

// The tolerance for the lookup's numbers must grow with the uncertainty of the place looked up. Two large cases: the
// gradient of a receiver plane half a million texels from the receiver, and a scene that lies 100 km from the origin.
TEST(Sound, AreReceiverPlanesFarFromTheirReceiversAndFromTheOrigin) {
  Settings settings;
  settings.scene.name = "spot-room";
  settings.view.width_px = 16;
  settings.view.height_px = 12;
  settings.map.resolution = 32;
  settings.map.extent_scale = 0.15;
  settings.bias.reference = "texel_plane";
  settings.bias["normal_offset_lateral"] = 558715;
  EXPECT_LE(measure(settings).at("rounding_excess"), 1);
  settings.bias["normal_offset_lateral"] = 15;
  settings.scene.move_m = glm::dvec3(1e5, 1e5, 1e5);
  EXPECT_LE(measure(settings).at("rounding_excess"), 1);
}

// The program itself notices a wrong variant of a shader, and the run ends with an error of the kind `defect`.
TEST(Workbench, HoldsAVariantToItsContract) {
  const Settings settings = cubes();
  const auto sound = [&](gl::ShaderReplacements shaders) {
    Workbench bench(gl::DebugMode::fatal, std::move(shaders));
    Results results;
    results.points.push_back(bench.measure(settings, std::nullopt).record);
    require_sound(results);
  };
  EXPECT_NO_THROW(sound({}));
  const auto kind = [&](gl::ShaderReplacements shaders) {
    try {
      sound(std::move(shaders));
    } catch (const Error& e) {
      return e.kind();
    }
    return ErrorKind::usage;
  };
  EXPECT_EQ(kind(patched("shaders/compare.glsl", "biased > stored_depth", "biased >= stored_depth")),
            ErrorKind::defect);
  EXPECT_EQ(kind(patched(projected, "ndc * 0.5 + 0.5", "ndc * 0.5 + 0.50001")), ErrorKind::defect);
}

TEST(RequireSound, RefusesAMapThatIsNotTheScenes) {
  Results results;
  PointRecord& point = results.points.emplace_back();
  point.settings = settings_map(cubes());
  point.metrics = sound_figures(cubes());
  EXPECT_NO_THROW(require_sound(results));
  point.metrics = measure(cubes(), {.edited_map = in_a_corner});
  EXPECT_THROW(require_sound(results), Error);
}

TEST(RequireSound, NamesEachLimit) {
  for (const SoundLimit& limit : sound_limits) {
    PointRecord point;
    point.metrics = {{"facing", 10}};
    for (const SoundLimit& other : sound_limits) point.metrics[other.metric] = other.most;
    Results results;
    results.points = {point};
    EXPECT_NO_THROW(require_sound(results));
    for (const double value : {limit.most + 1e-9 + limit.most * 1e-9, std::nan("")}) {
      results.points[0].metrics[limit.metric] = value;
      expect_refused(ErrorKind::defect, {limit.metric}, [&] { require_sound(results); });
    }
    results.points[0].metrics["facing"] = 0;  // nothing was measured, so no limit is broken
    EXPECT_NO_THROW(require_sound(results));
  }
}

TEST(Patched, RefusesAPatternThatIsGone) {
  EXPECT_THROW(patched(box, "no such text", ""), std::logic_error);
  EXPECT_THROW(gl::shader_file("shaders/none.such"), Error);
  EXPECT_THROW(gl::Renderer(gl::DebugMode::fatal, {{"shaders/none.such", "void main() {}"}}), Error);
}

}  // namespace
}  // namespace noonmark::planted
