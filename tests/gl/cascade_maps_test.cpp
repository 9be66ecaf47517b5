// The maps of cascades: layers of an array that are drawn, uploaded and looked up together, as each is alone.
#include <algorithm>
#include <utility>
#include <vector>

#include "scenes/camera_fit.h"
#include "scenes/library.h"
#include "technique/cascades.h"
#include "technique/casters.h"
#include "technique/settings.h"
#include "tests/gl/fixture.h"

namespace noonmark::gl {
namespace {

using Assignments = std::vector<std::pair<const char*, const char*>>;

struct CascadeCase {
  const char* name;
  Assignments settings;
};
void PrintTo(const CascadeCase& one, std::ostream* out) { *out << one.name; }

Settings street(const Assignments& more) {
  Settings settings;
  const auto set = [&](const char* name, const char* value) { find_setting(name).set(settings, value); };
  for (const auto& [name, value] : Assignments{{"scene.name", "street"},
                                               {"view.near_m", "0.2"},
                                               {"map.reach_m", "80"},
                                               {"map.fit", "sphere"},
                                               {"map.resolution", "128"},
                                               {"cascades.count", "4"},
                                               {"bias.unit", "texel"},
                                               {"bias.constant", "1.2"}})
    set(name, value);
  for (const auto& [name, value] : more) set(name, value);
  settings.view.width_px = 200;
  settings.view.height_px = 120;
  return settings;
}

class CascadeMaps : public testing::TestWithParam<CascadeCase> {
 protected:
  CascadeMaps()
      : settings(street(GetParam().settings)),
        scene(make_scene(settings.scene)),
        techniques(techniques_of(scene, settings)) {
    renderer.load_scene(scene);
  }
  Renderer::CastersOf casters() const {
    if (!techniques.front().moves_casters()) return {};
    return [this](const Technique& of) { return caster_positions(scene, of.frame, of.settings.map, of.bias); };
  }

  Settings settings;
  Scene scene;
  std::vector<Technique> techniques;
  Renderer renderer{DebugMode::fatal};
};

// Layer by layer, bit for bit; and the last one is still the own one when all have been drawn.
TEST_P(CascadeMaps, AreTheMapsDrawnAlone) {
  const ShadowMap all = renderer.render_maps(techniques, nullptr, casters());
  ASSERT_EQ(all.count(), static_cast<int>(techniques.size()));
  Renderer other(DebugMode::fatal);  // it has no spare textures
  other.load_scene(scene);
  int64_t used = 0;
  for (size_t k = 0; k < techniques.size(); ++k) {
    const int which = static_cast<int>(k);
    const ShadowMap alone = other.render_map(techniques[k], nullptr, casters());
    EXPECT_EQ(all.size(which), alone.size());
    const Image<float> depth = other.read_map(alone), layer = renderer.read_map(all, which);
    EXPECT_TRUE(layer.pixels == depth.pixels) << k;
    EXPECT_LT(*std::min_element(depth.pixels.begin(), depth.pixels.end()), 1.0f) << "something is drawn";
    EXPECT_EQ(layer.pixels == renderer.read_map(all, 0).pixels, k == 0) << "the maps differ";
    EXPECT_TRUE(renderer.read_rows(all, 7, 5, which).pixels == other.read_rows(alone, 7, 5).pixels);
    const auto some = std::make_shared<TexelSet>(glm::ivec2(depth.width, depth.height));
    for (int i = 0; i < 50; ++i) some->add({7 * i % depth.width, 11 * i % depth.height});
    some->close();
    EXPECT_TRUE(renderer.read_map(all, some, which).depth == other.read_map(alone, some).depth) << "of listed texels";
    used += other.used_texels(alone);
  }
  EXPECT_EQ(renderer.used_texels(all), used);
}

// The one pass gives each receiver, of its own map and of the next, the very floats of a pass over that map alone.
TEST_P(CascadeMaps, AreLookedUpInOnePassAsEachAlone) {
  const Camera camera = effective_camera(scene, settings.view);
  renderer.load_receivers(resolve_receivers(scene, camera, renderer.render_primitives(camera, 200, 120)), camera.eye_m);
  const ShadowMap all = renderer.render_maps(techniques, nullptr, casters());
  const MapChoice chosen = renderer.choose_maps(techniques.front());
  double ms = 0;
  const MapResults results = renderer.lookup_maps(all, techniques, &ms);
  EXPECT_GT(ms, 0);
  size_t receivers = 0, looked_up_next = 0, partly = 0;
  std::vector<Image<float>> by_map;
  for (size_t k = 0; k < techniques.size(); ++k) {
    const Image<float> one = result_in_map(results, chosen, static_cast<int>(k));
    const ShadowMap map = renderer.render_map(techniques[k], nullptr, casters());
    EXPECT_TRUE(renderer.lookup(map, techniques[k]).pixels == one.pixels) << "of its receivers, cascade " << k;
    Technique without = techniques[k];
    without.cascade.reset();
    const Image<float> everywhere = renderer.lookup(map, without);
    for (size_t i = 0; i < one.size(); ++i) {
      const bool own = chosen.of[i] == k;
      const bool next = chosen.of[i] + 1u == k && (chosen.share(i, static_cast<int>(k)) > 0 || chosen.seam[i]);
      ASSERT_TRUE(same_bits(one[i], own || next ? everywhere[i] : 0)) << i << " in cascade " << k;
      receivers += own;
      looked_up_next += next;
      partly += (own || next) && one[i] > 0 && one[i] < 1;
    }
    by_map.push_back(one);
  }
  EXPECT_GT(receivers, 10000u);
  EXPECT_GT(looked_up_next, 100u);
  EXPECT_EQ(partly > 50, techniques.front().taps.taps > 1);
  // The mix that is shown.
  const Image<float> mixed = mixed_results(results, chosen);
  for (size_t i = 0; i < mixed.size(); ++i) {
    double sum = 0;
    for (size_t k = 0; k < techniques.size(); ++k)
      sum += chosen.share(i, static_cast<int>(k)) * static_cast<double>(by_map[k][i]);
    ASSERT_NEAR(mixed[i], sum, 1e-6);  // two roundings to float
  }
  // Without the comparison at seams, as an engine looks it up, the next map is looked up only where it is blended in.
  for (Technique& one : techniques) one.cascade->seam = 1;
  const MapResults as_engine = renderer.lookup_maps(all, techniques);
  EXPECT_TRUE(as_engine.own.pixels == results.own.pixels);
  size_t compared = 0;
  for (size_t i = 0; i < mixed.size(); ++i) {
    const bool blended = chosen.blends() && chosen.next[i] > 0;
    ASSERT_TRUE(same_bits(as_engine.next[i], blended ? results.next[i] : 0)) << i;
    compared += !blended && results.next[i] > 0;
  }
  EXPECT_EQ(compared > 0, !chosen.blends()) << "a blend band is wider than what is compared";
}

// Uploaded over the maps before, which were others.
TEST_P(CascadeMaps, AreUploadedEachToItsOwnLayer) {
  std::mt19937 random(41);
  for (int round = 0; round < 3; ++round) {
    std::vector<MapDepths> depths;
    std::vector<const MapDepths*> uploaded;
    for (const Technique& one : techniques) {
      const glm::ivec2 size = one.frame.map_size();
      const auto texels = std::make_shared<TexelSet>(size);
      for (int i = 0; i < 40; ++i)
        texels->add({static_cast<int>(random() % static_cast<unsigned>(size.x)),
                     static_cast<int>(random() % static_cast<unsigned>(size.y))});
      texels->close();
      depths.emplace_back(texels, round == 1 ? 0.25f : 1.0f);
      for (float& depth : depths.back().depth) depth = static_cast<float>(random() >> 8) * 0x1p-24f;
    }
    for (const MapDepths& one : depths) uploaded.push_back(&one);
    const ShadowMap maps = renderer.upload_maps(uploaded, techniques);
    for (size_t k = 0; k < depths.size(); ++k) {
      const Image<float> read = renderer.read_map(maps, static_cast<int>(k));
      for (int y = 0; y < read.height; ++y) {
        std::vector<float> row(static_cast<size_t>(read.width));
        depths[k].copy_row(y, row.data());
        ASSERT_TRUE(std::equal(row.begin(), row.end(), &read.at(0, y))) << "row " << y << " of map " << k;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Each, CascadeMaps,
    testing::Values(CascadeCase{"Plain", {}},
                    CascadeCase{"Eight", {{"cascades.count", "8"}, {"cascades.blend", "0.2"}}},
                    CascadeCase{"Box", {{"filter.kind", "box"}}},
                    CascadeCase{"HardwareBlended", {{"filter.kind", "hardware"}, {"cascades.blend", "0.2"}}},
                    CascadeCase{"CastanoBySphere",
                                {{"filter.kind", "castano"},
                                 {"filter.size", "5"},
                                 {"cascades.select", "sphere"},
                                 {"cascades.blend", "0.2"}}},
                    CascadeCase{"PoissonByMap",
                                {{"filter.kind", "poisson"},
                                 {"filter.rotate", "true"},
                                 {"cascades.select", "map"},
                                 {"cascades.blend", "0.2"}}},
                    CascadeCase{"TwoSizes", {{"cascades.resolutions", "96, 128, 96, 128"}, {"cascades.blend", "0.2"}}},
                    CascadeCase{"Snapped", {{"map.snap", "true"}, {"cascades.blend", "0.2"}}},
                    CascadeCase{"Bits16", {{"map.format", "16"}}},
                    CascadeCase{
                        "OffsetAndPlane",
                        {{"filter.kind", "box"}, {"bias.normal_offset", "1.5"}, {"bias.reference", "receiver_plane"}}},
                    CascadeCase{"MovedCasters", {{"bias.caster_normal_offset", "1"}, {"bias.polygon_factor", "1"}}}),
    [](const auto& one) { return std::string(one.param.name); });

TEST_F(GlTest, MapsOfAnotherNumberAreRefused) {
  const Settings settings = street({});
  const Scene scene = make_scene(settings.scene);
  renderer.load_scene(scene);
  const std::vector<Technique> techniques = techniques_of(scene, settings);
  ReceiverImage receivers = resolve_receivers(scene, effective_camera(scene, settings.view), Image<uint32_t>(2, 2, 0));
  renderer.load_receivers(receivers, {});
  const ShadowMap maps = renderer.render_maps(techniques);
  EXPECT_EQ(kind_thrown([&] { renderer.lookup(maps, techniques[0]); }), static_cast<int>(ErrorKind::defect));
  EXPECT_THROW(renderer.upload_maps({}, techniques), std::logic_error);
}

}  // namespace
}  // namespace noonmark::gl
