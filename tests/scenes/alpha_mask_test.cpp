// MaskCutter against the texture itself, sampled at points, and against exact areas. The corners lie on tilted planes,
// so that rounding to float is part of each test.
#include "scenes/alpha_mask.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace noonmark {
namespace {

using Corners = std::array<glm::vec3, 3>;
using Coordinates = std::array<glm::dvec2, 3>;

AlphaMask random_mask(std::mt19937& random, int width, int height, MaskFilter filter, MaskWrap u, MaskWrap v,
                      bool smooth = false) {
  AlphaMask mask{width, height, {}, u, v, filter, 1, 0.5};
  for (int i = 0; i < width * height; ++i)
    mask.alpha.push_back(static_cast<uint8_t>(smooth ? random() % 256 : random() % 2 * 255));
  return mask;
}

// The texture sampled again, from the texts of OpenGL 4.5 (section 8.14) and glTF 2.0 (section 3.9.4) alone.
double texel(const AlphaMask& mask, double i, double j) {
  const auto index = [](double k, int size, MaskWrap wrap) {
    if (wrap == MaskWrap::clamp) return static_cast<int>(std::clamp(k, 0.0, size - 1.0));
    const double periods = std::floor(k / size);
    const int within = static_cast<int>(k - periods * size);
    const bool back = wrap == MaskWrap::mirrored && std::fmod(periods, 2) != 0;
    return back ? size - 1 - within : within;
  };
  return mask.factor *
         mask.alpha[static_cast<size_t>(index(j, mask.height, mask.wrap_v) * mask.width +
                                        index(i, mask.width, mask.wrap_u))] /
         255;
}
bool sampled(const AlphaMask& mask, glm::dvec2 uv) {
  const glm::dvec2 at = uv * glm::dvec2(mask.width, mask.height);
  if (mask.filter == MaskFilter::nearest) return texel(mask, std::floor(at.x), std::floor(at.y)) >= mask.cutoff;
  const glm::dvec2 low = glm::floor(at - 0.5), f = at - 0.5 - low;
  double sum = 0;
  for (int j : {0, 1})
    for (int i : {0, 1}) sum += (i ? f.x : 1 - f.x) * (j ? f.y : 1 - f.y) * texel(mask, low.x + i, low.y + j);
  return sum >= mask.cutoff;
}

// The plane z = 0.3 x - 0.7 y + 1, with (u, v) along x and y: a point of it by its texture coordinates.
glm::dvec3 on_plane(glm::dvec2 uv) { return {uv.x, uv.y, 0.3 * uv.x - 0.7 * uv.y + 1}; }
constexpr double area_factor = 1.25698050899765;  // sqrt(1 + 0.3^2 + 0.7^2), of the plane over its texture

Corners placed(const Coordinates& uv) {
  Corners corners;
  for (size_t k = 0; k < 3; ++k) corners[k] = glm::vec3(on_plane(uv[k]));
  return corners;
}

double area(const MaskCutter::Pieces& pieces) {
  double sum = 0;
  for (const glm::uvec3& t : pieces.triangles) {
    const glm::dvec3 a(pieces.positions[t.x]), b(pieces.positions[t.y]), c(pieces.positions[t.z]);
    sum += glm::length(glm::cross(b - a, c - a)) / 2;
  }
  return sum;
}

double side(glm::dvec2 a, glm::dvec2 b, glm::dvec2 p) { return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x); }

// How many pieces hold the point, and how near it comes to a side of one of them.
struct Held {
  int times = 0;
  double margin = 1e9;
};
Held held(const MaskCutter::Pieces& pieces, glm::dvec2 p) {
  Held out;
  for (const glm::uvec3& t : pieces.triangles) {
    double inside = 1e9;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec2 a(pieces.positions[t[k]]), b(pieces.positions[t[(k + 1) % 3]]);
      inside = std::min(inside, side(a, b, p) / glm::length(b - a));
    }
    out.times += inside > 0;
    out.margin = std::min(out.margin, std::abs(inside));
  }
  return out;
}

constexpr Coordinates lower = {{{0, 0}, {1, 0}, {1, 1}}}, upper = {{{0, 0}, {1, 1}, {0, 1}}};

TEST(AlphaMask, NearestKeepsExactlyTheAreaOfTheOpaqueTexels) {
  std::mt19937 random(1);
  for (const auto& [width, height] : {std::pair(1, 1), {2, 2}, {7, 5}, {16, 16}, {33, 20}}) {
    const AlphaMask mask = random_mask(random, width, height, MaskFilter::nearest, MaskWrap::repeat, MaskWrap::repeat);
    const MaskCutter cutter(mask);
    double sum = 0, texels = 0;
    for (const Coordinates& uv : {lower, upper}) {
      MaskCutter::Pieces pieces;
      cutter.cut(placed(uv), uv, pieces);
      sum += area(pieces);
    }
    for (uint8_t a : mask.alpha) texels += a > 0;
    EXPECT_NEAR(sum, area_factor * texels / (width * height), 1e-6) << width << " x " << height;
  }
}

// Every point is in a piece exactly if the texture is opaque there, whatever the wrap, the place and the winding. Points
// nearer to a side of a piece than rounding to float are not asked.
TEST(AlphaMask, PiecesAreWhereTheTextureIsOpaque) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-2.5, 2.5), weight(0, 1);
  constexpr MaskWrap wraps[] = {MaskWrap::repeat, MaskWrap::mirrored, MaskWrap::clamp};
  int asked = 0, opaque = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const AlphaMask mask = random_mask(random, 1 + static_cast<int>(random() % 9), 1 + static_cast<int>(random() % 9),
                                       MaskFilter::nearest, wraps[random() % 3], wraps[random() % 3]);
    const MaskCutter cutter(mask);
    const Coordinates uv = {
        {{place(random), place(random)}, {place(random), place(random)}, {place(random), place(random)}}};
    MaskCutter::Pieces pieces;
    cutter.cut(placed(uv), uv, pieces);
    for (const glm::uvec3& t : pieces.triangles) {  // the winding of the triangle
      const auto wound = [&](const auto& a, const auto& b, const auto& c) { return side(a, b, c) > 0; };
      ASSERT_EQ(wound(glm::dvec2(pieces.positions[t.x]), glm::dvec2(pieces.positions[t.y]),
                      glm::dvec2(pieces.positions[t.z])),
                wound(uv[0], uv[1], uv[2]));
    }
    if (side(uv[0], uv[1], uv[2]) < 0)
      for (glm::uvec3& t : pieces.triangles) std::swap(t.y, t.z);
    for (int i = 0; i < 200; ++i) {
      double a = weight(random), b = weight(random);
      if (a + b > 1) a = 1 - a, b = 1 - b;
      const glm::dvec2 p = uv[0] + a * (uv[1] - uv[0]) + b * (uv[2] - uv[0]);
      const Held found = held(pieces, p);
      if (found.margin < 1e-6) continue;
      ASSERT_EQ(found.times, sampled(mask, p) ? 1 : 0) << "trial " << trial << " at " << p.x << ", " << p.y;
      ++asked, opaque += found.times;
    }
  }
  EXPECT_GT(asked, 10000);
  EXPECT_GT(opaque, asked / 4);
}

// If alpha is a linear function of the place, the border of the mask is a straight line. Then the cut is exact with linear
// filtering too.
TEST(AlphaMask, LinearFollowsAStraightBorderExactly) {
  AlphaMask mask{8, 8, {}, MaskWrap::clamp, MaskWrap::clamp, MaskFilter::linear, 1, 0.4};
  for (int j = 0; j < 8; ++j)
    for (int i = 0; i < 8; ++i) mask.alpha.push_back(static_cast<uint8_t>(20 * i + 11 * j));
  const MaskCutter cutter(mask);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0.07, 0.93);
  for (int trial = 0; trial < 20; ++trial) {
    const Coordinates uv = {
        {{place(random), place(random)}, {place(random), place(random)}, {place(random), place(random)}}};
    if (side(uv[0], uv[1], uv[2]) < 0.01) continue;
    MaskCutter::Pieces pieces;
    cutter.cut(placed(uv), uv, pieces);
    for (int i = 0; i < 100; ++i) {
      const double a = place(random) / 2, b = place(random) / 2;
      const glm::dvec2 p = uv[0] + a * (uv[1] - uv[0]) + b * (uv[2] - uv[0]);
      const Held found = held(pieces, p);
      if (found.margin < 1e-6) continue;
      ASSERT_EQ(found.times, sampled(mask, p) ? 1 : 0) << p.x << ", " << p.y;
    }
  }
}

// Whether the texture says the same in the whole neighbourhood of a point, as far as a ring of samples tells.
bool same_around(const AlphaMask& mask, glm::dvec2 uv, double texels) {
  const bool here = sampled(mask, uv);
  for (int k = 0; k < 32; ++k) {
    const double angle = k * std::numbers::pi / 16;
    const glm::dvec2 way(std::cos(angle), std::sin(angle));
    if (sampled(mask, uv + texels * way / glm::dvec2(mask.width, mask.height)) != here) return false;
  }
  return true;
}

// Random alpha is the worst case: a third of its squares of four centres have a bent border. No point is on the wrong
// side of the pieces' border that is further from the texture's border than the pieces say, and hardly any is nearer.
TEST(AlphaMask, LinearFollowsTheBilinearBorderWithinItsError) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> weight(0, 1);
  int all = 0, near = 0, wrong = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const MaskWrap wraps[] = {MaskWrap::repeat, MaskWrap::mirrored, MaskWrap::clamp};
    const AlphaMask mask = random_mask(random, 6 + trial % 5, 7, MaskFilter::linear, wraps[trial % 3],
                                       wraps[(trial + trial / 3) % 3], trial % 2 == 1);
    const MaskCutter cutter(mask);
    MaskCutter::Pieces pieces;
    cutter.cut(placed(lower), lower, pieces);
    // The longest step of a texel on the plane is that of the wider texel, up its steepest slope.
    const double metres = cutter.metres_per_texel(placed(lower), lower);
    EXPECT_LE(pieces.error_m, MaskCutter::finest_error_texels * metres);
    EXPECT_GT(pieces.error_m, 0);
    for (int i = 0; i < 4000; ++i) {
      double a = weight(random), b = weight(random);
      if (a < b) std::swap(a, b);
      const Held found = held(pieces, {a, b});
      ASSERT_LE(found.margin < 1e-6 ? 0 : found.times, 1);
      const bool differs = (found.times > 0) != sampled(mask, {a, b});
      const bool firm = same_around(mask, {a, b}, 1.01 * MaskCutter::finest_error_texels);
      ASSERT_FALSE(differs && firm && found.margin > 1e-6) << "trial " << trial << " at " << a << ", " << b;
      ++all, near += !firm, wrong += differs;
    }
  }
  EXPECT_LT(near, all / 1000 + 30);  // 0.1%, and three standard deviations of such a count
  EXPECT_LE(wrong, near + 5);        // and those that rounding to float moved
}

TEST(AlphaMask, ACoarserErrorTakesFewerPieces) {
  std::mt19937 random(9);
  const AlphaMask mask = random_mask(random, 16, 16, MaskFilter::linear, MaskWrap::repeat, MaskWrap::repeat);
  const MaskCutter cutter(mask);
  size_t before = SIZE_MAX;
  for (const double error : {MaskCutter::finest_error_texels, 0.01, 1.0}) {
    MaskCutter::Pieces pieces;
    cutter.cut(placed(lower), lower, pieces, UINT64_MAX, error);
    EXPECT_LE(pieces.error_m, error * cutter.metres_per_texel(placed(lower), lower));
    EXPECT_LT(pieces.triangles.size(), before);
    before = pieces.triangles.size();
  }
}

TEST(AlphaMask, ATexelIsAsLongAsItsLongestStep) {
  const MaskCutter cutter({4, 2, std::vector<uint8_t>(8, 255)});
  // u along the plane by 3 m, v by 0.5 m and sheared: a texel measures 0.75 m along u.
  const Coordinates uv = {{{0, 0}, {1, 0}, {0, 1}}};
  EXPECT_NEAR(cutter.metres_per_texel({{{0, 0, 0}, {3, 0, 0}, {0, 0.5f, 0}}}, uv), 0.75, 1e-12);
  const double sheared = cutter.metres_per_texel({{{0, 0, 0}, {3, 0, 0}, {3, 0.5f, 0}}}, uv);
  double longest = 0;  // of all directions
  for (int k = 0; k < 3600; ++k) {
    const double angle = k * std::numbers::pi / 3600;
    longest =
        std::max(longest, glm::length(std::cos(angle) * glm::dvec2(0.75, 0) + std::sin(angle) * glm::dvec2(1.5, 0.25)));
  }
  EXPECT_NEAR(sheared, longest, 1e-5);
  EXPECT_EQ(cutter.metres_per_texel(placed(lower), {{{0, 0}, {1, 1}, {2, 2}}}), 0);
}

struct Less {
  bool operator()(const glm::vec3& a, const glm::vec3& b) const {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  }
};

// Two triangles beside each other: every side of a piece is the side of exactly one other piece, or it lies on the
// border of the mask or at the outline. A T-junction would leave sides without a partner where both sides are opaque.
TEST(AlphaMask, PiecesShareTheirSidesAlsoAcrossTriangles) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-1.3, 1.3);
  constexpr MaskWrap wraps[] = {MaskWrap::repeat, MaskWrap::mirrored, MaskWrap::clamp};
  int joined = 0;
  for (int trial = 0; trial < 80; ++trial) {
    const bool nearest = trial % 2 == 0;
    const AlphaMask mask = random_mask(random, 3 + static_cast<int>(random() % 14), 2 + static_cast<int>(random() % 9),
                                       nearest ? MaskFilter::nearest : MaskFilter::linear, wraps[random() % 3],
                                       wraps[random() % 3], trial % 4 == 1);
    const MaskCutter cutter(mask);
    Coordinates first = {
        {{place(random), place(random)}, {place(random), place(random)}, {place(random), place(random)}}};
    if (trial % 3 == 0) first = lower;  // sides along the texels, and a diagonal through their corners
    if (side(first[0], first[1], first[2]) < 0) std::swap(first[1], first[2]);
    Coordinates second = {{first[0], first[2], first[2] + (first[0] - first[1])}};
    if (trial % 3 == 0) second = upper;
    std::map<std::tuple<float, float, float, float, float, float>, int> sides;
    const auto key = [](const glm::vec3& a, const glm::vec3& b) { return std::tuple(a.x, a.y, a.z, b.x, b.y, b.z); };
    for (const Coordinates& uv : {first, second}) {
      MaskCutter::Pieces pieces;
      cutter.cut(placed(uv), uv, pieces);
      for (const glm::uvec3& t : pieces.triangles)
        for (int k = 0; k < 3; ++k) ++sides[key(pieces.positions[t[k]], pieces.positions[t[(k + 1) % 3]])];
    }
    const auto inside = [&](glm::dvec2 p) {  // one of the two, and not at a side of it
      for (const Coordinates* uv : {&first, &second}) {
        double least = 1e9;
        for (size_t k = 0; k < 3; ++k) {
          const glm::dvec2 from = (*uv)[k], to = (*uv)[(k + 1) % 3];
          least = std::min(least, side(from, to, p) / glm::length(to - from));
        }
        if (least > 1e-6) return true;
      }
      return false;
    };
    for (const auto& [ends, times] : sides) {
      const auto& [ax, ay, az, bx, by, bz] = ends;
      EXPECT_EQ(times, 1);
      const auto other = sides.find({bx, by, bz, ax, ay, az});
      if (other != sides.end()) {
        ++joined;
        continue;
      }
      const glm::dvec2 a(ax, ay), b(bx, by), middle = (a + b) / 2.0;
      const double length = glm::length(b - a);
      if (length < 1e-4) continue;
      const glm::dvec2 across = 2e-6 * glm::dvec2(a.y - b.y, b.x - a.x) / length;  // beyond rounding to float
      if (!inside(middle + across) || !inside(middle - across)) continue;
      if (nearest) {
        EXPECT_FALSE(sampled(mask, middle + across) && sampled(mask, middle - across))
            << "trial " << trial << ": " << middle.x << ", " << middle.y;
      } else {
        // In a square of four opaque centres there is no border.
        const glm::dvec2 texel = 1.0 / glm::dvec2(mask.width, mask.height);
        const glm::dvec2 low = (glm::floor(middle / texel - 0.5) + 0.5) * texel;
        const auto centre = [&](double i, double j) { return sampled(mask, low + glm::dvec2(i, j) * texel); };
        const glm::dvec2 in = (middle - low) / texel;
        if (in.x < 1e-3 || in.x > 0.999 || in.y < 1e-3 || in.y > 0.999) continue;
        EXPECT_FALSE(centre(0, 0) && centre(1, 0) && centre(0, 1) && centre(1, 1))
            << "trial " << trial << ": " << middle.x << ", " << middle.y;
      }
    }
  }
  EXPECT_GT(joined, 1000);
}

TEST(AlphaMask, LargeUniformPartsAreCutIntoFewPieces) {
  AlphaMask mask{
      256, 256, std::vector<uint8_t>(256 * 256, 255), MaskWrap::repeat, MaskWrap::repeat, MaskFilter::nearest, 1, 0.5};
  MaskCutter::Pieces pieces;
  MaskCutter(mask).cut(placed(lower), lower, pieces);
  EXPECT_EQ(pieces.triangles.size(), 1u);  // nothing is hidden
  EXPECT_EQ(pieces.positions.size(), 3u);
  mask.alpha[256 * 128 + 200] = 0;
  MaskCutter(mask).cut(placed(lower), lower, pieces);
  EXPECT_GT(pieces.triangles.size(), 1u);
  EXPECT_LT(pieces.triangles.size(), 200u);  // some for each halving of 256 by 256
  mask.alpha.assign(256 * 256, 0);
  MaskCutter(mask).cut(placed(lower), lower, pieces);
  EXPECT_TRUE(pieces.triangles.empty());
}

TEST(AlphaMask, FactorAndCutoffDecideAsGltfSays) {
  AlphaMask mask{1, 1, {128}, MaskWrap::repeat, MaskWrap::repeat, MaskFilter::linear, 1, 128 / 255.0};
  MaskCutter::Pieces pieces;
  const auto kept = [&] {
    MaskCutter(mask).cut(placed(lower), lower, pieces);
    return !pieces.triangles.empty();
  };
  EXPECT_TRUE(kept());  // at least the cutoff is opaque
  mask.factor = 0.99;
  EXPECT_FALSE(kept());
  mask.cutoff = 0;
  mask.factor = 0;
  EXPECT_TRUE(kept());
}

TEST(AlphaMask, SaysOfAPointWhatTheTextureSays) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> place(-3, 3);
  constexpr MaskWrap wraps[] = {MaskWrap::repeat, MaskWrap::mirrored, MaskWrap::clamp};
  for (int trial = 0; trial < 2000; ++trial) {
    const AlphaMask mask = random_mask(random, 1 + static_cast<int>(random() % 4), 1 + static_cast<int>(random() % 4),
                                       trial % 2 ? MaskFilter::nearest : MaskFilter::linear, wraps[random() % 3],
                                       wraps[random() % 3], true);
    const glm::dvec2 at(place(random), place(random));
    ASSERT_EQ(mask.opaque_at(at), sampled(mask, at));
  }
}

TEST(AlphaMask, TextureCoordinatesWithoutAnArea) {
  AlphaMask mask{2, 1, {255, 0}, MaskWrap::repeat, MaskWrap::repeat, MaskFilter::nearest, 1, 0.5};
  const MaskCutter cutter(mask);
  MaskCutter::Pieces pieces;
  const Coordinates shown = {{{0.25, 0}, {0.25, 0}, {0.25, 0}}}, hidden = {{{0.75, 0.1}, {0.75, 0.5}, {0.75, 0.9}}};
  cutter.cut(placed(lower), shown, pieces);
  EXPECT_EQ(pieces.triangles, std::vector<glm::uvec3>{glm::uvec3(0, 1, 2)});
  cutter.cut(placed(lower), hidden, pieces);
  EXPECT_TRUE(pieces.triangles.empty());
}

TEST(AlphaMask, RefusesWhatCannotBeCut) {
  AlphaMask mask{2, 1, {255, 0}, MaskWrap::repeat, MaskWrap::repeat, MaskFilter::nearest, 1, 0.5};
  const MaskCutter cutter(mask);
  MaskCutter::Pieces pieces;
  const auto scaled = [](double by) { return Coordinates{{{0, 0}, {by, 0}, {by, by}}}; };
  EXPECT_THROW(cutter.cut(placed(lower), scaled(1e5), pieces), MaskCutter::TooManyPieces);
  EXPECT_THROW(cutter.cut(placed(lower), scaled(1e30), pieces), MaskCutter::TooManyPieces);
  EXPECT_THROW(cutter.cut(placed(lower), scaled(10), pieces, 50), MaskCutter::TooManyPieces);
  EXPECT_NO_THROW(cutter.cut(placed(lower), scaled(10), pieces));
  mask.width = 3;
  EXPECT_THROW(MaskCutter{mask}, std::invalid_argument);
}

}  // namespace
}  // namespace noonmark
