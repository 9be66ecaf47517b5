// The order of the samples of times, and who shares them, with a clock that the test makes.
#include "measure/pass_times.h"

#include <gtest/gtest.h>

#include <cmath>

#include "measure/stage_keys.h"

namespace noonmark {
namespace {

struct Call {
  int resolution;
  std::string filter;
  bool map, lookup;
  bool operator==(const Call&) const = default;
};

// The n-th call takes n milliseconds for the map and 100 n for the lookup.
struct Clock {
  std::vector<Call> calls;
  SamplePasses sample() {
    return [this](const Settings& point, bool map, bool lookup) {
      calls.push_back({point.map.resolution, point.filter.kind, map, lookup});
      PassTimes times;
      const auto n = static_cast<double>(calls.size());
      if (map) times.map_ms = n;
      if (lookup) times.lookup_ms = 100 * n;
      return times;
    };
  }
};

Settings point(int resolution, const char* filter, double bias) {
  Settings settings;
  settings.map.resolution = resolution;
  settings.filter.kind = filter;
  settings.bias["constant"] = bias;
  return settings;
}

bool always(int, int) { return true; }

TEST(PassTimes, TakeTurnsAndShareEqualWork) {
  Clock clock;
  // The second differs from the first in the amount of a compared bias: the same map and the same lookup. The third shares
  // the map. The fourth shares nothing.
  const std::vector<Settings> points{point(256, "none", 0.01), point(256, "none", 0.02), point(256, "box", 0.01),
                                     point(512, "none", 0.01)};
  const auto times = time_passes(clock.sample(), points, always);
  ASSERT_TRUE(times);
  ASSERT_EQ(clock.calls.size(), 3u * timed_rounds);
  for (size_t round = 0; round < timed_rounds; ++round) {
    EXPECT_EQ(clock.calls[3 * round], (Call{256, "none", true, true})) << round;
    EXPECT_EQ(clock.calls[3 * round + 1], (Call{256, "box", false, true})) << round;
    EXPECT_EQ(clock.calls[3 * round + 2], (Call{512, "none", true, true})) << round;
  }
  EXPECT_EQ((*times)[0], (*times)[1]);
  // Calls 1, 4, 7 ... 25: the median is 13, the second 4, the eighth 22.
  EXPECT_EQ((*times)[0].at("map_low_ms"), 4);
  EXPECT_EQ((*times)[0].at("map_ms"), 13);
  EXPECT_EQ((*times)[0].at("map_high_ms"), 22);
  EXPECT_EQ((*times)[2].at("map_ms"), 13);
  EXPECT_EQ((*times)[2].at("lookup_ms"), 1400);
  EXPECT_EQ((*times)[2].at("shadow_ms"), 1413) << "the sum of the passes of one round";
  EXPECT_EQ((*times)[3].at("shadow_low_ms"), 6 * 101);
}

TEST(PassTimes, OfOnePictureAfterTheOther) {
  Clock clock;
  std::vector<Settings> points{point(256, "none", 0), point(512, "none", 0), point(256, "none", 0)};
  points[1].view.width_px /= 2;
  std::vector<int> rounds;
  const auto times = time_passes(clock.sample(), points, [&](int done, int all) {
    EXPECT_EQ(all, 2 * timed_rounds);
    rounds.push_back(done);
    return true;
  });
  ASSERT_TRUE(times);
  EXPECT_EQ(rounds.size(), 2u * timed_rounds);
  for (size_t i = 0; i < rounds.size(); ++i) EXPECT_EQ(rounds[i], static_cast<int>(i));
  EXPECT_EQ((*times)[0], (*times)[2]);
  for (size_t i = 1; i < timed_rounds; ++i)
    EXPECT_EQ(clock.calls[i].resolution, clock.calls[0].resolution) << "no scene and no picture is loaded twice";
}

TEST(PassTimes, AreNotGivenIfTheyAreStopped) {
  Clock clock;
  const std::vector<Settings> points{point(256, "none", 0)};
  EXPECT_FALSE(time_passes(clock.sample(), points, [](int done, int) { return done < 5; }));
  EXPECT_EQ(clock.calls.size(), 5u);
}

TEST(WorkKeys, AreEqualForEqualWorkOnly) {
  const Settings base = point(256, "none", 0.01);
  const auto changed = [&](const char* name, const char* value) {
    Settings other = base;
    find_setting(name).set(other, value);
    return std::pair(map_key_of(other) == map_key_of(base), lookup_work_of(other) == lookup_work_of(base));
  };
  using Same = std::pair<bool, bool>;
  EXPECT_EQ(changed("bias.constant", "0.02"), (Same{true, true})) << "an amount changes no step of the shader";
  EXPECT_EQ(changed("bias.constant", "0"), (Same{true, false})) << "without the part the shader is shorter";
  EXPECT_EQ(changed("bias.slope", "0.01"), (Same{true, false}));
  EXPECT_EQ(changed("bias.normal_offset", "1"), (Same{true, false}));
  EXPECT_EQ(changed("bias.unit", "texel"), (Same{true, false}));
  EXPECT_EQ(changed("bias.reference", "texel_plane"), (Same{true, false}));
  EXPECT_EQ(changed("filter.kind", "hardware"), (Same{true, false}));
  EXPECT_EQ(changed("view.width_px", "320"), (Same{true, false}));
  EXPECT_EQ(changed("map.lit_beyond_far", "false"), (Same{true, false}));
  EXPECT_EQ(changed("bias.polygon_factor", "1"), (Same{false, false}));
  EXPECT_EQ(changed("map.format", "16"), (Same{false, false})) << "a lookup reads that map";
  EXPECT_EQ(changed("map.placements", "8"), (Same{true, true})) << "the pass itself is the same";
  EXPECT_EQ(changed("truth.standard_error", "0.1"), (Same{true, true}));
  Settings a = base, b = base;
  a.map.fit = b.map.fit = MapFit::view;
  b.view.eye_m = glm::dvec3(1, 2, 3);
  EXPECT_NE(map_key_of(a), map_key_of(b)) << "the map is fitted to the view";
}

}  // namespace
}  // namespace noonmark
