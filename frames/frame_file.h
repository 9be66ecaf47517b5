// frame.json: what another renderer hands over, in numbers and paths. docs/reference/frame.md is its reference, and
// frame_schema() its JSON schema.
//
//   const FrameFile file = parse_frame_file("shots/frame.json", text);
//   const ViewMatrix view = file.view(scene, width, height);
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenes/scene.h"
#include "scenes/view_matrix.h"

namespace noonmark {

enum class ValueEncoding { linear, srgb };  // srgb: IEC 61966-2-1, as a PNG of a canvas has it
enum class DepthMeasure {
  window,  // what a depth buffer holds, from 0 to 1, in the camera's convention
  view_z   // metres along the camera's view; perspective cameras only
};

// The renderer's own map, as the file gives it.
struct MapFile {
  std::string file;
  bool top_row_first = false;     // of clip space with y up
  glm::dmat4 clip_from_frame{1};  // as given, of the convention below
  ClipConvention convention;
  std::vector<std::pair<std::string, std::string>> technique;  // settings by name, each known and allowed here
};

struct FrameFile {
  std::string path;  // of the JSON file, for messages. Paths below are as they stand in it, relative to its folder
  std::optional<std::string> scene;
  std::vector<std::string> not_in_map, notes;
  std::string visibility;
  ValueEncoding encoding = ValueEncoding::linear;
  bool normalised = false;
  std::optional<double> step;
  std::optional<std::string> positions;
  std::optional<std::string> depth;
  DepthMeasure depth_measure = DepthMeasure::window;

  // From the renderer's coordinates to the scene's: axes and unit. Positions, matrices and lights are in the renderer's.
  glm::dmat4 world_from_frame{1};

  std::optional<glm::dmat4> clip_from_frame;  // as given, of the convention below
  ClipConvention convention;
  std::optional<Camera> camera;            // given by eye and target, in the scene's coordinates
  std::optional<std::string> camera_name;  // of the scene's file
  std::optional<Light> light;              // in the scene's coordinates; empty: the scene's
  std::optional<std::string> light_name;   // of the scene's file; then `light` gives its size alone

  std::optional<MapFile> map;

  std::optional<double> edge_m, edge_pixels, contact_m;

  // The matrix of the map, from the scene's coordinates to OpenGL's clip space. Only if there is a map.
  glm::dmat4 map_from_world() const;
  // Of a scene that gives the camera or the light where the file gives none, or a name. Throw Error(file).
  ViewMatrix view(const Scene& scene, int width, int height) const;
  Light light_in(const Scene& scene) const;
};

// Throws Error(file) that names the key.
FrameFile parse_frame_file(const std::string& path, std::string_view text);

// The JSON schema (draft 7) of the file, as text.
std::string frame_schema();

}  // namespace noonmark
