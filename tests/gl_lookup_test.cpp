// The lookup against a second implementation on the host that starts from what the probe and the map say.
#include <algorithm>
#include <cmath>

#include "gl_fixture.h"
#include "scenes/depth_bias.h"
#include "scenes/receivers.h"

namespace noonmark::gl {
namespace {

// Counts of what a comparison met, so that none of it passes for want of cases.
struct Met {
  size_t lit = 0, dark = 0, fractions = 0, outside = 0, beyond_far = 0, background = 0;
};

float wrapped(const Image<float>& map, Wrap wrap, int x, int y) {
  const int n = map.width;
  const auto repeat = [n](int t) { return ((t % n) + n) % n; };
  switch (wrap) {
    case Wrap::repeat:
      return map.at(repeat(x), repeat(y));
    case Wrap::clamp_to_edge:
      return map.at(std::clamp(x, 0, n - 1), std::clamp(y, 0, n - 1));
    case Wrap::clamp_to_border:
      break;
  }
  return x < 0 || y < 0 || x >= n || y >= n ? 1.0f : map.at(x, y);
}

Image<float> lookup_on_host(const LookupProbe& probe, const ReceiverImage& receivers, const Image<float>& map,
                            const DepthBias& bias, const Settings& s, Met& met) {
  const int radius = (kernel_size(s.filter) - 1) / 2, taps = kernel_size(s.filter) * kernel_size(s.filter);
  Image<float> visibility(receivers.width(), receivers.height());
  for (size_t i = 0; i < visibility.size(); ++i) {
    if (receivers.primitive[i] == no_primitive) {
      ++met.background;
      continue;
    }
    const float reference = probe.reference[i];
    float depth_bias = 0;
    if (bias.form == BiasForm::constant) depth_bias = bias.constant;
    if (bias.form == BiasForm::slope) {
      const float turned = 1.0f - probe.n_dot_l[i];
      const float scaled = bias.slope * turned;
      depth_bias = std::max(scaled, bias.floor);
    }
    const float biased = reference - depth_bias;
    int lit = 0;
    for (int y = -radius; y <= radius; ++y)
      for (int x = -radius; x <= radius; ++x)
        lit += !(biased > wrapped(map, s.map.wrap, probe.texel[i].x + x, probe.texel[i].y + y));
    if (reference > 1) ++met.beyond_far;
    if (s.map.lit_beyond_far && reference > 1) lit = taps;
    const glm::ivec2 t = probe.texel[i];
    met.outside += t.x < 0 || t.y < 0 || t.x >= map.width || t.y >= map.width;
    met.lit += lit == taps;
    met.dark += lit == 0;
    met.fractions += lit > 0 && lit < taps;
    visibility[i] = static_cast<float>(lit) / static_cast<float>(taps);
  }
  return visibility;
}

Scene random_scene(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Scene scene;
  add_floor(scene, 0, 6);
  for (int k = 0; k < 8; ++k) {
    const glm::dvec3 low(4 * unit(random), unit(random) * 0.5, 4 * unit(random));
    add_box(scene, "box", low,
            low + glm::dvec3(0.7 + 0.5 * unit(random), 1.2 + unit(random), 0.7 + 0.5 * unit(random)));
  }
  scene.light.position_m = {6 * unit(random), 6 + 2 * unit(random), 6 * unit(random)};
  scene.camera.eye_m = {5 * unit(random), 4, 8};
  return scene;
}

template <class T>
T one_of(std::mt19937& random, std::initializer_list<T> choices) {
  return *(choices.begin() + random() % choices.size());
}

Settings random_settings(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  Settings s;
  s.map.resolution = one_of(random, {1, 7, 32, 64, 100, 257, 1024});
  s.map.format = one_of(random, {DepthFormat::d16, DepthFormat::d24, DepthFormat::d32f});
  s.map.wrap = one_of(random, {Wrap::repeat, Wrap::clamp_to_edge, Wrap::clamp_to_border});
  s.map.cull = one_of(random, {CulledFaces::none, CulledFaces::back, CulledFaces::front});
  s.map.extent_scale = one_of(random, {0.05, 0.4, 1.0, 3.0});
  s.map.lit_beyond_far = random() % 2;
  s.map.near_m = 1 + unit(random);
  s.map.far_m = one_of(random, {6.0, 9.0, 30.0});
  s.bias.form = one_of(random, {BiasForm::none, BiasForm::constant, BiasForm::slope, BiasForm::normal_offset});
  s.bias.unit = one_of(random, {BiasUnit::depth, BiasUnit::m, BiasUnit::texel});
  s.bias.constant = 0.02 * unit(random);
  s.bias.slope = 0.1 * unit(random);
  s.bias.floor = 0.01 * unit(random);
  s.bias.normal_offset = 3 * unit(random);
  s.filter.kind = one_of(random, {FilterKind::none, FilterKind::box});
  s.filter.size = one_of(random, {1, 3, 5, 7, 31});
  return s;
}

void expect_same(const Image<float>& gpu, const Image<float>& host, const std::string& where) {
  ASSERT_EQ(gpu.size(), host.size());
  size_t different = 0, first = 0;
  for (size_t i = gpu.size(); i-- > 0;)
    if (!same_bits(gpu[i], host[i])) ++different, first = i;
  EXPECT_EQ(different, 0u) << where << ": first at index " << first << ", shader " << gpu[first] << ", host "
                           << host[first];
}

std::string describe(const Settings& s) {
  std::string text;
  for (const Setting& row : settings_table())
    if (!row.name.starts_with("scene") && !row.name.starts_with("view"))
      text += std::string(row.name) + "=" + row.get(s) + " ";
  return text;
}

class GlLookupTest : public GlTest {
 protected:
  ReceiverImage load(const Scene& scene, int width, int height) {
    renderer.load_scene(scene);
    return resolve_receivers(scene, scene.camera, renderer.render_primitives(scene.camera, width, height));
  }
};

TEST_F(GlLookupTest, EqualsTheHostBitForBit) {
  std::mt19937 random(1978);
  Met met;
  for (int k = 0; k < 8; ++k) {
    const Scene scene = random_scene(random);
    const ReceiverImage receivers = load(scene, 113, 67);
    for (int j = 0; j < 25; ++j) {
      const Settings settings = random_settings(random);
      const LightFrame frame = make_light_frame(scene, settings);
      renderer.load_receivers(receivers, frame.direction_to_light());
      const ShadowMap map = renderer.render_map(frame, settings.map);
      const DepthBias bias = depth_bias(frame, settings.bias);
      const LookupProbe probe = renderer.probe(frame, bias);
      const Image<float> host = lookup_on_host(probe, receivers, renderer.read_map(map), bias, settings, met);
      expect_same(renderer.lookup(map, frame, settings), host, describe(settings));
    }
  }
  constexpr size_t enough = 1000;
  EXPECT_GT(met.lit, enough);
  EXPECT_GT(met.dark, enough);
  EXPECT_GT(met.fractions, enough);
  EXPECT_GT(met.outside, enough);
  EXPECT_GT(met.beyond_far, enough);
  EXPECT_GT(met.background, enough);
}

// At the very float where a pixel's verdict turns: the comparison is strict, and one float less bias is dark.
TEST_F(GlLookupTest, TurnsAtTheExactFloat) {
  std::mt19937 random(29);
  const Scene scene = random_scene(random);
  const ReceiverImage receivers = load(scene, 64, 48);
  Settings settings;
  settings.map.resolution = 64;
  settings.map.near_m = 0;
  settings.map.far_m = 30;
  const LightFrame frame = make_light_frame(scene, settings);
  renderer.load_receivers(receivers, frame.direction_to_light());
  const ShadowMap map = renderer.render_map(frame, settings.map);
  const LookupProbe probe = renderer.probe(frame);
  const Image<float> stored = renderer.read_map(map);
  int turned = 0;
  for (size_t i = 0; i < receivers.primitive.size() && turned < 40; i += 17) {
    if (receivers.primitive[i] == no_primitive) continue;
    const float reference = probe.reference[i],
                z = wrapped(stored, settings.map.wrap, probe.texel[i].x, probe.texel[i].y);
    if (!(reference > z)) continue;
    float bias = reference - z;  // near the least one that lights the pixel; then walk to it
    while (reference - bias > z) bias = std::nextafter(bias, 1.0f);
    while (!(reference - std::nextafter(bias, 0.0f) > z)) bias = std::nextafter(bias, 0.0f);
    settings.bias.constant = bias;
    EXPECT_EQ(renderer.lookup(map, frame, settings)[i], 1.0f) << bias;
    settings.bias.constant = std::nextafter(bias, 0.0f);
    EXPECT_EQ(renderer.lookup(map, frame, settings)[i], 0.0f) << bias;
    ++turned;
  }
  EXPECT_EQ(turned, 40);
}

// The probe of a moved lookup is that of receivers which lie there; and no other form moves it, not even by a bit.
TEST_F(GlLookupTest, ProbeMovesWithTheNormalOffsetAlone) {
  std::mt19937 random(2011);
  const Scene scene = random_scene(random);
  const ReceiverImage receivers = load(scene, 96, 64);
  Settings settings;
  settings.map.resolution = 64;
  const LightFrame frame = make_light_frame(scene, settings);
  renderer.load_receivers(receivers, frame.direction_to_light());
  const LookupProbe unmoved = renderer.probe(frame);
  const auto expect_equal = [&](const LookupProbe& probe, const char* form) {
    for (size_t i = 0; i < receivers.primitive.size(); ++i) {
      ASSERT_TRUE(same_bits(probe.reference[i], unmoved.reference[i])) << form;
      ASSERT_EQ(probe.texel[i], unmoved.texel[i]) << form;
      ASSERT_TRUE(same_bits(probe.n_dot_l[i], unmoved.n_dot_l[i])) << form;
    }
  };
  expect_equal(renderer.probe(frame, {.form = BiasForm::constant, .constant = 0.1f}), "constant");
  expect_equal(renderer.probe(frame, {.form = BiasForm::slope, .slope = 0.1f, .floor = 0.1f}), "slope");
  expect_equal(renderer.probe(frame, {.form = BiasForm::normal_offset}), "normal_offset of 0");

  const float offset_m = 0.37f;
  const LookupProbe moved = renderer.probe(frame, {.form = BiasForm::normal_offset, .normal_offset_m = offset_m});
  // The shader's own float arithmetic: the host is built without contraction.
  ReceiverImage there = receivers;
  for (size_t i = 0; i < there.position.size(); ++i) there.position[i] += offset_m * there.normal[i];
  renderer.load_receivers(there, frame.direction_to_light());
  const LookupProbe expected = renderer.probe(frame);
  size_t elsewhere = 0;
  for (size_t i = 0; i < receivers.primitive.size(); ++i) {
    ASSERT_TRUE(same_bits(moved.reference[i], expected.reference[i]));
    ASSERT_EQ(moved.texel[i], expected.texel[i]);
    ASSERT_TRUE(same_bits(moved.n_dot_l[i], unmoved.n_dot_l[i])) << "the normal stays";
    elsewhere += moved.texel[i] != unmoved.texel[i];
  }
  EXPECT_GT(elsewhere, 1000u);
}

TEST_F(GlLookupTest, ProbeIsNearTheExactPlaces) {
  std::mt19937 random(3);
  const Scene scene = random_scene(random);
  const ReceiverImage receivers = load(scene, 96, 64);
  Settings settings;
  settings.map.resolution = 512;
  settings.map.extent_scale = 0.3;  // so that there are receivers on all sides of the map, at negative texels too
  const LightFrame frame = make_light_frame(scene, settings);
  renderer.load_receivers(receivers, frame.direction_to_light());
  const LookupProbe probe = renderer.probe(frame);
  // Four products and sums of magnitude below 4 in float: a few times 2^-22.
  constexpr double float_error = 2e-6;
  for (size_t i = 0; i < receivers.primitive.size(); ++i) {
    if (receivers.primitive[i] == no_primitive) {
      EXPECT_EQ(probe.reference[i], 0.0f);
      EXPECT_EQ(probe.texel[i], glm::ivec2(0));
      continue;
    }
    const glm::dvec3 p = frame.to_light(receivers.position[i]);
    ASSERT_NEAR(probe.reference[i], frame.window_depth(p.z), float_error);
    ASSERT_NEAR(probe.n_dot_l[i], glm::dot(glm::dvec3(receivers.normal[i]), frame.direction_to_light()), float_error);
    const glm::dvec2 place = (glm::dvec2(p) / frame.extent_m + 0.5) * 512.0;
    for (int k = 0; k < 2; ++k) {
      ASSERT_GE(place[k], probe.texel[i][k] - 512 * float_error);
      ASSERT_LE(place[k], probe.texel[i][k] + 1 + 512 * float_error);
    }
  }
}

// One floor that reaches far beyond a map whose every texel is darkened by a lid: what does the outside say?
TEST_F(GlLookupTest, OutsideTheMap) {
  Scene scene;
  scene.light = light_from_above();
  scene.camera = camera_from_above(8);
  add_floor(scene, 0, 4);
  const ReceiverImage receivers = load(scene, 16, 16);
  Settings settings;
  settings.map.resolution = 8;
  settings.map.extent_m = 2;  // the middle 4 x 4 pixels
  settings.map.near_m = 0;
  settings.map.far_m = 20;
  const auto at_rim = [&](Wrap wrap) {
    settings.map.wrap = wrap;
    const LightFrame frame = make_light_frame(scene, settings);
    renderer.load_receivers(receivers, frame.direction_to_light());
    const ShadowMap map = renderer.upload_map(Image<float>(8, 8, 0.25f), settings.map);
    const Image<float> visibility = renderer.lookup(map, frame, settings);
    EXPECT_EQ(visibility.at(8, 8), settings.map.far_m == 20 ? 0.0f : 1.0f) << "inside: dark, or beyond far";
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
  renderer.load_receivers(receivers, frame.direction_to_light());
  const ShadowMap map = renderer.render_map(frame, settings.map);  // empty: all 1, and the reference is 2
  EXPECT_EQ(renderer.lookup(map, frame, settings).at(4, 4), 1.0f);
  settings.map.lit_beyond_far = false;
  EXPECT_EQ(renderer.lookup(map, frame, settings).at(4, 4), 0.0f);
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
  renderer.load_receivers(receivers, frame.direction_to_light());
  const ShadowMap map = renderer.upload_map(Image<float>(2, 2, 1.0f), settings.map);
  EXPECT_EQ(renderer.lookup(map, frame, settings).pixels, (std::vector<float>{1, 0, 0, 0, 0, 0}));
  const LookupProbe probe = renderer.probe(frame);
  for (size_t i = 1; i < 6; ++i) EXPECT_EQ(probe.reference[i], 0.0f) << i;
}

TEST(DepthBiasTest, IsInWindowDepth) {
  LightFrame frame;
  frame.near_m = 2;
  frame.far_m = 12;
  frame.extent_m = 20;
  frame.resolution = 100;
  BiasSettings bias;
  bias.constant = 0.5;
  EXPECT_EQ(depth_bias(frame, bias).constant, 0.5f);
  bias.unit = BiasUnit::m;
  EXPECT_EQ(depth_bias(frame, bias).constant, 0.05f);
  bias.unit = BiasUnit::texel;
  EXPECT_EQ(depth_bias(frame, bias).constant, 0.01f);
  bias.form = BiasForm::slope;
  bias.slope = 3;
  bias.floor = 1;
  const DepthBias slope = depth_bias(frame, bias);
  EXPECT_FLOAT_EQ(slope.slope, 0.06f);
  EXPECT_FLOAT_EQ(slope.floor, 0.02f);
  EXPECT_EQ(slope.constant, 0.0f);
  bias.form = BiasForm::none;
  EXPECT_EQ(depth_bias(frame, bias).constant, 0.0f);
}

TEST_F(GlLookupTest, TimesArePositiveAndDifferentSizesFollowEachOther) {
  std::mt19937 random(5);
  const Scene scene = random_scene(random);
  Settings settings;
  settings.map.resolution = 64;
  settings.filter = {FilterKind::box, 5};
  const LightFrame frame = make_light_frame(scene, settings);
  for (const int width : {32, 200, 32}) {
    const ReceiverImage receivers = load(scene, width, 24);
    renderer.load_receivers(receivers, frame.direction_to_light());
    double ms = -1;
    const Image<float> seen = renderer.lookup(renderer.render_map(frame, settings.map), frame, settings, &ms);
    EXPECT_EQ(seen.width, width);
    EXPECT_GT(ms, 0);
  }
}

// The time is of the work done, not of the calls that ask for it: 961 taps cost more than one.
TEST_F(GlLookupTest, TimesIncludeTheWork) {
  std::mt19937 random(6);
  const Scene scene = random_scene(random);
  Settings settings;
  settings.map.resolution = 64;
  const LightFrame frame = make_light_frame(scene, settings);
  renderer.load_receivers(load(scene, 320, 180), frame.direction_to_light());
  const ShadowMap map = renderer.render_map(frame, settings.map);
  const auto fastest = [&](FilterSettings filter) {
    settings.filter = filter;
    double best = INFINITY;
    for (int k = 0; k < 3; ++k) {
      double ms = 0;
      renderer.lookup(map, frame, settings, &ms);
      best = std::min(best, ms);
    }
    return best;
  };
  // Seen: about 50 on llvmpipe. A GPU may be idle for most of so small a picture.
  const double least_ratio = renderer.info().software ? 5 : 1;
  EXPECT_GT(fastest({FilterKind::box, 31}), least_ratio * fastest({FilterKind::none, 1}));
}

TEST_F(GlLookupTest, AMapOfAnotherResolutionIsADefect) {
  Scene scene;
  add_floor(scene, 0, 4);
  renderer.load_receivers(load(scene, 8, 8), {0, 1, 0});
  Settings settings;
  settings.map.resolution = 8;
  const ShadowMap map = renderer.upload_map(Image<float>(8, 8, 1.0f), settings.map);
  settings.map.resolution = 16;
  EXPECT_EQ(kind_thrown([&] { renderer.lookup(map, make_light_frame(scene, settings), settings); }),
            static_cast<int>(ErrorKind::defect));
}

}  // namespace
}  // namespace noonmark::gl
