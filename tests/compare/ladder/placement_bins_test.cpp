// The bins of the thresholds at all placements, found by depth, against the thresholds themselves.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <random>

#include "compare/ladder/threshold_bins.h"
#include "tests/compare/ladder/evidence.h"

namespace noonmark {
namespace {

std::vector<float> random_edges(std::mt19937_64& random) {
  std::vector<float> edges;
  if (random() % 2) edges.push_back(0);
  for (auto i = 1 + random() % 60; i > 0; --i)
    edges.push_back(std::exp2(std::uniform_real_distribution<float>(-20, 1)(random)));
  std::sort(edges.begin(), edges.end());
  return edges;
}

RC_GTEST_PROP(BinsByDepth, AreThoseOfTheThresholds, (uint64_t seed)) {
  const Synthetic s = random_evidence(seed, {4, 4, 6, 1, seed % 2 == 0, Lookup::box});
  std::mt19937_64 random(seed);
  const Bias bias(s.bias);
  const BiasPart* const varied = curve_part(s.bias);
  if (!varied) return;
  const ThresholdBins bins(random_edges(random));
  int wrong = 0, wrong_bias = 0;  // one assertion for all taps: each takes long
  for (size_t i = 0; i < s.truth.facing.size(); ++i) {
    if (!s.truth.facing[i]) continue;
    const TapThreshold threshold(s.probe, bias, *varied, i);
    const float reference = s.probe.reference[i];
    const auto depth = [&] {  // many equal ones, and many beside the reference
      const float d = s.exact[random() % s.exact.size()];
      return random() % 2 ? d : reference - d / 1024;
    };
    BinsByDepth by_depth(threshold, bins, reference);
    for (int k = 0; k < 200; ++k) {
      const float d = depth(), needed = threshold.at(reference, d);
      wrong += by_depth.of(d) != bins.of(needed);
      for (const float amount : bins.edges())
        wrong_bias += (needed <= amount) != !(reference - threshold.bias_at(amount) > d);
    }
  }
  RC_ASSERT(wrong == 0);
  RC_ASSERT(wrong_bias == 0);
}

}  // namespace
}  // namespace noonmark
