// The rows of the settings of the light, for the table in technique/settings.cpp.
#include "technique/light_kind.h"
#include "technique/setting_rows.h"
#include "technique/setting_rules.h"

namespace noonmark::setting_rows {

using namespace setting_rules;

#define MEMBER(path) [](Settings& s) -> decltype((s.path)) { return s.path; }

namespace {

// The choices are read from the table of lights. LightChoice has the same order, with `auto` before it.
Setting light_kind_row() {
  std::vector<std::string_view> choices = {"auto"};
  std::string help =
      "auto: the scene's. Without light.name and light.index, another kind than that of the scene's first light takes "
      "the first light of that kind; where the scene has none, its light becomes one, and a note says so";
  for (const KindOfLight* kind : kinds_of_light()) {
    choices.push_back(kind->name());
    help += fmt::format("; {}: {}", kind->name(), kind->help());
  }
  return choice("light.kind", choices, help + ".", MEMBER(light.kind));
}

}  // namespace

std::vector<Setting> light_rows() {
  return {
      text("light.name",
           "Which of the scene's lights is measured, by its name or by that of its node in a glTF file; auto: by "
           "light.index, else by light.kind, else the first.",
           MEMBER(light.name)),
      integer("light.index", "", 0, 1e6,
              "Which of the scene's lights is measured, counted from 0 in the file's order; auto: as light.name says.",
              MEMBER(light.index))
          .idle(with_name_of_light),
      light_kind_row(),
      point("light.position_m", "m", ranges::coordinate_m,
            "Position of a spot or point light. A directional light shines from here towards light.target_m, and the "
            "depth of its map is measured from here; auto: the scene's.",
            MEMBER(light.position_m)),
      point("light.target_m", "m", ranges::coordinate_m,
            "The point that the light points at, which is the middle of its map; auto: the scene's.",
            MEMBER(light.target_m))
          .idle(where_light_has_no_target),
      real("light.azimuth_deg", "deg", -360, 360,
           "directional: the side on which the sun stands: 0 above +Z, 90 above +X, 180 above -Z (a rotation about +Y, "
           "which is up; a glTF model's front faces +Z). It replaces the direction of the scene's light; auto: as the "
           "scene's light.",
           MEMBER(light.azimuth_deg))
          .refused(sun_of_azimuth),
      real("light.elevation_deg", "deg", -90, 90,
           "directional: the sun's angle above the horizon, the plane of X and Z; 90: overhead, along +Y. It replaces "
           "the direction of the scene's light; auto: as the scene's light.",
           MEMBER(light.elevation_deg))
          .refused(sun_of_elevation),
      real("light.angular_diameter_deg", "deg", 0, 90,
           "directional: angular diameter of the sun, for R0 (the real sun: 0.53); 0: no size; auto: the scene's. The "
           "sun is an evenly bright disc across the light's direction, not evenly bright over its solid angle: beside "
           "a straight edge R0 differs by at most 0.004 at 30 deg and 0.04 at 90 deg.",
           MEMBER(light.angular_diameter_deg))
          .only_read_by({Stage::truth})
          .idle(without_parallel_rays),
      real("light.radius_m", "m", 0, 1e6, "spot, point: radius of the light, for R0; 0: no size; auto: the scene's.",
           MEMBER(light.radius_m))
          .only_read_by({Stage::truth})
          .idle(with_parallel_rays),
      choice("light.shape", {"sphere", "disc"},
             "spot, point: shape of a light with a size, for R0. sphere; disc: across a spot light's axis, or facing "
             "each receiver for a point light.",
             MEMBER(light.shape))
          .only_read_by({Stage::truth})
          .idle(with_parallel_rays),
      real("light.cone_deg", "deg", ranges::mapped_cone_deg.least, ranges::mapped_cone_deg.most,
           "spot: whole angle of the cone; outside it nothing is lit; auto: the scene's.", MEMBER(light.cone_deg))
          .idle(without_cone),
  };
}

#undef MEMBER

}  // namespace noonmark::setting_rows
