// What people see of an error, in the picture of full size at the given view: how far the edges of shadows lie from the true ones,
// and how large a patch of wrong pixels is.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "compare/judge/bounds.h"
#include "measure/workbench.h"

namespace noonmark {

// The default bounds. An edge that lies within one pixel of its place cannot be told from the true one in this picture. A patch of
// 0.02% is 14 x 14 pixels of 1280 x 720.
inline constexpr double most_edge_pixels = 1;
inline constexpr double most_wrong_patch = 0.0002;
// The metric of each: 95% of the pixels at drawn edges lie within it, so that a single pixel decides nothing.
inline constexpr const char* edge_metric = "edge_displacement_p95_pixels";
inline constexpr const char* patch_metric = "wrong_patch";
std::vector<Bound> default_eye_bounds();

// Whether a bound is one for the eye: on a metric of edges in the picture, of patches or of FLIP, with a max.
bool is_eye_bound(const Bound& bound);

// The metrics of one picture.
struct EyeErrors {
  double edge_mean_pixels = 0, edge_p95_pixels = 0, wrong_patch = 0, flip = 0;
};
EyeErrors eye_errors(const PointRecord& point);

// For people: "95% of the pixels at shadow edges within 1 pixel".
std::string eye_bound_text(const Bound& bound);

// What breaks the bounds at this point, for people: "a patch of 0.04% of the picture is wrong". Empty if all hold.
std::string why_not_for_eye(const PointRecord& point, const std::vector<Bound>& bounds);

}  // namespace noonmark
