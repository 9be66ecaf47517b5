// The rules between the settings of a point. Each rule belongs to a row of the table of settings
// (technique/settings.cpp). It says which stages of the measurement read the setting, when the setting is not read at
// all, or with which other settings it conflicts. The functions here ask all rows.
//
//   validate(settings, frame.kind);                                   // throws SettingConflict
//   for (const IdleSetting& idle : idle_settings(frame.kind, settings)) print(idle.name, idle.why);
//   if (settings_key(settings, {Stage::scene, Stage::map}) == key) print("the same map");  // the same map
#pragma once
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "scenes/scene.h"
#include "technique/settings.h"

namespace noonmark {

// Settings that are each in their range but conflict with each other. The message names them and says what to change.
class SettingConflict : public Error {
 public:
  SettingConflict(std::string_view setting, const std::string& message)
      : Error(ErrorKind::usage, message), setting_(setting) {}
  const std::string& setting() const { return setting_; }  // the setting whose row found the conflict

 private:
  std::string setting_;
};

// Throws SettingConflict if settings conflict. light: the kind of the scene's light after `light.kind` is applied. It
// is empty while the scene is not loaded. Then the rules that hold for some kinds of light only are not checked.
void validate(const Settings& settings, std::optional<LightKind> light = std::nullopt);

// Throws SettingConflict if the settings have several maps. who: what is made for one map, "a phase diagram".
void require_one_map(const Settings& settings, std::string_view who);

// Throws SettingConflict if the settings' lookup compares no depths. who: what is made for one that compares, "a phase diagram".
void require_compared(const Settings& settings, std::string_view who);

struct IdleSetting {
  std::string name;  // "map.extent_m"
  std::string why;   // "on a point light"
};

// Every setting that differs from its default and is not read at this point.
std::vector<IdleSetting> idle_settings(LightKind light, const Settings& settings);

// The settings that these stages read, one "name=value" on each line, without the setting named `except`.
std::string settings_key(const Settings& settings, std::initializer_list<Stage> stages, std::string_view except = {});

// The rules that the rows of technique/settings.cpp name.
namespace setting_rules {

// The reason why the setting is not read; empty if it is read.
std::string in_builtin_scene(const Settings&, LightKind);
// setting: the name of the row, such as "scene.theta_deg" (BuiltinScene::reads).
std::function<std::string(const Settings&, LightKind)> only_in_scenes_with(std::string_view setting);
std::function<std::string(const Settings&, LightKind)> only_in_files_and_scenes_with(std::string_view setting);
std::string without_time(const Settings&, LightKind);
std::string where_depths_are_fitted(const Settings&, LightKind);
std::string with_parallel_rays(const Settings&, LightKind);
std::string without_parallel_rays(const Settings&, LightKind);
std::string where_light_has_no_target(const Settings&, LightKind);
std::string without_cone(const Settings&, LightKind);
std::string on_cube_map(const Settings&, LightKind);
std::string on_flat_map(const Settings&, LightKind);
std::string where_map_is_given(const Settings&, LightKind);
std::string without_size_of_light(const Settings&, LightKind);
std::string without_part_in_unit(const Settings&, LightKind);
std::string without_offset(const Settings&, LightKind);
std::string without_capped_plane(const Settings&, LightKind);
std::string without_slice_fit(const Settings&, LightKind);
std::string without_reach(const Settings&, LightKind);  // of the map: not fitted to a slice of the view, nor several
std::string without_moments(const Settings&, LightKind);
std::string without_motion(const Settings&, LightKind);
std::string without_turning_light(const Settings&, LightKind);
std::string without_moving_light(const Settings& s, LightKind light);
std::string in_perspective_view(const Settings& s, LightKind light);
std::string searched_roll_without_fit(const Settings& s, std::optional<LightKind> light);
std::string with_name_of_light(const Settings& s, LightKind light);

// The conflict as a whole message; empty if there is none. light: as for validate().
std::string map_near_beyond_far(const Settings&, std::optional<LightKind>);
std::string view_near_beyond_far(const Settings&, std::optional<LightKind>);
std::string sun_of_azimuth(const Settings&, std::optional<LightKind>);
std::string sun_of_elevation(const Settings&, std::optional<LightKind>);
std::string casters_without_lit_border(const Settings&, std::optional<LightKind>);
std::string moved_fit_without_parallel_rays(const Settings&, std::optional<LightKind>);
std::string camera_moved_away(const Settings&, std::optional<LightKind>);
std::string light_moved_away(const Settings&, std::optional<LightKind>);
std::string zoomed_beyond_a_picture(const Settings&, std::optional<LightKind>);
std::string no_direction_up(const Settings&, std::optional<LightKind>);
std::string filtered_without_a_blur(const Settings&, std::optional<LightKind>);
std::string moments_beyond_format(const Settings&, std::optional<LightKind>);
std::string filter_of_another_map(const Settings&, std::optional<LightKind>);
std::string plane_on_cube_or_blended(const Settings&, std::optional<LightKind>);
std::string cube_shifted_along_u(const Settings&, std::optional<LightKind>);
std::string cube_shifted_along_v(const Settings&, std::optional<LightKind>);
std::string turn_beyond_a_circle(const Settings&, std::optional<LightKind>);
std::string rectangle_without_parallel_rays(const Settings&, std::optional<LightKind>);
std::string snapped_perspective(const Settings&, std::optional<LightKind>);
std::string pancaked_perspective(const Settings&, std::optional<LightKind>);

}  // namespace setting_rules
}  // namespace noonmark
