// Draws the light's frustum over the camera's picture, to show which part of the scene the map covers.
#pragma once
#include <optional>
#include <vector>

#include "app/pictures/image_file.h"
#include "scenes/camera_frame.h"
#include "scenes/receivers.h"
#include "technique/light_frame.h"

namespace noonmark {

// A line in the world, in the colour of its kind (app/pictures/view_colors.h): an edge at the near or the far end, a side
// between them, or the rim of the light's cone.
struct WorldLine {
  std::vector<glm::dvec3> points;
  Color color;
};

// Directional: the box. Spot: the pyramid from near to far, and the cone's rim at both ends. Point: the cubes at near
// and at far, whose sides show the faces of the map, and the edges between the faces from near to far.
std::vector<WorldLine> frustum_lines(const LightFrame& light);

// One segment in the picture. Places are in pixels: (0.5, 0.5) is the centre of the top left one.
struct ScreenSegment {
  glm::dvec2 from{0}, to{0};
  double from_depth = 1, to_depth = 1;  // metres along the camera's axis
};

// The part of a segment before the camera's eye (perspective: beyond a thousandth of its near plane) and inside the
// picture with `margin_px` around it. Returns false if there is none.
bool project_segment(const CameraFrame& camera, int width, int height, glm::dvec3 a, glm::dvec3 b, double margin_px,
                     ScreenSegment& out);

// Draws the lines with soft edges, dashed and fainter where a receiver is nearer, and a mark at the light's position. A
// directional light has no position and so no mark. color: of all lines, in place of one for near, far and sides.
void draw_frustum(Image<Color>& picture, const LightFrame& light, const CameraFrame& camera,
                  const ReceiverImage& receivers, std::optional<Color> color = {});

}  // namespace noonmark
