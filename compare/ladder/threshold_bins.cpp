#include "compare/ladder/threshold_bins.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace noonmark {
namespace {

constexpr int least_edges_per_octave = 16;
// The leading bits of a float that choose where ThresholdBins::of begins: sign, exponent and three bits of the fraction.
constexpr int leading_shift = 20;

}  // namespace

ThresholdBins::ThresholdBins(std::vector<float> edges) : edges_(std::move(edges)) {
  if (edges_.empty() || !std::is_sorted(edges_.begin(), edges_.end()) || !(edges_.front() >= 0))
    throw std::logic_error("the edges of thresholds are not in ascending order from 0");
  first_.resize((std::bit_cast<uint32_t>(std::numeric_limits<float>::infinity()) >> leading_shift) + 1);
  for (size_t key = 0; key < first_.size(); ++key) {
    const float least = std::bit_cast<float>(static_cast<uint32_t>(key) << leading_shift);
    first_[key] = static_cast<uint32_t>(std::lower_bound(edges_.begin(), edges_.end(), least) - edges_.begin());
  }
}

size_t ThresholdBins::of(float threshold) const {
  size_t at = first_[std::bit_cast<uint32_t>(threshold) >> leading_shift];
  while (at < edges_.size() && edges_[at] < threshold) ++at;
  return at;
}

std::vector<float> placement_edges(const std::vector<double>& bias_depth, double depth_per_unit) {
  std::vector<float> edges;
  for (size_t i = 0; i < bias_depth.size(); ++i) {
    edges.push_back(static_cast<float>(bias_depth[i] / depth_per_unit));
    if (i + 1 == bias_depth.size() || !(bias_depth[i] > 0)) continue;
    const double ratio = bias_depth[i + 1] / bias_depth[i];
    const int parts = static_cast<int>(std::ceil(std::log2(ratio) * least_edges_per_octave));
    for (int k = 1; k < parts; ++k)
      edges.push_back(
          static_cast<float>(bias_depth[i] * std::pow(ratio, static_cast<double>(k) / parts) / depth_per_unit));
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace noonmark
