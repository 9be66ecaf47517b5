// Depth maps against closed forms.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "tests/gl/fixture.h"

namespace noonmark::gl {
namespace {

struct Format {
  DepthFormat format;
  const char* name;
  double quantum;  // window depth to which the format rounds
};
constexpr Format formats[] = {{DepthFormat::d16, "d16", 1.0 / 65535}, {DepthFormat::d24, "d24", 1.0 / 16777215}};

TEST_F(GlTest, FixedPointDepthsAreWholeQuanta) {
  Scene scene;
  scene.light = light_from_above();
  add_quad(scene, "plane", {-2, -1, 2}, {4, 2, 0}, {0, 0, -4});
  renderer.load_scene(scene);
  Settings settings;
  settings.map.resolution = 32;
  settings.map.extent_m = 2;
  settings.map.near_m = 5;
  settings.map.far_m = 15;
  const LightFrame frame = make_light_frame(scene, settings);
  for (const Format& f : formats) {
    settings.map.format = f.format;
    for (float depth : renderer.read_map(renderer.render_map({settings, frame})).pixels) {
      // A float near 0.5 has 24 bits: it cannot hold k / (2^24 - 1) better than to 2^-25.
      const double quanta = depth / f.quantum;
      ASSERT_NEAR(quanta, std::round(quanta), f.format == DepthFormat::d16 ? 0.01 : 0.5001) << f.name;
    }
  }
  // A 16-bit map is really coarser: the slope's 32 depths, within 0.1 of the range, differ from the 24-bit ones.
  settings.map.format = DepthFormat::d16;
  const Image<float> coarse = renderer.read_map(renderer.render_map({settings, frame}));
  settings.map.format = DepthFormat::d24;
  EXPECT_NE(coarse.pixels, renderer.read_map(renderer.render_map({settings, frame})).pixels);
}

// The matrix clips: a surface before near or beyond far leaves no depth, and is not clamped either.
TEST_F(GlTest, NearAndFarClip) {
  Scene scene;
  scene.light = light_from_above();
  add_floor(scene, 8, 1);  // 2 m from the light
  add_floor(scene, 5, 1);  // 5 m
  add_floor(scene, 0, 3);  // 10 m
  renderer.load_scene(scene);
  Settings settings;
  settings.map.resolution = 16;
  settings.map.extent_m = 4;  // the upper two fill the middle half
  settings.map.format = DepthFormat::d32f;
  const auto depths = [&](double near_m, double far_m) {
    settings.map.near_m = near_m;
    settings.map.far_m = far_m;
    const Image<float> map = renderer.read_map(renderer.render_map({scene, settings}));
    return std::pair(map.at(8, 8), map.at(0, 0));
  };
  constexpr float rounding = 1e-6f;  // a few float ulps of a depth near 1
  auto [middle, rim] = depths(1, 11);
  EXPECT_NEAR(middle, 0.1f, rounding);
  EXPECT_NEAR(rim, 0.9f, rounding);
  std::tie(middle, rim) = depths(3, 11);  // the topmost is before near
  EXPECT_NEAR(middle, 0.25f, rounding);
  EXPECT_NEAR(rim, 0.875f, rounding);
  std::tie(middle, rim) = depths(3, 9);  // and the lowest beyond far
  EXPECT_NEAR(middle, 1.0f / 3, rounding);
  EXPECT_EQ(rim, 1.0f);
}

TEST_F(GlTest, CullingChoosesTheStoredFace) {
  Scene scene;
  scene.light = light_from_above();
  add_box(scene, "box", {-1, 2, -1}, {1, 4, 1});
  renderer.load_scene(scene);
  Settings settings;
  settings.map.resolution = 8;
  settings.map.extent_m = 1;
  settings.map.near_m = 0;
  settings.map.far_m = 10;
  settings.map.format = DepthFormat::d32f;
  const LightFrame frame = make_light_frame(scene, settings);
  const auto stored = [&](CulledFaces cull) {
    settings.map.cull = cull;
    return renderer.read_map(renderer.render_map({settings, frame})).at(3, 5);
  };
  constexpr float rounding = 1e-6f;
  EXPECT_NEAR(stored(CulledFaces::none), 0.6f, rounding);
  EXPECT_NEAR(stored(CulledFaces::back), 0.6f, rounding);
  EXPECT_NEAR(stored(CulledFaces::front), 0.8f, rounding);
  // A single sheet shows the difference between culling the back and culling nothing.
  Scene sheet;
  sheet.light = scene.light;
  add_floor(sheet, 4, 1);
  renderer.load_scene(sheet);
  EXPECT_NEAR(stored(CulledFaces::none), 0.6f, rounding);
  EXPECT_NEAR(stored(CulledFaces::back), 0.6f, rounding);
  EXPECT_EQ(stored(CulledFaces::front), 1.0f);
  std::swap(sheet.triangles[0].y, sheet.triangles[0].z);
  std::swap(sheet.triangles[1].y, sheet.triangles[1].z);
  renderer.load_scene(sheet);
  EXPECT_EQ(stored(CulledFaces::back), 1.0f);
}

// Row 0 of a map is at the lowest v: the light's up.
TEST_F(GlTest, MapRowsRunUpwards) {
  Scene scene;
  scene.light = light_from_above();
  scene.light.position_m = {3, 10, 2};
  add_box(scene, "box", {0.3, 0, 0.7}, {0.8, 0.4, 0.9});
  renderer.load_scene(scene);
  Settings settings;
  settings.map.resolution = 128;
  settings.map.extent_m = 4;
  settings.map.near_m = 0;
  settings.map.far_m = 20;
  const LightFrame frame = make_light_frame(scene, settings);
  const Image<float> map = renderer.read_map(renderer.render_map({settings, frame}));
  const glm::dvec3 middle = frame.to_light({0.55, 0.2, 0.8});
  const glm::ivec2 texel(glm::floor((glm::dvec2(middle) + 2.0) / frame.texel_m(glm::dvec3(0))));
  EXPECT_LT(map.at(texel.x, texel.y), 1.0f);
  EXPECT_EQ(map.at(texel.x, 127 - texel.y), 1.0f);
  EXPECT_EQ(map.at(127 - texel.x, texel.y), 1.0f);
}

TEST_F(GlTest, UploadedMapsComeBackBitForBit) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(0, 1);
  std::uniform_int_distribution<int> exponent(-126, 0);
  for (const int side : {1, 3, 64, 333}) {
    Settings settings;
    settings.map.resolution = side;
    Image<float> depth(side, side);
    for (float& d : depth.pixels) d = random() % 4 ? any(random) : std::ldexp(1.0f, exponent(random));
    depth.pixels.front() = 0;
    depth.pixels.back() = 1;
    if (side > 2) depth.pixels[1] = std::nextafter(1.0f, 0.0f);
    const Image<float> back = renderer.read_map(renderer.upload_map(depth, settings.map));
    ASSERT_EQ(back.width, side);
    for (size_t i = 0; i < depth.size(); ++i)
      ASSERT_TRUE(same_bits(depth[i], back[i])) << side << ": " << depth[i] << " came back as " << back[i];
  }
}

// A map of more rows than one strip of the read-back holds.
TEST_F(GlTest, LargeMapsComeBackWhole) {
  Settings settings;
  settings.map.resolution = 5000;
  Image<float> depth(5000, 5000);
  std::mt19937 random(11);
  for (float& d : depth.pixels) d = static_cast<float>(random() >> 8) * 0x1p-24f;
  EXPECT_TRUE(renderer.read_map(renderer.upload_map(depth, settings.map)).pixels == depth.pixels);
}

// 2500 rows are more than one band; of a cube, bands end with a face.
TEST_F(GlTest, SomeTexelsAreUploadedAndReadBitForBit) {
  std::mt19937 random(13);
  for (const auto& [side, shape] : {std::pair{70, MapShape::flat}, {2500, MapShape::flat}, {70, MapShape::cube}}) {
    const int height = shape == MapShape::cube ? 6 * side : side;
    Settings settings;
    settings.map.resolution = side;
    const auto texels = std::make_shared<TexelSet>(glm::ivec2(side, height));
    for (int i = 0; i < 5000; ++i)
      texels->add({static_cast<int>(random() % side), static_cast<int>(random() % height)});
    texels->add({side - 1, height - 1});
    texels->close();
    MapDepths depths(texels, 1);
    for (float& d : depths.depth) d = static_cast<float>(random() >> 8) * 0x1p-24f;
    const ShadowMap map = renderer.upload_map(depths, settings.map, shape);
    EXPECT_EQ(renderer.read_map(map, texels).depth, depths.depth);
    const Image<float> whole = renderer.read_map(map);
    Image<float> expected(side, height);
    for (int y = 0; y < height; ++y) depths.copy_row(y, &expected.at(0, y));
    EXPECT_TRUE(whole.pixels == expected.pixels) << side;
    const int first = height / 3, count = height / 2;  // of a cube: from the third face to the fifth
    const Image<float> rows = renderer.read_rows(map, first, count);
    ASSERT_EQ(rows.height, count);
    EXPECT_TRUE(std::equal(rows.pixels.begin(), rows.pixels.end(), &expected.at(0, first))) << side;
    EXPECT_EQ(kind_thrown([&] { renderer.read_rows(map, height - 1, 2); }), static_cast<int>(ErrorKind::defect));
  }
}

TEST_F(GlTest, DepthsThatOpenGlWouldClampAreRefused) {
  Settings settings;
  settings.map.resolution = 2;
  for (const float bad : {-0.1f, 1.0001f, NAN, INFINITY}) {
    Image<float> depth(2, 2, 0.5f);
    depth[3] = bad;
    EXPECT_EQ(kind_thrown([&] { renderer.upload_map(depth, settings.map); }), static_cast<int>(ErrorKind::defect))
        << bad;
    EXPECT_EQ(kind_thrown([&] { renderer.upload_map(MapDepths(depth), settings.map); }),
              static_cast<int>(ErrorKind::defect));
    const auto one_texel = std::make_shared<TexelSet>(glm::ivec2(2, 2));
    one_texel->add({1, 0});
    one_texel->close();
    EXPECT_EQ(kind_thrown([&] { renderer.upload_map(MapDepths(one_texel, bad, 0.5f), settings.map); }),
              static_cast<int>(ErrorKind::defect));
  }
}

TEST_F(GlTest, TooLargeAMapIsAUsageErrorThatNamesTheLimit) {
  Settings settings;
  const int limit = renderer.info().max_map_resolution;
  settings.map.resolution = limit + 1;
  LightFrame frame;
  frame.resolution = frame.rows = limit + 1;
  std::string message;
  EXPECT_EQ(kind_thrown([&] { renderer.render_map({settings, frame}); }, &message), static_cast<int>(ErrorKind::usage));
  EXPECT_NE(message.find(std::to_string(limit)), std::string::npos) << message;
  EXPECT_NE(message.find("map.resolution"), std::string::npos) << message;
}

}  // namespace
}  // namespace noonmark::gl
