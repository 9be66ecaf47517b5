// Maps of spot and point lights, and the options of the pass, against the frame in double.
#include <algorithm>
#include <cmath>

#include "technique/light_frame.h"
#include "tests/gl/fixture.h"

namespace noonmark::gl {
namespace {

Light light_of(LightKind kind) {
  Light light;
  light.kind = kind;
  light.position_m = {0.5, 6, 1.5};
  light.target_m = {0.1, 0, 0.2};
  light.cone_deg = 50;
  return light;
}

// A triangle in front of each face of the cube, each at another distance and place. axes: of the cube.
Scene triangles_around(glm::dvec3 centre, const glm::dmat3& cube = glm::dmat3(1)) {
  Scene scene;
  scene.light = light_of(LightKind::point);
  scene.light.position_m = centre;
  const glm::dvec3 light(glm::vec3{centre});
  for (int face = 0; face < 6; ++face) {
    const CubeFace& axes = cube_face(face);
    const double away = 2 + 0.7 * face;
    const auto at = [&](double s, double t) {
      return glm::vec3(light + away * (cube * (axes.forward * (1 + 0.2 * s) + s * axes.right + t * axes.up)));
    };
    const uint32_t first = static_cast<uint32_t>(scene.positions.size());
    const double shift = 0.05 * face;
    scene.positions.insert(scene.positions.end(),
                           {at(-0.7 + shift, -0.6), at(0.5, -0.3 + shift), at(0.2, 0.8 - shift)});
    scene.triangles.push_back({first, first + 1, first + 2});
  }
  return scene;
}

// The triangles, and quads of which some cross edges and corners of the cube, lie before near or lie beyond far. OpenGL
// does not promise equal bits. llvmpipe transforms vertices that come from a geometry shader in another way: it rounds
// x * side / 2 + side / 2 differently, unless the side is a power of two.
TEST_F(GlTest, OneLayeredPassIsSixPasses) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto anywhere = [&](double size) { return glm::dvec3(unit(random), unit(random), unit(random)) * size; };
  Scene scene = triangles_around({0, 0, 0});
  for (int k = 0; k < 60; ++k) {
    const glm::dvec3 middle = anywhere(6);
    add_quad(scene, "quad", middle, anywhere(4), anywhere(4));
  }
  renderer.load_scene(scene);
  Settings settings;
  settings.map.near_m = 0.3;
  settings.map.far_m = 7;
  for (const int side : {1, 32, 256, 100})
    for (const DepthFormat format : {DepthFormat::d16, DepthFormat::d24, DepthFormat::d32f})
      for (const CulledFaces cull : {CulledFaces::none, CulledFaces::back, CulledFaces::front}) {
        settings.map.resolution = side;
        settings.map.format = format;
        settings.map.cull = cull;
        const LightFrame frame = make_light_frame(scene, settings);
        double layered_ms = -1, six_ms = -1;
        settings.map.cube_pass = CubePass::layered;
        const Image<float> layered = renderer.read_map(renderer.render_map({settings, frame}, &layered_ms));
        settings.map.cube_pass = CubePass::six_passes;
        const Image<float> six = renderer.read_map(renderer.render_map({settings, frame}, &six_ms));
        EXPECT_TRUE(std::isfinite(layered_ms) && layered_ms > 0);
        EXPECT_TRUE(std::isfinite(six_ms) && six_ms > 0);
        ASSERT_EQ(layered.size(), six.size());
        size_t different = 0, far_off = 0, drawn = 0;
        // A vertex that snaps to the next 1/256 of a texel changes a steep quad's depth by more than float rounding
        // does.
        const double snapped = 0x1p-16 + (format == DepthFormat::d16 ? 1.0 / 65535 : 0);
        for (size_t i = 0; i < six.size(); ++i) {
          different += !same_bits(layered[i], six[i]);
          far_off += std::abs(static_cast<double>(layered[i]) - six[i]) > snapped;
          drawn += six[i] < 1;
        }
        if (side != 100) {
          EXPECT_EQ(different, 0u) << side;
        }
        EXPECT_LE(far_off, six.size() / 1000) << "only pixels at edges may differ by more";
        EXPECT_GT(drawn, six.size() / 8);
        EXPECT_LT(drawn, six.size() + (side == 1))
            << "there must be some background too, except in a map of six texels";
      }
}

TEST_F(GlTest, UploadedCubesComeBackBitForBit) {
  std::mt19937 random(7);
  for (const int side : {1, 3, 65}) {
    Settings settings;
    settings.map.resolution = side;
    settings.map.wrap = Wrap::repeat;
    Image<float> depth(side, 6 * side);
    for (float& d : depth.pixels) d = static_cast<float>(random() >> 8) * 0x1p-24f;
    const Image<float> back = renderer.read_map(renderer.upload_map(depth, settings.map, MapShape::cube));
    ASSERT_EQ(back.height, 6 * side);
    EXPECT_TRUE(back.pixels == depth.pixels);
  }
}

TEST_F(GlTest, AMapOfAnotherKindIsADefect) {
  Scene scene;
  add_floor(scene, 0, 4);
  scene.camera = camera_from_above(4);
  scene.light = light_of(LightKind::point);
  renderer.load_scene(scene);
  renderer.load_receivers(resolve_receivers(scene, scene.camera, renderer.render_primitives(scene.camera, 8, 8)),
                          scene.camera.eye_m);
  Settings settings;
  settings.map.resolution = 8;
  const LightFrame frame = make_light_frame(scene, settings);
  const ShadowMap flat = renderer.upload_map(Image<float>(8, 8, 1.0f), settings.map);
  EXPECT_EQ(kind_thrown([&] { renderer.lookup(flat, {settings, frame}); }), static_cast<int>(ErrorKind::defect));
  EXPECT_EQ(kind_thrown([&] { renderer.upload_map(Image<float>(8, 40, 1.0f), settings.map, MapShape::cube); }),
            static_cast<int>(ErrorKind::defect));
  EXPECT_EQ(kind_thrown([&] { renderer.upload_map(Image<float>(8, 48, 1.0f), settings.map, MapShape::flat); }),
            static_cast<int>(ErrorKind::defect));
  settings.filter.kind = "box";
  EXPECT_EQ(kind_thrown([&] { renderer.probe({settings, frame}); }), static_cast<int>(ErrorKind::usage));
}

TEST_F(GlTest, TooLargeACubeIsAUsageErrorThatNamesTheLimit) {
  Settings settings;
  settings.map.resolution = 4097;
  LightFrame frame;
  frame.kind = LightKind::point;
  frame.resolution = frame.rows = 4097;
  std::string message;
  EXPECT_EQ(kind_thrown([&] { renderer.render_map({settings, frame}); }, &message), static_cast<int>(ErrorKind::usage));
  EXPECT_NE(message.find("4096"), std::string::npos) << message;
  EXPECT_NE(message.find("map.resolution"), std::string::npos) << message;
  EXPECT_EQ(kind_thrown([&] { renderer.probe({settings, frame}); }), static_cast<int>(ErrorKind::usage));
}

}  // namespace
}  // namespace noonmark::gl
