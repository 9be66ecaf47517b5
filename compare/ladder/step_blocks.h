// Where a ladder has steps. Almost all pixels of a picture are right, and their steps are 0: a sum over a cause's steps leaves
// out blocks without any, which changes none of its bits.
//
//   const StepBlocks steps(ladder);
//   steps.each(c, [&](size_t i) { sum += std::abs(double(ladder.causes[c].step[i])); });
#pragma once
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "compare/ladder/ladder.h"

namespace noonmark {

class StepBlocks {
 public:
  explicit StepBlocks(const Ladder& ladder)
      : pixels_(ladder.flags.size()),
        causes_(ladder.causes.size()),
        any_((pixels_ + of_block - 1) / of_block * causes_) {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, blocks(), 16), [&](const tbb::blocked_range<size_t>& range) {
      for (size_t block = range.begin(); block != range.end(); ++block)
        for (size_t c = 0; c < causes_; ++c) any_[block * causes_ + c] = has_step(ladder.causes[c].step, block);
    });
  }

  size_t blocks() const { return (pixels_ + of_block - 1) / of_block; }
  // Whether a pixel of the block has a step of the cause other than 0; NaN is one.
  bool any(size_t block, size_t cause) const { return any_[block * causes_ + cause] != 0; }
  bool any(size_t block) const {
    const auto first = any_.begin() + static_cast<std::ptrdiff_t>(block * causes_);
    return std::any_of(first, first + static_cast<std::ptrdiff_t>(causes_), [](uint8_t has) { return has != 0; });
  }
  static size_t block_of(size_t pixel) { return pixel / of_block; }
  size_t first(size_t block) const { return block * of_block; }
  size_t end(size_t block) const { return std::min(pixels_, (block + 1) * of_block); }

  // Calls visit(i) for each pixel of the blocks with a step of the cause, in the picture's order.
  template <class Visit>
  void each(size_t cause, const Visit& visit) const {
    for (size_t block = 0; block < blocks(); ++block)
      if (any(block, cause))
        for (size_t i = first(block); i < end(block); ++i) visit(i);
  }

 private:
  static constexpr size_t of_block = 512;  // pixels, one after the other: a part of a row, or some rows

  bool has_step(const Image<float>& step, size_t block) const {
    uint32_t bits = 0;
    for (size_t i = first(block); i < end(block); ++i) bits |= std::bit_cast<uint32_t>(step[i]);
    return (bits & 0x7fffffffu) != 0;  // -0 is no step
  }

  size_t pixels_, causes_;
  std::vector<uint8_t> any_;
};

}  // namespace noonmark
