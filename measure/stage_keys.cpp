#include "measure/stage_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "technique/setting_rules.h"

namespace noonmark {

std::string scene_key_of(const Settings& settings) { return settings_key(settings, {Stage::scene}); }

std::string view_key_of(const Settings& settings) { return settings_key(settings, {Stage::scene, Stage::view}); }

std::string truth_key_of(const Settings& settings) {
  return settings_key(settings, {Stage::scene, Stage::view, Stage::truth});
}

std::string map_key_of(const Settings& settings) {
  const std::string key = settings_key(settings, {Stage::scene, Stage::map});
  return fits_view(settings.map.fit) ? key + settings_key(settings, {Stage::view}) : key;
}

std::string lookup_key_of(const Settings& settings) {
  const std::string key = settings_key(settings, {Stage::scene, Stage::view, Stage::lookup});
  return Bias(settings.bias).polygon_offset() ? key + find_setting("map.format").get(settings) : key;
}

std::string lookup_work_of(const Settings& settings) {
  std::string key = map_key_of(settings) + settings_key(settings, {Stage::view, Stage::lookup});
  const Bias bias(settings.bias);
  for (const ActivePart& part : bias.compared()) key += std::string(part.part->name) + ' ';
  for (const char* setting : {"bias.unit", "map.lit_beyond_far"}) key += find_setting(setting).get(settings) + ' ';
  return key;
}

StageKeys::StageKeys(const Settings& settings)
    : scene(scene_key_of(settings)),
      view(view_key_of(settings)),
      truth(truth_key_of(settings)),
      map(map_key_of(settings)),
      lookup(lookup_key_of(settings)) {}

std::string curve_key_of(const Settings& settings, const BiasPart& varied, const CurveOptions& options) {
  // All settings except the amount of the part that the curve varies.
  return settings_key(settings, {Stage::scene, Stage::view, Stage::truth, Stage::map, Stage::lookup, Stage::ladder},
                      "bias." + std::string(varied.name)) +
         fmt::format("{} {} {} {}", varied.name, options.acne_bound, options.peter_panning_bound,
                     fmt::join(options.bias_depth, " "));
}

}  // namespace noonmark
