#include "scenes/view_clip.h"

namespace noonmark {

std::array<glm::dvec4, 4> side_planes(const CameraFrame& frame, double margin) {
  const bool perspective = frame.camera.projection == Projection::perspective;
  const double wide = (1 + margin) * frame.half_width, high = (1 + margin) * frame.half_height;
  const double spread = perspective ? 1 : 0, width = perspective ? 0 : wide, height = perspective ? 0 : high;
  return {{{1, 0, spread * wide, width},
           {-1, 0, spread * wide, width},
           {0, 1, spread * high, height},
           {0, -1, spread * high, height}}};
}

}  // namespace noonmark
