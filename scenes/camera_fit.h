// The camera that a picture is taken with, and its near and far where nobody gives them.
//
//   Camera camera = effective_camera(scene, settings.view);   // has near and far
#pragma once
#include "scenes/scene.h"
#include "scenes/scene_settings.h"

namespace noonmark {

// The scene's camera, with the changes that `view` asks for. Near and far come from `view`, else from the scene's file.
// One that neither of them gives is fitted to where the camera stands; with view.fit_depths the file's are fitted too.
// Fitted planes cut off nothing that the picture could show, except surfaces nearer than far / 10000. If only one of
// the two is given, the other is fitted to it: near is at most half of far. Throws Error(usage) when view.up is
// parallel to the view, when eye and target coincide, and when near >= far.
Camera effective_camera(const Scene& scene, const ViewSettings& view);

// The camera with near and far fitted, whatever it had.
Camera with_fitted_depths(const Scene& scene, Camera camera, int width, int height);

}  // namespace noonmark
