// The camera that a picture is taken with, and its near and far where nobody gives them.
//
//   Camera camera = effective_camera(scene, settings.view);   // has near and far
#pragma once
#include "scenes/scene.h"
#include "scenes/settings.h"

namespace noonmark {

// The scene's camera with what `view` changes of it. A near or far that neither gives, or that view.fit_depths takes
// from the scene's file, is fitted to where the camera stands: nothing that its picture could show is cut off, but what
// lies in view nearer than 1/10000 of far. Where one of the two is given, the other yields to it (near is at most half
// of far). Throws Error(usage) when view.up is parallel to the view, when eye and target coincide, and when near >=
// far.
Camera effective_camera(const Scene& scene, const ViewSettings& view);

// The camera with near and far fitted, whatever it had.
Camera with_fitted_depths(const Scene& scene, Camera camera, int width, int height);

}  // namespace noonmark
