// The squares that engines fit to the corners of a slice of the view: what map.fit = corner_sphere, corner_square and
// corner_box lay. A fit is one function and one row of the table in corner_fits.cpp.
//
//   const SliceCorners corners = corners_of_slice(camera, {0.2, 10}, axes);
//   const CornerSquare square = find_corner_fit(MapFit::corner_sphere)->around(corners, 0);
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <span>
#include <string_view>

#include "scenes/camera_frame.h"
#include "technique/settings.h"

namespace noonmark {

struct LightFrame;
struct ViewSlice;

// In the light's axes, in metres: corner i and corner i ^ 7 are opposite, and bit 2 says that it is of the far end.
using SliceCorners = std::array<glm::dvec3, 8>;

SliceCorners corners_of_slice(const CameraFrame& camera, const ViewSlice& slice, const LightFrame& axes);

struct CornerSquare {
  glm::dvec2 middle_m{0};
  double half_m = 0;             // half of its side
  double low_m = 0, high_m = 0;  // the depths along the light that hold the slice
};

struct CornerFit {
  MapFit fit;
  std::string_view name;  // a choice of map.fit
  std::string_view help;
  // round_m: half of the side is rounded up to a multiple of it; 0: not rounded.
  CornerSquare (*around)(const SliceCorners&, double round_m);
};

std::span<const CornerFit> corner_fits();

// Null if the fit is none to the corners.
const CornerFit* find_corner_fit(MapFit fit);

}  // namespace noonmark
