#include "compare/bias_curves.h"

#include <tbb/blocked_range.h>
#include <tbb/combinable.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/thresholds.h"

namespace noonmark {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

struct Lists {
  std::vector<float> error_dark, error_light, wrong_dark, wrong_light;
  std::array<std::vector<float>, cause_count> by_cause;
  uint64_t receivers = 0;
  float stored_acne = 0;  // the largest threshold
};

// Empties `from`: with large kernels these lists are gigabytes, and two copies of all of them would not do.
void append(std::vector<float>& to, std::vector<float>& from) {
  if (to.empty()) to.swap(from);
  to.insert(to.end(), from.begin(), from.end());
  std::vector<float>().swap(from);
}

}  // namespace

BiasCounts::BiasCounts(const LookupEvidence& e, const Image<float>& stored_map, CurveParameter parameter) {
  const int taps = e.taps.taps_per_receiver, kernel = kernel_of(e.taps);
  taps_per_receiver_ = taps;
  tbb::combinable<Lists> parts;
  tbb::parallel_for(tbb::blocked_range<size_t>(0, e.truth.facing.size(), 8192),
                    [&](const tbb::blocked_range<size_t>& range) {
                      Lists& lists = parts.local();
                      for (size_t i = range.begin(); i != range.end(); ++i) {
                        if (!e.truth.facing[i] || is_ambiguous(e.truth, e.taps, i)) continue;
                        ++lists.receivers;
                        const float factor = 1.0f - e.probe.n_dot_l[i];  // the shader's own
                        const auto threshold = [&](const Tap& tap) {
                          if (tap.always_lit) return 0.0f;
                          const float bias = lit_threshold(e.probe.reference[i], tap.depth);
                          if (parameter == CurveParameter::constant) return bias;
                          return e.bias.floor >= bias ? 0.0f : slope_threshold(bias, factor);
                        };
                        float least = infinity, most = 0;
                        for (int t = 0; t < taps; ++t) {
                          const Tap exact = tap_of(e.probe, e.taps, e.map, e.exact_map, i, kernel, t);
                          const float at_r4 = threshold(exact);
                          // Wrong on one side of its threshold only: when dark if it should be lit, when lit if it
                          // should be dark.
                          if (!exact.moved_lit || at_r4 > 0)
                            lists.by_cause[static_cast<size_t>(tap_cause(exact, !exact.moved_lit))].push_back(at_r4);
                          const float at_r5 = threshold(tap_of(e.probe, e.taps, e.map, stored_map, i, kernel, t));
                          if (exact.covered && exact.moved_lit && exact.texel_lit)
                            lists.stored_acne = std::max(lists.stored_acne, at_r5);
                          least = std::min(least, at_r5);
                          most = std::max(most, at_r5);
                          if (!e.truth.lit[i])
                            lists.error_light.push_back(at_r5);
                          else if (at_r5 > 0)
                            lists.error_dark.push_back(at_r5);
                        }
                        if (!e.truth.lit[i])
                          lists.wrong_light.push_back(least);
                        else if (most > 0)
                          lists.wrong_dark.push_back(most);
                      }
                    });
  parts.combine_each([&](Lists& part) {
    receivers_ += part.receivers;
    stored_acne_free_from_ = std::max(stored_acne_free_from_, part.stored_acne);
    append(error_dark_, part.error_dark);
    append(error_light_, part.error_light);
    append(wrong_dark_, part.wrong_dark);
    append(wrong_light_, part.wrong_light);
    for (int c = 0; c < cause_count; ++c) append(by_cause_[c], part.by_cause[c]);
  });
  for (Thresholds* list : {&error_dark_, &error_light_, &wrong_dark_, &wrong_light_}) tbb::parallel_sort(*list);
  for (Thresholds& list : by_cause_) tbb::parallel_sort(list);
}

uint64_t BiasCounts::dark(const Thresholds& t, float x) {
  return static_cast<uint64_t>(t.end() - std::upper_bound(t.begin(), t.end(), x));
}

uint64_t BiasCounts::lit(const Thresholds& t, float x) {
  return static_cast<uint64_t>(std::upper_bound(t.begin(), t.end(), x) - t.begin());
}

uint64_t BiasCounts::caused(Cause cause, float x) const {
  const Thresholds& list = by_cause_[static_cast<size_t>(cause)];
  const bool darkens = cause == Cause::acne || cause == Cause::aliasing_dark || cause == Cause::coverage_dark;
  return darkens ? dark(list, x) : lit(list, x);
}

float BiasCounts::acne_free_from(uint64_t allowed) const {
  const Thresholds& t = by_cause_[static_cast<size_t>(Cause::acne)];
  return t.size() <= allowed ? 0.0f : t[t.size() - 1 - allowed];
}

float BiasCounts::peter_panning_free_to(uint64_t allowed) const {
  const Thresholds& t = by_cause_[static_cast<size_t>(Cause::peter_panning)];
  if (t.size() <= allowed || t[allowed] == infinity) return infinity;  // infinity: a slope that no bias reaches
  return std::nextafter(t[allowed], -infinity);
}

BiasCounts::Best BiasCounts::best() const {
  // The error is constant from each breakpoint to the next; 0 starts the first stretch.
  struct Stretch {
    float from;
    uint64_t wrong;
  };
  std::vector<Stretch> stretches;
  size_t d = 0, l = 0;
  float x = 0;
  for (;;) {
    while (d < error_dark_.size() && error_dark_[d] <= x) ++d;
    while (l < error_light_.size() && error_light_[l] <= x) ++l;
    stretches.push_back({x, error_dark_.size() - d + l});
    const float next = std::min(d < error_dark_.size() ? error_dark_[d] : infinity,
                                l < error_light_.size() ? error_light_[l] : infinity);
    if (next > 1) break;  // a bias of 1 spans the whole map; nothing above it means anything
    x = next;
  }
  const auto least = std::min_element(stretches.begin(), stretches.end(),
                                      [](const Stretch& a, const Stretch& b) { return a.wrong < b.wrong; });
  const auto end_of = [&](auto stretch) {
    return stretch + 1 == stretches.end() ? 1.0f : std::nextafter((stretch + 1)->from, -infinity);
  };
  const double limit = 1.1 * static_cast<double>(least->wrong);
  auto first = least, last = least;
  while (first != stretches.begin() && static_cast<double>((first - 1)->wrong) <= limit) --first;
  while (last + 1 != stretches.end() && static_cast<double>((last + 1)->wrong) <= limit) ++last;
  return {least->from, end_of(least), least->wrong, first->from, end_of(last), stretches.size() - 1};
}

std::vector<double> default_bias_grid() {
  std::vector<double> grid = {0};
  for (int step = 0; step <= 140; ++step) grid.push_back(std::pow(10.0, -7 + step / 20.0));
  return grid;
}

BiasCurve summarise(const BiasCounts& counts, CurveParameter parameter, const LightFrame& frame,
                    const CurveOptions& options) {
  BiasCurve curve;
  curve.parameter = parameter == CurveParameter::constant ? "bias.constant" : "bias.slope";
  curve.made = "one pass";
  curve.bias_depth = options.bias_depth.empty() ? default_bias_grid() : options.bias_depth;
  const auto per = [](uint64_t count, uint64_t base) {
    return base == 0 ? std::numeric_limits<double>::quiet_NaN()
                     : static_cast<double>(count) / static_cast<double>(base);
  };
  for (double bias : curve.bias_depth) {
    const float x = static_cast<float>(bias);
    const auto share = [&](Cause cause) { return per(counts.caused(cause, x), counts.taps()); };
    curve.error.push_back(per(counts.wrong_taps(x), counts.taps()));
    curve.wrong.push_back(per(counts.wrong_receivers(x), counts.receivers()));
    curve.acne.push_back(share(Cause::acne));
    curve.peter_panning.push_back(share(Cause::peter_panning));
    curve.aliasing_dark.push_back(share(Cause::aliasing_dark));
    curve.aliasing_light.push_back(share(Cause::aliasing_light));
    curve.coverage.push_back(share(Cause::coverage_dark) + share(Cause::coverage_light));
  }
  curve.m_per_depth = frame.far_m - frame.near_m;
  curve.texels_per_depth = curve.m_per_depth / frame.texel_m();

  curve.acne_bound = options.acne_bound;
  curve.peter_panning_bound = options.peter_panning_bound;
  // The most taps whose share, as the metrics divide it, is within the bound; the product may round to either side.
  const auto allowed = [&](double bound) {
    auto count = static_cast<uint64_t>(bound * static_cast<double>(counts.taps()));
    if (per(count + 1, counts.taps()) <= bound) ++count;
    if (count > 0 && per(count, counts.taps()) > bound) --count;
    return count;
  };
  const float from = counts.acne_free_from(allowed(options.acne_bound));
  const float to = counts.peter_panning_free_to(allowed(options.peter_panning_bound));
  if (counts.receivers() > 0 && from <= to && from <= 1) {
    curve.window_min_depth = from;
    curve.window_max_depth = std::min(static_cast<double>(to), 1.0);
  }
  if (counts.receivers() > 0) {
    const BiasCounts::Best best = counts.best();
    // Where nothing limits the bias from above, the middle would be half the map's depth; twice the need is advice
    // enough.
    const double start = best.from, end = best.to;
    curve.best_bias_depth = end >= 1 ? std::min(2 * start, 1.0) : (start + end) / 2;
    curve.best_error = per(best.wrong_taps, counts.taps());
    curve.flat_min_depth = best.flat_from;
    curve.flat_max_depth = best.flat_to;
    curve.breakpoints = best.breakpoints;
    const auto if_any = [](float x) { return x < infinity ? std::optional<double>(x) : std::nullopt; };
    curve.acne_free_bias_depth = if_any(counts.acne_free_from(0));
    curve.acne_free_bias_stored_depth = if_any(counts.stored_acne_free_from());
  } else {
    curve.best_error = std::numeric_limits<double>::quiet_NaN();
  }
  return curve;
}

}  // namespace noonmark
