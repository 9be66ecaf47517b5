// The PNGs of a measured point, for people. app/pictures/point_files.h writes the files for other programs.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "app/pictures/image_file.h"
#include "measure/workbench.h"

namespace noonmark {

// Each picture of a point that write_pictures() may write.
inline constexpr std::string_view picture_names[] = {
    "truth",    "soft-truth", "map",          "classes",           "difference", "flicker",          "depth",
    "cascades", "frustum",    "shaded-truth", "shaded-soft-truth", "shaded-map", "shaded-difference"};

// Writes the point's PNGs as <folder>/<stem>-<name>.png. The paths in the records begin with `relative`, not `folder`.
std::vector<PictureRecord> write_pictures(const Measurement& m, const std::string& folder, const std::string& relative,
                                          const std::string& stem);

// The pictures with which people find mistakes in a renderer of their own; `render` writes them, and no report has them.
inline constexpr std::string_view debug_picture_names[] = {"debug-unshadowed", "debug-stored", "debug-painted",
                                                           "debug-corner", "debug-texels"};
std::vector<PictureRecord> write_debug_pictures(const Measurement& m, const std::string& folder,
                                                const std::string& relative, const std::string& stem);

// A frame of the animation of a motion: what the shadow map shows, and beside it what changes until the next frame
// although the truth does not. m.flicker must be there. Each is at most 480 pixels wide; a larger picture is reduced by a
// whole factor.
Image<Color> motion_frame(const Measurement& m);

// Grey clay with the true shadow (R1). What faces away from the light is blue, so that it is told from what faces the
// light and is in shadow, which is dark grey. A pixel with an ambiguous truth is pale yellow: it is neither lit nor in shadow.
Image<Color> lit_picture(const Measurement& m);

// The pictures "map" and "classes" of write_pictures().
Image<Color> shown_picture(const Measurement& m);
Image<Color> causes_picture(const Measurement& m);

// The surroundings of one pixel, enlarged: the truth, what the map showed, and why it is wrong, beside each other. The pixel
// is in the middle of each and framed. x, y: in the picture, row 0 on top. What lies beyond the picture's edge is black.
inline constexpr int crop_px = 17, crop_scale = 10, crop_gap = 6;
Image<Color> pixel_picture(const Measurement& m, int x, int y);
// The same of three pictures, from left to right.
Image<Color> pixel_picture(const std::array<Image<Color>, 3>& pictures, int x, int y);

}  // namespace noonmark
