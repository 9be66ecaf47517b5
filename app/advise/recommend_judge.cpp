#include "app/advise/recommend_judge.h"

#include <fmt/format.h>

#include <algorithm>

#include "compare/judge/curve_reading.h"
#include "compare/judge/recommendation.h"
#include "compare/results/point_settings.h"
#include "compare/results/quantities.h"
#include "technique/light_frame.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

// The settings whose values differ among the points.
std::vector<std::string> differing(const std::vector<PointRecord>& points) {
  std::vector<std::string> names;
  for (const auto& [name, text] : points.front().settings)
    for (const PointRecord& point : points)
      if (setting_of(point, name) != text) {
        names.push_back(name);
        break;
      }
  return names;
}

void set_bias(Settings& settings, const BiasChoice& bias) {
  find_setting(bias.parameter).set(settings, fmt::format("{}", bias.value));
}

// A curve that needs no bias is that of one rasteriser. Another one moves vertices by up to 1/16 of a texel or more, and the bias is
// to be enough there too: an eighth of a texel, where the window leaves room for that.
double bias_in_place_of_none(const PointRecord& point, double most) {
  if (!point.curve || !(point.curve->texels_per_depth > 0)) return 0;
  const double wanted = parameter_per_depth(point) / point.curve->texels_per_depth / 8;
  return most >= 2 * wanted ? short_decimal(wanted, wanted / 1.05, wanted * 1.05) : 0;
}

}  // namespace

std::string placed_accuracy(Workbench& bench, const Settings& settings, const std::string& accuracy) {
  if (accuracy != "error_soft") return accuracy;
  const LightKind light = make_light_frame(bench.scene(settings.scene), settings).kind;
  return setting_rules::without_size_of_light(settings, light).empty() ? accuracy : "error";
}

void judge_bias(Workbench& bench, Tried& tried, std::vector<PointRecord> points, const CurveOptions& searched,
                const std::string& accuracy) {
  tried.bias.reset();
  tried.worst.reset();
  tried.nearest.reset();
  tried.why_not.clear();
  Results results;
  results.info.accuracy = accuracy;
  results.info.over = differing(points);
  results.planned_points = static_cast<int64_t>(points.size());
  results.points = std::move(points);
  const auto failing = std::find_if(results.points.begin(), results.points.end(),
                                    [](const PointRecord& p) { return p.curve && !usable_window(*p.curve); });
  if (failing != results.points.end()) {
    tried.nearest = nearest_bias(*failing, searched);
    tried.why_not = why_no_window(*failing, *tried.nearest);
    tried.worst = *failing;
    return;
  }
  const std::vector<Recommendation> good = good_choices(results);
  if (good.empty()) {
    tried.why_not =
        results.points.front().curve ? "no bias is usable under every condition" : why_no_curve(results.points.front());
    tried.worst = results.points.front();
    return;
  }
  tried.bias = good.front().bias;
  if (tried.bias->value == 0)
    tried.bias->value = bias_in_place_of_none(results.points.front(), tried.bias->window.high);
  set_bias(tried.settings, *tried.bias);
  tried.error = 0;
  for (const PointRecord& point : results.points) {
    Settings there = settings_of(point);
    there.map.placements = 1;
    set_bias(there, *tried.bias);
    const PointRecord shown = bench.measure(there, std::nullopt, metric_set_for(accuracy), Checks::none).record;
    const double error = metric_of(shown, accuracy);
    if (!tried.worst || !(error <= tried.error)) tried.error = error, tried.worst = shown;
  }
}

}  // namespace noonmark
