// app/live/: the live page, one HTML file that draws a scene, its shadow map and its shadows with WebGL 2, traces the
// truth and names the causes while sliders move. May include base, scenes, technique, gl's page text and compare. Measures
// nothing itself.
//
//   require_live(scene, settings);                                // throws Error(usage) for what the page does not draw
//   write_file_atomically("live.html", live_page(scene, live_settings(settings), version));
//
// The page's arithmetic is the program's: its lookup is compiled from gl/shaders and technique/bias, its geometry is the
// scene's floats, and its light frame, receivers and truth follow technique/, scenes/ and raytrace/ (each script names the
// file that it follows). tests/app/live_agreement_test.cpp compares both in a browser.
#pragma once
#include <string>
#include <string_view>

#include "scenes/scene.h"
#include "technique/settings.h"

namespace noonmark {

// The page holds the floats of every vertex. With more triangles it would be no file that one sends around.
inline constexpr size_t most_live_triangles = 20'000;
// The page's picture has at most this size; a larger view is made smaller with its proportions.
inline constexpr int most_live_picture_width_px = 640, most_live_picture_height_px = 360;

// The settings with the page's picture size.
Settings live_settings(Settings settings);

// Throws Error(usage) that names the setting, the light or the number of triangles which the page does not draw. It takes
// settings that are modelled or have no effect, and refuses every other one that is not at its default.
void require_live(const Scene& scene, const Settings& settings);

// The page. settings: of live_settings(), not refused. version: of the program. Throws Error as make_light_frame() and
// effective_camera() do.
std::string live_page(const Scene& scene, const Settings& settings, std::string_view version);

}  // namespace noonmark
