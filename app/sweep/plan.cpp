#include "app/sweep/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "app/pictures/image_file.h"
#include "app/sweep/survey.h"
#include "app/sweep/sweep_phase.h"
#include "base/text.h"
#include "measure/workbench.h"
#include "technique/tap_pattern.h"

namespace noonmark {

namespace {

// One line for each share: its points, its groups, its part of the cost.
std::string shares_text(const std::vector<Share>& shares, const Shard& shard) {
  uint64_t all = 0, most = 0;
  for (const Share& share : shares) {
    all += share.cost;
    most = std::max(most, share.cost);
  }
  std::string text;
  for (size_t i = 0; i < shares.size(); ++i) {
    const Share& share = shares[i];
    const double part = static_cast<double>(share.cost) / static_cast<double>(std::max<uint64_t>(1, all));
    text += fmt::format("share {}/{}: ", i + 1, shares.size());
    if (share.points.empty()) {
      text += "no points\n";
      continue;
    }
    const auto [low, high] = std::minmax_element(share.points.begin(), share.points.end());
    text += fmt::format("{} from {} to {} in {}, {:.1f}% of the cost", counted(share.points.size(), "point"), *low,
                        *high, counted(share.groups, "group"), 100 * part);
    text += static_cast<int>(i) + 1 == shard.number ? " (listed above)\n" : "\n";
  }
  return text + fmt::format("a group shares scene, view, light and map; the largest share is {:.2f} times the mean\n",
                            static_cast<double>(most) * static_cast<double>(shares.size()) /
                                static_cast<double>(std::max<uint64_t>(1, all)));
}

}  // namespace

void print_plan(const Experiment& experiment, const std::optional<Shard>& shard) {
  const std::vector<Settings> planned = points(experiment);
  const std::vector<Share> shares = split(experiment, planned, shard ? shard->of : 1);
  const std::vector<int64_t>& wanted = shares[static_cast<size_t>(shard ? shard->number - 1 : 0)].points;
  std::vector<int64_t> listed = wanted;
  if (!shard) std::sort(listed.begin(), listed.end());
  const auto taps = [](const Settings& s) {
    return static_cast<double>(s.view.width_px) * s.view.height_px * tap_pattern(s).taps;
  };
  // Checks the same things as run, in the same order.
  require_room_to_start(writes_pictures(experiment));
  Workbench bench(gl::DebugMode::log);
  const Survey survey(bench, experiment, planned, listed);
  survey.tell();
  const std::vector<MemoryEstimate>& memory = survey.memory;
  const AvailableMemory there = bench.memory_of_program(writes_pictures(experiment));
  const auto peak = [&](const MemoryEstimate& of) { return fits_waiting(of, there) ? of.bytes() : of.needed(); };
  double all_taps = 0;
  for (const int64_t id : listed) {
    const auto i = static_cast<size_t>(id);
    const Experiment& part = part_of_point(experiment, id);
    std::string text = part.part.empty() ? "" : "  " + part.part;
    for (const Swept& swept : part.swept)
      text += fmt::format("  {} = {}", swept.name, find_setting(swept.name).get(planned[i]));
    fmt::print("{:5}{}  ({})\n", i, printable(text), bytes_text(peak(memory[i])));
  }
  for (const Settings& point : planned) all_taps += taps(point);
  if (listed.empty()) {
    fmt::print("{}", shares_text(shares, *shard));
    return;
  }
  const auto most =
      std::max_element(memory.begin(), memory.end(),
                       [&](const MemoryEstimate& a, const MemoryEstimate& b) { return peak(a) < peak(b); });
  const MemoryShare& share = most->largest();
  fmt::print("memory: at most {}, by point {} ({} of it for {}); {}\n", bytes_text(peak(*most)), most - memory.begin(),
             bytes_text(share.bytes), share.what, there.text());
  MemoryCheck room(bench, experiment, memory);
  for (const int64_t id : listed) room.require_room_for(static_cast<size_t>(id));
  const std::vector<PhasePlan> diagrams = phase_plans(experiment, planned);
  for (const PhasePlan& plan : diagrams) {
    require_room_for(bench, plan);
    fmt::print("{}: {} texel sizes, each at {} placements of its grid\n", printable(plan.name()),
               plan.request.texel_sizes, plan.request.placements * plan.request.placements);
  }
  fmt::print("{}, {:.3g} million taps\n", counted(planned.size(), "point"), all_taps / 1e6);
  if (shard) fmt::print("{}", shares_text(shares, *shard));
}

}  // namespace noonmark
