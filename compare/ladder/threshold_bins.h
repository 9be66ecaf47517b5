// The bins in which thresholds of taps are counted (compare/ladder/tap_threshold.h): between fixed amounts of a part of the bias,
// the edges.
//
//   const ThresholdBins bins(placement_edges(bias_depth, depth_per_unit));
//   size_t bin = bins.of(threshold);
//   BinsByDepth by_depth(threshold, bins, reference);          // of one receiver
//   bin = by_depth.of(depth);
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "compare/ladder/numbers.h"
#include "compare/ladder/tap_threshold.h"

namespace noonmark {

// Ascending floats, and the first of them that is not less than a number.
class ThresholdBins {
 public:
  explicit ThresholdBins(std::vector<float> edges);
  const std::vector<float>& edges() const { return edges_; }
  // edges().size() if all edges are less. threshold: not NaN, at least 0.
  size_t of(float threshold) const;

 private:
  std::vector<float> edges_;
  std::vector<uint32_t> first_;  // for the leading bits of a float
};

// The bins of the thresholds of one receiver's taps, from their depths alone: the bin is the first edge at which the tap is
// lit. The search begins at the last answer, or else where the threshold is about.
class BinsByDepth {
 public:
  // threshold: of the receiver. reference: of its taps. threshold and bins must outlive this.
  BinsByDepth(const TapThreshold& threshold, const ThresholdBins& bins, float reference)
      : threshold_(threshold), bins_(bins), edges_(bins.edges()), reference_(reference) {
    move_to(0);
  }
  // ThresholdBins::of(TapThreshold::at(reference, depth)).
  size_t of(float depth) {
    if (!(here_ > depth) && (at_ == 0 || before_ > depth)) return at_;
    if (const float amount = threshold_.about(reference_, depth); amount >= 0) move_to(bins_.of(amount));
    while (here_ > depth) {
      before_ = here_;
      here_ = compared_at(++at_);
    }
    while (at_ > 0 && !(before_ > depth)) {
      here_ = before_;
      before_ = --at_ == 0 ? -infinity_f : compared_at(at_ - 1);
    }
    return at_;
  }

 private:
  void move_to(size_t bin) {
    at_ = bin;
    before_ = at_ == 0 ? -infinity_f : compared_at(at_ - 1);
    here_ = compared_at(at_);
  }
  // What is compared with a depth at this edge. Beyond the last edge every tap counts as lit.
  float compared_at(size_t edge) const {
    return edge < edges_.size() ? reference_ - threshold_.bias_at(edges_[edge]) : -infinity_f;
  }
  const TapThreshold& threshold_;
  const ThresholdBins& bins_;
  const std::vector<float>& edges_;
  float reference_;
  size_t at_ = 0;
  float before_ = 0, here_ = 0;  // what is compared at the edge before, and at this one
};

// The edges for a curve over these biases (in window depth, ascending, from 0): its own, and others between them, so
// that there are at least 16 in an octave. In units of the part's amount.
std::vector<float> placement_edges(const std::vector<double>& bias_depth, double depth_per_unit);

}  // namespace noonmark
