#include "frames/check_statistics.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace noonmark {
namespace {

// Of each pixel: the smallest and the largest value within `reach` pixels along both axes.
struct Extremes {
  Image<uint8_t> least, most;
};
Extremes extremes_within(const Image<uint8_t>& values, int reach) {
  const int width = values.width, height = values.height;
  // Whole rows are joined, shifted by each step along the axis: the compiler makes vectors of that.
  const auto pass = [&](const Image<uint8_t>& from, bool along_x, const auto& better) {
    Image<uint8_t> to = from;
    tbb::parallel_for(0, height, [&](int y) {
      for (int step = -reach; step <= reach; ++step) {
        const int row = along_x ? y : y + step, shift = along_x ? step : 0;
        if (row < 0 || row >= height) continue;
        const uint8_t* const others = &from.at(0, row);
        uint8_t* const best = &to.at(0, y);
        for (int x = std::max(0, -shift), end = std::min(width, width - shift); x < end; ++x)
          best[x] = better(best[x], others[x + shift]);
      }
    });
    return to;
  };
  const auto least = [](uint8_t a, uint8_t b) { return std::min(a, b); };
  const auto most = [](uint8_t a, uint8_t b) { return std::max(a, b); };
  return {pass(pass(values, true, least), false, least), pass(pass(values, true, most), false, most)};
}

// Moves the value below which this share of the values lies to its place, and returns it. There must be values.
double place_quantile(std::vector<double>& values, double share) {
  const auto at = std::min(values.size() - 1, static_cast<size_t>(share * static_cast<double>(values.size())));
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(at);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

Region region_of(std::vector<double> values) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Region region{.count = values.size(), .median = none, .low = none, .high = none};
  if (values.empty()) return region;
  for (const double value : values) region.mean += value / static_cast<double>(values.size());
  region.median = place_quantile(values, 0.5);
  region.low = place_quantile(values, 0.05);
  region.high = place_quantile(values, 0.95);
  return region;
}

}  // namespace

Coverage coverage_of_frame(const GivenFrame& frame) {
  Coverage covered(frame.visibility.width, frame.visibility.height, 0);
  for (size_t i = 0; i < covered.size(); ++i)
    covered[i] = !std::isnan(frame.visibility[i]) &&
                 (frame.receivers == GivenReceivers::none || std::isfinite(frame.positions[i].x));
  return covered;
}

Coverage coverage_of(const Image<uint32_t>& seen) {
  Coverage covered(seen.width, seen.height, 0);
  for (size_t i = 0; i < covered.size(); ++i) covered[i] = seen[i] != no_primitive;
  return covered;
}

Coverage flipped(const Coverage& coverage, bool left_to_right, bool upside_down) {
  Coverage result(coverage.width, coverage.height);
  for (int y = 0; y < coverage.height; ++y)
    for (int x = 0; x < coverage.width; ++x)
      result.at(x, y) =
          coverage.at(left_to_right ? coverage.width - 1 - x : x, upside_down ? coverage.height - 1 - y : y);
  return result;
}

size_t differing(const Coverage& a, const Coverage& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
  return count;
}

size_t lost_surfaces(const Coverage& frame, const Coverage& scene) {
  size_t count = 0;
  for (size_t i = 0; i < frame.size(); ++i) count += scene[i] && !frame[i];
  return count;
}

size_t outline_pixels(const Coverage& c) {
  size_t count = 0;
  for (int y = 0; y < c.height; ++y)
    for (int x = 0; x < c.width; ++x) {
      const auto differs = [&](int i, int j) {
        return i >= 0 && j >= 0 && i < c.width && j < c.height && c.at(i, j) != c.at(x, y);
      };
      count += differs(x - 1, y) || differs(x + 1, y) || differs(x, y - 1) || differs(x, y + 1);
    }
  return count;
}

Shift best_shift(const raytrace::Tracer& tracer, const ViewMatrix& view, const Coverage& frame, const Coverage& scene) {
  Shift best{{0, 0}, differing(frame, scene)};
  for (int j = -2; j <= 2; ++j)
    for (int i = -2; i <= 2; ++i) {
      if (i == 0 && j == 0) continue;
      const glm::dvec2 pixels = 0.5 * glm::dvec2(i, j);
      glm::dmat4 moved(1);  // the picture moves by minus the shift; a pixel is 2 / width of clip space wide
      moved[3][0] = -2 * pixels.x / frame.width;
      moved[3][1] = 2 * pixels.y / frame.height;
      const ViewMatrix shifted(moved * view.clip_from_world());
      const size_t left = differing(frame, coverage_of(tracer.seen_primitives(shifted, frame.width, frame.height)));
      if (left < best.differing) best = {pixels, left};
    }
  return best;
}

FrameStatistics frame_statistics(const GivenFrame& frame, const ReceiverTruth& truth, const Image<uint8_t>& counted) {
  // 1: counted and dark, 2: counted and lit, 0: not counted
  Image<uint8_t> state(counted.width, counted.height, 0);
  for (size_t i = 0; i < state.size(); ++i) state[i] = counted[i] ? static_cast<uint8_t>(1 + truth.lit[i]) : 0;
  // 1: the frame is dark, 3: lit, 2: between or not counted
  Image<uint8_t> shown(counted.width, counted.height, 2);
  for (size_t i = 0; i < shown.size(); ++i)
    if (counted[i]) shown[i] = frame.visibility[i] <= 0.02f ? 1 : frame.visibility[i] >= 0.98f ? 3 : 2;
  // The same with what is not counted as neither.
  Image<uint8_t> only_counted(counted.width, counted.height, 2);
  for (size_t i = 0; i < state.size(); ++i)
    if (state[i]) only_counted[i] = static_cast<uint8_t>(2 * state[i] - 1);
  const Extremes wide = extremes_within(state, FrameStatistics::deep_px),
                 narrow = extremes_within(only_counted, FrameStatistics::edge_px),
                 of_frame = extremes_within(shown, FrameStatistics::edge_px);
  const auto between = [](double value) {
    return value > FrameStatistics::between_low && value < FrameStatistics::between_high;
  };
  const auto is_deep = [&](size_t i) { return state[i] && wide.least[i] == state[i] && wide.most[i] == state[i]; };
  std::vector<double> deep[2], filtered;
  double step = 0, steps = 0, grey = 0;
  for (int y = 0; y < state.height; ++y)
    for (int x = 0; x < state.width; ++x) {
      const size_t i = state.index(x, y);
      if (!state[i]) continue;
      const double value = frame.visibility[i];
      const bool lit = truth.lit[i];
      if (is_deep(i)) {
        deep[lit].push_back(value);
        if (lit) grey += between(value);
        if (lit && x + 1 < state.width && state[i + 1] == 2 && is_deep(i + 1)) {
          step += std::abs(frame.visibility[i + 1] - value);
          ++steps;
        }
      }
      if (narrow.least[i] == 1 && narrow.most[i] == 3 && of_frame.least[i] == 1 && of_frame.most[i] == 3 &&
          between(value))
        filtered.push_back(value);
    }
  FrameStatistics found{region_of(deep[1]), region_of(deep[0]), region_of(filtered)};
  double variance = 0;
  for (const double value : deep[1])
    variance += (value - found.deep_lit.mean) * (value - found.deep_lit.mean) / static_cast<double>(deep[1].size());
  if (steps > 0 && variance > 0) found.deep_lit_roughness = step / steps / std::sqrt(variance);
  if (!deep[1].empty()) found.deep_lit_between = grey / static_cast<double>(deep[1].size());
  return found;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return place_quantile(values, share);
}

bool is_half(double value) {
  if (value == 0) return true;
  int exponent = 0;
  const double fraction = std::frexp(std::abs(value), &exponent);  // in [1/2, 1)
  if (exponent > 16) return false;
  const int bits = std::min(11, exponent + 24);  // fewer for subnormals
  const double scaled = std::ldexp(fraction, bits);
  return bits > 0 && scaled == std::floor(scaled);
}

}  // namespace noonmark
