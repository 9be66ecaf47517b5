#include "app/advise/engine_promise.h"

#include <fmt/format.h>

#include <map>

#include "app/advise/recommend_filtered.h"
#include "app/advise/recommend_judge.h"
#include "base/error.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"
#include "measure/memory_estimate.h"
#include "technique/lookups.h"

namespace noonmark {
namespace {

// Texels on the side of a map that is measured at all placements. A larger one differs less from one placement to the next,
// because its texels are smaller, and takes longer: 16 placements of 4096 x 4096 take 1.7 s of CPU a view in cube-room.
constexpr int most_placed = 2048;
// One that is measured in more views than the first. A view of 16384 x 16384 texels takes 5 s of CPU.
constexpr int most_in_all_views = 4096;

void raise(double& most, double value) {
  if (!(value <= most)) most = value;
}

// Of lines for a filtered map: in which numbers it is measured, ", measured with map.moments = 32f". Otherwise empty.
std::string format_text(const EngineAdvice& advice) {
  if (!advice.emulated || compares(*advice.emulated)) return "";
  return fmt::format(", measured with map.moments = {}", find_setting("map.moments").get(*advice.emulated));
}

}  // namespace

EnginePromise measured_promise(Workbench& bench, std::span<const Settings> conditions, const std::string& accuracy) {
  EnginePromise promise;
  for (const Settings& settings : conditions) {
    require_memory(bench.memory(settings, false, false), bench.memory_of_program(false), "the engine's map");
    const PointRecord point = bench.measure(settings, std::nullopt, metric_set_for(accuracy), Checks::none).record;
    if (nothing_judged(point)) continue;
    // As the error of an answer: of a filtered map that of the worst placement, where it is measured at each.
    const bool filtered = !compares(settings);
    raise(promise.error, worst_placed(point, filtered ? placed_accuracy(bench, settings, accuracy) : accuracy));
    raise(promise.acne, worst_placed(point, "acne"));
    raise(promise.peter_panning, worst_placed(point, "peter_panning"));
    if (!filtered) continue;
    if (!promise.filtered) promise.filtered.emplace();
    raise(*promise.filtered, filtered_shares(point));
  }
  return promise;
}

std::vector<Settings> under_engine(const EngineAdvice& advice, std::span<const Settings> conditions) {
  std::vector<Settings> there;
  for (const Settings& condition : conditions) {
    there.push_back(as_engine(advice, condition));
    if (there.back().map.resolution > most_placed) there.back().map.placements = 1;
    if (there.back().map.resolution > most_in_all_views) break;
  }
  return there;
}

EnginePromise measure_promises(Workbench& bench, std::vector<EngineAdvice>& engines,
                               std::span<const Settings> conditions, const std::string& accuracy,
                               const std::function<void(const std::string&)>& say) {
  std::map<std::map<std::string, std::string>, EnginePromise> known;
  const auto promise_of = [&](const std::vector<Settings>& settings, const std::string& whose) {
    const auto key = settings_map(settings.front());
    if (const auto found = known.find(key); found != known.end()) return found->second;
    say("measuring " + whose);
    return known.emplace(key, measured_promise(bench, settings, accuracy)).first->second;
  };
  const EnginePromise recommended = promise_of({conditions.begin(), conditions.end()}, "the recommended settings");
  for (EngineAdvice& advice : engines) {
    if (!advice.emulated) continue;
    const std::vector<Settings> there = under_engine(advice, conditions);
    const bool all_views = there.size() == conditions.size();
    try {
      advice.promise = promise_of(there, "what " + advice.engine + " does with its lines");
      advice.promise->all_views = all_views;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::usage) throw;
      advice.emulated.reset();
      advice.why_not_emulated = error.what();
    }
  }
  return recommended;
}

std::string promise_text(const EngineAdvice& advice, const EnginePromise& recommended) {
  if (!advice.promise) return "error not known: " + advice.why_not_emulated;
  return fmt::format("error {} with these lines (recommended: {}){}{}", share_text(advice.promise->error),
                     share_text(recommended.error),
                     advice.promise->all_views ? "" : ", measured at the given view alone", format_text(advice));
}

std::string broken_promise_text(const EngineAdvice& advice, const CurveOptions& bounds, std::optional<double> error) {
  if (!advice.promise) return "";
  std::string broken;
  const auto compare = [&](const char* name, double value, double bound) {
    if (value <= bound) return;
    broken += fmt::format("{}{} {} (bound {})", broken.empty() ? "" : ", ", name, share_text(value), share_text(bound));
  };
  compare("acne", advice.promise->acne, bounds.acne_bound);
  compare("Peter Panning", advice.promise->peter_panning, bounds.peter_panning_bound);
  if (const std::optional<FilteredShares>& shares = advice.promise->filtered) {
    compare("leak", shares->leak, bounds.peter_panning_bound);
    compare("over-darkening", shares->over_darkening, bounds.acne_bound);
    compare("what the reduction darkens", shares->reduction, bounds.acne_bound);
  }
  if (error) compare("error", advice.promise->error, *error);
  return broken.empty() ? "" : "these lines are not an answer: " + broken;
}

}  // namespace noonmark
