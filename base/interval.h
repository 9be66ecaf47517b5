// A closed interval of numbers.
#pragma once

namespace noonmark {

struct Interval {
  double low = 0, high = 0;  // inclusive
  bool empty() const { return !(low <= high); }
};
inline constexpr Interval empty_interval{0, -1};

}  // namespace noonmark
