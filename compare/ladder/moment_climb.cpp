#include "compare/ladder/moment_climb.h"

#include <tbb/blocked_range.h>
#include <tbb/combinable.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compare/ladder/lasting_steps.h"
#include "compare/ladder/receiver_taps.h"

namespace noonmark {
namespace {

// The depths that a linear fetch blends at a receiver, with their weights. A sampler that clamps to the border takes its
// value for each of the four texels outside the map, whatever a blur there would hold. So near the border the weights are
// not those of the taps.
void blended_depths(const LookupEvidence& e, size_t i, const ReceiverTaps& taps, std::vector<double>& depths,
                    std::vector<double>& weights) {
  depths.clear(), weights.clear();
  const TapPattern& pattern = e.probe.pattern;
  const glm::ivec2 map = e.exact_map.size(), level = map / pattern.block;
  const glm::ivec2 corner = e.probe.fetch_corner(e.probe.map_texels[i]);  // the lower left of the four texels
  if (inside_map(corner, level) && inside_map(corner + 1, level)) {
    depths.resize(taps.size()), weights.resize(taps.size());
    for (size_t t = 0; t < taps.size(); ++t) {
      depths[t] = static_cast<double>(taps.depth_in(e.exact_map, t));
      weights[t] = taps.weight(t);
    }
    return;
  }
  const glm::dvec2 s = pattern.fetch_fraction(e.probe.map_texels[i]);
  const double whole = pattern.block * pattern.block;
  for (const int y : {0, 1})
    for (const int x : {0, 1}) {
      const double share = (x ? s.x : 1 - s.x) * (y ? s.y : 1 - s.y);
      const glm::ivec2 middle = wrapped(corner + glm::ivec2(x, y), level, e.map.wrap);
      if (middle.x < 0) {
        depths.push_back(static_cast<double>(border_depth)), weights.push_back(share);
        continue;
      }
      each_texel_of_blur(
          middle, pattern.fetches_along(), pattern.block, map, e.map.wrap, [&](int u, int v, glm::ivec2 texel) {
            const bool border = texel.x < 0;
            const double weight =
                share * pattern.kernel[static_cast<size_t>(u)] * pattern.along_v()[static_cast<size_t>(v)];
            depths.push_back(static_cast<double>(border ? border_depth : e.exact_map.at(texel)));
            weights.push_back(border ? weight : weight / whole);
          });
    }
}

// What a linear fetch gives at a receiver of the texels of a blur that stores spreads, without rounding.
Spread fetched_spread(const LookupEvidence& e, size_t i, std::vector<double>& depths) {
  const SpreadBlur& blur = *e.moments->spread();
  const glm::ivec2 map = e.exact_map.size(), corner = e.probe.fetch_corner(e.probe.map_texels[i]);
  const glm::dvec2 s = e.probe.pattern.fetch_fraction(e.probe.map_texels[i]);
  Spread fetched;
  for (const int y : {0, 1})
    for (const int x : {0, 1}) {
      const long double share = (x ? s.x : 1 - s.x) * (y ? s.y : 1 - s.y);
      const glm::ivec2 middle = wrapped(corner + glm::ivec2(x, y), map, e.map.wrap);
      if (middle.x < 0) {
        fetched.mean += share * static_cast<long double>(border_depth);
        continue;
      }
      depths.clear();
      each_texel_of_blur(middle, blur.size(), 1, map, e.map.wrap, [&](int, int, glm::ivec2 texel) {
        depths.push_back(static_cast<double>(texel.x < 0 ? border_depth : e.exact_map.at(texel)));
      });
      const Spread one = spread_of(blur, depths);
      fetched.mean += share * one.mean;
      fetched.deviation += share * one.deviation;
    }
  return fetched;
}

// The bounds of a receiver, and what law 13 says of them.
void find_bounds(const LookupEvidence& e, size_t i, const ReceiverTaps& taps, MomentScratch& scratch,
                 MomentSteps& steps) {
  const bool looks = e.probe.asks(i) && !(e.probe.reference[i] > 1.0f && e.map.lit_beyond_far);
  scratch.fetched.reset();
  if (looks && e.moments->spread()) {
    scratch.fetched = fetched_spread(e, i, scratch.depths);
  } else if (looks) {
    blended_depths(e, i, taps, scratch.depths, scratch.weights);
    scratch.truth.set(scratch.depths, scratch.weights);
  }
  const ExactBound bound = exact_bound(e, i, *e.moments, e.bias, scratch);
  steps.chain.bound = bound.lit;
  steps.decided = bound.decided;
  if (bound.decided) {
    steps.chain.bare = bound.lit;
    return;
  }
  const auto bare_depth = static_cast<double>(e.probe.reference[i]);
  if (scratch.fetched) {
    steps.chain.bare = e.moments->bare(*scratch.fetched, bare_depth);
    return;
  }
  steps.chain.bare = e.moments->bare(scratch.truth, bare_depth);
  double compared = 0;
  for (size_t t = 0; t < scratch.depths.size(); ++t)
    if (scratch.depths[t] >= bare_depth) compared += scratch.weights[t];
  steps.below_comparison = compared - steps.chain.bare;
}

}  // namespace

ExactBound exact_bound(const LookupEvidence& e, size_t i, const MomentLookup& lookup, const Bias& bias,
                       MomentScratch& scratch) {
  const float reference = e.probe.reference[i];
  if (!e.probe.asks(i)) return {0, reference, true};
  if (reference > 1.0f && e.map.lit_beyond_far) return {1, reference, true};
  const float biased = reference - bias.at(e.probe, i);
  const auto depth = static_cast<double>(biased);
  return {scratch.fetched ? lookup.exact(*scratch.fetched, depth) : lookup.exact(scratch.truth, depth), biased, false};
}

MomentSteps moment_steps(const LookupEvidence& e, size_t i, const ReceiverTaps& taps, MomentScratch& scratch) {
  MomentSteps s;
  LookupChain& c = s.chain;
  // As shares of the sum of the weights in the same order, so that lit taps alone are exactly 1.
  double whole = 0;
  const size_t count = taps.one_truth() ? 1 : taps.size();
  for (size_t t = 0; t < count; ++t) {
    const Tap tap = taps[t];
    const double weight = taps.one_truth() ? 1 : tap.weight;  // one tap stands for all of them
    whole += weight;
    if (tap.exact_lit) s.exact_lit += weight;
    if (tap.moved_lit) c.from += weight;
    if (tap.texel_lit) c.texels += weight;
    if (!tap.covered) c.uncovered += weight;
    if (tap.exact_sure && tap.moved_sure && tap.texel_sure) continue;
    c.unsure += weight;
    const auto step = [&](bool from, bool to) { return weight * (static_cast<int>(to) - static_cast<int>(from)); };
    if (!tap.exact_sure) s.before_exact += step(e.truth.lit[i] != 0, tap.exact_lit);
    if (!tap.exact_sure || !tap.moved_sure) s.before_moved += step(tap.exact_lit, tap.moved_lit);
  }
  for (double* sum : {&s.exact_lit, &c.from, &c.texels, &c.unsure, &c.uncovered, &s.before_exact, &s.before_moved})
    *sum /= whole;
  s.displacement = c.from - s.exact_lit - s.before_moved;
  find_bounds(e, i, taps, scratch, s);
  s.reduce(*e.moments);
  return s;
}

void MomentSteps::reduce(const MomentLookup& lookup) {
  shown = decided ? chain.bound : lookup.reduced(chain.bound);
  parts = parts_of(chain, shown);
}

MomentClimb::MomentClimb(const LookupEvidence& evidence, PixelRange strip, Ladder& ladder,
                         std::vector<MomentSteps>* kept)
    : e_(evidence), ladder_(ladder), kept_(kept) {
  for (size_t i = strip.first; i < strip.end; ++i)
    ladder.flags[i] = static_cast<uint8_t>((evidence.truth.facing[i] ? flag_facing : 0) |
                                           (evidence.truth.ambiguous[i] ? flag_ambiguous : 0));
}

void MomentClimb::receiver(size_t i, const ReceiverTaps& taps, Part& part) const {
  const MomentSteps steps = moment_steps(e_, i, taps, part.scratch);
  if (kept_) (*kept_)[i] = steps;
  book(i, steps, part);
}

void MomentClimb::climb_again(PixelRange strip) {
  tbb::combinable<Part> found;
  tbb::parallel_for(tbb::blocked_range<size_t>(strip.first, strip.end, 8192),
                    [&](const tbb::blocked_range<size_t>& range) {
                      Part& part = found.local();
                      for (size_t i = range.begin(); i != range.end(); ++i) {
                        if (!e_.truth.facing[i]) continue;
                        MomentSteps steps = (*kept_)[i];
                        steps.reduce(*e_.moments);
                        book(i, steps, part);
                      }
                    });
  found.combine_each([&](const Part& part) { join(part); });
}

void MomentClimb::book(size_t i, const MomentSteps& s, Part& worst) const {
  const LookupEvidence& e = e_;
  Ladder& ladder = ladder_;
  if (e.probe.reference[i] > 1.0f || !e.probe.asks(i) || !inside_of_map(e.probe, i, e.exact_map))
    ladder.flags[i] |= flag_outside;
  if (s.chain.unsure > 0) ladder.flags[i] |= flag_undecided;
  worst.below_comparison = larger_residual(worst.below_comparison, s.below_comparison);

  const auto number = [](double value) { return static_cast<float>(value); };
  const float r[std::size(rung_names)] = {e.truth.soft[i],        number(e.truth.lit[i]), number(s.exact_lit),
                                          number(s.chain.texels), number(s.shown),        e.r5[i]};
  for (size_t n = 0; n < std::size(r); ++n) ladder.rungs[n].lit[i] = r[n];

  // What a map shows at a seam for comparison alone is no result.
  if (is_counted(ladder, i) && e.truth.share_of(i) > 0) {
    const double shown = bound_of_shown(static_cast<double>(e.r5[i]), s.chain.bound, e.moments->reduction());
    worst.reductions.add({i, static_cast<double>(e.truth.lit[i]), s.chain},
                         {.truth = r[1], .soft = r[0], .bound = number(shown)});
  }

  const auto set = [&](Cause cause, double value) { ladder[cause][i] = number(value); };
  for (Ladder::CauseImage& cause : ladder.causes) cause.step[i] = 0;
  set(Cause::light_size, static_cast<double>(r[1]) - r[0]);
  set(Cause::filter, static_cast<double>(r[2]) - r[1] - s.before_exact);
  set(Cause::displacement, s.displacement);
  set(Cause::undecided, s.all_undecided());
  const LookupParts& parts = s.parts;
  set(parts.coverage < 0 ? Cause::coverage_dark : Cause::coverage_light, parts.coverage);
  set(parts.aliasing < 0 ? Cause::aliasing_dark : Cause::aliasing_light, parts.aliasing);
  set(Cause::leak, parts.leak());
  set(Cause::peter_panning, parts.peter_panning());
  set(Cause::over_darkening, parts.over_darkening());
  set(Cause::reduction, parts.reduction);
  // What OpenGL makes of the exact map, and of its own: the same rounding often turns both the same way.
  std::array<double, 2> device{};
  lasting_steps(std::array{s.shown, static_cast<double>(e.r4[i]), static_cast<double>(e.r5[i])}, device);
  set(Cause::moment_precision, device[0]);
  set(Cause::precision, device[1]);
  ladder.doubt[i] = number(s.chain.unsure);

  double all = 0, classes = s.before_moved + parts.undecided;
  for (size_t c = 0; c < ladder.built_in(); ++c) all += ladder.causes[c].step[i];
  for (const Cause cause :
       {Cause::displacement, Cause::aliasing_dark, Cause::aliasing_light, Cause::peter_panning, Cause::coverage_dark,
        Cause::coverage_light, Cause::leak, Cause::over_darkening, Cause::reduction})
    classes += ladder[cause][i];
  worst.steps = larger_residual(worst.steps, std::abs((static_cast<double>(r[5]) - r[0]) - all));
  worst.taps = larger_residual(worst.taps, std::abs((static_cast<double>(r[4]) - r[2]) - classes));
  ladder.cause[i] = static_cast<uint8_t>(pixel_cause(ladder, i, true));
}

void MomentClimb::join(const Part& part) {
  ladder_.residual = larger_residual(ladder_.residual, part.steps);
  ladder_.tap_residual = larger_residual(ladder_.tap_residual, part.taps);
  below_comparison_ = larger_residual(below_comparison_, part.below_comparison);
  reductions_.add(part.reductions);
}

}  // namespace noonmark
