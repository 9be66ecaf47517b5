// What was done to the picture after the lookup is named, and no shadow is taken for it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/frames/wrong_delivery.h"

namespace noonmark::test {
namespace {

// As shown: where there is no surface, the sky's 1; afterwards again none.
Image<float> processed(const Image<float>& v, const std::function<Image<float>(const Image<float>&)>& f) {
  Image<float> whole = v;
  for (float& value : whole.pixels) value = std::isnan(value) ? 1 : value;
  Image<float> result = f(whole);
  for (size_t i = 0; i < v.size(); ++i)
    if (std::isnan(v[i])) result[i] = v[i];
  return result;
}

// The steps of JPEG that lose something: each block's cosines are rounded, and then the values.
Image<float> through_jpeg(const Image<float>& v) {
  constexpr int side = 8;
  constexpr double step = 24 / 255.0;  // of a middle frequency at quality 75
  const auto cosine = [](int k, int x) {
    return (k == 0 ? std::sqrt(0.125) : 0.5) * std::cos((2 * x + 1) * k * 3.14159265358979 / 16);
  };
  Image<float> result = v;
  for (int top = 0; top + side <= v.height; top += side)
    for (int left = 0; left + side <= v.width; left += side) {
      std::array<std::array<double, side>, side> rounded{};
      for (int k = 0; k < side; ++k)
        for (int l = 0; l < side; ++l) {
          double sum = 0;
          for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) sum += cosine(k, y) * cosine(l, x) * v.at(left + x, top + y);
          rounded[k][l] = k + l == 0 ? sum : step * std::round(sum / step);
        }
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
          double sum = 0;
          for (int k = 0; k < side; ++k)
            for (int l = 0; l < side; ++l) sum += cosine(k, y) * cosine(l, x) * rounded[k][l];
          result.at(left + x, top + y) = static_cast<float>(std::round(std::clamp(sum, 0.0, 1.0) * 255) / 255);
        }
    }
  return result;
}

TEST(Samples, AJpegIsNamed) { expect_named(with(processed(good().frame.visibility, through_jpeg)), "samples", "JPEG"); }

// How near to a pixel of the other truth in its row or column each pixel is, and its value as far off as `off` says of that distance.
CheckResult samples_with_values_off(const std::function<float(int)>& off) {
  constexpr int farthest = 8;
  static const Delivered from = good_frame("street", 640, 360);
  const Image<float>& truth = from.frame.visibility;  // the good frame has no error
  Image<float> v = truth;
  for (int y = 0; y < v.height; ++y)
    for (int x = 0; x < v.width; ++x)
      for (int k = 1; k <= farthest; ++k) {
        const auto other = [&](int a, int b) {
          return a >= 0 && b >= 0 && a < v.width && b < v.height && std::abs(truth.at(a, b) - truth.at(x, y)) > 0.5f;
        };
        if (!other(x - k, y) && !other(x + k, y) && !other(x, y - k) && !other(x, y + k)) continue;
        v.at(x, y) = std::abs(v.at(x, y) - off(k));
        break;
      }
  GivenFrame frame = from.frame;
  frame.visibility = v;
  return check_named(judge_frame(*from.scene, *from.tracer, frame, {}), "samples");
}

// What mixes samples ends at the next pixel. A filter over texels that are many pixels wide falls off slowly, and is no fault of the
// delivery.
TEST(Samples, AFilterOverWideTexelsIsNoMultisampling) {
  const CheckResult mixed = samples_with_values_off([](int k) { return k == 1 ? 0.2f : 0.0f; }),
                    wide = samples_with_values_off([](int k) { return 0.04f * static_cast<float>(9 - k); });
  EXPECT_EQ(mixed.state, CheckState::failed) << mixed.says;
  EXPECT_NE(mixed.says.find("multisampling"), std::string::npos) << mixed.says;
  EXPECT_EQ(wide.state, CheckState::passed) << "not told at all, or refused: " << wide.says;
}

// A row's mean of five pixels, as of a picture that moves, over the truth and over soft edges.
TEST(Samples, ABlurOfThePictureIsNamed) {
  const auto blurred = [](const Image<float>& v) {
    Image<float> result = v;
    for (int y = 0; y < v.height; ++y)
      for (int x = 0; x < v.width; ++x) {
        float sum = 0;
        for (int k = -2; k <= 2; ++k) sum += v.at(std::clamp(x + k, 0, v.width - 1), y);
        result.at(x, y) = sum / 5;
      }
    return result;
  };
  for (const int softened : {0, 1}) {
    const Delivered from = good_frame("street", 640, 360, softened);
    GivenFrame frame = from.frame;
    frame.visibility = processed(from.frame.visibility, blurred);
    const CheckResult found = check_named(judge_frame(*from.scene, *from.tracer, frame, {}), "samples");
    EXPECT_EQ(found.state, CheckState::failed) << found.says;
    EXPECT_NE(found.says.find("blurred"), std::string::npos) << found.says;
  }
}

// The means of 2 x 2 pixels, and between them linearly.
Image<float> half_size_and_back(const Image<float>& v) {
  Image<float> small(v.width / 2, v.height / 2, 0), result = v;
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x)
      small.at(x, y) =
          (v.at(2 * x, 2 * y) + v.at(2 * x + 1, 2 * y) + v.at(2 * x, 2 * y + 1) + v.at(2 * x + 1, 2 * y + 1)) / 4;
  for (int y = 0; y < v.height; ++y)
    for (int x = 0; x < v.width; ++x) {
      const float a = static_cast<float>(x) / 2 - 0.25f, b = static_cast<float>(y) / 2 - 0.25f;
      const auto at = [&](float column, float row) {
        return small.at(std::clamp(static_cast<int>(column), 0, small.width - 1),
                        std::clamp(static_cast<int>(row), 0, small.height - 1));
      };
      const float c = std::floor(a), r = std::floor(b), s = a - c, t = b - r;
      result.at(x, y) =
          (1 - t) * ((1 - s) * at(c, r) + s * at(c + 1, r)) + t * ((1 - s) * at(c, r + 1) + s * at(c + 1, r + 1));
    }
  return result;
}

TEST(Samples, HalfTheSizeAndBackIsNamed) {
  expect_named(with(processed(good().frame.visibility, half_size_and_back)), "samples", "half the size");
}

// The means of n x n pixels, each n x n times.
Image<float> smaller_and_repeated(const Image<float>& v, int n) {
  Image<float> result = v;
  for (int top = 0; top + n <= v.height; top += n)
    for (int left = 0; left + n <= v.width; left += n) {
      float sum = 0;
      for (int y = top; y < top + n; ++y)
        for (int x = left; x < left + n; ++x) sum += v.at(x, y);
      for (int y = top; y < top + n; ++y)
        for (int x = left; x < left + n; ++x) result.at(x, y) = sum / static_cast<float>(n * n);
    }
  return result;
}

TEST(Samples, ASmallerSizeThatIsRepeatedIsNamed) {
  struct Case {
    int n;
    const char* says;
  };
  for (const Case& one : {Case{2, "half the size"}, Case{3, "a third of the size"}}) {
    const auto made = [&](const Image<float>& v) { return smaller_and_repeated(v, one.n); };
    for (const int blur : {0, 1})
      expect_named(with(processed(good_frame("cube-room", width, height, blur).frame.visibility, made)), "samples",
                   one.says);
  }
}

// A fence that stands straight before the camera: its bars are some pixels wide, each edge is one change, and along the columns
// there is none.
TEST(Samples, LongEdgesAreOneChangeEach) {
  for (const int bar : {24, 8}) {
    Image<float> v = good().frame.visibility;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        if (!std::isnan(v.at(x, y))) v.at(x, y) = static_cast<float>(x / bar % 2);
    const CheckResult found = check_named(judge_frame(*good().scene, *good().tracer, with(v), {}), "samples");
    EXPECT_NE(found.state, CheckState::failed) << found.says;
  }
}

TEST(Samples, AnotherFrameMixedInIsNamed) {
  for (const float part : {0.1f, 0.3f, 0.45f}) {
    const auto ghost = [&](const Image<float>& v) {
      Image<float> result = v;
      for (int y = 0; y < v.height; ++y)
        for (int x = 0; x < v.width; ++x)
          result.at(x, y) = (1 - part) * v.at(x, y) + part * v.at(std::max(0, x - 6), y);
      return result;
    };
    // Of light and shadow alone: no filter's values lie beside the part.
    const Delivered hard = good_frame("cube-room", width, height, 0);
    expect_named(with(processed(hard.frame.visibility, ghost)), "samples", "has another frame mixed in");
  }
}

// A bias that moves edges by some pixels puts a filter's values on one side of the true edge alone, and texels make blocks.
TEST(Samples, ShadowsOfEveryKindPass) {
  for (const int blur : {0, 1, 3}) {
    const Delivered from = good_frame("cube-room", width, height, blur);
    GivenFrame moved = from.frame, blocks = from.frame;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (std::isnan(from.frame.visibility.at(x, y))) continue;
        if (x + 5 < width && !std::isnan(from.frame.visibility.at(x + 5, y)))
          moved.visibility.at(x, y) = from.frame.visibility.at(x + 5, y);
        if ((x / 13 + y / 13) % 2 == 0) blocks.visibility.at(x, y) *= 0.9f;
      }
    for (const GivenFrame& frame : {from.frame, moved, blocks}) {
      const CheckResult found = check_named(judge_frame(*from.scene, *from.tracer, frame, {}), "samples");
      EXPECT_NE(found.state, CheckState::failed) << blur << ": " << found.says;
    }
  }
}

// Blocks on the squares of a grid of 1 m, under a sun at 45 degrees along it: each shadow ends on a line of the grid. The roofs of the
// lower ones lie in the shadow of the higher ones, and their edges are the shadow's.
struct City {
  std::vector<std::array<glm::vec3, 2>> boxes;
  Scene scene = scene_of(boxes);
  raytrace::Tracer tracer{scene};
  GivenFrame frame;
  FrameVerdict black;
  explicit City(const Camera& camera, std::vector<std::array<glm::vec3, 2>> of = blocks())
      : boxes(std::move(of)), frame(frame_through(camera, scene)), black(judge_frame(scene, tracer, frame, {})) {}

  static std::vector<std::array<glm::vec3, 2>> blocks() {
    std::vector<std::array<glm::vec3, 2>> made{{glm::vec3(-40, -40, -1), glm::vec3(40, 40, 0)}};
    for (int x = -25; x < 25; x += 5)
      for (int y = -14; y < 14; y += 2) {
        made.push_back({glm::vec3(x, y, 0), glm::vec3(x + 1, y + 1, 2)});
        made.push_back({glm::vec3(x + 1, y, 0), glm::vec3(x + 2, y + 1, 1)});
      }
    return made;
  }
  static Scene scene_of(const std::vector<std::array<glm::vec3, 2>>& boxes) {
    static constexpr int sides[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                         {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    Scene made;
    for (const auto& box : boxes) {
      const auto first = static_cast<int>(made.positions.size());
      for (size_t i = 0; i < 8; ++i) made.positions.emplace_back(box[i & 1].x, box[i >> 1 & 1].y, box[i >> 2 & 1].z);
      for (const auto& [a, b, c] : sides) made.triangles.emplace_back(first + a, first + b, first + c);
    }
    made.light.position_m = {-10, 0, 10};
    made.light.target_m = {0, 0, 0};
    return made;
  }
  // Of any place, also of one beside the surfaces, as of a filter's tap.
  float lit(glm::vec3 p) const {
    for (const auto& [low, high] : boxes)
      if (p.y > low.y && p.y < high.y &&
          std::min(p.x - low.x, high.z - p.z) > std::max({p.x - high.x, low.z - p.z, 0.0f}))
        return 0;
    return 1;
  }
  // The frame of a map without any error, whose filter takes the mean of taps. taps_m: the way of each tap along x and along y.
  CheckResult check_of(const std::vector<float>& taps_m, std::string_view check) const {
    GivenFrame filtered = frame;
    for (size_t i = 0; i < black.error.size(); ++i) {
      const glm::vec3 p = black.receivers.position[i];
      float sum = 0;
      for (const float by : taps_m) sum += lit(p + glm::vec3(by, by, 1e-4f));
      filtered.visibility[i] = black.truth.facing[i] ? sum / static_cast<float>(taps_m.size()) : 0;
    }
    return check_named(judge_frame(scene, tracer, filtered, {}), check);
  }
};

// From above 10 pixels are a metre, so all values change at the lines of the grid.
TEST(Samples, ACityOnThePixelsIsNotRepeated) {
  const City city({.projection = Projection::orthographic,
                   .eye_m = {0, 0, 9},
                   .target_m = {0, 0, 0},
                   .height_m = 27,
                   .near_m = 0.1,
                   .far_m = 12});
  const CheckResult found = city.check_of({0}, "samples");
  EXPECT_EQ(found.state, CheckState::not_checked) << found.says;
  EXPECT_NE(found.says.find("lies on the pixels"), std::string::npos) << found.says;
}

// From above, turned against the grid.
TEST(Samples, AnEdgeThatAnOutlineHidesIsNotMixed) {
  const City city({.projection = Projection::orthographic,
                   .eye_m = {0, 0, 9},
                   .target_m = {0, 0, 0},
                   .up = {0.3, 1, 0},
                   .height_m = 20,
                   .near_m = 0.1,
                   .far_m = 12});
  for (const char* const check : {"samples", "alignment"}) {
    const CheckResult found = city.check_of({-0.06f, 0, 0.06f}, check);
    EXPECT_NE(found.state, CheckState::failed) << found.says;
  }
}

// The edge of a long wall's shadow lies along the rows of a perspective picture, so a filter has one value all along it, here on
// one side alone.
TEST(Samples, ALongEdgeIsOneFinding) {
  City street({.eye_m = {0, -12, 9}, .target_m = {0, 0, 0}, .up = {0, 0, 1}, .near_m = 0.1, .far_m = 60},
              {{glm::vec3(-60, -40, -1), glm::vec3(60, 40, 0)}, {glm::vec3(-50, 2, 0), glm::vec3(50, 3, 3)}});
  street.frame.light.position_m = {0, 10, 10};
  const FrameVerdict black = judge_frame(street.scene, street.tracer, street.frame, {});
  GivenFrame frame = street.frame;
  size_t lighter = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool lit = black.truth.lit.at(x, y) != 0;
      const bool edge = lit && y > 0 && !black.truth.lit.at(x, y - 1) && black.receivers.position.at(x, y).z < 0.01f;
      frame.visibility.at(x, y) = edge ? 0.8f : lit ? 1.0f : 0.0f;
      lighter += edge;
    }
  ASSERT_GT(lighter, 200U);
  CheckResult found = check_named(judge_frame(street.scene, street.tracer, frame, {}), "samples");
  EXPECT_NE(found.state, CheckState::failed) << found.says;
  // As high as a block of a JPEG, and in one row of blocks by chance.
  const int top = 8 * (height / 8 - 3);
  for (int y = top; y < top + 7; ++y)
    for (int x = 0; x < width; ++x)
      if (black.truth.lit.at(x, y)) frame.visibility.at(x, y) = 0.9f + 0.01f * static_cast<float>((3 * x + 5 * y) % 7);
  found = check_named(judge_frame(street.scene, street.tracer, frame, {}), "samples");
  EXPECT_NE(found.state, CheckState::failed) << found.says;
}

}  // namespace
}  // namespace noonmark::test
