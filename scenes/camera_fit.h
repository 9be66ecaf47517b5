// The camera that a picture is taken with, and its near and far where nobody gives them.
//
//   Camera camera = effective_camera(scene, settings.view);   // has near and far
#pragma once
#include "scenes/scene.h"
#include "scenes/scene_settings.h"

namespace noonmark {

// The scene's camera, with the changes that `view` asks for. Near and far come from `view`, else from the scene's file.
// One that neither of them gives is fitted to where the camera stands; with view.fit_depths the file's are fitted too.
// A fitted near or far cuts nothing off that the picture could show, except what is nearer than 1/10000 of far. If only
// one of the two is given, the other adapts (near is at most half of far).
// Throws Error(usage) when view.up is parallel to the view, when eye and target coincide, and when near >= far.
Camera effective_camera(const Scene& scene, const ViewSettings& view);

// The camera with near and far fitted, whatever it had.
Camera with_fitted_depths(const Scene& scene, Camera camera, int width, int height);

}  // namespace noonmark
