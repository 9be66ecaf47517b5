#include "technique/chosen_light.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "scenes/library.h"
#include "technique/light_kind.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

Light light_with_name(const Scene& scene, const std::string& name) {
  try {
    return light_named(scene, name);
  } catch (const Error& error) {
    throw SettingConflict("light.name", error.what());
  }
}

Light light_with_index(const Scene& scene, size_t index) {
  // A scene without a list of lights has its one light.
  if (scene.lights.empty() && index == 0) return scene.light;
  if (index >= scene.lights.size())
    throw SettingConflict("light.index",
                          fmt::format("light.index = {}, but {} has {}; they are counted from 0", index, scene.name,
                                      counted(std::max<size_t>(1, scene.lights.size()), "light")));
  const Named<Light>& one = scene.lights[index];
  if (!one.value) throw SettingConflict("light.index", one.why_not);
  return *one.value;
}

std::optional<Light> first_of_kind(const Scene& scene, LightKind kind) {
  if (scene.light.kind == kind) return scene.light;
  for (const Named<Light>& one : scene.lights)
    if (one.value && one.value->kind == kind) return one.value;
  return std::nullopt;
}

bool same(const Light& a, const Light& b) {
  return a.kind == b.kind && a.position_m == b.position_m && a.target_m == b.target_m && a.cone_deg == b.cone_deg;
}

}  // namespace

ChosenLight chosen_light(const Scene& scene, const LightSettings& settings) {
  ChosenLight chosen{scene.light};
  const bool is_named = settings.name != LightSettings().name;
  if (is_named)
    chosen.light = light_with_name(scene, settings.name);
  else if (settings.index)
    chosen.light = light_with_index(scene, static_cast<size_t>(*settings.index));
  if (settings.kind != LightChoice::automatic) {
    const auto kind = static_cast<LightKind>(static_cast<int>(settings.kind) - 1);
    if (!is_named && !settings.index)
      if (const std::optional<Light> found = first_of_kind(scene, kind)) chosen.light = *found;
    chosen.made_up = chosen.light.kind != kind;
    chosen.light.kind = kind;
  }
  chosen.first = same(chosen.light, scene.light);
  return chosen;
}

std::string first_of_several_note(const Scene& scene, const Settings& settings) {
  const LightSettings& s = settings.light;
  if (scene.lights.size() < 2 || s.name != LightSettings().name || s.index || s.kind != LightChoice::automatic)
    return "";
  return fmt::format(
      "{}: has {} lights, and this is the first; light.name or light.index gives another, and lights = \"all\" in an "
      "experiment measures all",
      scene.name, scene.lights.size());
}

std::string made_up_light_note(const Scene& scene, const Settings& settings) {
  const ChosenLight chosen = chosen_light(scene, settings.light);
  if (!chosen.made_up) return "";
  LightSettings as_it_is = settings.light;
  as_it_is.kind = LightChoice::automatic;
  const Light before = chosen_light(scene, as_it_is).light;
  const KindOfLight& kind = kind_of_light(chosen.light.kind);
  const std::string_view made = kind.name();
  const glm::dvec3 at = settings.light.position_m.value_or(before.position_m);
  const bool named = settings.light.name != LightSettings().name || settings.light.index.has_value();
  const std::string_view was = kind_of_light(before.kind).name();
  return fmt::format(
      "{}: {}, so light.kind = {} makes one up{}; light.position_m{}", scene.name,
      named ? fmt::format("the light chosen is a {} light", was) : fmt::format("the scene has no {} light", made), made,
      settings.light.position_m
          ? ""
          : fmt::format(" at {:.4g}, {:.4g}, {:.4g} m, where its {} light stands", at.x, at.y, at.z, was),
      kind.is_aimed() ? " and light.target_m place it" : " places it");
}

}  // namespace noonmark
