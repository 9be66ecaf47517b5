// The contract on random evidence: it is 0 for the verdicts of the plain evaluation, and it is exact if some verdicts
// are changed.
#include "compare/judge/soundness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "technique/settings.h"
#include "tests/compare/ladder/evidence.h"

namespace noonmark {
namespace {

Image<float> image_of(const MapDepths& map) {
  Image<float> image(map.size().x, map.size().y);
  for (int y = 0; y < image.height; ++y) map.copy_row(y, &image.at(0, y));
  return image;
}

struct Case {
  Synthetic s;
  Image<float> ties, tie_lookup;
  ReceiverImage receivers;
  LightFrame frame;

  explicit Case(uint64_t seed, int kernel, Lookup lookup = Lookup::box)
      : s(random_evidence(seed, {.kernel = kernel, .lookup = lookup})) {
    set_verdicts(s);
    ties = image_of(tie_map(s.evidence()));
    tie_lookup = Image<float>(s.r4.width, s.r4.height, 0);
    for (size_t i = 0; i < s.r4.size(); ++i) tie_lookup[i] = naive::visibility(s, ties, i, DepthFormat::d32f);
    receivers = {Image<glm::vec3>(s.r4.width, s.r4.height, glm::vec3(0)),
                 Image<glm::vec3>(s.r4.width, s.r4.height, glm::vec3(0)), Image<uint32_t>(s.r4.width, s.r4.height, 0)};
  }
  std::map<std::string, double> metrics() {
    return measure_soundness({s.evidence(), s.stored_map(), MapDepths(ties), tie_lookup, receivers, frame, {}});
  }
};

TEST(Contract, CountsEveryBrokenReceiverOnce) {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    Case c(seed, seed % 3 == 0 ? 1 : 3, seed % 2 ? Lookup::box : Lookup::cube);
    std::vector<size_t> facing;
    for (size_t i = 0; i < c.s.truth.facing.size(); ++i)
      if (c.s.truth.facing[i]) facing.push_back(i);
    ASSERT_GT(facing.size(), 20u);
    const double count = static_cast<double>(facing.size());
    EXPECT_EQ(c.metrics().at("contract"), 0) << seed;
    c.s.r4[facing[1]] += 0.25f;
    EXPECT_DOUBLE_EQ(c.metrics().at("contract"), 1 / count);
    c.s.r5[facing[1]] += 0.25f;
    c.s.r5[facing[2]] = std::nextafter(c.s.r5[facing[2]], 2.0f);
    EXPECT_DOUBLE_EQ(c.metrics().at("contract"), 2 / count)
        << "one float off is broken, and two broken verdicts of a receiver count once";
    c.tie_lookup[facing[3]] -= 0.5f;
    c.s.r5[facing[4]] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_DOUBLE_EQ(c.metrics().at("contract"), 4 / count);
    for (size_t i = 0; i < c.s.truth.facing.size(); ++i)
      if (!c.s.truth.facing[i]) c.s.r5[i] = 7;  // attached: its verdict does not count
    EXPECT_DOUBLE_EQ(c.metrics().at("contract"), 4 / count);
  }
}

TEST(Contract, AndTheRestAreTheSameInStrips) {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    Case c(seed, 3, static_cast<Lookup>(seed % 3));
    for (size_t i = 0; i < c.s.r5.size(); i += 7) c.s.r5[i] += 0.25f;
    const std::map<std::string, double> whole = c.metrics();
    Synthetic held = c.s;  // the evidence refers to this; each strip replaces it
    const LookupEvidence evidence = held.evidence();
    const MapDepths stored = c.s.stored_map(), ties(c.ties);
    SoundnessCheck check({evidence, stored, ties, c.tie_lookup, c.receivers, c.frame, {}});
    for_each_strip(c.s, seed, [&](const Synthetic& part, PixelRange strip) {
      held.taps = part.taps;
      held.probe = part.probe;
      check.add(strip);
    });
    for (const auto& [name, value] : check.metrics()) EXPECT_EQ(value, whole.at(name)) << name << " " << seed;
  }
}

// If a sampler blends the taps, its allowed rounding is accepted, and no more.
TEST(Contract, AllowsASamplerItsWeights) {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    Case c(seed, seed % 3 == 0 ? 3 : 1, Lookup::linear);
    ASSERT_EQ(c.metrics().at("contract"), 0) << seed;
    double facing = 0, shifted = 0;
    for (size_t i = 0; i < c.s.r4.size(); ++i) {
      if (!c.s.truth.facing[i]) continue;
      ++facing;
      (seed % 2 ? c.s.r4 : c.tie_lookup)[i] += shifted++ < 5 ? 0x1p-6f : 0x1p-8f;  // first more than allowed, then less
    }
    EXPECT_DOUBLE_EQ(c.metrics().at("contract"), 5 / facing);
  }
}

// With fixed-point depths, a sampler may round the compared values. With float depths, ties must be exact.
TEST(Contract, AllowsASamplerTiesOfFixedPointDepthsOnly) {
  for (const DepthFormat format : {DepthFormat::d16, DepthFormat::d24, DepthFormat::d32f}) {
    Case c(1, 1, Lookup::linear);
    c.s.map.format = format;
    c.s.map.wrap = Wrap::clamp_to_edge;
    c.s.bias = {};
    for (size_t i = 0; i < c.s.r4.size(); ++i) {
      c.s.probe.reference[i] = 0.5f;
      c.s.probe.map_texels[i] = {2.5f, 2.5f};
    }
    for (float& depth : c.s.stored.pixels) depth = 0.5f;
    for (float& depth : c.s.exact.pixels) depth = 0.25f;
    c.ties = image_of(tie_map(c.s.evidence()));
    set_verdicts(c.s);
    for (size_t i = 0; i < c.s.r4.size(); ++i) {
      ASSERT_EQ(c.s.r5[i], 1);
      c.tie_lookup[i] = naive::visibility(c.s, c.ties, i, DepthFormat::d32f);
    }
    ASSERT_EQ(c.metrics().at("contract"), 0);
    for (float& v : c.s.r5.pixels) v = 0;  // `<` for `<=`
    EXPECT_EQ(c.metrics().at("contract"), format == DepthFormat::d32f ? 1 : 0);
    for (float& v : c.s.r5.pixels) v = 1;
    for (float& v : c.tie_lookup.pixels) v = 1 - v;
    EXPECT_EQ(c.metrics().at("contract"), 1) << "the tie map has float depths, so the rule for ties is exact";
  }
}

// Every second texel with a receiver's depth holds a lit tie. The others hold the next smaller float.
TEST(TieMap, IsDecidedByTheLastBit) {
  uint64_t ties = 0, below = 0;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const Case c(seed, 1, seed % 3 ? Lookup::box : Lookup::cube);
    for (size_t i = 0; i < c.s.truth.facing.size(); ++i) {
      if (!c.s.truth.facing[i]) continue;
      // The texel's index replaces its depth, so that the plain evaluation tells which texel it is.
      Image<float> index(c.ties.width, c.ties.height);
      for (size_t t = 0; t < index.size(); ++t) index[t] = static_cast<float>(t + 2);
      const naive::Tap tap = naive::taps_of(c.s, index, i).front();
      if (tap.depth == 1) continue;  // the border
      const int at = static_cast<int>(tap.depth) - 2;
      const glm::ivec2 read(at % index.width, at / index.width);
      const float biased = tap.reference - naive::bias_at(c.s, i);
      const float depth = c.ties.at(read.x, read.y);
      ties += depth == biased && (read.x + read.y) % 2 == 0;
      below += depth < biased && biased == std::nextafter(depth, 2.0f) && (read.x + read.y) % 2 == 1;
    }
    for (float depth : c.ties.pixels) EXPECT_TRUE(depth > 0 && depth <= 1);
  }
  EXPECT_GT(ties, 500u);
  EXPECT_GT(below, 500u);
}

TEST(Soundness, IsNotMeasuredWithoutAFacingReceiver) {
  Case c(1, 1);
  for (uint8_t& facing : c.s.truth.facing.pixels) facing = 0;
  std::set<std::string> names;
  for (const auto& [name, value] : c.metrics()) {
    EXPECT_TRUE(std::isnan(value)) << name;
    names.insert(name);
  }
  EXPECT_EQ(names, (std::set<std::string>{"contract", "rounding_excess", "address_error_texels", "reference_error_m",
                                          "map_error_quanta", "map_excess", "map_bits"}));
}

// What a sound program measures and a point does not have is no sign of soundness.
TEST(FindUnsound, AMetricThatIsAbsentFails) {
  Settings settings;
  settings.lookup.kind = "vsm";
  settings.filter.kind = "box";
  settings.cascades.count = 2;
  settings.map.placements = 2;
  PointRecord point;
  point.settings = settings_map(settings);
  point.metrics["facing"] = 10;
  for (const SoundLimit& limit : sound_limits) point.metrics[limit.metric] = limit.most;
  EXPECT_TRUE(find_unsound({&point, 1}).empty());
  for (const SoundLimit& limit : sound_limits) {
    PointRecord without = point;
    without.metrics.erase(limit.metric);
    const std::vector<Unsound> found = find_unsound({&without, 1});
    ASSERT_EQ(found.size(), 1u) << limit.metric;
    EXPECT_STREQ(found.front().limit->metric, limit.metric);
    EXPECT_TRUE(std::isnan(found.front().value));
    without.metrics["facing"] = 0;
    EXPECT_TRUE(find_unsound({&without, 1}).empty()) << "nothing was asked";
  }
  // A point with one map, at one place, that compares depths, has no metric of the others.
  point.settings = settings_map(Settings());
  for (const char* other : {"cascade_choice_excess", "placement_disagreements", "contract_store", "contract_blur",
                            "contract_fetch", "contract_lit", "below_comparison"})
    point.metrics.erase(other);
  EXPECT_TRUE(find_unsound({&point, 1}).empty());
}

}  // namespace
}  // namespace noonmark
