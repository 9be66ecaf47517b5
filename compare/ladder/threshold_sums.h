// Lists of thresholds, and the sums of their weights up to any threshold.
//
//   ThresholdList found;                 // of one thread
//   found.push(0.01f);
//   all.take(found);
//   ThresholdSums sums;
//   sums.add(all);                       // sorts them; all is empty then
//   sums.up_to(0.02f);                   // 1
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace noonmark {

// Floats that are at least 0 and not NaN, in no order. They are kept in blocks, so that the list grows and joins another
// without a copy.
class ThresholdList {
 public:
  void push(float threshold) {
    if (next_ == end_) grow();
    *next_++ = threshold;
  }
  // Adds the other's thresholds and leaves it empty.
  void take(ThresholdList& other);
  size_t size() const;
  std::vector<std::span<const float>> blocks() const;

 private:
  static constexpr size_t block_size = size_t{1} << 14;
  struct Block {
    std::unique_ptr<float[]> at;
    size_t size = 0;  // not up to date for the block that is written to
  };
  size_t written() const { return blocks_.empty() ? 0 : static_cast<size_t>(next_ - blocks_.back().at.get()); }
  void grow();

  std::vector<Block> blocks_;
  float *next_ = nullptr, *end_ = nullptr;  // in the last block
};

// Weights of thresholds, summed in ascending order. Each different threshold is stored once.
class ThresholdSums {
 public:
  using Weighted = std::vector<std::pair<float, double>>;  // thresholds with their weights

  // Each threshold weighs 1. This empties the list.
  void add(ThresholdList& thresholds);
  // This empties the list.
  void add(Weighted& thresholds);
  void add(ThresholdSums&& batch);

  double above(float x) const { return total() - up_to(x); }
  double up_to(float x) const;
  double total() const { return before(size()); }

  size_t size() const { return at_.size(); }
  float operator[](size_t i) const { return at_[i]; }
  double before(size_t i) const { return i == 0 ? 0 : up_to_[i - 1]; }  // the sum of the first i

 private:
  std::vector<float> at_;      // ascending
  std::vector<double> up_to_;  // [i]: the sum of all thresholds that are at most at_[i]
};

}  // namespace noonmark
