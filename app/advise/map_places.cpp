#include "app/advise/map_places.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <string>

#include "scenes/camera_fit.h"
#include "technique/light_frame.h"

namespace noonmark {
namespace {

// A box along the axes of the light.
struct LightBox {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  void add(const glm::dvec3& p) { low = glm::min(low, p), high = glm::max(high, p); }
  glm::dvec2 middle() const { return 0.5 * (glm::dvec2(low) + glm::dvec2(high)); }
  double side() const { return std::max(high.x - low.x, high.y - low.y); }
};

// Puts the light over this point of the plane through its own position. The map is fitted, whatever the settings gave.
void aim(Settings& settings, const Light& light, const LightFrame& axes, glm::dvec2 middle) {
  const glm::dvec3 way = middle.x * axes.right + middle.y * axes.up;
  settings.light.position_m = light.position_m + way;
  settings.light.target_m = light.target_m + way;
  settings.light.azimuth_deg.reset();
  settings.light.elevation_deg.reset();
  settings.map.fit = MapFit::tight;
  settings.map.extent_m.reset();
  settings.map.near_m.reset();
  settings.map.far_m.reset();
}

// The frame whose origin is the light's own position.
LightFrame axes_of(const Light& light) { return kind_of_light(light.kind).axes(light); }

MapPlace over_scene(const Scene& scene, const Settings& settings, const Light& light) {
  const LightFrame axes = axes_of(light);
  LightBox box;
  for (const glm::vec3& p : scene.positions) box.add(axes.to_light(glm::dvec3(p)));
  MapPlace place;
  place.covers = "the whole scene";
  place.apply = [light, axes, middle = box.middle()](Settings& there) { aim(there, light, axes, middle); };
  Settings there = settings;
  place.apply(there);
  place.extent_m = make_light_frame(scene, there).extent_m;
  return place;
}

LightBox box_of(const LightFrame& frame, const LightFrame& axes) {
  const glm::dvec3 middle = axes.to_light(frame.origin_m);
  const double half = 0.5 * frame.extent_m;
  LightBox box;
  box.add({middle.x - half, middle.y - half, frame.near_m});
  box.add({middle.x + half, middle.y + half, frame.far_m});
  return box;
}

LightFrame fitted(const Scene& scene, Settings settings, MapFit fit) {
  settings.map.fit = fit;
  // The place is one for all resolutions: its margin of a texel is that of the coarsest map.
  settings.map.resolution = std::min(settings.map.resolution, 128);
  settings.map.extent_m.reset();
  settings.map.near_m.reset();
  settings.map.far_m.reset();
  return make_light_frame(scene, settings);
}

MapPlace over(const char* covers, const LightBox& box, const Light& light) {
  MapPlace place;
  place.covers = covers;
  place.extent_m = box.side();
  place.apply = [light, box](Settings& there) {
    aim(there, light, axes_of(light), box.middle());
    there.map.extent_m = box.side();
    there.map.near_m = box.low.z;
    there.map.far_m = box.high.z;
  };
  return place;
}

// The box of the maps that map.fit = view lays for each view. Where a view shows nothing, it needs no map.
LightBox box_of_views(const Scene& scene, const Settings& settings, std::span<const Settings> views,
                      const LightFrame& axes) {
  LightBox all;
  for (const Settings& view : views) {
    Settings there = settings;
    there.view = view.view;
    const LightBox box = box_of(fitted(scene, there, MapFit::view), axes);
    all.add(box.low);
    all.add(box.high);
  }
  return all;
}

LightBox both(const LightBox& a, const LightBox& b) { return {glm::max(a.low, b.low), glm::min(a.high, b.high)}; }

bool same_light_and_scene(const Scene& scene, std::span<const Settings> conditions, const Light& light) {
  const auto first_scene = settings_map(conditions.front());
  return std::all_of(conditions.begin(), conditions.end(), [&](const Settings& condition) {
    const Light other = effective_light(scene, condition);
    const auto all = settings_map(condition);
    return other.kind == light.kind && other.position_m == light.position_m && other.target_m == light.target_m &&
           std::all_of(all.begin(), all.end(), [&](const auto& one) {
             return !one.first.starts_with("scene.") || first_scene.at(one.first) == one.second;
           });
  });
}

}  // namespace

void lay_as(const LightFrame& frame, Settings& settings) {
  settings.light.azimuth_deg.reset();
  settings.light.elevation_deg.reset();
  settings.light.position_m = frame.origin_m;
  settings.light.target_m = frame.origin_m + frame.far_m * frame.forward;
  settings.map.fit = MapFit::scene;
  settings.map.snap = false;
  settings.map.shift_u_texels = settings.map.shift_v_texels = 0;
  settings.map.extent_scale = 1;
  settings.map.extent_m = frame.extent_m;
  settings.map.aspect = static_cast<double>(frame.resolution) / frame.rows;
  settings.map.near_m = frame.near_m;
  settings.map.far_m = frame.far_m;
}

MapPlace place_as_given(bool in_texels) {
  MapPlace place;
  place.apply = [in_texels](Settings& there) {
    if (in_texels) there.bias.unit = BiasUnit::texel;
  };
  return place;
}

std::vector<MapPlace> map_places(const Scene& scene, std::span<const Settings> conditions,
                                 std::span<const Settings> views) {
  const Settings& first = conditions.front();
  const Light light = effective_light(scene, first);
  std::vector<MapPlace> places = {place_as_given()};
  // The places are square boxes along the light's own axes.
  const bool other_shape = first.map.roll_deg != 0 || first.map.aspect != 1;
  if (light.kind != LightKind::directional || first.view.motion.moves_light() || other_shape ||
      !same_light_and_scene(scene, conditions, light))
    return places;
  places.front().extent_m = make_light_frame(scene, first).extent_m;
  const LightFrame axes = axes_of(light);
  LightBox needed = box_of_views(scene, first, views, axes);
  // Outside of the map that holds all casters everything is lit, if the border is.
  std::optional<LightBox> casters;
  if (first.map.wrap == Wrap::clamp_to_border) casters = box_of(fitted(scene, first, MapFit::casters), axes);
  MapPlace whole = over_scene(scene, first, light);
  if (casters && places_differ * casters->side() < whole.extent_m) {
    whole = over("all that casts shadows", *casters, light);
    whole.of_casters = true;
  }
  if (whole.extent_m < places.front().extent_m) places.front() = std::move(whole);
  if (casters) needed = both(needed, *casters);
  if (needed.side() > 0 && places_differ * needed.side() < places.front().extent_m) {
    places.push_back(over("what these views show", needed, light));
    places.back().moves_with = true;
    places.back().of_casters = casters.has_value();
  }
  return places;
}

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

}  // namespace noonmark
