// The rows of the settings of a motion (MotionSettings, scenes/scene_settings.h), for the table in technique/settings.cpp.
#include "technique/setting_rows.h"
#include "technique/setting_rules.h"

namespace noonmark::setting_rows {

#define MEMBER(path) [](Settings& s) -> decltype((s.view.motion.path)) { return s.view.motion.path; }

std::vector<Setting> motion_rows() {
  using namespace setting_rules;
  return {
      integer(
          "motion.frame", "", 0, 1e6,
          "Which frame of the motion is shown, counted from 0, where camera and light are as the other settings say. "
          "The flicker of a frame is that from it to the next one.",
          MEMBER(frame))
          .idle(without_motion),
      point("motion.move_m", "m", ranges::coordinate_m,
            "Moves the camera by this much in each frame, along the world's axes; auto: not.", MEMBER(move_m))
          .only_read_by({Stage::view})
          .refused(camera_moved_away),
      point("motion.turn_deg", "deg", ranges::of_rotation_deg,
            "Rotates the camera about its eye in each frame. The vector is the rotation's axis in the world times its "
            "angle; auto: not.",
            MEMBER(turn_deg))
          .only_read_by({Stage::view}),
      real("motion.zoom", "", 0.5, 2, "Enlarges the picture by this factor in each frame.", MEMBER(zoom))
          .only_read_by({Stage::view})
          .refused(zoomed_beyond_a_picture),
      point("motion.light_turn_deg", "deg", ranges::of_rotation_deg,
            "Rotates the light's position and target about motion.light_pivot_m in each frame: a sun through a day is "
            "15 degrees an hour about the pole. The vector is the rotation's axis times its angle; auto: not.",
            MEMBER(light_turn_deg))
          .only_read_by({Stage::truth, Stage::map, Stage::lookup}),
      point("motion.light_pivot_m", "m", ranges::coordinate_m,
            "What motion.light_turn_deg rotates about; auto: the light's target.", MEMBER(light_pivot_m))
          .only_read_by({Stage::truth, Stage::map, Stage::lookup})
          .idle(without_turning_light),
      point("motion.light_move_m", "m", ranges::coordinate_m,
            "Moves the light's position and target by this much in each frame, along the world's axes, after "
            "motion.light_turn_deg: a lamp that flies; auto: not.",
            MEMBER(light_move_m))
          .only_read_by({Stage::truth, Stage::map, Stage::lookup})
          .refused(light_moved_away),
      integer("motion.light_period", "frames", 0, 1e6,
              "The light swings with this period: frame n is turned and moved by sin(2 pi n / period) times "
              "motion.light_turn_deg and motion.light_move_m. 0: by that much in each frame.",
              MEMBER(light_period))
          .only_read_by({Stage::truth, Stage::map, Stage::lookup})
          .idle(without_moving_light),
      real("motion.time_s", "s", 0, 1e6,
           "How much later scene.time_s is in the next frame. For a glTF file whose animation moves the camera or the "
           "light; frames are then values of scene.time_s.",
           MEMBER(time_s))
          .only_read_by({Stage::ladder})
          .idle(in_builtin_scene),
  };
}

#undef MEMBER

}  // namespace noonmark::setting_rows
