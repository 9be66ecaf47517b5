// A measured time as an interval: the median of samples and how far it is known. Two times differ only where their
// intervals do not overlap.
//
//   const MedianInterval time = interval_of_median(samples);
//   if (certainly_less(time, other)) print("faster");
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "compare/judge/choices.h"
#include "compare/results/records.h"

namespace noonmark {

struct MedianInterval {
  double low = 0, middle = 0, high = 0;
};

// Certain as far as the intervals are.
inline bool certainly_less(const MedianInterval& a, const MedianInterval& b) { return a.high < b.low; }
inline bool overlap(const MedianInterval& a, const MedianInterval& b) {
  return !certainly_less(a, b) && !certainly_less(b, a);
}

// The least coverage of an interval of a median.
inline constexpr double median_coverage = 0.95;

// The probability that the median of a distribution lies between the rank-th smallest and the rank-th largest of
// independent samples, whatever the distribution is, as long as it is continuous: 1 - 2 P(B < rank) with B binomial of
// (samples, 1/2). David and Nagaraja, Order Statistics, 2003, section 7.1. 1 <= rank, and 2 rank <= samples.
double coverage_of_ranks(int samples, int rank);

// The median of the samples, and the narrowest pair of order statistics of equal ranks that covers it by at least
// median_coverage. Of nine samples: the second smallest and the second largest, 96.1 %, so that one bad sample on either
// side has no effect. Throws std::logic_error if there are too few samples (five or less) or if one is not finite.
MedianInterval interval_of_median(std::vector<double> samples);

// The metrics that hold the ends of a time's interval: "map_ms" has "map_low_ms" and "map_high_ms".
struct IntervalNames {
  std::string low, high;
};
IntervalNames interval_names(const std::string& metric);

// A metric of a point with its ends, if the point has them; otherwise both ends are the value itself.
MedianInterval interval_of(const PointRecord& point, const std::string& metric);

// The largest over the conditions: of the values, and of each end. The ends enclose the largest median if the ends of each
// condition enclose its own.
MedianInterval joined_interval(const Choice& choice, const std::string& metric);

}  // namespace noonmark
