#include "frames/check_statistics.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

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

// A pixel deep in true light. by: what shading can depend on, which is 1, N.L, its square, and under a lamp N.L over the squared
// distance.
struct LitPixel {
  glm::dvec4 by{0};
  double value = 0;
  bool of_taps = false;  // a filter's taps make this value, so it is no evidence of shading
};

// A shadow only darkens: what shading makes of a lit pixel is the most that it can be. So the fit is one of the upper quarter
// of the values, and acne or a filter on three quarters of the pixels does not move it. used: 1 for what it depends on.
glm::dvec4 upper_fit(const std::vector<LitPixel>& pixels, glm::dvec4 used) {
  constexpr double quarter = 0.25, nearest = 1e-4, ridge = 1e-9;  // of all that is near the weight is one
  constexpr int rounds = 30;
  constexpr size_t most = 20000;
  const size_t step = pixels.size() / most + 1;
  glm::dvec4 fit{0};
  for (int round = 0; round < rounds; ++round) {
    glm::dmat4 products(ridge);
    glm::dvec4 sum{0};
    for (size_t i = 0; i < pixels.size(); i += step) {
      const glm::dvec4 by = used * pixels[i].by;
      const double off = pixels[i].value - glm::dot(fit, by);
      const double weight = round == 0 ? 1 : (off > 0 ? 1 - quarter : quarter) / std::max(std::abs(off), nearest);
      products += glm::outerProduct(weight * by, by);
      sum += weight * pixels[i].value * by;
    }
    fit = glm::inverse(products) * sum;
  }
  return fit;
}

// How many of the pixels are as bright as the fit says; 0 if the fit is not evidence of shading.
size_t explained_by(const std::vector<LitPixel>& pixels, glm::dvec4 used, bool roughly) {
  constexpr double step = 1 / 255.0;
  constexpr size_t bin_count = 64;
  constexpr size_t least = 4;  // pixels of a bin
  const glm::dvec4 fit = upper_fit(pixels, used);
  double within = step;
  if (roughly) {
    std::vector<double> fitted;
    for (const LitPixel& pixel : pixels) fitted.push_back(glm::dot(fit, used * pixel.by));
    const double range = place_quantile(fitted, 0.95) - place_quantile(fitted, 0.05);
    if (range < 0.1) return 0;
    within = range / 16;
  }
  struct Bin {
    size_t count = 0, explained = 0;
    double fit = 0;
  };
  std::vector<Bin> bins(bin_count + 2), by_cosine;
  size_t explained = 0, above = 0;
  for (const LitPixel& pixel : pixels) {
    const double fitted = glm::dot(fit, used * pixel.by), off = pixel.value - fitted;
    Bin& bin = bins[static_cast<size_t>(std::clamp(pixel.by[1], 0.0, 1.0) * bin_count)];
    ++bin.count;
    above += off > within;
    if (std::abs(off) > within || pixel.of_taps) continue;
    ++explained;
    ++bin.explained;
    bin.fit = fitted;
  }
  double low = 1, high = 0;
  for (size_t i = 0; i <= bin_count; ++i) {
    if (bins[i].explained < least) continue;
    low = std::min(low, bins[i].fit), high = std::max(high, bins[i].fit);
    // A plane may lie in two bins.
    by_cosine.push_back({bins[i].count + bins[i + 1].count, bins[i].explained + bins[i + 1].explained});
    ++i;
  }
  const auto numbers = static_cast<size_t>(glm::dot(used, used));
  const size_t more = roughly ? 8 : 1;  // values of N.L than numbers that were chosen for them
  if (by_cosine.size() < numbers + more || high - low < 4 * step) return 0;
  std::partial_sort(by_cosine.begin(), by_cosine.begin() + static_cast<std::ptrdiff_t>(numbers), by_cosine.end(),
                    [](const Bin& a, const Bin& b) { return a.explained > b.explained; });
  Bin others{pixels.size(), explained};
  for (size_t i = 0; i < numbers; ++i) others.count -= by_cosine[i].count, others.explained -= by_cosine[i].explained;
  // Of the others a quarter must be as bright, which is what the fit is made for.
  const bool is_evidence = explained * 5 >= pixels.size() * 2 && others.explained * 4 >= others.count &&
                           (roughly || above * 20 <= pixels.size());
  return is_evidence ? explained : 0;
}

size_t explained_by_shading(const std::vector<LitPixel>& pixels, bool of_lamp) {
  struct Row {
    glm::dvec4 used;
    bool roughly = false;
  };
  // Exactly, or where a renderer's own normals make N.L another one: N.L alone, and roughly. The acne of a wide filter follows
  // N.L, too, but not in proportion to it.
  static constexpr Row rows[] = {{{0, 1, 0, 0}}, {{1, 1, 0, 0}}, {{1, 1, 1, 0}}, {{0, 1, 0, 0}, true},
                                 {{0, 0, 0, 1}}, {{1, 1, 0, 1}}, {{1, 1, 1, 1}}, {{0, 0, 0, 1}, true}};
  size_t most = 0;
  for (const Row& row : rows)
    if (of_lamp || row.used[3] == 0) most = std::max(most, explained_by(pixels, row.used, row.roughly));
  return most;
}

// The number of each triangle's part, and of one that has none a number of its own.
std::vector<uint32_t> parts_of(const Scene& scene) {
  std::vector<uint32_t> part(scene.triangles.size());
  for (size_t t = 0; t < part.size(); ++t) part[t] = static_cast<uint32_t>(scene.parts.size() + t);
  for (size_t p = 0; p < scene.parts.size(); ++p)
    for (uint32_t t = 0; t < scene.parts[p].triangle_count; ++t)
      part[scene.parts[p].first_triangle + t] = static_cast<uint32_t>(p);
  return part;
}

// Whether a whole number of this many taps makes the value, as far as the picture's rounding tells.
bool is_of_taps(int taps, double value, double rounding) {
  return std::abs(value * taps - std::round(value * taps)) <= taps * rounding;
}

// Whether those of some filter do. Filters whose taps lie many texels apart, and which so can have one value on a whole plane,
// have at most 64.
bool is_share_of_taps(double value, double rounding) {
  for (int taps = 1; taps <= 64; ++taps)
    if (is_of_taps(taps, value, rounding)) return true;
  return false;
}

Shading shading_of(const CheckEvidence& e, const FrameStatistics& s) {
  const Image<uint8_t>& deep = s.deep;
  const Region& lit = s.deep_lit;
  constexpr size_t least = 32;         // pixels of a part
  constexpr double one_value = 0.002;  // half a step of 8 bits
  const double rounding = rounding_of(e.frame.visibility);
  const int taps = s.curve.by_levels() == value_curves.data() ? s.curve.fits[0].taps : 0;
  const std::vector<uint32_t> part = parts_of(e.scene);
  const bool of_lamp = e.light.kind != LightKind::directional;
  std::vector<LitPixel> all;
  std::unordered_map<uint32_t, std::vector<LitPixel>> parts;
  double unit = 0;  // the squared distance of the first receiver
  size_t at = 0, above = 0;
  for (size_t i = 0; i < deep.size(); ++i) {
    if (deep[i] != 2) continue;
    const glm::dvec3 p = e.receivers.position[i];
    const double n = glm::dot(glm::dvec3(e.receivers.normal[i]), e.light.direction_to_light(p));
    double fall = 0;
    if (of_lamp) {
      const glm::dvec3 way = e.light.to_light(p);
      if (unit == 0) unit = glm::dot(way, way);
      fall = unit / glm::dot(way, way);
    }
    const double value = e.frame.visibility[i];
    all.push_back({{1, n, n * n, n * fall}, value, taps > 0 && is_of_taps(taps, value, rounding)});
    parts[part[e.receivers.primitive[i]]].push_back(all.back());
    at += std::abs(value - lit.median) <= one_value;
    above += value > lit.median + one_value;
  }
  Shading found;
  if (all.empty()) return found;
  size_t by_parts = 0;
  for (const auto& [number, pixels] : parts)
    if (pixels.size() >= least) by_parts += explained_by_shading(pixels, of_lamp);
  const auto share = [&](size_t count) { return static_cast<double>(count) / static_cast<double>(all.size()); };
  found.explained = share(std::max(by_parts, explained_by_shading(all, of_lamp)));
  found.is_one_value =
      lit.median > 0.02 && share(at) >= 0.9 && share(above) <= 0.005 && !is_share_of_taps(lit.median, rounding);
  return found;
}

}  // namespace

Coverage coverage_of_visibility(const GivenFrame& frame) {
  Coverage covered(frame.visibility.width, frame.visibility.height, 0);
  for (size_t i = 0; i < covered.size(); ++i)
    covered[i] = !std::isnan(frame.visibility[i]) || (frame.not_judged.size() > 0 && frame.not_judged[i]);
  return covered;
}

Coverage coverage_of_positions(const GivenFrame& frame) {
  Coverage covered(frame.positions.width, frame.positions.height, 0);
  for (size_t i = 0; i < covered.size(); ++i) covered[i] = std::isfinite(frame.positions[i].x);
  return covered;
}

Coverage coverage_of_frame(const GivenFrame& frame) {
  Coverage covered = coverage_of_visibility(frame);
  if (frame.receivers == GivenReceivers::none) return covered;
  const Coverage given = coverage_of_positions(frame);
  for (size_t i = 0; i < covered.size(); ++i) covered[i] = covered[i] && given[i];
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

FrameStatistics frame_statistics(const CheckEvidence& e) {
  // 1: counted and dark, 2: counted and lit, 0: not counted
  Image<uint8_t> state(e.counted.width, e.counted.height, 0), light(e.counted.width, e.counted.height, 1);
  for (size_t i = 0; i < state.size(); ++i) {
    state[i] = e.counted[i] ? static_cast<uint8_t>(1 + e.truth.lit[i]) : 0;
    light[i] = !(e.frame.visibility[i] < 0.5f);
  }
  const int reach = FrameStatistics::deep_px(state.height);
  const Extremes wide = extremes_within(state, reach), of_frame = extremes_within(light, reach);
  Image<uint8_t> shadow(state.width, state.height, 0);
  for (size_t i = 0; i < state.size(); ++i) shadow[i] = state[i] == 1;
  Image<uint8_t> far_from_shadow = extremes_within(shadow, FrameStatistics::displaced_px(state.height)).most;
  for (uint8_t& pixel : far_from_shadow.pixels) pixel = !pixel;
  FrameStatistics found;
  found.deep = Image<uint8_t>(state.width, state.height, 0);
  std::vector<double> deep[2];
  for (size_t i = 0; i < state.size(); ++i) {
    if (!state[i] || wide.least[i] != state[i] || wide.most[i] != state[i]) continue;
    found.deep[i] = state[i];
    deep[state[i] - 1].push_back(e.frame.visibility[i]);
    found.shadow_elsewhere += state[i] == 2 && of_frame.most[i] == 0 && far_from_shadow[i];
  }
  found.deep_dark = region_of(deep[0]);
  found.deep_lit = region_of(deep[1]);
  found.curve = curve_evidence(e);
  found.outlines = outline_alignment(e);
  if (found.deep_lit.count > 0 && found.deep_lit.median < 0.95) found.shading = shading_of(e, found);
  return found;
}

double way_to_plane(const Scene& scene, uint32_t triangle, glm::dvec3 p, glm::dvec3 direction) {
  const glm::uvec3 corners = scene.triangles[triangle];
  const glm::dvec3 a = scene.positions[corners[0]];
  const glm::dvec3 across =
      glm::cross(glm::dvec3(scene.positions[corners[1]]) - a, glm::dvec3(scene.positions[corners[2]]) - a);
  return glm::dot(across, a - p) / glm::dot(across, direction);
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
