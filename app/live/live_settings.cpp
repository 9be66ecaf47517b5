#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/live/live_page.h"
#include "base/error.h"
#include "technique/bias.h"
#include "technique/light_frame.h"

namespace noonmark {
namespace {

// Groups whose every setting the page takes as it is: what they change is in the geometry and the camera that it holds.
constexpr std::array modelled_groups{"scene.", "view."};
constexpr std::array modelled{"light.kind",         "light.name",         "light.index",         "light.position_m",
                              "light.target_m",     "light.azimuth_deg",  "light.elevation_deg", "map.resolution",
                              "map.format",         "map.depth_range",    "map.extent_m",        "map.extent_scale",
                              "map.shift_u_texels", "map.shift_v_texels", "map.near_m",          "map.far_m",
                              "map.wrap",           "map.lit_beyond_far", "bias.unit",           "bias.reference",
                              "bias.plane_cap",     "filter.size",        "filter.step_texels",  "truth.standard_error",
                              "truth.method"};

bool is_modelled(std::string_view name) {
  const auto begins = [&](std::string_view group) { return name.starts_with(group); };
  if (std::any_of(modelled_groups.begin(), modelled_groups.end(), begins)) return true;
  if (std::find(modelled.begin(), modelled.end(), name) != modelled.end()) return true;
  return std::any_of(bias_parts().begin(), bias_parts().end(), [&](const BiasPart& part) {
    return part.acts_on != BiasTarget::caster && name.starts_with("bias." + std::string(part.name)) &&
           (name.size() == 5 + part.name.size() || name.ends_with("_floor") || name.ends_with("_cap"));
  });
}

// Values that the page models of settings of which it does not model every value.
bool is_modelled_value(std::string_view name, std::string_view value) {
  if (name == "map.fit") return value == "scene" || value == "tight";
  if (name == "filter.kind") return value == "none" || value == "box";
  return false;
}

[[noreturn]] void refuse(const std::string& what) { throw Error(ErrorKind::usage, what); }

}  // namespace

Settings live_settings(Settings settings) {
  const double smaller = std::max({1.0, static_cast<double>(settings.view.width_px) / most_live_picture_width_px,
                                   static_cast<double>(settings.view.height_px) / most_live_picture_height_px});
  settings.view.width_px = std::max(1, static_cast<int>(std::lround(settings.view.width_px / smaller)));
  settings.view.height_px = std::max(1, static_cast<int>(std::lround(settings.view.height_px / smaller)));
  return settings;
}

void require_live(const Scene& scene, const Settings& settings) {
  const Light light = effective_light(scene, settings);
  if (light.kind != LightKind::directional)
    refuse(
        fmt::format("{}: the light is a {} light; the live page draws directional lights only; give --set "
                    "light.kind=directional, or noonmark render for this light",
                    scene.name, kind_of_light(light.kind).name()));
  if (scene.triangles.empty()) refuse(fmt::format("{} has no triangle to draw", scene.name));
  if (scene.triangles.size() > most_live_triangles)
    refuse(
        fmt::format("{} has {} triangles; the live page holds at most {}, so that it stays small enough to send; "
                    "simplify the model, or use noonmark render",
                    scene.name, scene.triangles.size(), most_live_triangles));
  if (scene.mask_error_m > 0)
    refuse(fmt::format(
        "{}: the borders of its alpha masks are cut with an error of {:.2g} m, which the live page does not "
        "account for; give --set scene.masks=false",
        scene.name, scene.mask_error_m));
  const Settings defaults;
  for (const Setting& row : settings_table()) {
    const std::string value = row.get(settings);
    if (is_modelled(row.name) || value == row.get(defaults) || is_modelled_value(row.name, value)) continue;
    if (row.why_idle && !row.why_idle(settings, LightKind::directional).empty()) continue;
    refuse(fmt::format("the live page does not model {} = {}; leave it at {}, or use noonmark render", row.name, value,
                       row.get(defaults)));
  }
}

}  // namespace noonmark
