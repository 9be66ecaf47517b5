// Sums of thresholds, compared with sums over a list that std::sort has sorted.
#include "compare/ladder/threshold_sums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <random>

#include "compare/ladder/numbers.h"

namespace noonmark {
namespace {

// Any float that a threshold can be: 0, denormal, normal, infinity. Some values repeat.
std::vector<float> any_thresholds(size_t count, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<float> values;
  while (values.size() < count) {
    if (!values.empty() && random() % 4 == 0)
      values.push_back(values[random() % values.size()]);
    else
      values.push_back(
          std::bit_cast<float>(static_cast<uint32_t>(random() % (std::bit_cast<uint32_t>(infinity_f) + 1))));
  }
  return values;
}

// Lists the values as several threads do, each with a list of its own.
ThresholdList listed(const std::vector<float>& values, size_t threads) {
  std::vector<ThresholdList> of_thread(threads);
  for (size_t i = 0; i < values.size(); ++i) of_thread[i * threads / values.size()].push(values[i]);
  ThresholdList all;
  for (ThresholdList& list : of_thread) all.take(list);
  return all;
}

void expect_sums(const ThresholdSums& sums, std::vector<float> values) {
  std::sort(values.begin(), values.end());
  ASSERT_EQ(sums.total(), static_cast<double>(values.size()));
  size_t different = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    if (i + 1 < values.size() && values[i + 1] == values[i]) continue;
    ASSERT_EQ(sums[different], values[i]);
    ASSERT_EQ(sums.up_to(values[i]), static_cast<double>(i + 1));
    ASSERT_EQ(sums.before(++different), static_cast<double>(i + 1));
  }
  ASSERT_EQ(sums.size(), different);
}

TEST(ThresholdSums, AreThoseOfTheSortedList) {
  // A block of a list has 16384 values.
  for (const size_t count : {1, 2, 1000, 16384, 16385, 100000})
    for (const size_t threads : {1, 2, 5}) {
      const std::vector<float> values = any_thresholds(count, 7);
      ThresholdList list = listed(values, std::min(count, threads));
      ASSERT_EQ(list.size(), count);
      ThresholdSums sums;
      sums.add(list);
      EXPECT_EQ(list.size(), 0u);
      expect_sums(sums, values);
    }
}

TEST(ThresholdSums, AddBatches) {
  const std::vector<float> first = any_thresholds(20000, 1), second = any_thresholds(3000, 2);
  ThresholdSums sums;
  for (const std::vector<float>& values : {first, std::vector<float>(), second}) {
    ThresholdList list;
    for (const float x : values) list.push(x);
    sums.add(list);
  }
  std::vector<float> all = first;
  all.insert(all.end(), second.begin(), second.end());
  expect_sums(sums, all);
}

TEST(ThresholdSums, AddWeights) {
  // Eighths, so that the sums are exact in any order.
  ThresholdSums::Weighted weighted = {{0.5f, 0.125}, {0, 0.25}, {0.5f, 0.5}, {infinity_f, 1}};
  ThresholdSums sums;
  sums.add(weighted);
  EXPECT_TRUE(weighted.empty());
  ASSERT_EQ(sums.size(), 3u);
  EXPECT_EQ(sums.up_to(0), 0.25);
  EXPECT_EQ(sums.up_to(0.5f), 0.875);
  EXPECT_EQ(sums.above(0.5f), 1);
}

TEST(ThresholdSums, OfNothingAreZero) {
  ThresholdList none, other;
  none.take(other);
  ThresholdSums sums;
  sums.add(none);
  EXPECT_EQ(sums.size(), 0u);
  EXPECT_EQ(sums.total(), 0);
  EXPECT_EQ(sums.up_to(1), 0);
}

}  // namespace
}  // namespace noonmark
