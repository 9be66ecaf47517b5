#include "frames/value_curve.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "frames/check_statistics.h"

namespace noonmark {
namespace {

// Of a shader's float arithmetic: a GPU's pow is off by 2^-14.
constexpr double of_shader = 1e-4;
constexpr size_t most_levels = 24;
constexpr size_t least_of_level = 4;  // pixels

// Values that many pixels share: far more than others nearby, which a blend spreads over all places.
std::vector<double> levels_in(std::vector<double> values, double rounding) {
  std::sort(values.begin(), values.end());
  struct Level {
    double value;
    size_t count;
  };
  std::vector<Level> found;
  for (size_t i = 0; i < values.size();) {
    size_t end = i;
    while (end < values.size() && values[end] - values[i] <= rounding_of_sums) ++end;
    found.push_back({values[(i + end) / 2], end - i});
    i = end;
  }
  // Of a picture of whole numbers a place is one of them.
  const double place = std::max(rounding_of_sums, 2 * rounding), reach = 0.03;
  std::vector<Level> levels;
  size_t first = 0, last = 0, inside = 0;
  for (const Level& level : found) {
    while (last < found.size() && found[last].value <= level.value + reach) inside += found[last++].count;
    while (found[first].value < level.value - reach) inside -= found[first++].count;
    const double by_chance = static_cast<double>(inside - level.count) * place / (2 * reach);
    if (level.count >= least_of_level && static_cast<double>(level.count) > 8 * by_chance) levels.push_back(level);
  }
  std::stable_sort(levels.begin(), levels.end(), [](const Level& a, const Level& b) { return a.count > b.count; });
  if (levels.size() > most_levels) levels.resize(most_levels);
  std::vector<double> result;
  for (const Level& level : levels) result.push_back(level.value);
  return result;
}

// Levels of one k are one finding: what rounding makes of a value is several levels.
TapFit fit_of(const std::vector<double>& levels, const ValueCurve& curve, double rounding) {
  constexpr int most_taps = 256;
  TapFit best;
  for (int taps = 2; taps <= most_taps; ++taps) {
    // A number of taps is chosen among many, the larger ones among more.
    double bits = -2 * std::log2(taps);
    std::set<double> found;
    for (const double level : levels) {
      const double value = curve.linear(level);
      const double off = 0.5 * (curve.linear(level + rounding) - curve.linear(level - rounding));
      const double lit = std::round(value * taps);
      if (lit < 1 || lit > taps - 1 || std::abs(value * taps - lit) > taps * off) {
        bits = 0;
        break;
      }
      if (found.insert(lit).second) bits += std::max(0.0, -std::log2(2 * taps * off));
    }
    if (bits > best.bits) best = {taps, bits};
  }
  return best;
}

// The way along a line of receivers on one plane, in a measure in which places in the map are linear.
double map_way(const LightFrame& light, glm::dvec3 from, glm::dvec3 to) {
  const auto depth = [&](glm::dvec3 p) {
    const glm::dvec3 at = light.to_light(p);
    return light.kind == LightKind::directional ? 1 : at.z;
  };
  return glm::length(to - from) / depth(to);
}

void find_ramps(const CheckEvidence& e, double rounding, CurveEvidence& found) {
  if (e.light.kind == LightKind::point) return;  // the sides of a cube have measures of their own
  constexpr double low = 0.03, high = 0.97;
  // Receivers and texels are rounded, too; in steps of a blend that is a thousandth of the step.
  const double tolerance = 2 * rounding + 1e-3;
  const Image<float>& v = e.frame.visibility;
  std::array<size_t, curve_count> straight{};
  size_t by_chance = 0;
  // beside: how far the same place of the line before lies. Along an edge one ramp may be repeated, which is one finding.
  const auto ask = [&](size_t i, size_t j, size_t k, size_t beside) {
    if (!e.counted[i] || !e.counted[j] || !e.counted[k]) return;
    if (e.receivers.primitive[i] != e.receivers.primitive[j] || e.receivers.primitive[j] != e.receivers.primitive[k])
      return;
    for (const size_t at : {i, j, k})
      if (!(v[at] > low && v[at] < high)) return;
    if ((v[i] < v[j]) != (v[j] < v[k]) || v[i] == v[j] || v[j] == v[k]) return;
    if (i >= beside && std::abs(v[i - beside] - v[i]) <= tolerance && std::abs(v[j - beside] - v[j]) <= tolerance &&
        std::abs(v[k - beside] - v[k]) <= tolerance)
      return;
    const glm::dvec3 p = e.receivers.position[i], q = e.receivers.position[j], r = e.receivers.position[k];
    const double whole = map_way(e.light, p, r);
    if (!(whole > 0)) return;
    const double share = map_way(e.light, p, q) / whole;
    const auto off_by = [&](double (*linear)(double)) {
      const double a = linear(v[i]), b = linear(v[j]), d = linear(v[k]);
      return b - (a + (d - a) * share);
    };
    std::array<double, curve_count> off{};
    double least = 1, most = -1;
    for (size_t c = 0; c < curve_count; ++c) {
      off[c] = off_by(value_curves[c].linear);
      if (c > 1) continue;  // sRGB and powers are too much alike to be told apart here
      least = std::min(least, off[c]);
      most = std::max(most, off[c]);
    }
    if (most - least < 4 * tolerance) return;
    ++found.ramps;
    for (size_t c = 0; c < curve_count; ++c) straight[c] += std::abs(off[c]) <= tolerance;
    by_chance += std::abs(off_by([](double value) { return value * value * value; })) <= tolerance;
  };
  for (int y = 0; y < v.height; ++y)
    for (int x = 0; x < v.width; ++x) {
      if (x + 2 < v.width) ask(v.index(x, y), v.index(x + 1, y), v.index(x + 2, y), static_cast<size_t>(v.width));
      if (y + 2 < v.height) ask(v.index(x, y), v.index(x, y + 1), v.index(x, y + 2), 1);
    }
  for (size_t c = 0; c < curve_count; ++c)
    if (found.ramps > 0) found.straight[c] = static_cast<double>(straight[c]) / static_cast<double>(found.ramps);
  if (found.ramps > 0) found.straight_by_chance = static_cast<double>(by_chance) / static_cast<double>(found.ramps);
}

}  // namespace

double linear_of_srgb(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

const std::array<ValueCurve, curve_count> value_curves{{
    {"linear", [](double value) { return value; }},
    {"sRGB", linear_of_srgb},
    {"a gamma of 2.2", [](double value) { return std::pow(std::max(0.0, value), 2.2); }},
    {"a gamma of 1.8", [](double value) { return std::pow(std::max(0.0, value), 1.8); }},
    {"a square root", [](double value) { return value * value; }},
    {"a gamma of 2.4", [](double value) { return std::pow(std::max(0.0, value), 2.4); }},
}};

double rounding_of(const Image<float>& visibility) {
  bool bits_8 = true, bits_16 = true, half = true;
  for (const float value : visibility.pixels) {
    if (!(value > 0 && value < 1)) continue;
    const double steps = 255.0 * value;
    bits_8 = bits_8 && std::abs(steps - std::round(steps)) < 1e-3;
    bits_16 = bits_16 && std::abs(value * 65535.0 - std::round(value * 65535.0)) < 0.01;
    half = half && is_half(value);
  }
  if (bits_8) return 0.5 / 255;
  if (half) return 0x1p-12;
  return bits_16 ? std::max(0.5 / 65535, rounding_of_sums) : of_shader;
}

CurveEvidence curve_evidence(const CheckEvidence& e) {
  CurveEvidence found;
  const double rounding = rounding_of(e.frame.visibility);
  std::vector<double> between;
  for (size_t i = 0; i < e.counted.size(); ++i)
    if (const float value = e.frame.visibility[i]; e.counted[i] && value > 0.004f && value < 0.996f)
      between.push_back(value);
  found.levels = levels_in(std::move(between), rounding == of_shader ? 0 : rounding);
  for (size_t c = 0; c < curve_count; ++c) found.fits[c] = fit_of(found.levels, value_curves[c], rounding);
  find_ramps(e, rounding == of_shader ? 0 : rounding, found);
  return found;
}

const ValueCurve* CurveEvidence::by_levels() const {
  // A million to one for each curve; the values of a wrong one fit by chance.
  constexpr double sure = 20;
  size_t best = 0;
  for (size_t c = 1; c < curve_count; ++c)
    if (fits[c].bits > fits[best].bits) best = c;
  if (best > 0 && fits[best].bits < fits[0].bits + sure) best = 0;
  return fits[best].bits >= (best == 0 ? sure / 2 : sure) ? &value_curves[best] : nullptr;
}

const ValueCurve* CurveEvidence::by_ramps() const {
  constexpr size_t enough_ramps = 25;
  constexpr double mostly = 0.25;
  if (ramps < enough_ramps) return nullptr;
  // Ramps do not tell powers from each other, and of more of them one straightens a blurred moment's.
  const size_t curve = straight[2] > straight[1] ? 2 : 1;
  const double here = straight[0], there = straight[curve];
  if (here >= mostly && here >= 3 * there) return &value_curves[0];
  if (there >= mostly && there >= 3 * here && there >= 1.5 * straight_by_chance) return &value_curves[curve];
  return nullptr;
}

}  // namespace noonmark
