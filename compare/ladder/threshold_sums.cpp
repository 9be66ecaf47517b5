#include "compare/ladder/threshold_sums.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <iterator>
#include <limits>

#include "compare/ladder/numbers.h"

namespace noonmark {
namespace {

// Sorts floats that are at least 0 (radix sort). Their order is that of their bits, which are read in three digits from
// the lowest to the highest. The sign is 0 and is not read.
constexpr size_t passes = 3;
constexpr int digit_shift[passes] = {0, 11, 21};
constexpr size_t digits[passes] = {1u << 11, 1u << 10, 1u << 10};

size_t digit(float x, size_t pass) { return (std::bit_cast<uint32_t>(x) >> digit_shift[pass]) % digits[pass]; }

// Empties the list before the second array is made, because with many taps each is large.
std::vector<float> sorted(ThresholdList& list) {
  // [pass][digit]: first how many have it, then where the next of them belongs.
  std::array<std::array<size_t, digits[0]>, passes> place{};
  for (const std::span<const float> block : list.blocks())
    for (const float x : block)
      for (size_t pass = 0; pass < passes; ++pass) ++place[pass][digit(x, pass)];
  for (auto& of_pass : place) {
    size_t sum = 0;
    for (size_t& count : of_pass) sum += std::exchange(count, sum);
  }
  std::vector<float> values(list.size());
  for (const std::span<const float> block : list.blocks())
    for (const float x : block) values[place[0][digit(x, 0)]++] = x;
  list = {};
  std::vector<float> other(values.size());
  for (size_t pass = 1; pass < passes; ++pass) {
    for (const float x : values) other[place[pass][digit(x, pass)]++] = x;
    values.swap(other);
  }
  return values;
}

}  // namespace

void ThresholdList::grow() {
  if (!blocks_.empty()) blocks_.back().size = written();
  // Not initialised: each place is written before it is read.
  blocks_.push_back({std::unique_ptr<float[]>(new float[block_size])});
  next_ = blocks_.back().at.get();
  end_ = next_ + block_size;
}

void ThresholdList::take(ThresholdList& other) {
  if (other.blocks_.empty()) return;
  if (!blocks_.empty()) blocks_.back().size = written();
  std::move(other.blocks_.begin(), other.blocks_.end(), std::back_inserter(blocks_));
  next_ = other.next_;
  end_ = other.end_;
  other = {};
}

size_t ThresholdList::size() const {
  size_t sum = 0;
  for (const std::span<const float> block : blocks()) sum += block.size();
  return sum;
}

std::vector<std::span<const float>> ThresholdList::blocks() const {
  std::vector<std::span<const float>> all;
  for (const Block& block : blocks_) all.emplace_back(block.at.get(), block.size);
  if (!all.empty()) all.back() = {blocks_.back().at.get(), written()};
  return all;
}

void ThresholdSums::add(ThresholdList& thresholds) {
  const std::vector<float> values = sorted(thresholds);
  if (values.empty()) return;
  ThresholdSums batch;
  size_t different = 1;
  for (size_t i = 1; i < values.size(); ++i) different += values[i] != values[i - 1];
  batch.at_.resize(different);
  batch.up_to_.resize(different);
  size_t last = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    last += i > 0 && values[i] != values[i - 1];
    batch.at_[last] = values[i];
    batch.up_to_[last] = static_cast<double>(i + 1);
  }
  add(std::move(batch));
}

void ThresholdSums::add(Weighted& thresholds) {
  // Sorted by weight too, so that sums do not depend on the order in which the threads added them.
  tbb::parallel_sort(thresholds);
  ThresholdSums batch;
  double sum = 0;
  for (const auto& [at, weight] : thresholds) {
    if (batch.at_.empty() || batch.at_.back() != at) {
      batch.at_.push_back(at);
      batch.up_to_.push_back(sum);
    }
    batch.up_to_.back() = sum += weight;
  }
  Weighted().swap(thresholds);
  add(std::move(batch));
}

void ThresholdSums::add(ThresholdSums&& batch) {
  if (batch.size() == 0) return;
  if (at_.empty()) {
    *this = std::move(batch);
    return;
  }
  ThresholdSums both;
  both.at_.reserve(at_.size() + batch.at_.size());
  both.up_to_.reserve(both.at_.capacity());
  for (size_t i = 0, j = 0; i < size() || j < batch.size();) {
    const float next = std::min(i < size() ? at_[i] : infinity_f, j < batch.size() ? batch[j] : infinity_f);
    if (i < size() && at_[i] == next) ++i;
    if (j < batch.size() && batch[j] == next) ++j;
    both.at_.push_back(next);
    both.up_to_.push_back(before(i) + batch.before(j));
  }
  *this = std::move(both);
}

double ThresholdSums::up_to(float x) const {
  return before(static_cast<size_t>(std::upper_bound(at_.begin(), at_.end(), x) - at_.begin()));
}

}  // namespace noonmark
