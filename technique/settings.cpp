#include "technique/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/suggestion.h"
#include "technique/corner_fits.h"
#include "technique/filters.h"
#include "technique/light_kind.h"
#include "technique/lookups.h"
#include "technique/placements.h"
#include "technique/setting_rows.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

using namespace setting_rows;
using namespace setting_rules;

// "corner_sphere (directional): ...; corner_square (directional): ..."
std::string help_of_corner_fits() {
  std::string help;
  for (const CornerFit& fit : corner_fits())
    help += fmt::format("{}{} (directional): {}", help.empty() ? "" : "; ", fit.name, fit.help);
  return help + ".";
}

#define MEMBER(path) [](Settings& s) -> decltype((s.path)) { return s.path; }

// A part that moves the lookup or the caster changes which texels are read or what they hold. A part that is subtracted
// from the compared depth changes the verdict only.
Stages stages_of(BiasTarget place) {
  switch (place) {
    case BiasTarget::compared_depth:
      return {Stage::ladder};
    case BiasTarget::place_looked_up:
      return {Stage::lookup};
    case BiasTarget::caster:
      return {Stage::map, Stage::lookup};
  }
  throw std::logic_error("a part of the bias that acts nowhere");
}

// The row of one parameter of a part of the bias.
Setting bias_row(const BiasParameter& parameter) {
  const bool is_cap = parameter.role == BiasParameter::Role::cap;
  Setting row{parameter.setting,
              parameter.part->unit,
              ValueType::real,
              parameter.part->either_sign && parameter.role == BiasParameter::Role::amount ? -parameter.part->most : 0,
              parameter.part->most,
              is_cap,
              {},
              std::string(parameter.help),
              {},
              {}};
  row.get = [&parameter](const Settings& s) {
    const double value = s.bias[parameter.name];
    return std::isinf(value) ? std::string("auto") : number_text(value);
  };
  row.set = [&parameter, row](Settings& s, std::string_view text) {
    s.bias[parameter.name] =
        row.may_be_auto && text == "auto" ? std::numeric_limits<double>::infinity() : parse_real(row, text);
  };
  row.read_by = stages_of(parameter.part->acts_on);
  const BiasPart& part = *parameter.part;
  if (part.acts_on == BiasTarget::caster && !part.formula.way)
    row.why_idle = [](const Settings& s, LightKind light) {
      const std::string why = on_cube_map(s, light);
      return why.empty() ? why : why + ", whose shader writes its depth itself";
    };
  if (!is_cap) return row;
  row.why_idle = [&part](const Settings& s, LightKind) {
    const std::string name(part.name);
    const bool acts = s.bias[name] != 0 || (!part.floor_help.empty() && s.bias[name + "_floor"] != 0);
    return acts ? "" : fmt::format("with bias.{} = 0", name);
  };
  if (part.floor_help.empty()) return row;
  row.why_refused = [&part](const Settings& s, std::optional<LightKind>) {
    const std::string name(part.name);
    const double floor = s.bias[name + "_floor"], cap = s.bias[name + "_cap"];
    return floor > cap ? fmt::format("bias.{0}_floor = {1} is more than bias.{0}_cap = {2}", name, floor, cap) : "";
  };
  return row;
}

// The stages that read the settings of this group, except for rows with stages of their own.
Stages stages_of_group(std::string_view group) {
  if (group == "scene") return {Stage::scene};
  if (group == "view") return {Stage::view};
  if (group == "motion") return {Stage::view, Stage::truth, Stage::map, Stage::lookup};
  if (group == "light") return {Stage::truth, Stage::map, Stage::lookup};
  if (group == "map" || group == "cascades") return {Stage::map, Stage::lookup};
  if (group == "bias" || group == "filter" || group == "lookup") return {Stage::lookup};
  if (group == "truth") return {Stage::truth};
  if (group == "given") return {Stage::scene};  // another frame is another scene (app/sweep/frame_run.h)
  throw std::logic_error("no stage reads the group of settings '" + std::string(group) + "'");
}

// The choices are read from the table of lights. LightChoice has the same order, with `auto` before it.
Setting light_kind_row() {
  std::vector<std::string_view> choices = {"auto"};
  std::string help =
      "auto: the scene's. Without light.name and light.index, another kind than that of the scene's first light takes "
      "the "
      "first light of that kind; where the scene has none, its light becomes one, and a note says so";
  for (const KindOfLight* kind : kinds_of_light()) {
    choices.push_back(kind->name());
    help += fmt::format("; {}: {}", kind->name(), kind->help());
  }
  return choice("light.kind", choices, help + ".", MEMBER(light.kind));
}

std::vector<Setting> make_table() {
  std::vector<Setting> table = {
      text("scene.name", "A built-in scene, or the path of a .gltf, .glb or .vrm file.", MEMBER(scene.name)),
      real("scene.theta_deg", "deg", 0, 89.9,
           "plane: the angle between its normal and the light; crease: the same of the face that rises.",
           MEMBER(scene.theta_deg))
          .idle(only_in_scenes_with("scene.theta_deg")),
      real("scene.phi_deg", "deg", -360, 360,
           "plane: azimuth of its slope in the light's plane, measured from the texel axes; plate: rotation about the "
           "vertical.",
           MEMBER(scene.phi_deg))
          .idle(only_in_scenes_with("scene.phi_deg")),
      real("scene.thickness_m", "m", 1e-4, 10, "wall, plate: thickness.", MEMBER(scene.thickness_m))
          .idle(only_in_scenes_with("scene.thickness_m")),
      real("scene.height_m", "m", 0, 100, "plate: height of its lit face above the floor.", MEMBER(scene.height_m))
          .idle(only_in_scenes_with("scene.height_m")),
      integer("scene.plates", "", 1, 16, "layers: how many plates lie one above the other.", MEMBER(scene.plates))
          .idle(only_in_scenes_with("scene.plates")),
      real("scene.gap_m", "m", 1e-3, 100, "layers: from the floor to the lit face of the lowest plate.",
           MEMBER(scene.gap_m))
          .idle(only_in_scenes_with("scene.gap_m")),
      real("scene.step_m", "m", 1e-3, 100, "layers: from the lit face of a plate to that of the next one above.",
           MEMBER(scene.step_m))
          .idle(only_in_scenes_with("scene.step_m")),
      real("scene.offset_m", "m", 0, 1,
           "layers: from an edge of an upper plate to that of the next one above; 0: the edges are aligned.",
           MEMBER(scene.offset_m))
          .idle(only_in_scenes_with("scene.offset_m")),
      choice("scene.mesh", {std::begin(mesh_forms), std::end(mesh_forms)},
             "How the scene's surface is cut into triangles. as_built: as it is; one_mesh: welded into one mesh; "
             "split: each triangle in four; reversed: triangles and vertices in reverse order; doubled: each triangle "
             "twice; tiles: tiles whose borders agree only to rounding; t_junctions: strips with vertices on their "
             "neighbours' edges.",
             MEMBER(scene.mesh)),
      real("scene.turn_deg", "deg", -360, 360,
           "Rotates the scene with its camera and light about the axis (1, 2, 3), so that no plane lies along an axis.",
           MEMBER(scene.turn_deg)),
      point("scene.move_m", "m", ranges::coordinate_m,
            "Moves the scene with its camera and light, after the rotation; auto: no move.", MEMBER(scene.move_m)),
      flag("scene.masks",
           "Whether alpha masks (of the scene foliage, and of a glTF file's materials: alphaMode MASK) are cut out of "
           "the triangles. false: "
           "masked triangles are opaque, which makes fewer triangles.",
           MEMBER(scene.masks))
          .idle(only_in_files_and_scenes_with("scene.masks")),
      flag("scene.floor",
           "Adds a horizontal square under the scene, for a model that has nothing to cast its shadow on. It touches "
           "the scene's lowest point, its middle is below the middle of the scene's box, and its side is 4 times the "
           "box's diagonal. Up is +Y, before scene.turn_deg. Camera and light stay those of the scene without it; a "
           "scene's own map volume is replaced by a fit.",
           MEMBER(scene.floor)),
      real("scene.time_s", "s", 0, 1e6,
           "The time at which a glTF file's animation poses the scene. Before its first key and after its last key the "
           "scene stands still; auto: at rest, without the animation.",
           MEMBER(scene.time_s))
          .idle(in_builtin_scene),
      integer("scene.animation", "", 0, 1e6, "Which animation of the file scene.time_s refers to, counted from 0.",
              MEMBER(scene.animation))
          .idle(without_time),
      integer("view.width_px", "px", 1, 8192, "Width of the picture.", MEMBER(view.width_px)),
      integer("view.height_px", "px", 1, 8192, "Height of the picture.", MEMBER(view.height_px)),
      point("view.eye_m", "m", ranges::coordinate_m, "Where the camera is; auto: the scene's.", MEMBER(view.eye_m)),
      point("view.target_m", "m", ranges::coordinate_m, "What the camera looks at; auto: the scene's.",
            MEMBER(view.target_m)),
      point("view.up", "", ranges::of_direction,
            "The direction that points up in the picture, of any length; auto: the scene's.", MEMBER(view.up))
          .refused(no_direction_up),
      choice("view.projection", {"auto", "perspective", "orthographic"},
             "Projection of the camera. auto: the scene's; orthographic: parallel, as the plans and side views of "
             "textbooks; it "
             "shows as much of the world as a perspective camera does in the distance of its target, unless "
             "view.height_m says "
             "how much.",
             MEMBER(view.projection)),
      real("view.fov_deg", "deg", 1, 170,
           "perspective: whole vertical angle of view; auto: the scene's. With view.projection = orthographic it gives "
           "the "
           "height that is shown, unless view.height_m does.",
           MEMBER(view.fov_deg)),
      real("view.height_m", "m", ranges::length_m.least, ranges::length_m.most,
           "orthographic: how much of the world the picture shows in its height; auto: as view.projection says.",
           MEMBER(view.height_m))
          .idle(in_perspective_view),
      real("view.near_m", "m", ranges::length_m.least, ranges::length_m.most,
           "Distance of the camera's near plane along the view; auto: from the scene's file, or fitted so that nothing "
           "in view is cut off.",
           MEMBER(view.near_m))
          .refused(view_near_beyond_far),
      real("view.far_m", "m", ranges::length_m.least, ranges::length_m.most,
           "Distance of the camera's far plane along the view; auto: from the scene's file, or fitted so that nothing "
           "in view is cut off.",
           MEMBER(view.far_m)),
      flag("view.fit_depths",
           "Fits the near and far planes that are auto, so that nothing in view is cut off, even if the scene's file "
           "gives them.",
           MEMBER(view.fit_depths))
          .idle(where_depths_are_fitted),
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
            "depth "
            "of its map is measured from here; auto: the scene's.",
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
      real(
          "light.angular_diameter_deg", "deg", 0, 90,
          "directional: angular diameter of the sun, for R0 (the real sun: 0.53); 0: no size; auto: the scene's. The "
          "sun is an evenly bright disc across the light's direction, not evenly bright over its solid angle: beside a "
          "straight edge R0 differs by at most 0.004 at 30 deg and 0.04 at 90 deg.",
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
      integer("map.resolution", "texels", 1, 16384,
              "Texels along each side of the shadow map; with map.aspect along its width.", MEMBER(map.resolution)),
      real("map.aspect", "", 1.0 / 64, 64,
           "directional: width over height of the map. Its texels are square: it has map.resolution / map.aspect rows, "
           "rounded, and its extent is its width. A fit then is the smallest area of this shape. auto: a fitted map is "
           "as wide as what it holds, with as many rows as that needs, but no more than map.resolution; "
           "map.roll_deg = auto turns its longer side along the width.",
           MEMBER(map.aspect))
          .refused(rectangle_without_parallel_rays),
      choice("map.format", {"16", "24", "32f"}, "Depth format of the shadow map.", MEMBER(map.format))
          .only_read_by({Stage::map}),
      choice(
          "map.fit", {"scene", "tight", "view", "sphere", "casters", "corner_sphere", "corner_square", "corner_box"},
          "Where extent, near and far come from if they are auto. scene: from the scene, or fitted tightly if the "
          "scene has none or the light is not the scene's; tight: always fitted tightly around the scene; view "
          "(directional): fitted to the part of the scene in the picture's frustum, and near also to what can cast "
          "a shadow on it; sphere (directional): around the least sphere that holds the picture's frustum up to "
          "map.reach_m, so that the extent is the same wherever the camera stands and looks; casters (directional): "
          "around everything that can cast a shadow, wherever the camera is, but not a ground below everything: what "
          "lies outside of such a map is lit; " +
              help_of_corner_fits(),
          MEMBER(map.fit))
          .idle(where_map_is_given)
          .refused(moved_fit_without_parallel_rays),
      real("map.reach_m", "m", ranges::length_m.least, ranges::length_m.most,
           "map.fit = sphere, corner_*: how far from the camera the map covers what is in view; auto: the diagonal of "
           "the "
           "scene's box, of corner_* the camera's far plane. With cascades, also of map.fit = view: where the last one "
           "ends; auto: the camera's far plane.",
           MEMBER(map.reach_m))
          .idle(without_reach),
      real(
          "map.fit_fov_deg", "deg", 1, 170,
          "map.fit = sphere, corner_*: the map is fitted to a picture of at least this vertical angle, in place of the "
          "camera's own where that is narrower. With the widest angle that a camera has, its zoom changes no size, and "
          "a snapped map does not flicker; auto: the camera's own.",
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
           "nothing "
           "else. The edges of the scene then cross the texels at other angles, and so do slopes (A of law 1). auto "
           "(directional): the rotation by which a fitted map is smallest, to half a degree.",
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
            "times "
            "its angle, of at most 360; auto: the cube's faces are square to the world's axes.",
            MEMBER(map.turn_deg))
          .idle(on_flat_map)
          .refused(turn_beyond_a_circle),
      integer(
          "map.placements", "", 1, Placements::most,
          "S: measures at S x S placements of the texel grid, and gives mean, largest and least over them. "
          "Placement 0 is the map as the other settings place it. A flat map is shifted by 1/S texel from one to the "
          "next, and one set of rays answers for all; with a map of moments (lookup.kind) each takes its own, so 4 "
          "suffices there. A point light's cube is turned, a sample of all rotations, and each turn takes its own "
          "rays.",
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
      choice("bias.unit", {"depth", "m", "texel"},
             "Unit of the parts of the bias that have no unit of their own: window depth, metres of the map's depth, "
             "or texels of the map at the receiver.",
             MEMBER(bias.unit))
          .idle(without_part_in_unit),
      choice("bias.offset_unit", {"texel", "m"},
             "Unit of the parts of the bias that move a place: the receiver's that is looked up (bias.normal_offset "
             "...) or "
             "the caster's (bias.caster_offset ...). texel: the width of a texel there; m: metres, as in three.js.",
             MEMBER(bias.offset_unit))
          .idle(without_offset)
          .only_read_by({Stage::map, Stage::lookup}),
      named("bias.reference", "The depth that a tap is compared with, before the bias is subtracted.", tap_references(),
            MEMBER(bias.reference))
          .refused(plane_on_cube_or_blended),
      real(
          "bias.plane_cap", "bias.unit", 0, 1e6,
          "receiver_plane: largest difference between the compared depth and the receiver's own depth; auto: no limit.",
          MEMBER(bias.plane_cap))
          .idle(without_capped_plane),
      named("filter.kind", "The filter: where the lookup reads the map.", filters(), MEMBER(filter.kind))
          .refused(filter_of_another_map),
      named("lookup.kind", "How the lookup answers from what it reads in the map.", lookups(), MEMBER(lookup.kind))
          .refused(moments_without_a_blur),
      real("truth.standard_error", "", 1e-3, 0.5,
           "Largest standard error of R0 at a receiver, for a light with a size. A smaller value takes more rays.",
           MEMBER(truth.standard_error))
          .idle(without_size_of_light),
      choice(
          "truth.method", {"auto", "rays"},
          "auto: what certified squares of the light's plane answer needs no ray, and the exact map of a flat map is "
          "found by scan conversion in double. rays: every answer comes from Embree's rays. The verdicts are the "
          "same; rays takes longer.",
          MEMBER(truth.method))
          .only_read_by({Stage::scene}),
      text("given.frame", "Which frame of another renderer is judged; only [[frame]] of an experiment gives it.",
           MEMBER(given.frame)),
  };
  // The rows of the parts of the bias and of the filters' parameters stand after the other settings of their group.
  const auto after = [&](std::string_view name, const auto& parameters, auto row_of) {
    auto at = std::find_if(table.begin(), table.end(), [&](const Setting& row) { return row.name == name; });
    for (const auto& parameter : parameters) at = table.insert(at + 1, row_of(parameter));
  };
  after("bias.plane_cap", bias_parameters(), bias_row);
  const std::vector<Setting> motion = motion_rows();
  table.insert(std::find_if(table.begin(), table.end(), [](const Setting& row) { return row.name == "light.name"; }),
               motion.begin(), motion.end());
  after("filter.kind", FilterTable::parameters(),
        [](const KindParameter* parameter) { return kind_row(filters(), *parameter, MEMBER(filter)); });
  after("lookup.kind", LookupTable::parameters(), [](const KindParameter* parameter) {
    const Setting row = kind_row(lookups(), *parameter, MEMBER(lookup));
    if (parameter->name() == "level") return row.only_read_by({Stage::map, Stage::lookup});  // LightFrame::texel_block
    return parameter->of_blur ? row : row.only_read_by({Stage::ladder});
  });
  const std::vector<Setting> cascades = cascade_rows();
  table.insert(std::find_if(table.begin(), table.end(), [](const Setting& row) { return row.name == "bias.unit"; }),
               cascades.begin(), cascades.end());
  for (Setting& row : table)
    if (row.read_by.bits == 0) row.read_by = stages_of_group(row.name.substr(0, row.name.find('.')));
  return table;
}

#undef MEMBER

}  // namespace

std::vector<double> BiasSettings::no_bias() {
  std::vector<double> values;
  for (const BiasParameter& parameter : bias_parameters())
    values.push_back(parameter.role == BiasParameter::Role::cap ? std::numeric_limits<double>::infinity() : 0);
  return values;
}

Setting Setting::idle(std::function<std::string(const Settings&, LightKind)> why) const {
  Setting row = *this;
  row.why_idle = std::move(why);
  return row;
}
Setting Setting::refused(std::function<std::string(const Settings&, std::optional<LightKind>)> why) const {
  Setting row = *this;
  row.why_refused = std::move(why);
  return row;
}
Setting Setting::only_read_by(Stages stages) const {
  Setting row = *this;
  row.read_by = stages;
  return row;
}

std::string Setting::range_text() const { return may_be_auto ? bare_range() + " or auto" : bare_range(); }

std::string Setting::range_with_unit() const {
  std::string range = bare_range();
  if (!unit.empty()) range += fmt::format(" {}", unit);
  return may_be_auto ? range + ", or auto" : range;
}

std::string Setting::bare_range() const {
  switch (type) {
    case ValueType::integer:
    case ValueType::real:
      return fmt::format("{:g} ... {:g}", min, max);
    case ValueType::flag:
      return "true | false";
    case ValueType::choice:
      return fmt::format("{}", fmt::join(choices, " | "));
    case ValueType::text:
      return "a name or a path";
    case ValueType::point:
      return fmt::format("x,y,z, each {:g} ... {:g}", min, max);
    case ValueType::list:
      return fmt::format("ascending numbers, {:g} ... {:g}", min, max);
    case ValueType::whole_list:
      return fmt::format("whole numbers, {:g} ... {:g}", min, max);
    case ValueType::real_list:
      return fmt::format("numbers, {:g} ... {:g}", min, max);
  }
  throw std::logic_error("unknown value type");
}

std::span<const Setting> settings_table() {
  static const std::vector<Setting> table = make_table();
  return table;
}

const Setting& find_setting(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Setting& row : settings_table()) {
    if (row.name == name) return row;
    names.push_back(row.name);
  }
  throw Error(ErrorKind::usage, fmt::format("there is no setting '{}'{} (noonmark settings lists them)", name,
                                            did_you_mean(name, names)));
}

std::map<std::string, std::string> settings_map(const Settings& settings) {
  std::map<std::string, std::string> map;
  for (const Setting& row : settings_table()) map[std::string(row.name)] = row.get(settings);
  return map;
}

}  // namespace noonmark
