#include "measure/point_work.h"

#include "measure/pass_times.h"
#include "measure/stage_keys.h"
#include "technique/tap_pattern.h"

namespace noonmark {

// The factors are nanoseconds of processor time for one of each count, rounded, as they were measured for cube-room on two cores
// with llvmpipe. They only have to be in proportion.
uint64_t nominal_cost(const Settings& s, const Settings* before, const std::optional<CurveOptions>& options,
                      bool timed) {
  const auto anew = [&](const auto& key) { return !before || key(s) != key(*before); };
  const uint64_t pixels = static_cast<uint64_t>(s.view.width_px) * static_cast<uint64_t>(s.view.height_px);
  const TapPattern pattern = tap_pattern(s);
  const uint64_t taps = pixels * static_cast<uint64_t>(pattern.taps);
  const uint64_t texels = static_cast<uint64_t>(s.map.resolution) * static_cast<uint64_t>(s.map.rows());
  const uint64_t look = 300 * taps, compare = 200 * taps;
  uint64_t ns = 10'000'000 + compare;
  if (anew(scene_key_of)) ns += 50'000'000;
  if (anew(map_key_of)) ns += 3 * texels * (timed ? 1 + 2 * timed_rounds : 1);
  if (anew(view_key_of)) ns += 170 * pixels;
  if (anew(truth_key_of)) {
    const bool sized = s.light.angular_diameter_deg.value_or(0) > 0 || s.light.radius_m.value_or(0) > 0;
    ns += (sized ? 30 + 300 : 30) * pixels;
  }
  if (anew(lookup_key_of)) ns += look;
  if (timed && anew(lookup_work_of)) ns += 60 * taps;
  const BiasPart* const varied = options ? curve_part(s) : nullptr;
  if (varied && anew([&](const Settings& one) { return curve_key_of(one, *varied, *options); })) ns += 60 * taps;
  if (s.map.placements > 1) {
    const auto side = static_cast<uint64_t>(s.map.placements);
    // Of a filtered map each placement is looked up and compared by itself.
    ns += pattern.blurred ? (look + compare) * (side * side - 1) : 70 * taps * side * side;
  }
  return ns / 1000 + 1;
}

}  // namespace noonmark
