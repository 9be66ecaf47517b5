// The rows of the settings of scene and camera, for the table in technique/settings.cpp.
#include "technique/setting_rows.h"
#include "technique/setting_rules.h"

namespace noonmark::setting_rows {

using namespace setting_rules;

#define MEMBER(path) [](Settings& s) -> decltype((s.path)) { return s.path; }

std::vector<Setting> view_rows() {
  return {
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
           "the triangles. false: masked triangles are opaque, which makes fewer triangles.",
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
             "textbooks; it shows as much of the world as a perspective camera does in the distance of its target, "
             "unless view.height_m says how much.",
             MEMBER(view.projection)),
      real("view.fov_deg", "deg", 1, 170,
           "perspective: whole vertical angle of view; auto: the scene's. With view.projection = orthographic it gives "
           "the height that is shown, unless view.height_m does.",
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
  };
}

#undef MEMBER

}  // namespace noonmark::setting_rows
