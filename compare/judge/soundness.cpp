#include "compare/judge/soundness.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "compare/judge/map_distance.h"
#include "compare/ladder/numbers.h"
#include "compare/ladder/probe_errors.h"
#include "compare/ladder/receiver_taps.h"
#include "compare/results/metrics.h"
#include "compare/results/point_settings.h"
#include "compare/results/quantities.h"
#include "technique/depth_format.h"
#include "technique/lookups.h"

namespace noonmark {
namespace {

// Of fewer texels the depths may have no spread although a slope is there, which a rasteriser's grid moves.
constexpr size_t enough_texels = 100;

// Whether `visibility` is what the technique's definition gives for the probe and a map whose depths are of `format`.
// If all taps have the same weight, it must be the number of lit taps, divided, bit for bit.
bool holds(const LookupEvidence& e, const ReceiverTaps& taps, float bias, const MapDepths& map, DepthFormat format,
           size_t i, float visibility) {
  if (!e.probe.pattern.bilinear()) {
    size_t lit = 0;
    if (taps.by_depth())
      lit = taps.lit_on(map, bias);
    else
      for (size_t t = 0; t < taps.size(); ++t) lit += taps.on(map, format, t).lit(bias);
    return visibility == static_cast<float>(lit) / static_cast<float>(taps.size());
  }
  // A sampler's comparison may round the reference to the map's fixed-point format. So within one step of the depth
  // both verdicts are right.
  double least = 0, most = 0;
  for (size_t t = 0; t < taps.size(); ++t) {
    const Tap tap = taps.on(map, format, t);
    const bool lit = tap.lit(bias);
    const bool tie = format != DepthFormat::d32f && !tap.always_lit &&
                     std::abs(static_cast<double>(tap.reference - bias) - tap.depth) <= depth_step(format, tap.depth);
    if (lit && !tie) least += tap.weight;
    if (lit || tie) most += tap.weight;
  }
  // The sampler's weights have 8 bits. They come from an address that is a rounded division, which has an error of 8 u
  // of the address in texels. Visibility changes by at most 1 per texel along each of two axes.
  const glm::dvec2 at = glm::abs(glm::dvec2(e.probe.map_texels[i]));
  const double weights = 2 * (0x1p-8 + 8 * 0x1p-24 * std::max({at.x, at.y, static_cast<double>(map.size().x)}));
  return visibility >= least - weights && visibility <= most + weights;
}

}  // namespace

void SoundnessCheck::receiver(size_t i, const ReceiverTaps& taps, Part& part) const {
  const LookupEvidence& e = in_.evidence;
  const float bias = e.bias.at(e.probe, i);
  ++part.facing;
  // Uploaded maps are 32-bit float, whatever format the settings name.
  if (!e.probe.pattern.blurred)  // what a filtered map shows is checked stage by stage
    part.broken += !(holds(e, taps, bias, e.exact_map, DepthFormat::d32f, i, e.r4[i]) &&
                     holds(e, taps, bias, in_.stored_map, e.map.format, i, e.r5[i]) &&
                     holds(e, taps, bias, in_.ties, DepthFormat::d32f, i, in_.tie_lookup[i]));
  if (!in_.known_probe) check_.compare(i, part.probe);
}

void SoundnessCheck::join(const Part& part) {
  found_.facing += part.facing;
  found_.broken += part.broken;
  raise_error(found_.probe.excess, part.probe.excess);
  raise_error(found_.probe.address_texels, part.probe.address_texels);
  raise_error(found_.probe.reference_m, part.probe.reference_m);
}

SoundnessCheck::MapFound SoundnessCheck::compare_maps() const {
  const SoundnessInput& in = in_;
  const MapDepths& exact = in.evidence.exact_map;
  const glm::ivec2 size = exact.size();
  const auto across = static_cast<size_t>(size.x);
  // One bit for each texel: a map has many more texels than a small picture asks for. They are read in their order in the
  // map, because which format could have stored them all depends on it.
  std::vector<uint64_t> asked((across * static_cast<size_t>(size.y) + 63) / 64);
  for (size_t i = 0; i < in.evidence.truth.facing.size(); ++i) {
    if (!in.evidence.truth.facing[i]) continue;
    const glm::ivec2 texel = in.evidence.probe.middle_texel(i);
    if (!inside_map(texel, size)) continue;
    const size_t at = static_cast<size_t>(texel.y) * across + static_cast<size_t>(texel.x);
    asked[at / 64] |= uint64_t{1} << at % 64;
  }
  std::vector<double> errors;
  MapDistance apart(in.frame, in.evidence.map.format);
  MapFound found;
  const auto compare = [&](size_t i) {
    const glm::ivec2 texel(i % across, i / across);
    const float stored = in.stored_map.at(texel), right = exact.at(texel);
    const double error = std::abs(static_cast<double>(stored) - right);
    errors.push_back(std::isnan(error) ? infinity : error / depth_step(in.evidence.map.format, right));
    apart.add(texel, right, stored);
    if (found.bits == 16 && !is_held_by(DepthFormat::d16, stored)) found.bits = 24;
    if (found.bits == 24 && !is_held_by(DepthFormat::d24, stored)) found.bits = 32;
  };
  for (size_t word = 0; word < asked.size(); ++word)
    for (uint64_t left = asked[word]; left != 0; left &= left - 1)
      compare(64 * word + static_cast<size_t>(std::countr_zero(left)));
  if (errors.empty()) return found;  // no texel of the map was read
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  found.error_quanta = *middle;
  if (apart.texels() >= enough_texels) found.excess = apart.excess();
  return found;
}

MapDepths tie_map(const LookupEvidence& e) {
  MapDepths map(e.exact_map.texels, 1, 1);
  for (size_t i = 0; i < e.truth.facing.size(); ++i) {
    if (!e.truth.facing[i]) continue;
    const glm::ivec2 texel = e.probe.middle_texel(i);
    const glm::ivec2 read = wrapped(texel, map.size(), e.map.wrap);
    if (read.x < 0) continue;
    const float biased = e.probe.tap_depth(i, e.probe.middle_tap()) - e.bias.at(e.probe, i);
    const float depth = (read.x + read.y) % 2 ? std::nextafter(biased, -1.0f) : biased;
    if (depth > 0 && depth <= 1) map.depth[map.texels->index(read)] = depth;
  }
  return map;
}

SoundnessCheck::SoundnessCheck(const SoundnessInput& in)
    : in_(in), check_(in.evidence, in.receivers, in.frame, in.eye_m) {
  if (in.known_probe) found_.probe = *in.known_probe;
}

void SoundnessCheck::add(PixelRange strip) { read_taps(in_.evidence, strip, *this); }

std::map<std::string, double> SoundnessCheck::metrics() const {
  const MapFound map = compare_maps();
  const auto measured = [&](double value) {
    return found_.facing == 0 ? std::numeric_limits<double>::quiet_NaN() : value;
  };
  return {
      {"contract", measured(static_cast<double>(found_.broken) / static_cast<double>(found_.facing))},
      {"rounding_excess", measured(found_.probe.excess)},
      {"address_error_texels", measured(found_.probe.address_texels)},
      {"reference_error_m", measured(found_.probe.reference_m)},
      {"map_error_quanta", measured(map.error_quanta)},
      {"map_excess", measured(map.excess)},
      {"map_bits", measured(map.bits)},
  };
}

std::map<std::string, double> measure_soundness(const SoundnessInput& in) {
  SoundnessCheck check(in);
  check.add({0, in.evidence.truth.facing.size()});
  return check.metrics();
}

bool must_have(const PointRecord& point, const SoundLimit& limit) {
  const Metric& metric = find_metric(limit.metric);
  const auto several = [&](const char* setting) { return number_of(setting_of(point, setting)).value_or(1) > 1; };
  if (metric.is(Metric::cascades)) return several("cascades.count");
  if (metric.is(Metric::placements)) return several("map.placements");
  // The frame of another renderer is looked up nowhere.
  const std::string frame = setting_of(point, "given.frame");
  const bool given = !frame.empty() && frame != find_setting("given.frame").get(Settings());
  if (!metric.is(Metric::moments)) return !metric.optional() && !given;
  const LookupKind* const kind = filtered_lookup_of(point);
  return kind && (std::string_view(limit.metric) != "below_comparison" || kind->bound);
}

std::vector<Unsound> find_unsound(std::span<const PointRecord> points) {
  std::vector<Unsound> found;
  for (const PointRecord& point : points) {
    if (!(metric_of(point, "facing") > 0)) continue;
    for (const SoundLimit& limit : sound_limits) {
      const auto value = point.metrics.find(limit.metric);
      if (value == point.metrics.end() ? must_have(point, limit) : !(value->second <= limit.most))
        found.push_back({point.id, &limit, value == point.metrics.end() ? not_a_number : value->second});
    }
  }
  return found;
}

std::string value_text(const Unsound& unsound) {
  return fmt::format("{} = {}, a sound one has at most {}", unsound.limit->metric, unsound.value, unsound.limit->most);
}

std::string text_of(const Unsound& unsound) {
  return fmt::format("point {}: the measurement contradicts itself ({})", unsound.point, value_text(unsound));
}

}  // namespace noonmark
