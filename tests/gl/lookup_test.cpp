// The lookup against a second implementation on the host, which uses the numbers of the probe and the map.
#include <set>
#include <tuple>

#include "technique/setting_rules.h"
#include "tests/gl/lookup_host.h"

namespace noonmark::gl {
namespace {

constexpr LightKind kinds[] = {LightKind::directional, LightKind::spot, LightKind::point};
const std::string kind_names[] = {"directional", "spot", "point"};

// How far a sampler's blended result may be from the exact weights. llvmpipe blends in floats: a place among up to 1024
// texels is rounded three times on each of both axes, each time by at most 2^-15 of a texel (seen: 1e-5). GPUs keep 8
// bits of a texel's fraction, and need not round it to the nearest: 2^-8 more on each axis (an H100: 1.2 x 2^-8 in all).
double sampler_error(const DeviceInfo& info) { return 6 * 0x1p-15 + (info.software ? 0 : 2 * 0x1p-8); }

// Random scenes and settings, in parts: most of the time goes into compiling a shader for each settings.
constexpr int parts_of_a_kind = 6, settings_of_a_part = 24;
struct Draw {
  Scene scene;
  std::vector<Settings> settings;
};
Draw draw(LightKind kind, int part) {
  std::seed_seq seed{1978, static_cast<int>(kind), part};
  std::mt19937 random(seed);
  Draw drawn{random_scene(random, kind), {}};
  for (int j = 0; j < settings_of_a_part; ++j) drawn.settings.push_back(random_settings(random, kind));
  return drawn;
}

class GlLookupOnHostTest : public GlLookupTest, public testing::WithParamInterface<std::tuple<LightKind, int>> {};

TEST_P(GlLookupOnHostTest, EqualsTheHost) {
  const auto [kind, part] = GetParam();
  const Draw drawn = draw(kind, part);
  const ReceiverImage receivers = load(drawn.scene, 83, 61);
  double worst_blend = 0;
  Met met;
  for (const Settings& settings : drawn.settings) {
    const LightFrame frame = make_light_frame(drawn.scene, settings);
    const ShadowMap map = renderer.render_map({settings, frame});
    const LookupProbe probe = renderer.probe({settings, frame});
    Image<double> ties;
    const Image<double> host = lookup_on_host(probe, receivers, renderer.read_map(map), settings, met, &ties);
    const Image<float> gpu = renderer.lookup(map, {settings, frame});
    // llvmpipe compares floats, also with a fixed-point map.
    const bool rounds_reference = probe.pattern.bilinear() && !renderer.info().software;
    const double allowed = probe.pattern.bilinear() ? sampler_error(renderer.info()) : 0;
    ASSERT_EQ(gpu.size(), host.size());
    size_t different = 0, first = 0;
    for (size_t i = gpu.size(); i-- > 0;) {
      const double off = std::abs(gpu[i] - host[i]);
      if (probe.pattern.bilinear()) worst_blend = std::max(worst_blend, off);
      if (!(off <= allowed + (rounds_reference ? ties[i] : 0))) ++different, first = i;
      ASSERT_TRUE(gpu[i] >= 0 && gpu[i] <= 1) << gpu[i];
    }
    EXPECT_EQ(different, 0u) << describe(settings) << ": first at index " << first << ", shader " << gpu[first]
                             << ", host " << host[first];
  }
  constexpr size_t enough = 1000;
  EXPECT_GT(met.lit, enough);
  EXPECT_GT(met.dark, enough);
  EXPECT_GT(met.fractions, enough);
  EXPECT_GT(met.outside + (kind == LightKind::point ? enough + 1 : 0), enough);
  EXPECT_GT(met.beyond_far, enough);
  EXPECT_GT(met.background, enough);
  RecordProperty("worst_blend", std::to_string(worst_blend));
}

INSTANTIATE_TEST_SUITE_P(Lights, GlLookupOnHostTest,
                         testing::Combine(testing::ValuesIn(kinds), testing::Range(0, parts_of_a_kind)),
                         [](const testing::TestParamInfo<std::tuple<LightKind, int>>& test) {
                           return kind_names[static_cast<int>(std::get<0>(test.param))] +
                                  std::to_string(std::get<1>(test.param));
                         });

TEST(GlLookupDraws, HaveEveryPartOfABiasReferenceAndFilter) {
  std::set<std::string> parts_met, references_met, filters_met;
  for (const LightKind kind : kinds)
    for (int part = 0; part < parts_of_a_kind; ++part)
      for (const Settings& settings : draw(kind, part).settings) {
        for (const BiasPart& one : bias_parts())
          if (settings.bias[one.name] != 0) parts_met.emplace(one.name);
        references_met.insert(settings.bias.reference);
        filters_met.insert(settings.filter.kind);
      }
  EXPECT_EQ(parts_met.size(), bias_parts().size());
  EXPECT_EQ(references_met.size(), tap_references().size());
  EXPECT_EQ(filters_met.size(), find_setting("filter.kind").choices.size());
}

// Every filter's comparison is strict: a receiver at the stored depth is lit. If the stored depth is one float nearer
// to the light, the receiver is dark.
TEST_F(GlLookupTest, ATieIsLit) {
  std::mt19937 random(3);
  for (const LightKind kind : kinds) {
    const Scene scene = random_scene(random, kind);
    for (size_t f = 0; f < find_setting("filter.kind").choices.size(); ++f) {
      Settings settings;
      settings.map.resolution = 8;
      settings.map.wrap = Wrap::clamp_to_edge;
      settings.map.far_m = 40;
      settings.bias = {};
      settings.filter.kind = std::string(find_setting("filter.kind").choices[f]);
      if (kind_thrown([&] { validate(settings, kind); })) continue;
      load(scene, 1, 1);
      const LightFrame frame = make_light_frame(scene, settings);
      const float reference = renderer.probe({settings, frame}).reference[0];
      ASSERT_GT(reference, 0);
      const auto seen_with = [&](float depth) {
        return renderer.lookup(
            renderer.upload_map(Image<float>(8, frame.map_size().y, depth), settings.map, frame.map_shape()),
            {settings, frame})[0];
      };
      EXPECT_EQ(seen_with(reference), 1) << describe(settings);
      EXPECT_EQ(seen_with(std::nextafter(reference, 0.0f)), 0) << describe(settings);
    }
  }
}

// A map whose left half is dark, looked up across its middle. What each filter makes of this edge is computed from its
// definition.
TEST_F(GlLookupTest, AnEdgeThroughEachFilter) {
  Scene scene;
  scene.light = light_from_above();
  scene.camera = camera_from_above(4);
  add_floor(scene, 0, 4);
  load(scene, 128, 128);  // 8 pixels per texel; their centres lie at odd sixteenths
  Settings settings;
  settings.map.resolution = 16;
  settings.map.extent_m = 4;
  settings.map.near_m = 0;
  settings.map.far_m = 20;
  settings.map.wrap = Wrap::clamp_to_edge;
  settings.bias = {};
  Image<float> half(16, 16, 1.0f);
  const LightFrame frame = make_light_frame(scene, settings);
  const bool right_is_plus_x = frame.right.x > 0;
  for (int j = 0; j < 16; ++j)
    for (int i = 0; i < 8; ++i) half.at(i, j) = 0.25f;
  const ShadowMap map = renderer.upload_map(half, settings.map);
  const auto row = [&](FilterSettings filter) {
    settings.filter = filter;
    return renderer.lookup(map, {settings, frame});
  };
  // Along one axis: P at `at` texels is lit by the share of its taps that lie in texels 8 and up.
  const auto expect_edge = [&](FilterSettings filter, auto&& lit_at) {
    const Image<float> seen = row(filter);
    int fractions = 0;
    for (int x = 0; x < 128; ++x) {
      const double at = right_is_plus_x ? (x + 0.5) / 8 : 16 - (x + 0.5) / 8;
      ASSERT_NEAR(seen.at(x, 64), lit_at(at), sampler_error(renderer.info()))
          << find_setting("filter.kind").get(settings) << " at " << at;
      fractions += seen.at(x, 64) > 0 && seen.at(x, 64) < 1;
    }
    EXPECT_EQ(fractions > 0, filter.kind != "none");
  };
  const auto nearest = [](double at) { return std::floor(at) >= 8 ? 1.0 : 0.0; };
  const auto ramp = [](double at) { return std::clamp(at - 7.5, 0.0, 1.0); };
  expect_edge({"none", {}}, nearest);
  expect_edge({"box", {{"size", 3}}}, [&](double at) { return (nearest(at - 1) + nearest(at) + nearest(at + 1)) / 3; });
  expect_edge({"box", {{"size", 3}, {"step_texels", 2.5}}},
              [&](double at) { return (nearest(at - 2.5) + nearest(at) + nearest(at + 2.5)) / 3; });
  expect_edge({"hardware", {}}, ramp);
  const double g = std::exp(-1 / (2 * 0.8 * 0.8)), sum = 1 + 2 * g;
  expect_edge({"gaussian", {{"size", 3}, {"sigma_texels", 0.8}}},
              [&](double at) { return (g * ramp(at - 1) + ramp(at) + g * ramp(at + 1)) / sum; });
}

// A lone tilted plane. Its own map shadows it unless the comparison follows the plane: at the tap (then only the
// rounding of the tap to a texel is left), or at the texel's centre, where the map stores exactly that depth.
TEST_F(GlLookupTest, PlaneFormsFreeAPlaneOfAcne) {
  for (const LightKind kind : {LightKind::directional, LightKind::spot}) {
    Scene scene;
    scene.light = light_from_above();
    scene.light.kind = kind;
    scene.light.cone_deg = 40;
    scene.camera = camera_from_above(3);
    const double rise = 1.5;
    const glm::dvec3 u(8, 8 * rise, 0), v(0, 2, -8);
    add_quad(scene, "plane", -0.5 * (u + v), u, v);
    const ReceiverImage receivers = load(scene, 64, 64);
    Settings settings;
    settings.map.resolution = 64;
    settings.map.format = DepthFormat::d32f;
    settings.map.extent_m = 8;
    settings.map.near_m = 1;
    settings.map.far_m = 30;
    settings.filter.kind = "box";
    settings.filter["size"] = 5;
    const LightFrame frame = make_light_frame(scene, settings);
    const ShadowMap map = renderer.render_map({settings, frame});
    const auto dark_share = [&](const char* reference, double constant) {
      settings.bias.reference = reference;
      settings.bias["constant"] = constant;
      const Image<float> seen = renderer.lookup(map, {settings, frame});
      double dark = 0;
      for (float s : seen.pixels) dark += 1 - static_cast<double>(s);
      return dark / static_cast<double>(seen.size());
    };
    // Half a texel of the steepest depth gradient that any receiver has, along both axes.
    settings.bias.reference = "receiver_plane";
    const LookupProbe probe = renderer.probe({settings, frame});
    double half_texel = 0;
    for (size_t i = 0; i < probe.gradient.size(); ++i) {
      ASSERT_NE(receivers.primitive[i], no_primitive);
      half_texel = std::max(half_texel, 0.5 * (std::abs(probe.gradient[i].x) + std::abs(probe.gradient[i].y)));
    }
    // 2 last places of the rasteriser and a few of the shader (2^-24 each), times the kernel's reach.
    constexpr double float_error = 32 * 0x1p-24;
    EXPECT_GT(half_texel, 100 * float_error);
    EXPECT_GT(dark_share("own_depth", 0), 0.3) << "two fifths of the taps lie uphill";
    EXPECT_GT(dark_share("own_depth", 4 * half_texel), 0.01) << "its kernel needs five times as much";
    EXPECT_EQ(dark_share("own_depth", 5 * half_texel + float_error), 0);
    EXPECT_GT(dark_share("receiver_plane", 0), 0.3);
    EXPECT_GT(dark_share("receiver_plane", 0.7 * half_texel), 0.001);
    EXPECT_EQ(dark_share("receiver_plane", half_texel + float_error), 0);
    EXPECT_EQ(dark_share("texel_plane", float_error), 0);
  }
}

// The test finds the exact float at which a pixel turns lit. The comparison is strict: with one float less bias the
// pixel is dark.
TEST_F(GlLookupTest, TurnsAtTheExactFloat) {
  std::mt19937 random(29);
  const Scene scene = random_scene(random);
  const ReceiverImage receivers = load(scene, 64, 48);
  Settings settings;
  settings.map.resolution = 64;
  settings.map.near_m = 0;
  settings.map.far_m = 30;
  const LightFrame frame = make_light_frame(scene, settings);
  const ShadowMap map = renderer.render_map({settings, frame});
  const LookupProbe probe = renderer.probe({settings, frame});
  const Image<float> stored = renderer.read_map(map);
  int turned = 0;
  for (size_t i = 0; i < receivers.primitive.size() && turned < 40; i += 17) {
    if (receivers.primitive[i] == no_primitive) continue;
    const float reference = probe.reference[i], z = stored_at(stored, settings.map.wrap, probe.texel(i, 0));
    if (!(reference > z)) continue;
    float bias = reference - z;  // near the smallest that lights the pixel; then step to it
    while (reference - bias > z) bias = std::nextafter(bias, 1.0f);
    while (!(reference - std::nextafter(bias, 0.0f) > z)) bias = std::nextafter(bias, 0.0f);
    settings.bias["constant"] = bias;
    EXPECT_EQ(renderer.lookup(map, {settings, frame})[i], 1.0f) << bias;
    settings.bias["constant"] = std::nextafter(bias, 0.0f);
    EXPECT_EQ(renderer.lookup(map, {settings, frame})[i], 0.0f) << bias;
    ++turned;
  }
  EXPECT_EQ(turned, 40);
}

// A floor that extends far beyond the map. Every texel of the map stores 0.25, so the floor inside the map is dark. The
// corner of the picture is outside the map, and its result depends on the wrap.
TEST_F(GlLookupTest, OutsideTheMap) {
  Scene scene;
  scene.light = light_from_above();
  scene.camera = camera_from_above(8);
  add_floor(scene, 0, 4);
  load(scene, 16, 16);
  Settings settings;
  settings.map.resolution = 8;
  settings.map.extent_m = 2;  // the middle 4 x 4 pixels
  settings.map.near_m = 0;
  settings.map.far_m = 20;
  const auto at_rim = [&](Wrap wrap) {
    settings.map.wrap = wrap;
    const LightFrame frame = make_light_frame(scene, settings);
    const ShadowMap map = renderer.upload_map(Image<float>(8, 8, 0.25f), settings.map);
    const Image<float> visibility = renderer.lookup(map, {settings, frame});
    EXPECT_EQ(visibility.at(8, 8), settings.map.far_m == 20 ? 0.0f : 1.0f)
        << "inside the map: dark, or beyond far and lit";
    return visibility.at(0, 15);
  };
  EXPECT_EQ(at_rim(Wrap::clamp_to_border), 1.0f);
  EXPECT_EQ(at_rim(Wrap::clamp_to_edge), 0.0f);
  EXPECT_EQ(at_rim(Wrap::repeat), 0.0f);
  settings.map.far_m = 5;  // the floor is 10 m away: beyond far
  EXPECT_EQ(at_rim(Wrap::repeat), 1.0f);
}

TEST_F(GlLookupTest, BeyondFarIsLitOnlyWhenAsked) {
  Scene scene;
  scene.light = light_from_above();
  scene.camera = camera_from_above(2);
  add_floor(scene, 0, 4);
  const ReceiverImage receivers = load(scene, 8, 8);
  Settings settings;
  settings.map.resolution = 8;
  settings.map.extent_m = 8;
  settings.map.near_m = 0;
  settings.map.far_m = 5;
  const LightFrame frame = make_light_frame(scene, settings);
  const ShadowMap map = renderer.render_map({settings, frame});  // empty: all 1, and the reference is 2
  EXPECT_EQ(renderer.lookup(map, {settings, frame}).at(4, 4), 1.0f);
  settings.map.lit_beyond_far = false;
  EXPECT_EQ(renderer.lookup(map, {settings, frame}).at(4, 4), 0.0f);
}

TEST_F(GlLookupTest, ReceiversThatAreNotFiniteAreDark) {
  Scene scene;
  scene.light = light_from_above();
  Settings settings;
  settings.map.resolution = 2;
  settings.map.extent_m = 0.5;
  settings.map.near_m = 0;
  settings.map.far_m = 20;
  ReceiverImage receivers{Image<glm::vec3>(6, 1, glm::vec3(0)), Image<glm::vec3>(6, 1, glm::vec3(0, 1, 0)),
                          Image<uint32_t>(6, 1, 0u)};
  receivers.position[1].x = NAN;
  receivers.position[2].y = INFINITY;
  receivers.normal[3].z = NAN;
  receivers.position[4] = glm::vec3(3e38f);  // finite, but not after the matrix
  receivers.primitive[5] = no_primitive;
  const LightFrame frame = make_light_frame(scene, settings);
  renderer.load_receivers(receivers, {0, 5, 5});
  const ShadowMap map = renderer.upload_map(Image<float>(2, 2, 1.0f), settings.map);
  EXPECT_EQ(renderer.lookup(map, {settings, frame}).pixels, (std::vector<float>{1, 0, 0, 0, 0, 0}));
  const LookupProbe probe = renderer.probe({settings, frame});
  for (size_t i = 1; i < 6; ++i) EXPECT_EQ(probe.reference[i], 0.0f) << i;
}

// A receiver behind a spot light, or exactly at a point light, has no direction in which it can be looked up.
TEST_F(GlLookupTest, ReceiversWithoutAPlaceInTheMapAreDark) {
  Scene scene;
  scene.light.position_m = {0, 2, 0};
  scene.light.target_m = {0, 2, -1};
  ReceiverImage receivers{Image<glm::vec3>(4, 1), Image<glm::vec3>(4, 1, glm::vec3(0, 1, 0)),
                          Image<uint32_t>(4, 1, 0u)};
  receivers.position.pixels = {{0.1f, 1.9f, -3}, {0.1f, 1.9f, 3}, {0.5f, 2, 0}, {0, 2, 0}};
  renderer.load_receivers(receivers, {0, 5, 5});
  Settings settings;
  settings.map.resolution = 4;
  settings.map.near_m = 1;
  settings.map.far_m = 20;
  const auto seen_by = [&](LightKind kind) {
    scene.light.kind = kind;
    const LightFrame frame = make_light_frame(scene, settings);
    const LookupProbe probe = renderer.probe({settings, frame});
    for (size_t i = 0; i < 4; ++i) EXPECT_TRUE(std::isfinite(probe.n_dot_l[i]) && std::isfinite(probe.reference[i]));
    const Image<float> open(4, frame.map_size().y, 1.0f);
    return renderer.lookup(renderer.upload_map(open, settings.map, frame.map_shape()), {settings, frame}).pixels;
  };
  EXPECT_EQ(seen_by(LightKind::spot), (std::vector<float>{1, 0, 0, 0}));
  EXPECT_EQ(seen_by(LightKind::point), (std::vector<float>{1, 1, 1, 0}));
}

// The time is that of the work, not of the calls that start it: 961 taps cost more than one.
TEST_F(GlLookupTest, TimesIncludeTheWork) {
  std::mt19937 random(6);
  const Scene scene = random_scene(random);
  Settings settings;
  settings.map.resolution = 64;
  const LightFrame frame = make_light_frame(scene, settings);
  load(scene, 320, 180);
  const ShadowMap map = renderer.render_map({settings, frame});
  const auto fastest = [&](FilterSettings filter) {
    settings.filter = filter;
    double best = INFINITY;
    for (int k = 0; k < 3; ++k) {
      double ms = 0;
      renderer.lookup(map, {settings, frame}, &ms);
      best = std::min(best, ms);
    }
    return best;
  };
  // Seen: about 50 on llvmpipe. A GPU may be idle most of the time, because the picture is so small.
  const double least_ratio = renderer.info().software ? 5 : 1;
  EXPECT_GT(fastest({"box", {{"size", 31}}}), least_ratio * fastest({"none", {}}));
}

TEST_F(GlLookupTest, AMapOfAnotherResolutionIsADefect) {
  Scene scene;
  add_floor(scene, 0, 4);
  load(scene, 8, 8);
  Settings settings;
  settings.map.resolution = 8;
  const ShadowMap map = renderer.upload_map(Image<float>(8, 8, 1.0f), settings.map);
  settings.map.resolution = 16;
  EXPECT_EQ(kind_thrown([&] { renderer.lookup(map, {scene, settings}); }), static_cast<int>(ErrorKind::defect));
}

}  // namespace
}  // namespace noonmark::gl
