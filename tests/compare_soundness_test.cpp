// The contract on evidence made at random: 0 for verdicts that the plain reading gives, and exact when some are
// changed.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "compare/soundness.h"
#include "tests/compare_evidence.h"

namespace noonmark {
namespace {

struct Case {
  Synthetic s;
  Image<float> ties, tie_lookup;
  ReceiverImage receivers;
  LightFrame frame;

  explicit Case(uint64_t seed, int kernel) : s(random_evidence(seed, {.kernel = kernel})) {
    set_verdicts(s);
    ties = tie_map(s.evidence());
    tie_lookup = Image<float>(s.r4.width, s.r4.height, 0);
    for (size_t i = 0; i < s.r4.size(); ++i) tie_lookup[i] = naive::visibility(s, ties, i);
    receivers = {Image<glm::vec3>(s.r4.width, s.r4.height, glm::vec3(0)),
                 Image<glm::vec3>(s.r4.width, s.r4.height, glm::vec3(0)), Image<uint32_t>(s.r4.width, s.r4.height, 0)};
  }
  std::map<std::string, double> metrics() {
    return measure_soundness({s.evidence(), s.stored, ties, tie_lookup, receivers, frame});
  }
};

TEST(Contract, CountsEveryBrokenReceiverOnce) {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    Case c(seed, seed % 3 == 0 ? 1 : 3);
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
    EXPECT_DOUBLE_EQ(c.metrics().at("contract"), 2 / count) << "one float beside is broken, and twice counts once";
    c.tie_lookup[facing[3]] -= 0.5f;
    c.s.r5[facing[4]] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_DOUBLE_EQ(c.metrics().at("contract"), 4 / count);
    for (size_t i = 0; i < c.s.truth.facing.size(); ++i)
      if (!c.s.truth.facing[i]) c.s.r5[i] = 7;  // dark by shading: nobody asked
    EXPECT_DOUBLE_EQ(c.metrics().at("contract"), 4 / count);
  }
}

// A lit tie in every second texel that a receiver with a depth falls into, and the next float below in the others.
TEST(TieMap, IsDecidedByTheLastBit) {
  uint64_t ties = 0, below = 0;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const Case c(seed, 1);
    for (size_t i = 0; i < c.s.truth.facing.size(); ++i) {
      const glm::ivec2 read = wrapped(c.s.probe.texel[i], c.ties.width, c.s.map.wrap);
      if (!c.s.truth.facing[i] || read.x < 0) continue;
      const float biased = c.s.probe.reference[i] - naive::bias_at(c.s.bias, c.s.probe.n_dot_l[i]);
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
                                          "map_error_quanta", "map_bits"}));
}

}  // namespace
}  // namespace noonmark
