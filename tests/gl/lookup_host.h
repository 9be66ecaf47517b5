// A second implementation of the lookup, on the host, from the numbers of the probe and the map; and random scenes to
// compare them in.
#pragma once
#include <algorithm>
#include <cmath>

#include "scenes/camera_fit.h"
#include "scenes/receivers.h"
#include "technique/bias.h"
#include "technique/filters.h"
#include "technique/map_address.h"
#include "technique/setting_rules.h"
#include "tests/gl/fixture.h"

namespace noonmark::gl {

// Counts of the cases that a comparison met, so that it cannot pass because a case never occurred.
struct Met {
  size_t lit = 0, dark = 0, fractions = 0, outside = 0, beyond_far = 0, background = 0;
};

inline float stored_at(const Image<float>& map, Wrap wrap, glm::ivec2 texel) {
  const glm::ivec2 at = wrapped(texel, {map.width, map.height}, wrap);
  return at.x < 0 ? border_depth : map.at(at.x, at.y);
}

// A step of a fixed-point depth format; 0 for floats.
inline double step_of(DepthFormat format) {
  return format == DepthFormat::d16 ? 1.0 / 65535 : format == DepthFormat::d24 ? 1.0 / 16777215 : 0;
}

// Computed in floats as in the shader; for bilinear patterns in double. ties: the weight of the taps whose verdict may be
// either, because a sampler may round the reference to the map's fixed-point format before it compares.
inline Image<double> lookup_on_host(const LookupProbe& probe, const ReceiverImage& receivers, const Image<float>& map,
                                    const Settings& s, Met& met, Image<double>* ties = nullptr) {
  const Bias bias(s.bias);
  Image<double> visibility(receivers.width(), receivers.height());
  if (ties) *ties = Image<double>(receivers.width(), receivers.height());
  for (size_t i = 0; i < visibility.size(); ++i) {
    // The probe is all zeros where there is no receiver, or where the receiver lies behind the light.
    if (receivers.primitive[i] == no_primitive || probe.bias_unit[i] == 0) {
      ++met.background;
      continue;
    }
    const float depth_bias = bias.at(probe, i);
    int lit = 0;
    double weighted = 0;
    for (int tap = 0; tap < probe.taps(); ++tap) {
      const glm::ivec2 texel = probe.texel(i, tap);
      float biased = probe.tap_depth(i, tap) - depth_bias;
      // OpenGL 4.5, 8.23.1: the sampler clamps the reference when the map has fixed-point depths.
      if (probe.pattern.bilinear() && s.map.format != DepthFormat::d32f) biased = std::clamp(biased, 0.0f, 1.0f);
      const float stored = stored_at(map, s.map.wrap, texel);
      const bool tap_lit = !(biased > stored);
      if (ties && std::abs(static_cast<double>(biased) - stored) <= step_of(s.map.format))
        (*ties)[i] += probe.weight(i, tap);
      lit += tap_lit;
      weighted += tap_lit ? probe.weight(i, tap) : 0;
      met.outside += !inside_map(texel, {map.width, map.height});
    }
    if (probe.reference[i] > 1) {
      ++met.beyond_far;
      if (s.map.lit_beyond_far) lit = probe.taps(), weighted = 1;
    }
    met.lit += lit == probe.taps();
    met.dark += lit == 0;
    met.fractions += lit > 0 && lit < probe.taps();
    visibility[i] = probe.pattern.bilinear() ? weighted : static_cast<float>(lit) / static_cast<float>(probe.taps());
  }
  return visibility;
}

inline Scene random_scene(std::mt19937& random, LightKind kind = LightKind::directional) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Scene scene;
  add_floor(scene, 0, 6);
  for (int k = 0; k < 8; ++k) {
    const glm::dvec3 low(4 * unit(random), unit(random) * 0.5, 4 * unit(random));
    add_box(scene, "box", low,
            low + glm::dvec3(0.7 + 0.5 * unit(random), 1.2 + unit(random), 0.7 + 0.5 * unit(random)));
  }
  scene.light.kind = kind;
  scene.light.position_m = {6 * unit(random), 6 + 2 * unit(random), 6 * unit(random)};
  if (kind == LightKind::point) scene.light.position_m = {2 * unit(random), 3 + unit(random), 2 * unit(random)};
  scene.light.cone_deg = 70;
  scene.camera.eye_m = {5 * unit(random), 4, 8};
  return scene;
}

template <class T>
T one_of(std::mt19937& random, std::initializer_list<T> choices) {
  return *(choices.begin() + random() % choices.size());
}

// Random settings that are allowed with the kind of light.
inline Settings random_settings(std::mt19937& random, LightKind kind) {
  std::uniform_real_distribution<double> unit(0, 1);
  Settings s;
  s.map.resolution = one_of(random, {1, 7, 32, 64, 100, 257, 1024});
  s.map.format = one_of(random, {DepthFormat::d16, DepthFormat::d24, DepthFormat::d32f});
  s.map.wrap = one_of(random, {Wrap::repeat, Wrap::clamp_to_edge, Wrap::clamp_to_border});
  s.map.cull = one_of(random, {CulledFaces::none, CulledFaces::back, CulledFaces::front});
  s.map.extent_scale = one_of(random, {0.05, 0.4, 1.0, 3.0});
  s.map.lit_beyond_far = random() % 2;
  s.map.depth_clamp = random() % 2;
  s.map.near_m = 1 + unit(random);
  s.map.far_m = one_of(random, {6.0, 9.0, 30.0});
  s.bias.unit = one_of(random, {BiasUnit::depth, BiasUnit::m, BiasUnit::texel});
  const auto maybe = [&](double most) { return random() % 2 ? most * unit(random) : 0; };
  s.bias["constant"] = maybe(0.02);
  s.bias["slope"] = maybe(0.1);
  s.bias["slope_floor"] = maybe(0.01);
  s.bias["tan"] = maybe(0.02);
  s.bias["tan_floor"] = maybe(0.01);
  if (random() % 2) s.bias["tan_cap"] = s.bias["tan_floor"] + 0.05 * unit(random);
  s.bias["polygon_factor"] = maybe(2);
  s.bias["polygon_units"] = maybe(10);
  for (const BiasPart& part : bias_parts())
    if (part.formula.way && random() % 8 == 0) s.bias[part.name] = 3 * unit(random);
  if (random() % 2) s.bias.plane_cap = 0.01 * unit(random);
  // Every parameter within its range, and those whose range is too wide for a small map again.
  for (const KindParameter* p : FilterTable::parameters()) {
    const bool real = p->type == ValueType::real;
    const double low = p->choices.empty() ? p->min : 0;
    const double high = p->type == ValueType::flag ? 1 : p->choices.empty() ? p->max : double(p->choices.size() - 1);
    s.filter[p->name()] = real ? low + (high - low) * unit(random) : low + std::floor((high - low + 1) * unit(random));
  }
  s.filter["size"] = one_of(random, {1, 3, 3, 5, 5, 7, 31});
  s.filter["step_texels"] = one_of(random, {0.5, 1.0, 1.7, 3.0});
  s.filter["sigma_texels"] = one_of(random, {0.5, 1.0, 4.0});
  s.filter["radius_texels"] = 0.5 + 5 * unit(random);
  s.filter["offset_m"] = 0.02 + 0.2 * unit(random);
  s.filter["radius_m"] = 0.01 + 0.1 * unit(random);
  if (kind == LightKind::point && random() % 2)
    s.map.turn_deg = glm::dvec3(unit(random), unit(random), unit(random)) * 200.0 - 100.0;
  do {
    s.bias.reference = std::string(tap_references()[random() % tap_references().size()].name);
    s.filter.kind = std::string(filters()[random() % filters().size()].name);
  } while (kind_thrown([&] { validate(s, kind); }));
  return s;
}

inline std::string describe(const Settings& s) {
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
    ViewSettings view;
    view.width_px = width;
    view.height_px = height;
    const Camera camera = effective_camera(scene, view);
    const ReceiverImage receivers = resolve_receivers(scene, camera, renderer.render_primitives(camera, width, height));
    renderer.load_receivers(receivers, scene.camera.eye_m);
    return receivers;
  }
};

}  // namespace noonmark::gl
