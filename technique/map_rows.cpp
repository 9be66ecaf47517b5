// The rows of the settings of the shadow map, for the table in technique/settings.cpp.
#include "technique/corner_fits.h"
#include "technique/placements.h"
#include "technique/setting_rows.h"
#include "technique/setting_rules.h"

namespace noonmark::setting_rows {

using namespace setting_rules;

#define MEMBER(path) [](Settings& s) -> decltype((s.path)) { return s.path; }

namespace {

// "corner_sphere (directional): ...; corner_square (directional): ..."
std::string help_of_corner_fits() {
  std::string help;
  for (const CornerFit& fit : corner_fits())
    help += fmt::format("{}{} (directional): {}", help.empty() ? "" : "; ", fit.name, fit.help);
  return help + ".";
}

}  // namespace

std::vector<Setting> map_rows() {
  return {
      integer("map.resolution", "texels", 1, 16384,
              "Texels along each side of the shadow map; with map.aspect along its width.", MEMBER(map.resolution)),
      real("map.aspect", "", 1.0 / 64, 64,
           "directional: width over height of the map. Its texels are square: it has map.resolution / map.aspect rows, "
           "rounded, and its extent is its width. A fit then is the smallest area of this shape. auto: a fitted map is "
           "as wide as what it holds, with as many rows as that needs, but no more than map.resolution; map.roll_deg = "
           "auto turns its longer side along the width.",
           MEMBER(map.aspect))
          .refused(rectangle_without_parallel_rays),
      choice("map.format", {"16", "24", "32f"}, "Depth format of the shadow map.", MEMBER(map.format))
          .only_read_by({Stage::map}),
      choice("map.fit", {"scene", "tight", "view", "sphere", "casters", "corner_sphere", "corner_square", "corner_box"},
             "Where extent, near and far come from if they are auto. scene: from the scene, or fitted tightly if the "
             "scene has none or the light is not the scene's; tight: always fitted tightly around the scene; view "
             "(directional): fitted to the part of the scene in the picture's frustum, and near also to what can cast "
             "a shadow on it; sphere (directional): around the least sphere that holds the picture's frustum up to "
             "map.reach_m, so that the extent is the same wherever the camera stands and looks; casters (directional): "
             "around everything that can cast a shadow, wherever the camera is, but not a ground below everything: "
             "what lies outside of such a map is lit; " +
                 help_of_corner_fits(),
             MEMBER(map.fit))
          .idle(where_map_is_given)
          .refused(moved_fit_without_parallel_rays),
      real("map.reach_m", "m", ranges::length_m.least, ranges::length_m.most,
           "map.fit = sphere, corner_*: how far from the camera the map covers what is in view; auto: the diagonal of "
           "the scene's box, of corner_* the camera's far plane. With cascades, also of map.fit = view: where the last "
           "one ends; auto: the camera's far plane.",
           MEMBER(map.reach_m))
          .idle(without_reach),
      real("map.fit_fov_deg", "deg", 1, 170,
           "map.fit = sphere, corner_*: the map is fitted to a picture of at least this vertical angle, in place of "
           "the camera's own where that is narrower. With the widest angle that a camera has, its zoom changes no "
           "size, and a snapped map does not flicker; auto: the camera's own.",
           MEMBER(map.fit_fov_deg))
          .idle(without_slice_fit),
      choice("map.depth_range", {"fit", "scene"},
             "directional: what near and far are if they are auto. fit: by map.fit; scene: those of the whole scene, "
             "whatever the camera sees, so that depths are rounded alike in every frame.",
             MEMBER(map.depth_range))
          .idle(without_parallel_rays),
      real("map.extent_m", "m", ranges::length_m.least, ranges::length_m.most,
           "directional: whole width of the area that the map covers; auto: by map.fit.", MEMBER(map.extent_m))
          .idle(without_parallel_rays),
      real("map.extent_scale", "", 1e-3, 1e3, "Multiplies the extent, whether it is given or fitted.",
           MEMBER(map.extent_scale))
          .idle(on_cube_map),
      real("map.fov_deg", "deg", 1, 175, "spot: whole angle that the map covers; auto: the light's cone.",
           MEMBER(map.fov_deg))
          .idle(without_cone),
      real("map.roll_deg", "deg", -180, 180,
           "directional, spot: rotates the map about the light's axis, counter-clockwise as the light sees it, and "
           "nothing else. The edges of the scene then cross the texels at other angles, and so do slopes (A of law 1). "
           "auto (directional): the rotation by which a fitted map is smallest, to half a degree.",
           MEMBER(map.roll_deg))
          .idle(on_cube_map)
          .refused(searched_roll_without_fit),
      flag("map.snap",
           "directional: moves the map by less than a texel, so that its texel grid stays fixed in the world when the "
           "light's position or target moves without a rotation, or when the map follows the view and keeps its extent "
           "(map.fit = sphere).",
           MEMBER(map.snap))
          .refused(snapped_perspective),
      real("map.shift_u_texels", "texels", -8, 8,
           "Moves the map with its texel grid to the light's right, to try another alignment of texels and edges.",
           MEMBER(map.shift_u_texels))
          .refused(cube_shifted_along_u),
      real("map.shift_v_texels", "texels", -8, 8, "Moves the map with its texel grid up, as the light sees it.",
           MEMBER(map.shift_v_texels))
          .refused(cube_shifted_along_v),
      point("map.turn_deg", "deg", ranges::of_rotation_deg,
            "point: rotates the cube of the map about the light, and nothing else. The vector is the rotation's axis "
            "times its angle, of at most 360; auto: the cube's faces are square to the world's axes.",
            MEMBER(map.turn_deg))
          .idle(on_flat_map)
          .refused(turn_beyond_a_circle),
      integer(
          "map.placements", "", 1, Placements::most,
          "S: measures at S x S placements of the texel grid, and gives mean, largest and least over them. Placement 0 "
          "is the map as the other settings place it. A flat map is shifted by 1/S texel from one to the next, and one "
          "set of rays answers for all; with a map of moments (lookup.kind) each takes its own, so 4 suffices there. A "
          "point light's cube is turned, a sample of all rotations, and each turn takes its own rays.",
          MEMBER(map.placements))
          .only_read_by({Stage::ladder}),
      real("map.near_m", "m", ranges::coordinate_m.least, ranges::coordinate_m.most,
           "Near plane, measured from the light's position along its axis (point light: along the axis of each face); "
           "auto: by map.fit.",
           MEMBER(map.near_m))
          .refused(map_near_beyond_far),
      real("map.far_m", "m", ranges::coordinate_m.least, ranges::coordinate_m.most,
           "Far plane, measured from the light's position along its axis; a point light's depth is distance / far; "
           "auto: by map.fit.",
           MEMBER(map.far_m)),
      choice("map.wrap", {"repeat", "clamp_to_edge", "clamp_to_border"},
             "What a lookup outside the map reads. The border of clamp_to_border is lit.", MEMBER(map.wrap))
          .idle(on_cube_map)
          .refused(casters_without_lit_border),
      flag("map.lit_beyond_far", "Receivers beyond the far plane are lit without a comparison.",
           MEMBER(map.lit_beyond_far))
          .only_read_by({Stage::ladder}),
      choice("map.cull", {"none", "back", "front"}, "Which faces are not drawn into the shadow map.", MEMBER(map.cull)),
      flag("map.depth_clamp",
           "Geometry before the near plane or beyond the far plane is drawn at depth 0 or 1 instead of being clipped "
           "(GL_DEPTH_CLAMP).",
           MEMBER(map.depth_clamp)),
      flag("map.pancake",
           "directional: vertices before the near plane are moved onto it along the light, as Unity does. A triangle "
           "through the plane gets other depths. Implies map.depth_clamp.",
           MEMBER(map.pancake))
          .refused(pancaked_perspective),
      choice("map.moments", {"32f", "16f", "16"},
             "Format of each number of a map of moments: floats of 32 or 16 bits, or integers of 16 bits for 0 to 1.",
             MEMBER(map.moments))
          .idle(without_moments)
          .refused(moments_beyond_format)
          .only_read_by({Stage::ladder}),
      choice("map.cube_pass", {"layered", "six_passes"},
             "point: all six faces in one pass through a geometry shader, or one pass for each face. The map is the "
             "same; the time differs.",
             MEMBER(map.cube_pass))
          .idle(on_flat_map)
          .only_read_by({Stage::map}),
  };
}

#undef MEMBER

}  // namespace noonmark::setting_rows
