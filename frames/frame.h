// frames/: the frame of another renderer, judged: what is handed over, whether it is what it should be, and how wrong its
// shadows are. May include base, scenes, technique and raytrace. Knows no shadow map of our own, no OpenGL, no image
// file and no store: it takes plain images, so that it runs where there is no driver. Begin here, then frames/judge.h.
//
// What another renderer hands over. Conventions: scenes/scene.h.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/image.h"
#include "base/memory.h"
#include "scenes/scene.h"
#include "scenes/view_matrix.h"

namespace noonmark {

// Where a receiver of the frame lies, best first: the renderer's own world positions, its depths, or nothing. With nothing
// the receivers are those of rays through the pixels' centres.
enum class GivenReceivers { positions, depth, none };

// The shadow map that the frame was drawn with, and how the renderer looks it up.
struct GivenMap {
  std::string name;               // for messages: its file
  Image<float> depth;             // window depth, 0 near and 1 far; row 0 has the lowest y of the light's clip space
  glm::dmat4 clip_from_world{1};  // of the light; OpenGL's clip space
  std::vector<std::pair<std::string, std::string>> technique;  // settings by name: bias, filter, culling
};

struct GivenFrame {
  std::string name;  // for messages: the file of the visibility
  // Of each pixel, as it was delivered: 1 lit, 0 shadowed. NaN: nothing is judged there.
  Image<float> visibility;
  // 1 for a pixel whose visibility is NaN although it shows a surface: one that is not judged. Empty: there is none.
  Image<uint8_t> not_judged = {};
  // The visibility was measured as the share between the same frame with all lit and with all dark. So shading, ambient light
  // and an exchange of light and shadow are no faults that it can have.
  bool normalised = false;
  double step = 0;  // how far a value may lie from what was drawn, by the steps of the picture that it was read from
  // True if the picture could say "no surface" (-1, NaN or alpha 0) and did so for at least one pixel, or if positions or
  // depths say it. Then its coverage can be compared with the scene's.
  bool marks_no_surface = false;
  GivenReceivers receivers = GivenReceivers::none;
  Image<glm::dvec3> positions;  // world, metres; NaN: no surface. Empty with GivenReceivers::none
  ViewMatrix view;
  Light light;
  std::optional<GivenMap> map = {};
  std::vector<std::string> not_in_map = {};  // names of parts of the scene: casters that the frame's map lacks
  std::vector<std::string> notes = {};       // sentences for people
};

// Takes the marks out of a visibility as it was delivered: -1 or NaN where there is no surface, -2 at a surface that is not
// judged. Sets not_judged, and marks_no_surface if there is a mark of the first kind.
void take_marks(GivenFrame& frame);

// What judging a frame of this size takes beside its scene, in bytes, an upper bound: receivers, truth, classes, the values
// that the checks sort, and the files that are written. Without the frame's own shadow map.
double frame_bytes(int width, int height);

// Throws Error(file) if it does not fit. name: of the frame, for the message.
void require_frame_memory(const std::string& name, int width, int height,
                          const AvailableMemory& available = available_memory());

}  // namespace noonmark
