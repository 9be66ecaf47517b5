#include "measure/point_work.h"

#include "measure/pass_times.h"
#include "measure/stage_keys.h"
#include "technique/tap_pattern.h"

namespace noonmark {
namespace {

// Nanoseconds of processor time for one of each count, rounded: what the calibration of app/sweep/time_estimate.h found for
// cube-room on two cores with llvmpipe. They only have to be in proportion.
constexpr uint64_t nominal_ns[PointWork::works] = {
    10'000'000,  // point
    50'000'000,  // scene
    3,           // map
    170,         // view
    30,          // truth
    300,         // soft
    60,          // passes
    300,         // look
    200,         // compare
    60,          // curve
    70,          // place
};

}  // namespace

std::vector<uint64_t> work_of(const Settings& s, const Settings* before, const std::optional<CurveOptions>& options,
                              bool timed) {
  std::vector<uint64_t> work(PointWork::works, 0);
  const auto anew = [&](const auto& key) { return !before || key(s) != key(*before); };
  const auto square = [](int n) { return static_cast<uint64_t>(n) * static_cast<uint64_t>(n); };
  const uint64_t pixels = static_cast<uint64_t>(s.view.width_px) * static_cast<uint64_t>(s.view.height_px);
  const uint64_t taps = pixels * static_cast<uint64_t>(tap_pattern(s).taps);
  const uint64_t texels = static_cast<uint64_t>(s.map.resolution) * static_cast<uint64_t>(s.map.rows());
  work[PointWork::point] = 1;
  work[PointWork::scene] = anew(scene_key_of);
  if (anew(map_key_of)) work[PointWork::map] = texels * (timed ? 1 + 2 * timed_rounds : 1);
  if (anew(view_key_of)) work[PointWork::view] = pixels;
  if (anew(truth_key_of)) {
    work[PointWork::truth] = pixels;
    const bool sized = s.light.angular_diameter_deg.value_or(0) > 0 || s.light.radius_m.value_or(0) > 0;
    if (sized) work[PointWork::soft] = pixels;
  }
  if (anew(lookup_key_of)) work[PointWork::look] = taps;
  if (timed && anew(lookup_work_of)) work[PointWork::passes] = taps;
  work[PointWork::compare] = taps;
  const BiasPart* const varied = options ? curve_part(s) : nullptr;
  if (varied && anew([&](const Settings& one) { return curve_key_of(one, *varied, *options); }))
    work[PointWork::curve] = taps;
  if (s.map.placements > 1 && reads_moments(s)) {  // each is looked up and compared by itself
    const uint64_t others = taps * (square(s.map.placements) - 1);
    work[PointWork::look] += others;
    work[PointWork::compare] += others;
  } else if (s.map.placements > 1) {
    work[PointWork::place] = taps * square(s.map.placements);
  }
  return work;
}

uint64_t nominal_cost(const Settings& s, const Settings* before, const std::optional<CurveOptions>& options,
                      bool timed) {
  const std::vector<uint64_t> work = work_of(s, before, options, timed);
  uint64_t ns = 0;
  for (size_t stage = 0; stage < PointWork::works; ++stage) ns += work[stage] * nominal_ns[stage];
  return ns / 1000 + 1;
}

}  // namespace noonmark
