// The settings of the scene and of the camera. The rows that name these members are in technique/settings.cpp.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "scenes/scene.h"

namespace noonmark {

enum class MeshForm { as_built, one_mesh, split, reversed, doubled, tiles, t_junctions };  // scenes/remesh.h
// The choices of scene.mesh, in the order of the enumerators.
inline constexpr std::string_view mesh_forms[] = {"as_built", "one_mesh", "split",      "reversed",
                                                  "doubled",  "tiles",    "t_junctions"};

struct SceneSettings {
  std::string name = "cube-room";  // a built-in scene, or the path of a .gltf, .glb or .vrm file
  double theta_deg = 45;           // plane: the angle between its normal and the light
  double phi_deg = 0;              // plane: azimuth of the slope in the light's plane, against the texel axes; plate:
                                   // how far it is turned about the vertical
  double thickness_m = 0.1;        // wall, plate
  double height_m = 0.5;           // plate: of its lit face above the floor
  int plates = 2;                  // layers: how many plates lie one above the other
  double gap_m = 1;                // layers: from the floor to the lit face of the lowest plate
  double step_m = 1;               // layers: from the lit face of a plate to that of the next one above
  double offset_m = 0.25;          // layers: from an edge of an upper plate to that of the next one above
  MeshForm mesh = MeshForm::as_built;     // the same surface in other triangles
  bool masks = true;                      // alpha masks of a file's materials are cut out (scenes/alpha_mask.h)
  bool floor = false;                     // a square under the scene (scenes/floor.h)
  double turn_deg = 0;                    // the whole scene, camera and light with it, about the axis (1, 2, 3)
  std::optional<glm::dvec3> move_m = {};  // and then moved; empty: not
  std::optional<double> time_s = {};      // of a file's animation: the pose at that time; empty: at rest
  int animation = 0;                      // which of the file's animations time_s is a time of
};

// How camera and light move from one frame to the next. Frame 0 is what the other settings say. Frame n is n steps
// later. It is computed from frame 0, so that rounding does not add up from frame to frame. What moves the camera is read by effective_camera()
// (scenes/camera_fit.h), what moves the light by effective_light() (technique/light_frame.h).
struct MotionSettings {
  int frame = 0;
  // Of the camera, for each frame: a move of eye and target, in the world; a rotation about the eye, as the axis times
  // the angle; and the factor by which the picture is enlarged.
  std::optional<glm::dvec3> move_m;
  std::optional<glm::dvec3> turn_deg;
  double zoom = 1;
  // Of the light: a rotation of position and target about the pivot (empty: the target), and then a move of both. Without
  // a period they are those of each frame (a sun through a day, a lamp that flies). With one the light swings: frame n is
  // turned and moved by sin(2 pi n / period) times the vectors.
  std::optional<glm::dvec3> light_turn_deg;
  std::optional<glm::dvec3> light_pivot_m;
  std::optional<glm::dvec3> light_move_m;
  int light_period = 0;  // frames; 0: no swing
  double time_s = 0;     // by which scene.time_s of the next frame is later

  // Whether the next frame can differ from this one.
  bool any() const { return move_m || turn_deg || zoom != 1 || light_turn_deg || light_move_m || time_s != 0; }
  // Whether the light of the next frame differs from that of this one.
  bool moves_light() const {
    return light_turn_deg.value_or(glm::dvec3(0)) != glm::dvec3(0) ||
           light_move_m.value_or(glm::dvec3(0)) != glm::dvec3(0);
  }
};

// The first is the projection of the scene's camera. The others are in the order of Projection.
enum class ViewProjection { automatic, perspective, orthographic };

struct ViewSettings {
  int width_px = 1280;
  int height_px = 720;
  std::optional<glm::dvec3> eye_m;     // empty: the scene's
  std::optional<glm::dvec3> target_m;  // empty: the scene's
  std::optional<glm::dvec3> up;        // of the picture, any length but 0; empty: the scene's
  ViewProjection projection = ViewProjection::automatic;
  std::optional<double> fov_deg;  // perspective: whole vertical angle; empty: the scene's
  std::optional<double>
      height_m;  // orthographic: of the world that the picture shows; empty: as scenes/camera_fit.h says
  std::optional<double> near_m;  // along the view; empty: the scene's, or fitted (scenes/camera_fit.h)
  std::optional<double> far_m;
  bool fit_depths = false;  // near and far fitted, also where the scene's file gives them
  MotionSettings motion;
};

}  // namespace noonmark
