#include "technique/idle_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/library.h"
#include "technique/filters.h"

namespace noonmark {
namespace {

using S = const Settings&;

// Which settings are read only sometimes, and when.
struct Rule {
  std::string_view name;
  bool (*is_read)(LightKind light, S settings);
};

bool from_file(LightKind, S s) { return names_file(s.scene.name); }
bool directional(LightKind light, S) { return light == LightKind::directional; }
bool spot(LightKind light, S) { return light == LightKind::spot; }
bool point(LightKind light, S) { return light == LightKind::point; }
bool has_place(LightKind light, S) { return light != LightKind::directional; }
bool flat(LightKind light, S) { return light != LightKind::point; }

constexpr Rule rules[] = {
    {"bias.plane_cap", [](LightKind, S s) { return tap_reference(s.bias.reference).reads_cap; }},
    {"scene.time_s", from_file},
    {"scene.animation", [](LightKind, S s) { return names_file(s.scene.name) && s.scene.time_s.has_value(); }},
    {"view.fit_depths", [](LightKind, S s) { return names_file(s.scene.name) && !(s.view.near_m && s.view.far_m); }},
    {"light.angular_diameter_deg", directional},
    {"light.radius_m", has_place},
    {"light.shape", has_place},
    {"light.cone_deg", spot},
    {"map.extent_m", directional},
    {"map.extent_scale", flat},
    {"map.fov_deg", spot},
    {"map.wrap", flat},
    {"map.cube_pass", point},
    {"filter.radius_m",
     [](LightKind, S s) { return s.filter.kind != "cube_disk" || s.filter.disk == DiskRadius::fixed; }},
};

std::string because(std::string_view name, LightKind light, S s) {
  if (name.starts_with("scene.")) return names_file(s.scene.name) ? "without scene.time_s" : "in a built-in scene";
  if (name == "view.fit_depths")
    return names_file(s.scene.name) ? "with both view.near_m and view.far_m"
                                    : "in a built-in scene, where near and far are always fitted";
  if (name.starts_with("filter.")) return "with filter.kind = " + find_setting("filter.kind").get(s);
  if (name == "bias.plane_cap") return "with bias.reference = " + s.bias.reference;
  constexpr std::string_view kinds[] = {"directional", "spot", "point"};
  return fmt::format("on a {} light", kinds[static_cast<size_t>(light)]);
}

}  // namespace

std::vector<IdleSetting> idle_settings(LightKind light, const Settings& settings) {
  const Settings defaults;
  std::vector<IdleSetting> idle;
  const auto changed = [&](std::string_view name) {
    const Setting& row = find_setting(name);
    return row.get(settings) != row.get(defaults);
  };
  for (const Rule& rule : rules)
    if (changed(rule.name) && !rule.is_read(light, settings))
      idle.push_back({std::string(rule.name), because(rule.name, light, settings)});
  const Filter& filter = find_filter(settings.filter.kind);
  for (const Setting& row : settings_table()) {
    if (!row.name.starts_with("filter.") || row.name == "filter.kind" || !changed(row.name)) continue;
    if (std::find(filter.reads.begin(), filter.reads.end(), row.name) == filter.reads.end())
      idle.push_back({std::string(row.name), because(row.name, light, settings)});
  }
  for (const BiasPart& part : bias_parts()) {
    const std::string name(part.name);
    if (part.cap_help.empty() || settings.bias[name] != 0) continue;
    if (settings.bias[name + "_floor"] == 0 && !std::isinf(settings.bias[name + "_cap"]))
      idle.push_back({"bias." + name + "_cap", "with bias." + name + " = 0"});
  }
  if (light == LightKind::point)
    for (const char* name : {"polygon_factor", "polygon_units"})
      if (settings.bias[name] != 0)
        idle.push_back({std::string("bias.") + name, "on a point light, whose shader writes its depth itself"});
  return idle;
}

}  // namespace noonmark
