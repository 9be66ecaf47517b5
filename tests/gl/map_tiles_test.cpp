// Flat maps at some of their texels: uploading by tiles, into textures of maps before, and reading back by a list.
#include <epoxy/gl.h>

#include <memory>

#include "gl/spare_maps.h"
#include "tests/gl/fixture.h"

namespace noonmark::gl {
namespace {

Settings map_of(int side) {
  Settings settings;
  settings.map.resolution = side;
  return settings;
}

// Depths of 24 bits at about `count` texels in a random corner of the map, so that some tiles stay empty.
MapDepths some_depths(std::mt19937& random, int side, int count, float elsewhere) {
  const auto texels = std::make_shared<TexelSet>(glm::ivec2(side));
  const int part = std::max(1, side / 2);
  const auto any = [&](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
  const glm::ivec2 corner(any(side - part + 1), any(side - part + 1));
  for (int i = 0; i < count; ++i) texels->add(corner + glm::ivec2(any(part), any(part)));
  texels->close();
  MapDepths map(texels, elsewhere);
  for (float& d : map.depth) d = static_cast<float>(random() >> 8) * 0x1p-24f;
  return map;
}

Image<float> whole(const MapDepths& map) {
  Image<float> image(map.size().x, map.size().y);
  for (int y = 0; y < image.height; ++y) map.copy_row(y, &image.at(0, y));
  return image;
}

// The second and later maps are written into textures of the maps before. Sides below, at and above whole tiles.
TEST_F(GlTest, NothingOfTheMapBeforeIsLeftInALaterOne) {
  std::mt19937 random(17);
  for (const int side : {1, 63, 64, 65, 130, 300})
    for (int i = 0; i < 12; ++i) {
      const MapDepths exact = some_depths(random, side, 200, 1), ties = some_depths(random, side, 200, 1);
      const ShadowMap first = renderer.upload_map(exact, map_of(side).map);
      const ShadowMap second = renderer.upload_map(ties, map_of(side).map);  // while the first is in use
      EXPECT_TRUE(renderer.read_map(first).pixels == whole(exact).pixels) << side << " " << i;
      EXPECT_TRUE(renderer.read_map(second).pixels == whole(ties).pixels) << side << " " << i;
    }
}

TEST_F(GlTest, ALaterMapMayHaveAnotherDepthElsewhere) {
  std::mt19937 random(19);
  for (const float elsewhere : {1.0f, 0.25f, 0.25f, 0.0f, 1.0f}) {
    const MapDepths depths = some_depths(random, 200, 100, elsewhere);
    EXPECT_TRUE(renderer.read_map(renderer.upload_map(depths, map_of(200).map)).pixels == whole(depths).pixels);
  }
  // A map whose set is whole has no depth elsewhere; the one after it does not take any for granted.
  const Image<float> all(200, 200, 0.5f);
  EXPECT_TRUE(renderer.read_map(renderer.upload_map(MapDepths(all), map_of(200).map)).pixels == all.pixels);
  const MapDepths depths = some_depths(random, 200, 100, 1);
  EXPECT_TRUE(renderer.read_map(renderer.upload_map(depths, map_of(200).map)).pixels == whole(depths).pixels);
}

// A receiver beside the map reads its border, or the map again.
TEST_F(GlTest, ALaterMapHasItsOwnWrapMode) {
  Scene scene;
  scene.light = light_from_above();
  Settings settings = map_of(4);
  settings.map.extent_m = 1;
  settings.map.near_m = 0;
  settings.map.far_m = 20;
  ReceiverImage receivers{Image<glm::vec3>(1, 1, glm::vec3(0.9f, 0, 0.1f)), Image<glm::vec3>(1, 1, glm::vec3(0, 1, 0)),
                          Image<uint32_t>(1, 1, 0u)};
  renderer.load_receivers(receivers, {0, 5, 5});
  const MapDepths dark(Image<float>(4, 4, 0));
  for (const Wrap wrap : {Wrap::clamp_to_border, Wrap::repeat, Wrap::clamp_to_border}) {
    settings.map.wrap = wrap;
    const LightFrame frame = make_light_frame(scene, settings);
    const float lit = renderer.lookup(renderer.upload_map(dark, settings.map), {settings, frame}).pixels.front();
    EXPECT_EQ(lit, wrap == Wrap::repeat ? 0.0f : 1.0f);
  }
}

// 1.2 million texels are read with two draws. 2.4 million of 2.56 million are read with all others.
TEST_F(GlTest, ListedTexelsAreThoseOfTheWholeMap) {
  std::mt19937 random(23);
  const int side = 1600;
  Image<float> depth(side, side);
  for (float& d : depth.pixels) d = static_cast<float>(random() >> 8) * 0x1p-24f;
  const ShadowMap map = renderer.upload_map(depth, map_of(side).map);
  for (const size_t every : {size_t{0}, size_t{1000}, size_t{2}, size_t{1}}) {
    const auto texels = std::make_shared<TexelSet>(glm::ivec2(side));
    for (size_t i = 0; every && i < depth.size(); i += every)
      if (every > 2 || i % 50 > 2) texels->add({i % side, i / side});
    texels->close();
    EXPECT_EQ(texels->count() > size_t{1} << 20, every == 1 || every == 2) << "as the comment above says";
    const MapDepths read = renderer.read_map(map, texels);
    ASSERT_EQ(read.depth.size(), texels->count());
    size_t wrong = 0;
    for (int y = 0; y < side; ++y)
      texels->each_in_row(y, [&](int x, size_t index) { wrong += !same_bits(read[index], depth.at(x, y)); });
    EXPECT_EQ(wrong, 0u);
  }
}

TEST(GlSpareMaps, AreFewAndOfOneKind) {
  constexpr GLenum kind = GL_DEPTH_COMPONENT32F;
  const auto of_side = [](int side) { return TiledMaps{Texture(), kind, glm::ivec3(side, side, 1)}; };
  const glm::ivec3 square(64, 64, 1);
  const auto large = std::make_shared<SpareMaps>(1, SpareMaps::no_limit);
  SpareMaps spares(2, SpareMaps::most_small_bytes, large), others(1, SpareMaps::most_small_bytes, large);
  EXPECT_FALSE(spares.take(kind, square));
  for (int i = 0; i < 5; ++i) spares.put(of_side(64));
  EXPECT_EQ(spares.count(), 2u);
  EXPECT_EQ(spares.take(kind, square)->size, square);
  EXPECT_EQ(spares.count(), 1u);
  EXPECT_FALSE(spares.take(kind, {64, 65, 1})) << "a map of another size";
  EXPECT_EQ(spares.count(), 0u) << "must not take memory beside that map";
  spares.put(of_side(64));
  EXPECT_FALSE(spares.take(GL_DEPTH_COMPONENT16, square)) << "a map of another format";
  EXPECT_EQ(spares.count(), 0u) << "must not take the place of one of that format";
  spares.put(of_side(64));
  EXPECT_FALSE(spares.take(kind, {64, 64, 2})) << "two maps";
  EXPECT_EQ(spares.count(), 0u);
  spares.put(of_side(64));
  spares.keep_only(glm::ivec2(square));
  EXPECT_EQ(spares.count(), 1u);
  spares.keep_only(glm::ivec2(0));
  EXPECT_EQ(spares.count(), 0u);
  for (int i = 0; i < 2; ++i) spares.put(of_side(8192)), others.put(of_side(8192));
  EXPECT_EQ(spares.count(), 0u);
  EXPECT_EQ(large->count(), 1u) << "one of 256 MiB is enough";
  EXPECT_FALSE(spares.take(GL_DEPTH_COMPONENT16, {8192, 8192, 1}));
  EXPECT_EQ(large->count(), 0u) << "must not take memory beside one of another format";
  spares.put(of_side(8192));
  EXPECT_TRUE(others.take(kind, {8192, 8192, 1})) << "whoever put it";
  spares.put(of_side(8192));
  others.keep_only(glm::ivec2(64));
  EXPECT_EQ(large->count(), 0u);
  spares.put(of_side(8192));
  spares.clear();
  EXPECT_EQ(large->count(), 0u);
  SpareMaps small_only(2, SpareMaps::most_small_bytes);
  small_only.put(of_side(8192));
  EXPECT_FALSE(small_only.take(kind, {8192, 8192, 1}));
}

int live_textures() {
  int live = 0;
  for (GLuint id = 1; id < 4096; ++id) live += glIsTexture(id);
  return live;
}

// Spare textures are deleted for a map of another size, and when memory is asked back.
TEST_F(GlTest, SpareTexturesAreDeleted) {
  std::mt19937 random(29);
  const auto upload_two = [&](int side) {
    const ShadowMap exact = renderer.upload_map(some_depths(random, side, 50, 1), map_of(side).map);
    const ShadowMap ties = renderer.upload_map(some_depths(random, side, 50, 1), map_of(side).map);
  };
  upload_two(100);  // makes what every upload uses
  renderer.release_spares();
  const int before = live_textures();
  upload_two(100);
  EXPECT_EQ(live_textures(), before + 2) << "both are kept for the next";
  upload_two(100);
  EXPECT_EQ(live_textures(), before + 2) << "which were used";
  upload_two(200);
  EXPECT_EQ(live_textures(), before + 2) << "of one side alone";
  { const ShadowMap image = renderer.upload_map(Image<float>(70, 70, 0.5f), map_of(70).map); }
  EXPECT_EQ(live_textures(), before) << "a map of another side has come";
  upload_two(100);
  renderer.release_spares();
  EXPECT_EQ(live_textures(), before);
}

// A map is drawn into the texture of the one before, if that has its format; nothing of that is left.
TEST_F(GlTest, ADrawnMapShowsNothingOfTheOneBefore) {
  Scene wide, narrow;
  wide.light = narrow.light = light_from_above();
  add_floor(wide, 1, 4);
  add_floor(narrow, 0, 1);
  Settings settings = map_of(50);
  settings.map.extent_m = 6;
  settings.map.near_m = 1;
  settings.map.far_m = 20;
  renderer.release_spares();
  const int before = live_textures();
  for (const DepthFormat format : {DepthFormat::d32f, DepthFormat::d32f, DepthFormat::d16, DepthFormat::d32f}) {
    settings.map.format = format;
    renderer.load_scene(wide);
    { const ShadowMap drawn = renderer.render_map({wide, settings}); }
    EXPECT_EQ(live_textures(), before + 1) << "one is kept for the next";
    renderer.load_scene(narrow);
    const ShadowMap drawn = renderer.render_map({narrow, settings});
    EXPECT_EQ(live_textures(), before + 1) << "which was used";
    Renderer other(DebugMode::fatal);
    other.load_scene(narrow);
    const Image<float> expected = other.read_map(other.render_map({narrow, settings}));
    EXPECT_LT(expected.at(25, 25), 1.0f);
    EXPECT_EQ(expected.at(2, 2), 1.0f) << "where the wide floor was";
    EXPECT_TRUE(renderer.read_map(drawn).pixels == expected.pixels);
    renderer.release_spares();
  }
}

// A large map is drawn into the texture of an uploaded one, and uploaded into that of a drawn one.
TEST_F(GlTest, ALargeMapTakesTheTextureOfTheOneBefore) {
  const int side = 5800;
  static_assert(side * side * sizeof(float) > SpareMaps::most_small_bytes);
  Scene scene;
  scene.light = light_from_above();
  add_floor(scene, 0, 1);
  Settings settings = map_of(side);
  settings.map.extent_m = 6;
  settings.map.near_m = 1;
  settings.map.far_m = 20;
  renderer.load_scene(scene);
  const auto texels = std::make_shared<TexelSet>(glm::ivec2(side));
  for (int i = 0; i < side; i += 7) texels->add(glm::ivec2(i));
  texels->close();
  { const ShadowMap first = renderer.upload_map(MapDepths(texels, 1), settings.map); }  // makes what every upload uses
  renderer.release_spares();
  const int before = live_textures();
  const auto row_of = [&](const ShadowMap& map, int row) { return renderer.read_rows(map, row, 1); };
  for (const DepthFormat format : {DepthFormat::d32f, DepthFormat::d32f, DepthFormat::d16, DepthFormat::d32f}) {
    settings.map.format = format;
    {
      const ShadowMap drawn = renderer.render_map({scene, settings});
      EXPECT_EQ(live_textures(), before + 1) << "that of the map before was used, or deleted";
      const Image<float> row = row_of(drawn, side / 2);
      EXPECT_LT(row.at(side / 2, 0), 1.0f) << "the floor";
      EXPECT_EQ(row.at(1, 0), 1.0f) << "beside it";
      EXPECT_EQ(row_of(drawn, 7).at(7, 0), 1.0f) << "where an uploaded map has a texel";
    }
    for (const float depth : {0.25f, 0.5f}) {
      const MapDepths depths(texels, 0.75f, depth);
      const ShadowMap uploaded = renderer.upload_map(depths, settings.map);
      EXPECT_EQ(live_textures(), before + 1);
      const Image<float> row = row_of(uploaded, 7 * 400);
      EXPECT_EQ(row.at(7 * 400, 0), depth);
      EXPECT_EQ(std::count(row.pixels.begin(), row.pixels.end(), depths.elsewhere), side - 1);
    }
  }
  renderer.release_spares();
  EXPECT_EQ(live_textures(), before);
}

TEST(GlLife, AnUploadedMapMayOutliveItsRenderer) {
  std::mt19937 random(31);
  auto owner = std::make_unique<Renderer>(DebugMode::fatal);
  auto map = std::make_unique<ShadowMap>(owner->upload_map(some_depths(random, 70, 50, 1), map_of(70).map));
  owner.reset();
  Renderer other(DebugMode::fatal);
  const MapDepths depths = some_depths(random, 70, 50, 1);
  const ShadowMap kept = other.upload_map(depths, map_of(70).map);
  map.reset();  // must not become a spare of the other renderer, nor delete its texture of the same number
  const ShadowMap next = other.upload_map(depths, map_of(70).map);
  EXPECT_TRUE(other.read_map(kept).pixels == whole(depths).pixels);
  EXPECT_TRUE(other.read_map(next).pixels == whole(depths).pixels);
}

}  // namespace
}  // namespace noonmark::gl
