// The numbers that the shader computes before it compares, against the light's frame in double.
#include <array>

#include "gl/bias_text.h"
#include "technique/light_frame.h"
#include "technique/setting_rules.h"
#include "tests/gl/lookup_host.h"
#include "tests/support/bias_of.h"

namespace noonmark::gl {
namespace {

class GlProbeTest : public GlLookupTest {};

constexpr LightKind probed_kinds[] = {LightKind::directional, LightKind::spot, LightKind::point};

testing::AssertionResult same_probe(const LookupProbe& a, const LookupProbe& b, size_t i) {
  if (!same_bits(a.reference[i], b.reference[i]))
    return testing::AssertionFailure() << "receiver " << i << ": depth " << a.reference[i] << " and " << b.reference[i]
                                       << ", apart by " << (a.reference[i] - b.reference[i]) * 0x1p24f << " x 2^-24";
  if (a.texel(i, 0) != b.texel(i, 0))
    return testing::AssertionFailure() << "receiver " << i << ": texel " << a.texel(i, 0).x << " " << a.texel(i, 0).y
                                       << " and " << b.texel(i, 0).x << " " << b.texel(i, 0).y;
  for (int axis = 0; axis < 2 && a.map_texels.size() > 0; ++axis)
    if (!same_bits(a.map_texels[i][axis], b.map_texels[i][axis]))
      return testing::AssertionFailure() << "receiver " << i << ": place along axis " << axis << " "
                                         << a.map_texels[i][axis] << " and " << b.map_texels[i][axis] << " texels";
  return testing::AssertionSuccess();
}

// The probe of a moved lookup equals the probe of receivers at the moved places. No other part of a bias changes these
// numbers, not even by one bit.
TEST_F(GlProbeTest, MovesWithTheNormalOffsetAlone) {
  std::mt19937 random(2011);
  for (const LightKind kind : probed_kinds) {
    const Scene scene = random_scene(random, kind);
    const ReceiverImage receivers = load(scene, 96, 64);
    Settings settings;
    settings.map.resolution = 64;
    const LightFrame frame = make_light_frame(scene, settings);
    const LookupProbe unmoved = renderer.probe({settings, frame});
    for (const BiasSettings& bias : every_bias()) {
      settings.bias = bias;
      if (kind_thrown([&] { validate(settings, kind); }) || Bias(bias).moves_lookup()) continue;
      const LookupProbe probe = renderer.probe({settings, frame});
      for (size_t i = 0; i < receivers.primitive.size(); ++i) {
        ASSERT_TRUE(same_probe(probe, unmoved, i)) << bias_text_name(Bias(bias));
        ASSERT_TRUE(same_bits(probe.n_dot_l[i], unmoved.n_dot_l[i])) << bias_text_name(Bias(bias));
      }
    }
    settings.bias = bias_settings_of({{"normal_offset", 3}});
    const LookupProbe moved = renderer.probe({settings, frame});
    ReceiverImage there = receivers;
    const Bias bias(settings.bias);
    for (size_t i = 0; i < there.position.size(); ++i)
      there.position[i] = glm::vec3(bias.looked_up(frame, receivers.position[i], receivers.normal[i]));
    renderer.load_receivers(there, scene.camera.eye_m);
    settings.bias = {};
    const LookupProbe expected = renderer.probe({settings, frame});
    // Both places are floats of a few metres, each off by a few of its last places (2^-22 m). The map's 64 texels and
    // its depth change by less than 64 per metre.
    constexpr double float_error = 64 * 4 * 0x1p-22;
    size_t elsewhere = 0, other_texel = 0, seen = 0;
    for (size_t i = 0; i < receivers.primitive.size(); ++i) {
      if (expected.bias_unit[i] == 0 || unmoved.bias_unit[i] == 0 || moved.bias_unit[i] == 0) continue;
      ++seen;
      ASSERT_NEAR(moved.reference[i], expected.reference[i], float_error);
      ASSERT_TRUE(same_bits(moved.n_dot_l[i], unmoved.n_dot_l[i]))
          << "the normal and the light's direction do not change";
      other_texel += moved.texel(i, 0) != expected.texel(i, 0);
      elsewhere += moved.texel(i, 0) != unmoved.texel(i, 0);
      if (kind == LightKind::point) continue;
      for (int k = 0; k < 2; ++k) ASSERT_NEAR(moved.map_texels[i][k], expected.map_texels[i][k], float_error);
    }
    EXPECT_GT(elsewhere, 1000u);
    // A place within float_error of a texel's side may fall on either side of it.
    EXPECT_LE(static_cast<double>(other_texel), 4 * float_error * static_cast<double>(seen) + 3);
  }
}

TEST_F(GlProbeTest, IsNearTheExactPlaces) {
  std::mt19937 random(3);
  for (const LightKind kind : probed_kinds)
    for (const BiasUnit unit : {BiasUnit::depth, BiasUnit::m, BiasUnit::texel}) {
      const Scene scene = random_scene(random, kind);
      const ReceiverImage receivers = load(scene, 96, 64);
      Settings settings;
      settings.map.resolution = 512;
      // A small map, so that there are receivers outside it on all sides, also at negative texels.
      settings.map.extent_scale = kind == LightKind::point ? 1 : 0.3;
      settings.bias.unit = unit;
      if (kind == LightKind::point) {
        settings.filter.kind = "cube_disk";
        settings.filter["disk"] = 1;
      }
      const LightFrame frame = make_light_frame(scene, settings);
      const LookupProbe probe = renderer.probe({settings, frame});
      EXPECT_EQ(probe.cube_resolution, kind == LightKind::point ? 512 : 0);
      EXPECT_EQ(probe.map_texels.size() > 0, kind != LightKind::point);
      EXPECT_EQ(probe.radius.size() > 0, kind == LightKind::point);
      EXPECT_EQ(probe.gradient.size(), 0u);
      // A few products and sums of magnitudes below 16 m in float: an error of a few times 2^-20. In the map's depth it
      // is divided by far - near; in its texels it is multiplied by 512 over a few metres.
      constexpr double float_error = 4e-6;
      size_t seen = 0, steep = 0, outside = 0;
      for (size_t i = 0; i < receivers.primitive.size(); ++i) {
        const glm::dvec3 P = receivers.position[i], N = receivers.normal[i];
        const glm::dvec3 p = frame.to_light(P);
        if (receivers.primitive[i] == no_primitive || (kind == LightKind::spot && p.z <= 0)) {
          EXPECT_EQ(probe.reference[i], 0.0f);
          if (kind != LightKind::point) {
            EXPECT_EQ(probe.texel(i, 0), glm::ivec2(0));
          }
          continue;
        }
        ++seen;
        const double z = kind == LightKind::spot ? p.z : 1;
        const double steeper = std::max(1.0, frame.window_depth_slope(p));
        ASSERT_NEAR(probe.reference[i], frame.window_depth(p), steeper * float_error);
        const double n_dot_l = glm::dot(N, frame.direction_to_light(P));
        ASSERT_NEAR(probe.n_dot_l[i], n_dot_l, float_error);
        const double bias_unit = frame.depth_per_bias_unit(unit, p);
        if (unit == BiasUnit::depth) {
          ASSERT_EQ(probe.bias_unit[i], 1.0f);
        }
        ASSERT_NEAR(probe.bias_unit[i] / bias_unit, 1, float_error / std::min(z, 1.0));
        if (n_dot_l > 0.01) {  // tan is below 100, and its error is n_dot_l's times 1 / cos^2
          const double tan_theta = std::sqrt(1 - n_dot_l * n_dot_l) / n_dot_l;
          const double flat = std::max(tan_theta, 1e-3);  // near N = L the root turns an error into its root
          ASSERT_NEAR(probe.tan_theta[i], tan_theta, float_error * (1 / (n_dot_l * n_dot_l) + 1 / flat)) << n_dot_l;
          steep += tan_theta > 1;
        }
        if (kind == LightKind::point) {
          const double radius = (1 + glm::distance(scene.camera.eye_m, P) / frame.far_m) / 25;
          ASSERT_NEAR(probe.radius[i], radius, float_error);
          continue;
        }
        const glm::dvec2 place = frame.map_texels(frame.place(p));
        for (int k = 0; k < 2; ++k)
          ASSERT_NEAR(probe.map_texels[i][k], place[k],
                      512 * float_error * std::max(1.0, 4 / z) / frame.tan_half_fov + std::abs(place[k]) * float_error);
        outside += place.x < 0 || place.y < 0;
      }
      EXPECT_GT(seen, 1000u);
      EXPECT_GT(steep, 100u);
      if (kind != LightKind::point) {
        EXPECT_GT(outside, 100u);
      }
    }
}

// The gradient is that of the plane through P. The test computes it in double, from two steps along the plane as the
// light sees them. Window depth is affine in texels, under a perspective too.
TEST_F(GlProbeTest, GradientIsThePlanes) {
  std::mt19937 random(2006);
  for (const LightKind kind : {LightKind::directional, LightKind::spot}) {
    const Scene scene = random_scene(random, kind);
    const ReceiverImage receivers = load(scene, 96, 64);
    Settings settings;
    settings.map.resolution = 300;
    settings.bias.reference = "texel_plane";
    const LightFrame frame = make_light_frame(scene, settings);
    const LookupProbe probe = renderer.probe({settings, frame});
    ASSERT_EQ(probe.gradient.size(), receivers.primitive.size());
    EXPECT_EQ(probe.tap_reference->name, "texel_plane");
    size_t seen = 0, tilted = 0;
    for (size_t i = 0; i < receivers.primitive.size(); ++i) {
      const glm::dvec3 P = receivers.position[i], N = receivers.normal[i];
      if (probe.bias_unit[i] == 0 || std::abs(probe.n_dot_l[i]) < 0.05) continue;  // 1 / 0.05 is in the tolerance
      const glm::dvec3 side =
          glm::normalize(glm::cross(N, std::abs(N.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
      const auto seen_at = [&](glm::dvec3 world) {
        const glm::dvec3 p = frame.to_light(world);
        return glm::dvec3(frame.map_texels(frame.place(p)), frame.window_depth(p));
      };
      constexpr double step_m = 1e-3;
      const glm::dvec3 o = seen_at(P), a = seen_at(P + step_m * side) - o,
                       b = seen_at(P + step_m * glm::cross(N, side)) - o;
      const double area = a.x * b.y - a.y * b.x;
      const glm::dvec2 expected((a.z * b.y - b.z * a.y) / area, (a.x * b.z - b.x * a.z) / area);
      // The float rounding of N and of the matrix, magnified by 1 / N.L.
      const double float_error = 1e-6 / 0.05 * glm::length(expected) + 1e-9;
      ASSERT_NEAR(probe.gradient[i].x, expected.x, float_error);
      ASSERT_NEAR(probe.gradient[i].y, expected.y, float_error);
      ++seen;
      tilted += std::abs(expected.x) > 1e-3 && std::abs(expected.y) > 1e-3;
    }
    EXPECT_GT(seen, 1000u);
    EXPECT_GT(tilted, 300u);
  }
}

// The texel of a cube map's tap is the one that the frame finds in double, except for taps within float error of a
// texel's side.
TEST_F(GlProbeTest, CubeTapsFallWhereTheFrameSays) {
  std::mt19937 random(64);
  for (const std::string filter : {"none", "cube_grid", "cube_disk"})
    for (const int disk : {0, 1, 2}) {
      const bool turned = disk == 2;
      const Scene scene = random_scene(random, LightKind::point);
      // 64 taps of 320 x 240 pixels are read back in two strips.
      const bool large = filter == "cube_grid" && disk == 0;
      const ReceiverImage receivers = large ? load(scene, 320, 240) : load(scene, 64, 48);
      Settings settings;
      settings.map.resolution = 100;
      settings.filter.kind = filter;
      settings.filter["disk"] = disk % 2;
      if (turned) settings.map.turn_deg = glm::dvec3(30, -100, 12);
      const LightFrame frame = make_light_frame(scene, settings);
      const LookupProbe probe = renderer.probe({settings, frame});
      size_t taps = 0, elsewhere = 0, moved = 0;
      std::array<size_t, 6> faces{};
      for (size_t i = 0; i < receivers.primitive.size(); ++i) {
        if (receivers.primitive[i] == no_primitive) continue;
        const glm::dvec3 p = frame.to_light(receivers.position[i]);
        for (int tap = 0; tap < probe.taps(); ++tap) {
          const glm::dvec2 exact = frame.map_texels(frame.tap_place(p, probe.offset(i, tap)));
          const glm::ivec2 texel = probe.texel(i, tap);
          ++taps;
          elsewhere += texel != glm::ivec2(glm::floor(exact));
          moved += texel != probe.texel(i, 0);
          ++faces[static_cast<size_t>(texel.y / 100)];
        }
      }
      EXPECT_GT(taps, 1000u);
      // Places among 100 texels are floats: one tap in some thousands lies so near to a side that it may fall on
      // either.
      EXPECT_LE(elsewhere, taps / 1000 + 2);
      EXPECT_EQ(moved > taps / 4, filter != "none");
      EXPECT_GE(std::count_if(faces.begin(), faces.end(), [](size_t n) { return n > 20; }), 4);
    }
}

// A picture of more than a million pixels is probed in bands of rows. Its numbers are those of its upper and its lower part.
TEST_F(GlProbeTest, GivesTheSameNumbersInBands) {
  std::mt19937 random(78);
  const int width = 2048, height = 1100, upper = 700;  // bands of 512 rows
  for (const LightKind kind : {LightKind::directional, LightKind::point}) {
    const Scene scene = random_scene(random, kind);
    const ReceiverImage receivers = load(scene, width, height);
    Settings settings;
    settings.map.resolution = 100;
    if (kind == LightKind::point) {
      settings.filter.kind = "cube_disk";
      settings.filter["disk"] = 1;  // the radius grows with the distance from the view
    } else {
      settings.bias.reference = "receiver_plane";
    }
    const LightFrame frame = make_light_frame(scene, settings);
    const LookupProbe whole = renderer.probe({settings, frame});
    ASSERT_EQ(whole.reference.size(), size_t{width} * height);
    ASSERT_EQ(whole.radius.size(), kind == LightKind::point ? size_t{width} * height : 0);
    size_t asked = 0;
    for (const auto& [first, end] : {std::pair(0, upper), std::pair(upper, height)}) {
      const auto rows = [&, first = first, end = end](const auto& image) {
        auto part = image;
        part.height = end - first;
        part.pixels.assign(image.pixels.begin() + first * width, image.pixels.begin() + end * width);
        return part;
      };
      Image<uint32_t> pixels(width, end - first);
      for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<uint32_t>(i + size_t(first) * width);
      renderer.load_receivers({rows(receivers.position), rows(receivers.normal), rows(receivers.primitive)},
                              scene.camera.eye_m, &pixels);
      const LookupProbe part = renderer.probe({settings, frame});
      EXPECT_EQ(part.reference.pixels, rows(whole.reference).pixels);
      EXPECT_EQ(part.n_dot_l.pixels, rows(whole.n_dot_l).pixels);
      EXPECT_EQ(part.bias_unit.pixels, rows(whole.bias_unit).pixels);
      EXPECT_EQ(part.tan_theta.pixels, rows(whole.tan_theta).pixels);
      if (kind == LightKind::point) {
        EXPECT_EQ(part.radius.pixels, rows(whole.radius).pixels);
        EXPECT_EQ(part.cube_middle.pixels, rows(whole.cube_middle).pixels);
      } else {
        EXPECT_TRUE(part.map_texels.pixels == rows(whole.map_texels).pixels);
        EXPECT_TRUE(part.gradient.pixels == rows(whole.gradient).pixels);
      }
      for (size_t i = 0; i < part.reference.size(); ++i) asked += part.asks(i);
    }
    EXPECT_GT(asked, size_t{width} * height / 10);
  }
}

// The receivers of a large picture leave the device and come back.
TEST_F(GlProbeTest, ReleasedReceiversAreLoadedAgain) {
  std::mt19937 random(79);
  const Scene scene = random_scene(random, LightKind::directional);
  const ReceiverImage receivers = load(scene, 96, 64);
  Settings settings;
  settings.map.resolution = 100;
  const LightFrame frame = make_light_frame(scene, settings);
  const ShadowMap map = renderer.render_map({settings, frame});
  const Image<float> lit = renderer.lookup(map, {settings, frame});
  const LookupProbe probe = renderer.probe({settings, frame});
  renderer.release_receivers();
  EXPECT_THROW(renderer.probe({settings, frame}), std::logic_error);
  EXPECT_THROW(renderer.lookup(map, {settings, frame}), std::logic_error);
  renderer.load_receivers(receivers, scene.camera.eye_m);
  EXPECT_EQ(renderer.lookup(map, {settings, frame}).pixels, lit.pixels);
  EXPECT_EQ(renderer.probe({settings, frame}).reference.pixels, probe.reference.pixels);
}

// A picture with many taps is measured strip by strip, so strips must give the same texels.
TEST_F(GlProbeTest, GivesTheSameTexelsInStrips) {
  std::mt19937 random(77);
  for (const LightKind kind : probed_kinds) {
    const Scene scene = random_scene(random, kind);
    const ReceiverImage receivers = load(scene, 64, 50);
    Settings settings;
    settings.map.resolution = 100;
    settings.filter.kind = kind == LightKind::point ? "cube_disk" : "box";
    settings.filter["size"] = 3;
    const LightFrame frame = make_light_frame(scene, settings);
    const LookupProbe whole = renderer.probe({settings, frame});
    LookupProbe probe = renderer.probe({settings, frame}, ProbeTaps::none);
    EXPECT_EQ(probe.holds({0, 64}), kind != LightKind::point) << "the texels of a flat map follow from P";
    for (size_t i = 0; i < receivers.primitive.size(); ++i)
      ASSERT_EQ(probe.middle_texel(i), whole.texel(i, whole.taps() / 2));
    for (const PixelRange strip : {PixelRange{64 * 20, 64 * 50}, {0, 64}, {64, 64 * 20}}) {
      renderer.probe_strip(probe, {settings, frame}, strip);
      ASSERT_TRUE(probe.holds(strip));
      for (size_t i = strip.first; i < strip.end; ++i)
        for (int tap = 0; tap < whole.taps(); ++tap) ASSERT_EQ(probe.texel(i, tap), whole.texel(i, tap));
    }
    if (kind == LightKind::point) {
      EXPECT_THROW(renderer.probe_strip(probe, {settings, frame}, {1, 64}), std::logic_error);
    }
  }
}

}  // namespace
}  // namespace noonmark::gl
