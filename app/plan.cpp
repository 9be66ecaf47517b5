#include "app/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "app/image_file.h"
#include "app/survey.h"
#include "app/sweep_phase.h"
#include "app/time_estimate.h"
#include "app/workbench.h"
#include "scenes/text.h"
#include "technique/tap_pattern.h"

namespace noonmark {

namespace {

std::string seconds_text(double seconds) {
  if (seconds < 9.5) return fmt::format("{:.2g} s", seconds);
  return seconds < 120 ? fmt::format("{:.0f} s", seconds) : fmt::format("{:.0f} min", seconds / 60);
}

}  // namespace

void print_plan(const Experiment& experiment) {
  const std::vector<Settings> planned = points(experiment);
  const auto taps = [](const Settings& s) {
    return static_cast<double>(s.view.width_px) * s.view.height_px * tap_pattern(s.filter).taps;
  };
  // Checks the same things as run, in the same order.
  require_room_to_start(writes_pictures(experiment));
  Workbench bench(gl::DebugMode::log);
  if (writes_pictures(experiment)) require_image_files();
  const Survey survey(bench, experiment, planned);
  survey.tell();
  const std::vector<MemoryEstimate>& memory = survey.memory;
  double all_taps = 0;
  for (size_t i = 0; i < planned.size(); ++i) {
    const Experiment& part = part_of_point(experiment, static_cast<int64_t>(i));
    std::string text = part.part.empty() ? "" : "  " + part.part;
    for (const Swept& swept : part.swept)
      text += fmt::format("  {} = {}", swept.name, find_setting(swept.name).get(planned[i]));
    fmt::print("{:5}{}  ({})\n", i, text, bytes_text(memory[i].bytes()));
    all_taps += taps(planned[i]);
  }
  const auto most =
      std::max_element(memory.begin(), memory.end(),
                       [](const MemoryEstimate& a, const MemoryEstimate& b) { return a.bytes() < b.bytes(); });
  const MemoryShare& share = most->largest();
  fmt::print("memory: at most {}, by point {} ({} of it for {}); {}\n", bytes_text(most->bytes()),
             most - memory.begin(), bytes_text(share.bytes), share.what,
             bench.memory_of_program(writes_pictures(experiment)).text());
  MemoryCheck room(bench, experiment, memory);
  for (size_t i = 0; i < planned.size(); ++i) room.require_room_for(i);
  const std::vector<PhasePlan> diagrams = phase_plans(experiment, planned);
  for (const PhasePlan& plan : diagrams) {
    require_room_for(bench, plan);
    fmt::print("{}: {} texel sizes, each at {} placements of its grid\n", printable(plan.name()),
               plan.request.texel_sizes, plan.request.placements * plan.request.placements);
  }
  const TimeEstimate time = estimate_time(bench, experiment, planned, diagrams);
  fmt::print(
      "{}, {:.3g} million taps; about {} of processor time, {} here if the machine stays as busy as now (from {} in "
      "small "
      "pictures, {} of processor time)\n",
      counted(planned.size(), "point"), all_taps / 1e6, seconds_text(time.cpu_s), seconds_text(time.wall_s),
      counted(static_cast<size_t>(time.measured), "point"), seconds_text(time.calibration_s));
}

}  // namespace noonmark
