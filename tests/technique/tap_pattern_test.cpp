// The filters as tables of taps.
#include "technique/tap_pattern.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "technique/evidence.h"
#include "technique/filters.h"
#include "technique/lookups.h"

namespace noonmark {
namespace {

FilterSettings filter(const std::string& kind, int size = 3) { return {kind, {{"size", size}}}; }

TEST(TapPattern, HasAsManyTapsAsTheFilterSays) {
  const auto expect = [](const FilterSettings& f, int taps, int variants, bool in_world, bool bilinear) {
    const TapPattern p = tap_pattern(f);
    EXPECT_EQ(p.taps, taps);
    EXPECT_EQ(p.variants, variants);
    EXPECT_EQ(static_cast<int>(p.offsets.size()), taps * variants);
    EXPECT_EQ(p.in_world, in_world);
    EXPECT_EQ(p.bilinear(), bilinear);
    for (const glm::vec3& o : p.offsets) EXPECT_TRUE(in_world || o.z == 0);
  };
  expect(filter("none"), 1, 1, false, false);
  for (int n : {1, 3, 5, 31}) {
    expect(filter("box", n), n * n, 1, false, false);
    expect(filter("gaussian", n), (n + 1) * (n + 1), 1, false, true);
  }
  expect(filter("hardware"), 4, 1, false, true);
  expect(filter("poisson"), 16, 1, false, false);
  FilterSettings turned = filter("poisson");
  turned["rotate"] = true;
  expect(turned, 16, 64, false, false);
  expect(filter("cube_grid"), 64, 1, true, false);
  expect(filter("cube_disk"), 20, 1, true, false);
}

// The taps on a square's diagonal give all its columns and rows, and so the texels of all other taps.
TEST(TapPattern, OfASquareHasTheColumnsAndRowsOfItsDiagonal) {
  FilterSettings wide = filter("box", 5);
  wide["step_texels"] = 1.3;
  int squares = 0;
  for (const FilterSettings& f : {filter("none"), filter("box", 1), filter("box", 3), filter("box", 31), wide,
                                  filter("hardware"), filter("gaussian", 5), filter("poisson"), filter("cube_grid")}) {
    const TapPattern p = tap_pattern(f);
    const int side = p.square_side;
    squares += side > 0;
    if (side == 0) continue;
    ASSERT_EQ(p.taps, side * side) << f.kind;
    ASSERT_EQ(p.variants, 1);
    ASSERT_FALSE(p.bilinear() || p.in_world || p.scaled_by_view);
    for (int row = 0; row < side; ++row)
      for (int column = 0; column < side; ++column)
        ASSERT_EQ(p.offset(0, row * side + column),
                  glm::vec3(p.offset(0, column * (side + 1)).x, p.offset(0, row * (side + 1)).y, 0));
  }
  EXPECT_EQ(squares, 5);
}

// A tap is a texel of a block of the level that is read; with a place of its own that keeps its distance to P. Brute force:
// the weights of the level's texels by their hats, shared out over their blocks.
TEST(TapPattern, OfALevelIsItsTexelsShareOfTheBlend) {
  Settings s;
  s.lookup.kind = "vsm";
  s.filter = filter("gaussian", 3);
  const std::vector<double> kernel = find_filter("gaussian").blur(s.filter);
  for (const int level : {0, 1, 2, 3}) {
    s.lookup["level"] = level;
    const TapPattern p = tap_pattern(s);
    const int block = 1 << level;
    ASSERT_EQ(p.block, block);
    ASSERT_EQ(p.taps, 16 * block * block);
    LookupProbe probe;
    probe.pattern = p;
    double reach = 0;
    for (const float x : {0.0f, 0.25f, 3.5f, 7.75f, 4.9375f, 5.9375f, 11.9375f, 15.9375f}) {
      const glm::vec2 at(x, 16 - x);
      std::map<std::pair<int, int>, double> weights;
      double sum = 0;
      for (int t = 0; t < p.taps; ++t) {
        const glm::ivec2 texel = probe.texel_at(at, 0, t);
        EXPECT_EQ(weights.count({texel.x, texel.y}), 0u);
        weights[{texel.x, texel.y}] = probe.weight_at(at, t);
        sum += probe.weight_at(at, t);
        const glm::vec2 way = glm::abs(glm::vec2(texel) + 0.5f - at);
        reach = std::max<double>({reach, way.x, way.y});
        // The exact place is within half a block of the texel's centre.
        const glm::vec2 moved = glm::abs(at + glm::vec2(p.offset(0, t)) - (glm::vec2(texel) + 0.5f));
        EXPECT_LE(std::max(moved.x, moved.y), static_cast<float>(block) / 2);
      }
      EXPECT_NEAR(sum, 1, 1e-12);
      const auto along = [&](int texel, double position) {
        const double middle = std::floor(texel / static_cast<double>(block));
        double weight = 0;
        for (int k = -1; k <= 1; ++k)
          weight +=
              kernel[static_cast<size_t>(k + 1)] * std::max(0.0, 1 - std::abs(position / block - 0.5 - middle + k));
        return weight / block;
      };
      for (int v = -8; v < 40; ++v)
        for (int u = -8; u < 40; ++u) {
          const auto found = weights.find({u, v});
          EXPECT_NEAR(found == weights.end() ? 0 : found->second,
                      along(u, static_cast<double>(at.x)) * along(v, static_cast<double>(at.y)), 1e-12)
              << level << " " << x << " " << u << " " << v;
        }
    }
    EXPECT_LE(reach, p.reach_texels());
    EXPECT_GT(reach, p.reach_texels() - 0.6);
  }
}

TEST(TapPattern, OfABoxHasItsStepAndItsMiddle) {
  FilterSettings f = filter("box", 5);
  f["step_texels"] = 1.5;
  const TapPattern p = tap_pattern(f);
  std::set<std::pair<float, float>> places;
  for (int t = 0; t < p.taps; ++t) {
    const glm::vec3 o = p.offset(0, t);
    EXPECT_EQ(o, glm::vec3(1.5f * static_cast<float>(t % 5 - 2), 1.5f * static_cast<float>(t / 5 - 2), 0));
    places.insert({o.x, o.y});
  }
  EXPECT_EQ(places.size(), 25);
  EXPECT_EQ(p.reach_texels(), 3.5);
  EXPECT_EQ(tap_pattern(filter("none")).reach_texels(), 0.5);
  EXPECT_EQ(tap_pattern(filter("hardware")).reach_texels(), 1);
  EXPECT_EQ(tap_pattern(filter("gaussian", 5)).reach_texels(), 3);
}

// The weights are the bilinear blend of a kernel: the texels' weights when P lies on a texel's centre.
TEST(TapPattern, CastanosWeightsAreItsKernelBlended) {
  const std::map<int, std::vector<double>> kernels = {
      {3, {1, 2, 1}}, {5, {1, 3, 4, 3, 1}}, {7, {1, 5, 12, 16, 12, 5, 1}}};
  for (const auto& [size, kernel] : kernels) {
    const TapPattern p = tap_pattern(filter("castano", size));
    double sum = 0;
    for (double k : kernel) sum += k;
    const auto at = [&, size = size, &kernel = kernel](int i) {
      return i < 0 || i >= size ? 0 : kernel[static_cast<size_t>(i)] / sum;
    };
    for (double s : {0.0, 0.25, 0.75})
      for (int texel = 0; texel <= size; ++texel)
        EXPECT_NEAR(p.axis_weight(texel, s, size), (1 - s) * at(texel) + s * at(texel - 1), 1e-15) << size;
    EXPECT_EQ(p.taps, (size + 1) * (size + 1));
    EXPECT_EQ(p.reach_texels(), (size + 1) / 2.0);
  }
}

// The weight of a texel is the integral of the tent over it, here summed in a thousand steps.
TEST(TapPattern, ATentIsIntegratedOverEachTexel) {
  for (int size : {3, 5, 7}) {
    const TapPattern p = tap_pattern(filter("tent", size));
    const double half_base = size / 2.0;
    for (double s : {0.0, 0.3, 0.9})
      for (int texel = 0; texel <= size; ++texel) {
        const double left = texel - size / 2 - 0.5 - s;  // the texel's left side, from P
        double area = 0;
        for (int step = 0; step < 1000; ++step)
          area += std::max(0.0, 1 - std::abs(left + (step + 0.5) / 1000) / half_base) / half_base / 1000;
        EXPECT_NEAR(p.axis_weight(texel, s, size), area, 1e-6) << size << " " << texel << " " << s;
      }
    EXPECT_EQ(p.reach_texels(), (size + 1) / 2.0);
  }
}

TEST(TapPattern, VogelsTapsFillADiskEvenly) {
  FilterSettings settings = filter("vogel");
  settings["taps"] = 40;
  settings["radius_texels"] = 3;
  for (const bool rotate : {false, true}) {
    settings["rotate"] = rotate;
    const TapPattern p = tap_pattern(settings);
    EXPECT_EQ(p.taps, 40);
    EXPECT_EQ(p.variants, rotate ? 25 : 1) << "as many rotations as the shader has room for";
    ASSERT_EQ(p.offsets.size(), static_cast<size_t>(p.taps * p.variants));
    for (int v = 0; v < p.variants; ++v) {
      // An inner disk with a quarter of the area has a quarter of the taps, and the mean of all taps is near the centre
      // of the disk.
      int inner = 0;
      glm::dvec2 middle(0);
      for (int t = 0; t < p.taps; ++t) {
        const glm::dvec2 o(p.offset(v, t));
        EXPECT_LE(glm::length(o), 3);
        inner += glm::length(o) < 1.5;
        middle += o / 40.0;
      }
      EXPECT_EQ(inner, 10);
      EXPECT_LT(glm::length(middle), 0.1);
    }
  }
}

// At the ends of every parameter's range, alone and with the rotation.
TEST(TapPattern, FitsIntoTheShadersTable) {
  for (const Filter& row : filters())
    for (const KindRead<FilterSettings>& read : row.reads)
      for (const bool rotate : {false, true}) {
        const KindParameter& p = *read.parameter;
        const double last = p.type == ValueType::flag ? 1 : p.choices.empty() ? p.max : double(p.choices.size() - 1);
        for (const double value : {p.min, last}) {
          FilterSettings settings(std::string(row.name), {{p.name(), value}});
          if (rotate) settings["rotate"] = 1;
          if (read.why_refused && !read.why_refused(settings).empty()) continue;
          const TapPattern pattern = tap_pattern(settings);
          EXPECT_GT(pattern.taps, 0) << row.name << ", " << p.name() << " = " << value;
          if (!pattern.bilinear()) {
            EXPECT_LE(pattern.offsets.size(), static_cast<size_t>(most_listed_taps))
                << row.name << ", " << p.name() << " = " << value;
          }
        }
      }
}

TEST(TapPattern, WeightsSumToOneWhereverPLies) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  for (const Filter& row : filters()) {
    const std::string kind(row.name);
    for (int size : {1, 3, 5, 7}) {
      const FilterSettings settings = filter(kind, size);
      const auto refused = [&](const KindRead<FilterSettings>& read) {
        return read.why_refused && !read.why_refused(settings).empty();
      };
      if (std::any_of(row.reads.begin(), row.reads.end(), refused)) continue;
      const TapPattern p = tap_pattern(settings);
      for (int i = 0; i < 50; ++i) {
        // The first four places are the corners, where a row of taps has the weight 0.
        const glm::dvec2 fraction = i < 4 ? glm::dvec2(i % 2, i / 2) : glm::dvec2(share(random), share(random));
        double sum = 0;
        for (int t = 0; t < p.taps; ++t) {
          EXPECT_GE(p.weight(t, fraction), 0);
          sum += p.weight(t, fraction);
        }
        EXPECT_NEAR(sum, 1, 1e-14);
      }
    }
  }
}

// A comparison sampler blends four texels for each of N x N fetches, by the place of the fetch between their centres
// (OpenGL 4.5 core, 8.14.2). The weights of the taps in the table must equal the sums of these blends.
TEST(TapPattern, OfFetchesWeighsTexelsAsTheSamplerDoes) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> somewhere(20, 30);
  for (int size : {1, 3, 5}) {
    FilterSettings f = filter(size == 1 ? "hardware" : "gaussian", size);
    f["sigma_texels"] = 1.25;
    LookupProbe probe;
    probe.pattern = tap_pattern(f);
    for (int i = 0; i < 200; ++i) {
      const glm::vec2 at(somewhere(random), somewhere(random));
      probe.map_texels = Image<glm::vec2>(1, 1, at);
      std::map<std::pair<int, int>, double> expected, found;
      double whole = 0;
      const auto gauss = [&](int n) { return size == 1 ? 1 : std::exp(-n * n / (2 * 1.25 * 1.25)); };
      const int r = (size - 1) / 2;
      for (int dy = -r; dy <= r; ++dy)
        for (int dx = -r; dx <= r; ++dx) {
          const double u = static_cast<double>(at.x) + dx - 0.5, v = static_cast<double>(at.y) + dy - 0.5,
                       g = gauss(dx) * gauss(dy);
          const double i0 = std::floor(u), j0 = std::floor(v);
          for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 2; ++x)
              expected[{static_cast<int>(i0) + x, static_cast<int>(j0) + y}] +=
                  g * (x ? u - i0 : 1 - (u - i0)) * (y ? v - j0 : 1 - (v - j0));
          whole += g;
        }
      for (int t = 0; t < probe.taps(); ++t) {
        const glm::ivec2 texel = probe.texel(0, t);
        found[{texel.x, texel.y}] += probe.weight(0, t);
      }
      ASSERT_EQ(found.size(), expected.size());
      // P - 1/2 is rounded to float: by half a last place of a number below 32.
      for (const auto& [texel, weight] : expected) ASSERT_NEAR(found.at(texel), weight / whole, 4 * 0x1p-20);
    }
  }
}

// The truth uses a tap's exact place. The texel nearest to it must be the one that the sampler reads.
TEST(TapPattern, OfFetchesReadsTheTexelNearestToEachTapsPlace) {
  std::mt19937 random(3);
  for (int size : {1, 3, 5}) {
    LookupProbe probe;
    probe.pattern = tap_pattern(filter(size == 1 ? "hardware" : "gaussian", size));
    for (int i = 0; i < 500; ++i) {
      // Odd multiples of 1/128 texel: no place is a tie, and float sums are exact.
      const auto place = [&] { return static_cast<float>(2 * (random() % 3200) + 1) / 128; };
      const glm::vec2 at(place(), place());
      probe.map_texels = Image<glm::vec2>(1, 1, at);
      for (int t = 0; t < probe.taps(); ++t)
        ASSERT_EQ(probe.texel(0, t), glm::ivec2(glm::floor(at + glm::vec2(probe.offset(0, t)))));
    }
  }
}

TEST(TapPattern, OfAPoissonDiskIsSpreadOverIt) {
  FilterSettings f = filter("poisson");
  f["radius_texels"] = 2.5;
  const TapPattern p = tap_pattern(f);
  for (int a = 0; a < p.taps; ++a) {
    EXPECT_LE(glm::length(p.offset(0, a)), 2.5f * (1 + 0x1p-22f));
    for (int b = 0; b < a; ++b)
      // The smallest distance of 16 points in a disk is at most about 0.6 of the radius: disks of half that distance
      // about the points do not overlap, and they lie in the disk grown by half that distance. The best of many
      // candidates comes near to this. By chance alone the nearest pair is a tenth of it apart.
      EXPECT_GT(glm::length(p.offset(0, a) - p.offset(0, b)), 0.3f * 2.5f) << a << ' ' << b;
  }
  EXPECT_LE(p.reach_texels(), 3);
  f["rotate"] = true;
  const TapPattern turned = tap_pattern(f);
  for (int v = 0; v < turned.variants; ++v)
    for (int t = 0; t < turned.taps; ++t) {
      EXPECT_NEAR(glm::length(turned.offset(v, t)), glm::length(p.offset(0, t)), 1e-6);
      if (v > 0 && glm::length(p.offset(0, t)) > 0.1f) {
        EXPECT_GT(glm::length(turned.offset(v, t) - turned.offset(v - 1, t)), 1e-3);
      }
    }
}

TEST(TapPattern, VariantsAreAllUsedAndNeighboursDiffer) {
  std::vector<int> used(64, 0);
  int same = 0;
  for (uint32_t pixel = 0; pixel < 64 * 1000; ++pixel) {
    ++used[static_cast<size_t>(tap_variant(pixel, 64))];
    same += tap_variant(pixel, 64) == tap_variant(pixel + 1, 64);
    EXPECT_EQ(tap_variant(pixel, 1), 0);
  }
  for (int count : used) EXPECT_NEAR(count, 1000, 200);  // six standard deviations of a fair random draw
  EXPECT_LT(same, 1200);
}

// The loops of the tutorials run from -offset to +offset in steps of offset / 2, without the last value.
TEST(TapPattern, OfACubeGridIsTheTutorials) {
  FilterSettings f = filter("cube_grid");
  f["offset_m"] = 0.1;
  const TapPattern p = tap_pattern(f);
  std::set<std::array<float, 3>> places;
  for (const glm::vec3& o : p.offsets) places.insert({o.x, o.y, o.z});
  EXPECT_EQ(places.size(), 64);
  std::set<float> along;
  for (const auto& place : places) along.insert(place[0]);
  EXPECT_EQ(along, (std::set<float>{-0.1f, -0.05f, 0.0f, 0.05f}));
}

TEST(TapPattern, OfACubeDiskIsTheTutorials20Directions) {
  FilterSettings f = filter("cube_disk");
  f["radius_m"] = 0.5;
  int corners = 0, edges = 0;
  std::set<std::array<float, 3>> places;
  for (const glm::vec3& o : tap_pattern(f).offsets) {
    places.insert({o.x, o.y, o.z});
    const float length = glm::length(o);
    corners += std::abs(length - 0.5f * std::sqrt(3.0f)) < 1e-6f;
    edges += std::abs(length - 0.5f * std::sqrt(2.0f)) < 1e-6f;
  }
  EXPECT_EQ(places.size(), 20);
  EXPECT_EQ(corners, 8);
  EXPECT_EQ(edges, 12);
  EXPECT_FALSE(tap_pattern(f).scaled_by_view);
  f["disk"] = 1;  // the receiver's own radius is the factor, not radius_m
  EXPECT_TRUE(tap_pattern(f).scaled_by_view);
  LookupProbe probe;
  probe.pattern = tap_pattern(f);
  probe.radius = Image<float>(2, 1, 0.04f);
  probe.radius[1] = 0.25f;
  for (int t = 0; t < 20; ++t) {
    EXPECT_EQ(probe.offset(0, t), 0.04f * probe.pattern.offset(0, t));
    EXPECT_EQ(probe.offset(1, t), 0.25f * probe.pattern.offset(0, t));
  }
}

}  // namespace
}  // namespace noonmark
