#include "compare/judge/moment_contract.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace noonmark {
namespace {

constexpr float largest_half = 65504;

// How far a number that a texture of this format holds may be from the number that was computed. Half floats are the nearest
// ones (gl/shaders/prefilter/format.glsl).
double step_of(MomentFormat format, double value) {
  switch (format) {
    case MomentFormat::f32:
      return 0;
    case MomentFormat::f16: {
      int exponent = 0;
      std::frexp(value, &exponent);  // |value| in [2^(exponent - 1), 2^exponent)
      return std::ldexp(0.5, std::max(exponent - 1, -14) - 10);
    }
    case MomentFormat::u16:
      return 1.0 / 65535;
  }
  throw std::logic_error("a format of moments without a step");
}

bool is_held(MomentFormat format, float written, float read, double error) {
  double value = static_cast<double>(written);
  if (format == MomentFormat::u16) value = std::clamp(value, 0.0, 1.0);
  if (format == MomentFormat::f16 &&
      std::abs(value) + error > largest_half)  // OpenGL may store the largest or infinity
    return std::abs(read) >= largest_half && std::signbit(read) == std::signbit(written);
  return std::abs(static_cast<double>(read) - value) <= error + step_of(format, value);
}

class Check {
 public:
  Check(const LookupEvidence& e, const MapDepths& map, const MomentEvidence& moments, const Image<float>& result)
      : e_(e),
        lookup_(*e.moments),
        map_(map),
        moments_(moments),
        result_(result),
        border_(lookup_.stored(border_depth)) {
    for (const double weight : lookup_.kernel()) kernel_.push_back(static_cast<float>(weight));
  }

  // Of the map itself.
  void stored(size_t index, MomentContractCounts& counts) const {
    ++counts.texels;
    // What a blur of spreads reads is the depth of the map itself.
    const MomentFormat format = lookup_.spread() ? MomentFormat::f32 : lookup_.format();
    counts.stored += !holds(format, moments_.levels.front().moments[index], lookup_.stored(map_[index]), stored_error_);
  }

  // Of a mip level from 1 on.
  void halved(size_t level, glm::ivec2 at, size_t index, MomentContractCounts& counts) const {
    const MomentEvidence::Level& from = moments_.levels[level - 1];
    const auto read = [&](int x, int y) -> std::optional<glm::vec4> {
      const glm::ivec2 texel = 2 * at + glm::ivec2(x, y);
      if (!from.texels.has(texel)) return std::nullopt;
      return from.moments[from.texels.index(texel)];
    };
    const auto a = read(0, 0), b = read(1, 0), c = read(0, 1), d = read(1, 1);
    if (!a || !b || !c || !d) return;
    ++counts.sums;
    const glm::vec4 mean = 0.25f * ((*a + *b) + (*c + *d));
    counts.blurred += !holds(lookup_.format(), moments_.levels[level].moments[index], mean, no_error);
  }

  // Of the last level.
  void blurred(glm::ivec2 at, size_t index, MomentContractCounts& counts) const {
    const std::vector<glm::vec4>& stored = moments_.levels.back().moments;
    if (const SpreadBlur* const spread = lookup_.spread()) {
      spread_pass(stored, moments_.blurred_once, at, index, {0, 1}, spread->along_v, counts);
      spread_pass(moments_.blurred_once, moments_.blurred, at, index, {1, 0}, spread->along_u, counts);
      return;
    }
    for (const auto& [from, to, way] : {std::tuple(&stored, &moments_.blurred_once, glm::ivec2(1, 0)),
                                        std::tuple(&moments_.blurred_once, &moments_.blurred, glm::ivec2(0, 1))}) {
      const std::optional<glm::vec4> sum = summed(*from, at, way);
      if (!sum) continue;
      ++counts.sums;
      counts.blurred += !holds(lookup_.format(), (*to)[index], *sum, no_error);
    }
  }

  void receiver(size_t i, MomentContractCounts& counts) const {
    if (!e_.probe.asks(i)) return;
    const float reference = e_.probe.reference[i];
    const glm::vec4 fetched = moments_.fetched[i];
    const double block = e_.probe.pattern.block;
    if (const std::optional<Blend> blend = blend_at(glm::dvec2(e_.probe.map_texels[i]) / block - 0.5)) {
      ++counts.fetches;
      bool held = true;
      for (int c = 0; c < lookup_.kind().channels; ++c) {
        const double slack = 4 * 0x1p-23 * std::max(std::abs(blend->low[c]), std::abs(blend->high[c]));
        held &= fetched[c] >= blend->low[c] - slack && fetched[c] <= blend->high[c] + slack;
      }
      counts.fetched += !held;
    }
    ++counts.results;
    if (reference > 1.0f && e_.map.lit_beyond_far) {
      counts.lit += result_[i] != 1.0f;
      return;
    }
    const Bounded lit = lookup_.bounded_lit(fetched, reference - e_.bias.at(e_.probe, i));
    const double low = lookup_.reduced(lit.value - lit.error), high = lookup_.reduced(lit.value + lit.error);
    // Two roundings of the reduction.
    counts.lit += !(result_[i] >= low - 0x1p-22 && result_[i] <= high + 0x1p-22);
  }

 private:
  using Error = double (*)(float);
  static double no_error(float) { return 0; }
  // Of exp, whose argument is the logarithm of what is stored; its square has twice the error.
  static double exp_error(float stored) {
    const double value = std::abs(static_cast<double>(stored));
    return value > 0 ? 2 * value * (3 + 2 * std::abs(std::log(value))) * 0x1p-23 : 0x1p-126;
  }

  bool holds(MomentFormat format, glm::vec4 read, glm::vec4 written, Error error) const {
    for (int c = 0; c < lookup_.kind().channels; ++c)
      if (!is_held(format, written[c], read[c], error(written[c]))) return false;
    return true;
  }

  // Of the texel of the last level outside or inside the map; empty if it was not read.
  std::optional<glm::vec4> at(const std::vector<glm::vec4>& pass, glm::ivec2 texel) const {
    const TexelSet& texels = moments_.levels.back().texels;
    const glm::ivec2 read = wrapped(texel, texels.size(), e_.map.wrap);
    if (read.x < 0) return border_;
    if (!texels.has(read)) return std::nullopt;
    return pass[texels.index(read)];
  }

  std::optional<glm::vec4> summed(const std::vector<glm::vec4>& pass, glm::ivec2 texel, glm::ivec2 way) const {
    const int size = static_cast<int>(kernel_.size());
    glm::vec4 sum(0);
    for (int k = 0; k < size; ++k) {
      const std::optional<glm::vec4> one = at(pass, texel + (k - size / 2) * way);
      if (!one) return std::nullopt;
      sum += kernel_[static_cast<size_t>(k)] * *one;
    }
    return sum;
  }

  // A pass of a blur that stores the spread of what it reads, within the error of float arithmetic.
  void spread_pass(const std::vector<glm::vec4>& from, const std::vector<glm::vec4>& to, glm::ivec2 middle,
                   size_t index, glm::ivec2 way, std::span<const SpreadBlur::Tap> taps,
                   MomentContractCounts& counts) const {
    const auto exact = [](float value) { return Bounded(static_cast<double>(value)); };
    const auto bounded = [&](glm::vec4 m) { return in_bounds::vec4(exact(m.x), exact(m.y), exact(m.z), exact(m.w)); };
    const SpreadFormulas& formulas = *lookup_.kind().spread;
    in_bounds::vec4 sums = bounded(glm::vec4(0));
    for (const SpreadBlur::Tap& tap : taps) {
      const std::optional<glm::vec4> one = at(from, middle + tap.texel * way);
      const std::optional<glm::vec4> other = at(from, middle + (tap.texel + 1) * way);
      if (!one || (!other && tap.next > 0)) return;
      const Bounded next = exact(tap.next);
      sums = formulas.bounded_added(sums, (Bounded(1.0) - next) * bounded(*one) + next * bounded(other.value_or(*one)));
    }
    const in_bounds::vec4 spread = formulas.bounded_spread(sums, Bounded(static_cast<double>(taps.size())));
    ++counts.sums;
    const auto held = [&](Bounded value, float read) {
      const auto written = static_cast<float>(value.value);
      return is_held(lookup_.format(), written, read, value.error + 0x1p-24 * std::abs(value.value));
    };
    counts.blurred += !(held(spread.x, to[index].x) && held(spread.y, to[index].y));
  }

  struct Blend {
    glm::dvec4 low, high;
  };
  // The least and the largest blend of the blurred texels around a place (0 at the centre of texel 0) that is off by what a
  // sampler's weights are. A blend is linear between the centres of texels.
  std::optional<Blend> blend_at(glm::dvec2 place) const {
    const glm::dvec2 across = glm::abs(place);
    const auto width = static_cast<double>(moments_.levels.back().texels.size().x);
    const double off = 0x1p-8 + 8 * 0x1p-24 * std::max({across.x, across.y, width});
    Blend blend{glm::dvec4(HUGE_VAL), glm::dvec4(-HUGE_VAL)};
    const auto places = [&](double x) {
      std::vector<double> all = {x - off, x + off};
      if (const double centre = std::round(x); std::abs(centre - x) < off) all.push_back(centre);
      return all;
    };
    for (const double y : places(place.y))
      for (const double x : places(place.x)) {
        const glm::ivec2 corner(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));
        const double u = x - corner.x, v = y - corner.y;
        glm::dvec4 sum(0);
        for (const int up : {0, 1})
          for (const int right : {0, 1}) {
            const std::optional<glm::vec4> one = at(moments_.blurred, corner + glm::ivec2(right, up));
            if (!one) return std::nullopt;
            sum += (right ? u : 1 - u) * (up ? v : 1 - v) * glm::dvec4(*one);
          }
        blend.low = glm::min(blend.low, sum);
        blend.high = glm::max(blend.high, sum);
      }
    return blend;
  }

  const LookupEvidence& e_;
  const MomentLookup& lookup_;
  const MapDepths& map_;
  const MomentEvidence& moments_;
  const Image<float>& result_;
  glm::vec4 border_;
  std::vector<float> kernel_;
  Error stored_error_ = lookup_.kind().warp_power > 0 ? exp_error : no_error;
};

template <class Each>
MomentContractCounts counted(size_t count, const Each& each) {
  return tbb::parallel_reduce(
      tbb::blocked_range<size_t>(0, count), MomentContractCounts{},
      [&](const tbb::blocked_range<size_t>& range, MomentContractCounts so_far) {
        for (size_t i = range.begin(); i != range.end(); ++i) each(i, so_far);
        return so_far;
      },
      [](MomentContractCounts a, const MomentContractCounts& b) { return a += b; });
}

}  // namespace

MomentContractCounts& MomentContractCounts::operator+=(const MomentContractCounts& more) {
  texels += more.texels, stored += more.stored, sums += more.sums, blurred += more.blurred;
  fetches += more.fetches, fetched += more.fetched, results += more.results, lit += more.lit;
  return *this;
}

MomentContractCounts check_moments(const LookupEvidence& e, const MapDepths& map, const MomentEvidence& moments,
                                   const Image<float>& result) {
  const Check check(e, map, moments, result);
  MomentContractCounts counts;
  const auto count_level = [&](const TexelSet& texels, const auto& each) {
    counts += counted(static_cast<size_t>(texels.size().y), [&](size_t row, auto& found) {
      const int y = static_cast<int>(row);
      texels.each_in_row(y, [&](int x, size_t index) { each(glm::ivec2(x, y), index, found); });
    });
  };
  for (size_t level = 0; level < moments.levels.size(); ++level)
    count_level(moments.levels[level].texels, [&](glm::ivec2 at, size_t index, auto& found) {
      if (level == 0)
        check.stored(index, found);
      else
        check.halved(level, at, index, found);
    });
  count_level(moments.levels.back().texels,
              [&](glm::ivec2 at, size_t index, auto& found) { check.blurred(at, index, found); });
  counts += counted(e.truth.facing.size(), [&](size_t i, auto& found) {
    if (e.truth.facing[i]) check.receiver(i, found);
  });
  return counts;
}

std::map<std::string, double> moment_contract_metrics(const MomentContractCounts& c) {
  const auto share = [](uint64_t broken, uint64_t of) {
    return of == 0 ? 0 : static_cast<double>(broken) / static_cast<double>(of);
  };
  return {{"contract_store", share(c.stored, c.texels)},
          {"contract_blur", share(c.blurred, c.sums)},
          {"contract_fetch", share(c.fetched, c.fetches)},
          {"contract_lit", share(c.lit, c.results)}};
}

}  // namespace noonmark
