// Finds out why pixels are wrong. The evidence comes from another program (here it is written by hand); the ladder and
// the bounds are Noonmark's. Ends with 0 if the causes are those for which the evidence was made.
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "compare/judge/bounds.h"
#include "compare/ladder/bias_curves.h"
#include "compare/ladder/ladder.h"

using namespace noonmark;

int main() {
  // A row of pixels with one texel each, without a filter. map: the stored depth; reference: the depth of the pixel.
  struct Pixel {
    float map, reference;
    bool lit, texel_lit;  // by rays: at the pixel, and at the centre of its texel
    Cause expected;
  };
  const std::vector<Pixel> pixels = {
      {0.50f, 0.25f, true, true, Cause::none},   // nearer than the stored depth: lit, which is right
      {0.50f, 0.625f, true, true, Cause::acne},  // the stored depth is nearer than a pixel of the same surface
      {0.50f, 0.53125f, false, false, Cause::peter_panning},  // the bias is larger than its distance to the occluder
      {0.25f, 0.75f, true, false, Cause::aliasing_dark},      // a shadow's edge runs between the pixel and the centre
  };
  const int count = static_cast<int>(pixels.size());
  BiasSettings bias;
  bias["constant"] = 0.0625;  // window depth

  ReceiverTruth truth;
  truth.facing = Image<uint8_t>(count, 1, 1);
  truth.lit = truth.ambiguous = Image<uint8_t>(count, 1, 0);
  truth.soft = Image<float>(count, 1);
  LookupProbe probe;
  probe.pattern.taps = 1;
  probe.pattern.offsets = {{0, 0, 0}};
  probe.reference = probe.tan_theta = Image<float>(count, 1);
  probe.n_dot_l = probe.bias_unit = Image<float>(count, 1, 1);
  probe.map_texels = Image<glm::vec2>(count, 1);
  TapTruth taps;
  taps.taps.resize(pixels.size());
  Image<float> depths(count, count, 1), shown(count, 1);
  for (size_t i = 0; i < pixels.size(); ++i) {
    const Pixel& pixel = pixels[i];
    const int x = static_cast<int>(i);
    truth.lit[i] = pixel.lit;
    truth.soft[i] = pixel.lit;
    probe.reference[i] = pixel.reference;
    probe.map_texels[i] = {static_cast<float>(x) + 0.5f, 0.5f};
    taps.taps[i] = static_cast<uint8_t>((pixel.lit ? tap_exact_lit : 0) | (pixel.texel_lit ? tap_texel_lit : 0));
    depths.at(x, 0) = pixel.map;
    shown[i] = pixel.reference - 0.0625f > pixel.map ? 0 : 1;  // the result of the other program's shader
  }
  const MapDepths map(depths);
  MapSettings settings;
  settings.resolution = count;
  const LookupEvidence evidence{truth, probe, taps, map, settings, Bias(bias), shown, shown};

  bool as_expected = true;
  const Ladder ladder = climb(evidence);
  PointRecord point;
  for (size_t i = 0; i < pixels.size(); ++i) {
    const Cause cause = static_cast<Cause>(ladder.cause[i]);
    std::printf("pixel %zu: %s\n", i, std::string(cause_name(cause)).c_str());
    as_expected = as_expected && cause == pixels[i].expected;
    if (cause == Cause::acne) point.metrics["acne"] += 1.0 / count;
  }

  // The curve gives the result of every bias, from the same lookup. The pixel with acne needs the bias 0.625 - 0.5. The
  // compared float is near 0.5, so rounding can lower this by half of its last place.
  const float rounding = 0x1p-25f;
  const BiasCounts curve(evidence, map, *curve_part(bias));
  std::printf("free of acne from a bias of %g on\n", static_cast<double>(curve.acne_free_from(0)));
  as_expected = as_expected && std::abs(curve.acne_free_from(0) - 0.125f) <= rounding;

  Bound bound;
  bound.metric = "acne";
  bound.max = 0.01;
  const auto nothing = [](const PointRecord&) { return std::string("consumer"); };
  const BoundResult result = evaluate_bounds({&point, 1}, {&bound, 1}, nothing).at(0);
  std::printf("%s: %s\n", bound_text(result).c_str(), result.held ? "held" : "broken");
  return as_expected && !result.held && ladder.residual < 1e-6 ? 0 : 1;
}
