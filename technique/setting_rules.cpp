#include "technique/setting_rules.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "scenes/builtin.h"
#include "scenes/library.h"
#include "scenes/number_ranges.h"
#include "technique/bias.h"
#include "technique/filters.h"
#include "technique/light_kind.h"
#include "technique/lookups.h"

namespace noonmark {
namespace setting_rules {
namespace {

std::string on_a(LightKind light) { return fmt::format("on a {} light", kind_of_light(light).name()); }

// The names of the filters for which `meant` is true, as text: "none, box or poisson".
template <class Meant>
std::string filters_that(const Meant& meant) {
  std::vector<std::string_view> names;
  for (const Filter& filter : filters())
    if (meant(filter)) names.push_back(filter.name);
  const std::string_view last = names.back();
  names.pop_back();
  return names.empty() ? std::string(last) : fmt::format("{} or {}", fmt::join(names, ", "), last);
}

std::string near_beyond_far(std::string_view group, std::optional<double> near_m, std::optional<double> far_m) {
  if (!near_m || !far_m || *near_m < *far_m) return "";
  return fmt::format("{0}.near_m = {1} is not less than {0}.far_m = {2}", group, *near_m, *far_m);
}

// A sun's direction, set by `setting`, against the kind of the light and against the other way to set a direction.
std::string sun_and(const Settings& s, std::optional<LightKind> light, std::string_view setting) {
  if (light && !kind_of_light(*light).rays().have_one_direction())
    return fmt::format(
        "{} is the direction of a directional light, and this one is a {} light; set light.kind = "
        "directional, or leave {} out",
        setting, kind_of_light(*light).name(), setting);
  if (!s.light.position_m) return "";
  return fmt::format(
      "{0} and light.position_m both set the light's direction; leave one of them out, or give one of them as auto "
      "(--set {0}=auto takes back what a file sets)",
      setting);
}

std::string shifted_cube(std::string_view setting, double texels, std::optional<LightKind> light) {
  if (texels == 0 || !light || kind_of_light(*light).map_shape() == MapShape::flat) return "";
  return fmt::format("{} needs a flat map; turn the cube with map.turn_deg instead", setting);
}

}  // namespace

std::string in_builtin_scene(const Settings& s, LightKind) {
  return names_file(s.scene.name) ? "" : "in a built-in scene";
}
std::function<std::string(const Settings&, LightKind)> only_in_scenes_with(std::string_view setting) {
  return [setting](const Settings& s, LightKind) -> std::string {
    if (names_file(s.scene.name)) return "in a scene from a file";
    for (const BuiltinScene& scene : builtin_scenes())
      if (scene.name == s.scene.name && std::find(scene.reads.begin(), scene.reads.end(), setting) == scene.reads.end())
        return fmt::format("in the scene {}", scene.name);
    return "";
  };
}
std::function<std::string(const Settings&, LightKind)> only_in_files_and_scenes_with(std::string_view setting) {
  return [in_scene = only_in_scenes_with(setting)](const Settings& s, LightKind light) -> std::string {
    return names_file(s.scene.name) ? "" : in_scene(s, light);
  };
}
std::string without_time(const Settings& s, LightKind light) {
  if (const std::string why = in_builtin_scene(s, light); !why.empty()) return why;
  return s.scene.time_s ? "" : "without scene.time_s";
}
// A scene's own camera can be orthographic only if it is a file's.
std::string in_perspective_view(const Settings& s, LightKind) {
  if (s.view.projection == ViewProjection::orthographic) return "";
  if (s.view.projection == ViewProjection::automatic && names_file(s.scene.name)) return "";
  return "in a perspective view";
}
std::string where_depths_are_fitted(const Settings& s, LightKind) {
  if (!names_file(s.scene.name)) return "in a built-in scene, where near and far are always fitted";
  return s.view.near_m && s.view.far_m ? "with both view.near_m and view.far_m" : "";
}
std::string with_parallel_rays(const Settings&, LightKind light) {
  return kind_of_light(light).rays().have_one_direction() ? on_a(light) : "";
}
std::string without_parallel_rays(const Settings&, LightKind light) {
  return kind_of_light(light).rays().have_one_direction() ? "" : on_a(light);
}
std::string where_light_has_no_target(const Settings&, LightKind light) {
  return kind_of_light(light).is_aimed() ? "" : on_a(light);
}
std::string without_cone(const Settings&, LightKind light) {
  return kind_of_light(light).has_cone() ? "" : on_a(light);
}
std::string on_cube_map(const Settings&, LightKind light) {
  return kind_of_light(light).map_shape() == MapShape::cube ? on_a(light) : "";
}
std::string on_flat_map(const Settings&, LightKind light) {
  return kind_of_light(light).map_shape() == MapShape::flat ? on_a(light) : "";
}
std::string where_map_is_given(const Settings& s, LightKind light) {
  if (!s.map.near_m || !s.map.far_m) return "";
  if (!kind_of_light(light).rays().have_one_direction()) return "with both map.near_m and map.far_m";
  if (moves_map(s.map.fit)) return "";  // it also places the map's middle
  return s.map.extent_m ? "with map.extent_m, map.near_m and map.far_m" : "";
}
// A light has a size only if the settings give it one: neither the built-in scenes nor glTF have lights with a size.
std::string without_size_of_light(const Settings& s, LightKind kind) {
  Light light;
  light.angular_diameter_deg = s.light.angular_diameter_deg.value_or(0);
  light.radius_m = s.light.radius_m.value_or(0);
  return kind_of_light(kind).disc_radius(light) > 0 ? "" : "with a light without a size";
}
// A part of the compared depth is in this unit, also the one that a curve would vary; and so is the cap.
std::string without_part_in_unit(const Settings& s, LightKind) {
  const bool capped = s.bias.plane_cap && tap_reference(s.bias.reference).reads_cap;
  return capped || curve_part(s.bias) ? "" : "without a part of the bias in that unit";
}
std::string without_offset(const Settings& s, LightKind) {
  const Bias bias(s.bias);
  return bias.moves_lookup() || bias.moves_casters() ? "" : "without a part of the bias that moves a place";
}
std::string without_capped_plane(const Settings& s, LightKind) {
  return tap_reference(s.bias.reference).reads_cap ? "" : "with bias.reference = " + s.bias.reference;
}
std::string map_near_beyond_far(const Settings& s, std::optional<LightKind>) {
  return near_beyond_far("map", s.map.near_m, s.map.far_m);
}
std::string view_near_beyond_far(const Settings& s, std::optional<LightKind>) {
  return near_beyond_far("view", s.view.near_m, s.view.far_m);
}

std::string sun_of_azimuth(const Settings& s, std::optional<LightKind> light) {
  return s.light.azimuth_deg ? sun_and(s, light, "light.azimuth_deg") : "";
}
std::string sun_of_elevation(const Settings& s, std::optional<LightKind> light) {
  return s.light.elevation_deg ? sun_and(s, light, "light.elevation_deg") : "";
}
std::string moved_fit_without_parallel_rays(const Settings& s, std::optional<LightKind> light) {
  if (!moves_map(s.map.fit) || !light || kind_of_light(*light).rays().have_one_direction()) return "";
  if (s.cascades.count > 1)  // which ask for such a fit
    return fmt::format(
        "cascades need a directional light, and this one is a {} light; set cascades.count = 1 and map.fit = tight",
        kind_of_light(*light).name());
  return fmt::format("map.fit = {} needs a directional light, and this one is a {} light; take map.fit = tight",
                     find_setting("map.fit").get(s), kind_of_light(*light).name());
}
std::string casters_without_lit_border(const Settings& s, std::optional<LightKind>) {
  if (s.map.fit != MapFit::casters || s.map.wrap == Wrap::clamp_to_border) return "";
  return fmt::format(
      "outside of the map of map.fit = casters everything is lit, but map.wrap = {} reads the map there; take "
      "map.wrap = clamp_to_border, or map.fit = tight",
      find_setting("map.wrap").get(s));
}
std::string without_slice_fit(const Settings& s, LightKind) {
  return s.map.fit == MapFit::sphere || fits_corners(s.map.fit) ? ""
                                                                : "with map.fit = " + find_setting("map.fit").get(s);
}
std::string without_reach(const Settings& s, LightKind light) {
  return s.cascades.count > 1 ? "" : without_slice_fit(s, light);
}
std::string without_moments(const Settings& s, LightKind) {
  return compares(s) ? "with lookup.kind = " + s.lookup.kind : "";
}
std::string without_motion(const Settings& s, LightKind) { return s.view.motion.any() ? "" : "without a motion"; }
std::string without_turning_light(const Settings& s, LightKind) {
  return s.view.motion.light_turn_deg ? "" : "without motion.light_turn_deg";
}
std::string without_moving_light(const Settings& s, LightKind) {
  return s.view.motion.light_turn_deg || s.view.motion.light_move_m
             ? ""
             : "without motion.light_turn_deg and motion.light_move_m";
}
std::string with_name_of_light(const Settings& s, LightKind) {
  return s.light.name == LightSettings().name ? "" : "with light.name = " + s.light.name;
}

std::string no_direction_up(const Settings& s, std::optional<LightKind>) {
  if (!s.view.up || has_direction(*s.view.up)) return "";
  return fmt::format("view.up = {} is no direction; give another, or auto", find_setting("view.up").get(s));
}

namespace {

// Frame n is n steps from the first, and its flicker is that to the next one.
double steps(const MotionSettings& motion) { return motion.frame + 1.0; }

std::string moved_away(const Settings& s, std::string_view setting, const std::optional<glm::dvec3>& each,
                       double times) {
  if (!each) return "";
  const glm::dvec3 way = times * *each;
  const double most = std::max({std::abs(way.x), std::abs(way.y), std::abs(way.z)});
  if (ranges::coordinate_m.holds(most)) return "";
  return fmt::format(
      "{} = {} moves by {:.4g} m up to the frame after motion.frame = {}, and a coordinate is at most {:g} m; "
      "lower one of them",
      setting, find_setting(setting).get(s), most, s.view.motion.frame, ranges::coordinate_m.most);
}

}  // namespace

std::string camera_moved_away(const Settings& s, std::optional<LightKind>) {
  return moved_away(s, "motion.move_m", s.view.motion.move_m, steps(s.view.motion));
}
std::string light_moved_away(const Settings& s, std::optional<LightKind>) {
  const MotionSettings& motion = s.view.motion;
  return moved_away(s, "motion.light_move_m", motion.light_move_m, motion.light_period > 0 ? 1 : steps(motion));
}
std::string zoomed_beyond_a_picture(const Settings& s, std::optional<LightKind>) {
  const MotionSettings& motion = s.view.motion;
  constexpr double most = 1e6;  // of what a picture shows then, a float's coordinates make a few steps
  const double enlarged = std::pow(motion.zoom, steps(motion));
  if (enlarged <= most && enlarged >= 1 / most) return "";
  return fmt::format(
      "motion.zoom = {} enlarges the picture by {:.4g} up to the frame after motion.frame = {}; it can be "
      "from {:g} to {:g}; set motion.zoom nearer to 1, or lower motion.frame",
      motion.zoom, enlarged, motion.frame, 1 / most, most);
}

// The texels of a mip level are means of whole blocks of texels.
std::string undivided_map(const Settings& s) {
  const int block = texel_block(s);
  if (block == 1) return "";
  if (!s.map.aspect)
    return "lookup.level needs a map whose height is known; set map.aspect to a number, or lookup.level = 0";
  std::vector<double> sizes = s.cascades.count > 1 ? s.cascades.resolutions : std::vector<double>();
  if (sizes.empty()) sizes = {static_cast<double>(s.map.resolution), static_cast<double>(s.map.rows())};
  if (const int rows = s.map.rows(); sizes.size() == 2 && s.map.resolution % block == 0 && rows % block != 0) {
    const double width = s.map.resolution;
    return fmt::format(
        "lookup.level = {} halves the map's height of {} texels (map.aspect = {:g}) {} times, and that is no multiple "
        "of "
        "{}; take map.aspect = {:.6g} or {:.6g}",
        s.lookup.whole("level"), rows, *s.map.aspect, s.lookup.whole("level"), block,
        width / ((rows / block + 1) * block), width / (std::max(1, rows / block) * block));
  }
  for (const double size : sizes)
    if (const int texels = static_cast<int>(size); texels % block != 0)
      return fmt::format(
          "lookup.level = {} halves the map's {} texels {} times, and they are no multiple of {}; take {} or {} texels",
          s.lookup.whole("level"), texels, s.lookup.whole("level"), block, std::max(1, texels / block) * block,
          (texels / block + 1) * block);
  return "";
}

// What a filtered map cannot be combined with.
std::string filtered_without_a_blur(const Settings& s, std::optional<LightKind> light) {
  if (compares(s)) return "";
  const std::string& kind = s.lookup.kind;
  if (light && kind_of_light(*light).map_shape() == MapShape::cube)
    return fmt::format("lookup.kind = {} needs a flat map; a point light's cube map has lookup.kind = compare", kind);
  if (!find_filter(s.filter.kind).blur)
    return fmt::format(
        "lookup.kind = {} reads a map that is blurred before the lookup, and filter.kind = {} is no blur; "
        "take filter.kind {}",
        kind, s.filter.kind, filters_that([](const Filter& f) { return f.blur != nullptr; }));
  if (find_lookup(kind).spread && s.filter.kind != "none")
    return fmt::format(
        "lookup.kind = {} has a blur of its own, of lookup.samples over lookup.radius; set filter.kind = none", kind);
  if (s.filter.kind == "box" && s.filter["step_texels"] != 1)
    return fmt::format("lookup.kind = {} blurs neighbouring texels; set filter.step_texels = 1", kind);
  if (const std::string why = undivided_map(s); !why.empty()) return why;
  if (tap_reference(s.bias.reference).plane)
    return fmt::format(
        "bias.reference = {} gives each tap a depth of its own, and lookup.kind = {} has one for all; set "
        "bias.reference = own_depth",
        s.bias.reference, kind);
  for (const BiasPart& part : bias_parts())
    if (part.acts_on == BiasTarget::caster && s.bias[part.name] != 0)
      return fmt::format(
          "bias.{} moves the casters in the map, and what a map of moments shows with it is not measured yet; "
          "set it to 0 and give the receiver a bias (bias.constant, bias.slope)",
          part.name);
  return "";
}

std::string moments_beyond_format(const Settings& s, std::optional<LightKind>) {
  const LookupKind& kind = find_lookup(s.lookup.kind);
  if (kind.compares()) return "";
  if (s.map.moments == MomentFormat::u16 && !(kind.within_one && kind.within_one(s.lookup)))
    return fmt::format(
        "map.moments = 16 holds numbers from 0 to 1, and lookup.kind = {} stores others{} 16f or 32f", kind.name,
        kind.within_one ? " with lookup.moments = plain; set lookup.moments = 2017, whose moments are made "
                          "for 16 bits, and lookup.moment_bias = 6e-5, or map.moments ="
                        : "; set");
  // The largest number that is stored: e^c of a depth of 1, or the square e^(2 c).
  if (s.map.moments != MomentFormat::f16 || kind.warp_power == 0 || kind.within_one) return "";
  const double largest_half = 65504, most = std::log(largest_half) / kind.warp_power;
  for (const char* parameter : {"exponent", "negative_exponent"})
    for (const auto& read : kind.reads)
      if (read.parameter->name() == parameter && s.lookup[parameter] > most)
        return fmt::format(
            "lookup.{} = {}: with map.moments = 16f numbers go up to {}, so it goes up to {:.4g}; lower it, or "
            "set map.moments = 32f",
            parameter, s.lookup[parameter], largest_half, most);
  return "";
}

std::string filter_of_another_map(const Settings& s, std::optional<LightKind> light) {
  if (!light) return "";
  const Filter& filter = find_filter(s.filter.kind);
  const bool cube = kind_of_light(*light).map_shape() == MapShape::cube;
  if (cube && filter.map == FilterMap::flat)
    return fmt::format("filter.kind = {} needs a flat map; a point light's cube map takes {}", s.filter.kind,
                       filters_that([](const Filter& f) { return f.map != FilterMap::flat; }));
  if (!cube && filter.map == FilterMap::cube)
    return fmt::format("filter.kind = {} needs a cube map; set light.kind = point, or take another filter",
                       s.filter.kind);
  return "";
}

std::string plane_on_cube_or_blended(const Settings& s, std::optional<LightKind> light) {
  if (!tap_reference(s.bias.reference).plane) return "";
  if (light && kind_of_light(*light).map_shape() == MapShape::cube)
    return fmt::format("bias.reference = {} needs a flat map; a point light's cube map has own_depth alone",
                       s.bias.reference);
  if (!find_filter(s.filter.kind).blended) return "";
  return fmt::format(
      "bias.reference = {} gives each texel a depth of its own, and a hardware comparison has one for the four texels "
      "that it reads; take filter.kind {}",
      s.bias.reference, filters_that([](const Filter& f) { return !f.blended && f.map != FilterMap::cube; }));
}

std::string cube_shifted_along_u(const Settings& s, std::optional<LightKind> light) {
  return shifted_cube("map.shift_u_texels", s.map.shift_u_texels, light);
}
std::string cube_shifted_along_v(const Settings& s, std::optional<LightKind> light) {
  return shifted_cube("map.shift_v_texels", s.map.shift_v_texels, light);
}

// The length of a rotation vector is its angle.
std::string turn_beyond_a_circle(const Settings& s, std::optional<LightKind>) {
  if (!s.map.turn_deg || glm::length(*s.map.turn_deg) <= 360) return "";
  return fmt::format("map.turn_deg turns by {:.6g} degrees, the length of its vector; it can be at most 360",
                     glm::length(*s.map.turn_deg));
}

std::string searched_roll_without_fit(const Settings& s, std::optional<LightKind> light) {
  if (s.map.roll_deg) return "";
  if (light && !kind_of_light(*light).rays().have_one_direction())
    return "map.roll_deg = auto needs a directional light: only its map has an extent that a rotation changes";
  return s.map.extent_m ? "map.roll_deg = auto searches the smallest extent, and map.extent_m gives it; give a number"
                        : "";
}

std::string rectangle_without_parallel_rays(const Settings& s, std::optional<LightKind> light) {
  if (s.map.aspect == 1) return "";
  if (light && !kind_of_light(*light).rays().have_one_direction())
    return "map.aspect needs a directional light: the map of a spot light is square around its cone, and so is each "
           "face "
           "of a cube";
  return !s.map.aspect && s.map.extent_m
             ? "map.aspect = auto is the shape of what a fit holds, and map.extent_m gives the extent; give a number"
             : "";
}

std::string snapped_perspective(const Settings& s, std::optional<LightKind> light) {
  if (!s.map.snap || !light || kind_of_light(*light).rays().have_one_direction()) return "";
  return "map.snap needs a directional light: only its texels have one size everywhere";
}

std::string pancaked_perspective(const Settings& s, std::optional<LightKind> light) {
  if (!s.map.pancake || !light || kind_of_light(*light).rays().have_one_direction()) return "";
  return "map.pancake needs a directional light: only there one move along the light keeps a vertex at its place in "
         "the "
         "map; set map.depth_clamp = true instead";
}

}  // namespace setting_rules

void validate(const Settings& settings, std::optional<LightKind> light) {
  for (const Setting& row : settings_table())
    if (row.why_refused)
      if (const std::string why = row.why_refused(settings, light); !why.empty()) throw SettingConflict(row.name, why);
}

void require_compared(const Settings& settings, std::string_view who) {
  if (!compares(settings))
    throw SettingConflict("lookup.kind",
                          fmt::format("{} is of a lookup that compares depths, and lookup.kind = {}; set "
                                      "lookup.kind = compare",
                                      who, settings.lookup.kind));
}

void require_one_map(const Settings& settings, std::string_view who) {
  if (settings.cascades.count > 1)
    throw SettingConflict(
        "cascades.count",
        fmt::format("{} is of one map, and cascades.count = {}; set cascades.count = 1", who, settings.cascades.count));
}

std::vector<IdleSetting> idle_settings(LightKind light, const Settings& settings) {
  const Settings defaults;
  std::vector<IdleSetting> idle;
  for (const Setting& row : settings_table()) {
    if (!row.why_idle || row.get(settings) == row.get(defaults)) continue;
    if (const std::string why = row.why_idle(settings, light); !why.empty())
      idle.push_back({std::string(row.name), why});
  }
  return idle;
}

std::string settings_key(const Settings& settings, std::initializer_list<Stage> stages, std::string_view except) {
  std::string key;
  for (const Setting& row : settings_table()) {
    const auto reads = [&](Stage stage) { return row.read_by.has(stage); };
    if (row.name != except && std::any_of(stages.begin(), stages.end(), reads))
      key += fmt::format("{}={}\n", row.name, row.get(settings));
  }
  return key;
}

}  // namespace noonmark
