// The set of the texels that are asked for, and the depths of a map at these texels, against plain lists.
#include "technique/texel_set.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <random>
#include <set>
#include <thread>
#include <vector>

#include "technique/map_depths.h"

namespace noonmark {
namespace {

using Place = std::pair<int, int>;  // row, column

struct Sample {
  glm::ivec2 size;
  std::set<Place> places;
  std::shared_ptr<TexelSet> set;
};

// Sizes that fill their last tile, and sizes that do not; cubes, whose faces stand above one another.
Sample random_sample() {
  const int width = *rc::gen::inRange(1, 150), height = *rc::gen::inRange(1, 200);
  Sample sample{{width, height}, {}, std::make_shared<TexelSet>(glm::ivec2(width, height))};
  std::mt19937 random(*rc::gen::arbitrary<uint32_t>());
  for (auto i = random() % 300; i > 0; --i) {
    const Place place(static_cast<int>(random() % static_cast<unsigned>(height)),
                      static_cast<int>(random() % static_cast<unsigned>(width)));
    sample.places.insert(place);
    sample.set->add({place.second, place.first});
  }
  sample.set->close();
  return sample;
}

RC_GTEST_PROP(TexelSet, NumbersItsTexelsOnce, ()) {
  const Sample sample = random_sample();
  const TexelSet& set = *sample.set;
  RC_ASSERT(set.count() == sample.places.size());
  std::set<size_t> numbers;
  int wrong = 0;  // one assertion for all texels: each takes long
  for (int y = -1; y <= sample.size.y; ++y)
    for (int x = -1; x <= sample.size.x; ++x) {
      const bool has = sample.places.contains({y, x});
      wrong += set.has({x, y}) != has;
      if (has) numbers.insert(set.index({x, y}));
    }
  RC_ASSERT(wrong == 0);
  RC_ASSERT(numbers.size() == sample.places.size());
  // Not inside the assertion: it evaluates both sides of ||, and an empty set has no last element.
  const bool without_gaps = numbers.empty() || *numbers.rbegin() == sample.places.size() - 1;
  RC_ASSERT(without_gaps);
}

// The texels that a box filter reads: also where its step is more than a texel, and where two taps read one column.
RC_GTEST_PROP(TexelSet, AddsAndNumbersSquaresAsTheirTexels, ()) {
  const int width = *rc::gen::inRange(1, 150), height = *rc::gen::inRange(1, 200);
  std::mt19937 random(*rc::gen::arbitrary<uint32_t>());
  const auto below = [&](int most) { return static_cast<int>(random() % static_cast<unsigned>(most)); };
  TexelSet squares({width, height}), plain({width, height});
  std::vector<std::vector<glm::ivec2>> asked;
  for (int i = below(20); i >= 0; --i) {
    std::vector<glm::ivec2>& square = asked.emplace_back();
    const int step = 1 + below(3) / 2 * below(9);
    for (glm::ivec2 at(below(width), below(height)); at.x < width && at.y < height && square.size() < 70;
         at += step - (below(10) == 0))
      square.push_back(at);
    squares.add_square(square);
    for (const glm::ivec2 row : square)
      for (const glm::ivec2 column : square) plain.add({column.x, row.y});
  }
  squares.close();
  plain.close();
  int wrong = squares.count() != plain.count();
  for (const std::vector<glm::ivec2>& square : asked) {
    std::vector<uint32_t> numbers, expected;
    for (const glm::ivec2 row : square) {
      squares.indexes(row.y, square, numbers);
      for (const glm::ivec2 column : square) {
        wrong += !squares.has({column.x, row.y});
        expected.push_back(static_cast<uint32_t>(plain.index({column.x, row.y})));
      }
    }
    wrong += numbers != expected;
  }
  RC_ASSERT(wrong == 0);
}

RC_GTEST_PROP(TexelSet, VisitsRowsAndTilesInTheOrderOfTheNumbers, ()) {
  const Sample sample = random_sample();
  const TexelSet& set = *sample.set;
  std::vector<Place> by_rows;
  for (int y = 0; y < sample.size.y; ++y)
    set.each_in_row(y, [&](int x, size_t index) {
      by_rows.push_back({y, x});
      RC_ASSERT(index == set.index({x, y}));
    });
  RC_ASSERT(by_rows == std::vector<Place>(sample.places.begin(), sample.places.end()));
  size_t next = 0;
  for (size_t tile = 0; tile < set.tiles(); ++tile) {
    RC_ASSERT(set.first(tile) == next);
    for (int row = 0; row < TexelSet::side; ++row)
      for (uint64_t bits = set.bits(tile, row); bits; bits &= bits - 1)
        RC_ASSERT(set.index(set.origin(tile) + glm::ivec2(std::countr_zero(bits), row)) == next++);
    RC_ASSERT(set.first(tile) + set.count(tile) == next);
  }
  RC_ASSERT(next == set.count());
}

// Neighbouring texels share a word of memory.
TEST(TexelSet, TakesTexelsFromSeveralThreads) {
  TexelSet set({64, 64});
  std::vector<std::thread> threads;
  for (int part = 0; part < 4; ++part)
    threads.emplace_back([&set, part] {
      for (int round = 0; round < 50; ++round)
        for (int y = 0; y < 64; ++y)
          for (int x = part; x < 64; x += 4) set.add({x, y});
    });
  for (std::thread& thread : threads) thread.join();
  set.close();
  EXPECT_EQ(set.count(), 64u * 64u);
}

RC_GTEST_PROP(MapDepths, AreThoseOfTheSetAndOneElsewhere, ()) {
  const Sample sample = random_sample();
  MapDepths map(sample.set, 1);
  for (const auto& [y, x] : sample.places)
    map.depth[sample.set->index({x, y})] = static_cast<float>(x + 200 * y) / 1e6f;
  std::vector<float> row(static_cast<size_t>(sample.size.x));
  int wrong = 0;
  for (int y = 0; y < sample.size.y; ++y) {
    map.copy_row(y, row.data());
    for (int x = 0; x < sample.size.x; ++x) {
      const float expected = sample.places.contains({y, x}) ? static_cast<float>(x + 200 * y) / 1e6f : 1;
      wrong += map.at({x, y}) != expected || row[static_cast<size_t>(x)] != expected;
    }
  }
  RC_ASSERT(wrong == 0);
}

TEST(MapDepths, OfAnImageAreAllOfItsTexels) {
  Image<float> image(70, 3);
  for (size_t i = 0; i < image.size(); ++i) image[i] = static_cast<float>(i);
  const MapDepths map(image);
  ASSERT_EQ(map.texels->count(), image.size());
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) EXPECT_EQ(map.at({x, y}), image.at(x, y));
}

}  // namespace
}  // namespace noonmark
