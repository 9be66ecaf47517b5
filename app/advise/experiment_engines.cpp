#include "app/advise/experiment_engines.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "app/advise/engine_promise.h"
#include "app/advise/recommend_judge.h"
#include "app/advise/recommend_text.h"
#include "base/error.h"
#include "base/text.h"
#include "compare/judge/recommendation.h"
#include "compare/judge/undecided.h"
#include "compare/results/number_text.h"
#include "compare/results/point_settings.h"
#include "compare/results/quantities.h"
#include "scenes/camera_fit.h"
#include "technique/light_frame.h"
#include "technique/lookups.h"

namespace noonmark {

SeenDepths depths_in_views(Workbench& bench, std::span<const Settings> conditions) {
  std::set<std::string> known;  // conditions are many where lights or placements differ, and views are few
  SeenDepths seen;
  for (const Settings& condition : conditions) {
    std::string key;
    for (const Setting& row : settings_table())
      if (row.name.starts_with("scene.") || row.name.starts_with("view.") || row.name.starts_with("motion."))
        key += row.get(condition) + '\n';
    if (!known.insert(key).second) continue;
    const Scene& scene = bench.scene(condition.scene);
    seen.nearest_m = std::min(seen.nearest_m, *effective_camera(scene, condition.view).near_m);
    seen.farthest_m = std::max(seen.farthest_m, farthest_in_view_m(condition, scene));
  }
  return seen;
}

namespace {

std::vector<EngineAdvice> engines_of_choice(Workbench& bench, std::span<const Settings> conditions) {
  const Settings& first = conditions.front();
  const Scene& scene = bench.scene(first.scene);
  return engine_advice(first, make_light_frame(scene, first), scene, depths_in_views(bench, conditions));
}

DescribedChoice described(const Choice& choice, const std::optional<BiasChoice>& bias, std::string why) {
  DescribedChoice made{{}, choice.points, std::move(why)};
  for (const PointRecord* point : choice.points) {
    made.conditions.push_back(settings_of(*point));
    if (bias) find_setting(bias->parameter).set(made.conditions.back(), fmt::format("{}", bias->value));
  }
  return made;
}

// "point 4, map.resolution = 512, lookup.radius = 2"; with the bias or the reduction, if it is another one than the point's.
std::string name_of(const DescribedChoice& choice, const Results& results) {
  const PointRecord& first = *choice.points.front();
  std::string text = fmt::format("point {}", first.id);
  for (const std::string& name : choice_settings(results.info))
    text += fmt::format(", {} = {}", name, setting_text(setting_of(first, name)));
  for (const Setting& row : settings_table())
    if ((row.name.starts_with("bias.") || row.name.starts_with("lookup.")) &&
        row.get(choice.conditions.front()) != setting_of(first, std::string(row.name)))
      text += fmt::format(", at {} = {}", row.name, setting_text(row.get(choice.conditions.front())));
  return text;
}

double measured_error(const DescribedChoice& choice, const std::string& accuracy) {
  double most = 0;
  for (const PointRecord* point : choice.points)
    if (const double error = worst_placed(*point, accuracy); !(error <= most)) most = error;
  return most;
}

// "cube-room, 1280 x 720 pixels, the largest under 3 conditions"
std::string where_measured(const DescribedChoice& choice) {
  const Settings& first = choice.conditions.front();
  return fmt::format("{}, {} x {} pixels{}", first.scene.name, first.view.width_px, first.view.height_px,
                     choice.conditions.size() > 1
                         ? fmt::format(", the largest under {}", counted(choice.conditions.size(), "condition"))
                         : "");
}

// What the lines give. Engines store other moments than the point may have, and fit cascades in their own way.
void promise_lines(Workbench& bench, EngineAdvice& engine, const DescribedChoice& choice, const std::string& accuracy) {
  if (!engine.emulated) return;
  try {
    const std::vector<Settings> there = under_engine(engine, choice.conditions);
    // The memory of a run is known before it starts, and that is the memory of its points.
    if (const int needed = there.front().map.resolution, own = choice.conditions.front().map.resolution; needed > own)
      throw Error(
          ErrorKind::usage,
          fmt::format("its maps have {0} x {0} texels, more than the point; noonmark recommend measures them", needed));
    engine.promise = measured_promise(bench, there, accuracy);
    engine.promise->all_views = there.size() == choice.conditions.size();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::usage) throw;
    engine.promised = fmt::format("error not known: {}", error.what());
    return;
  }
  const Settings& first = choice.conditions.front();
  engine.promised = fmt::format(
      "error {} with these lines ({}){}, in {}; the point itself{} has {}", share_text(engine.promise->error), accuracy,
      format_text(engine), where_measured(choice),
      reads_moments(first) ? fmt::format(", with map.moments = {},", find_setting("map.moments").get(first)) : "",
      share_text(measured_error(choice, accuracy)));
  if (!engine.promise->all_views) engine.promised += "; the lines were measured under the first condition alone";
}

}  // namespace

std::optional<DescribedChoice> described_choice(const Results& results) {
  if (results.points.empty() || !results.points.front().part.empty()) return std::nullopt;
  if (static_cast<int64_t>(results.points.size()) < results.planned_points) return std::nullopt;
  const std::vector<Choice> choices = choices_of(results);
  if (choices.size() == 1) return described(choices.front(), {}, "");
  if (comparable_choices(results).size() != 1) return std::nullopt;
  const Recommendation found = recommend(results);
  if (found.outcome == Recommendation::Outcome::incomplete) return std::nullopt;
  if (found.outcome == Recommendation::Outcome::found)
    return described(found.choice, found.bias, "the answer of this report");
  if (std::any_of(results.points.begin(), results.points.end(), [&](const PointRecord& point) {
        return ambiguous_room(point, results.info.accuracy) > 0;
      }))
    return std::nullopt;  // which choice errs least is not known
  const Choice* least = nullptr;
  double least_error = std::numeric_limits<double>::infinity();
  for (const Choice& choice : choices)
    if (const double error = joined(choice, results.info.accuracy).worst; error < least_error)
      least = &choice, least_error = error;
  if (!least) return std::nullopt;
  return described(*least, {},
                   found.outcome == Recommendation::Outcome::none_holds
                       ? "no choice of this report holds its bounds, and this one errs least"
                       : "this report has no bound to answer by, and this choice errs least");
}

std::string experiment_engines(Workbench& bench, const Results& results) {
  const std::optional<DescribedChoice> choice = described_choice(results);
  if (!choice) return "";
  std::vector<EngineAdvice> engines = engines_of_choice(bench, choice->conditions);
  if (const Settings& first = choice->conditions.front(); reads_moments(first) || first.cascades.count > 1)
    for (EngineAdvice& engine : engines) promise_lines(bench, engine, *choice, results.info.accuracy);
  const std::string text = advice_engines(engines);
  return choice->why.empty() ? text : fmt::format("Of {}: {}.\n{}", name_of(*choice, results), choice->why, text);
}

std::string experiment_engines(Workbench& bench, const Experiment& experiment, std::span<const Settings> points) {
  const bool one_choice = experiment.parts.empty() && std::all_of(experiment.swept.begin(), experiment.swept.end(),
                                                                  [](const Swept& swept) { return swept.condition; });
  return one_choice ? advice_engines(engines_of_choice(bench, points)) : "";
}

}  // namespace noonmark
