// Metrics in which the laws of shadow maps are closed forms: lengths of the map, the bias that law 1 asks for, and
// errors summed over the light's plane, which do not depend on where the camera stands.
//
//   m.merge(measure_laws({ladder, scene, receivers, camera, frame, settings.map.format, probe}));
#pragma once
#include <map>
#include <string>

#include "compare/ladder/ladder.h"
#include "scenes/receivers.h"
#include "scenes/scene.h"
#include "technique/light_frame.h"

namespace noonmark {

struct LawInput {
  const Ladder& ladder;
  const Scene& scene;
  const ReceiverImage& receivers;
  const Camera& camera;
  const LightFrame& frame;
  DepthFormat format = DepthFormat::d24;
  const LookupProbe& probe;
};

// One step of the map's format in window depth; of 32-bit float the largest step in [0,1].
double depth_quantum(DepthFormat format);

// How much of the light's plane the surface behind each pixel covers, in m2: the pixel's solid angle, carried to the
// receiver's distance and turned from the view to the surface and from the surface to the light. Under a spot or point
// light, whose rays have no plane in common: the area across the light's ray there. Exact to the first
// order of the pixel's size; the whole pixel is taken to be the surface at its centre. 0 for background.
Image<double> light_plane_areas(const Camera& camera, const LightFrame& frame, const ReceiverImage& receivers);

// Without a counted receiver the areas and the law's bias are NaN; what is not finite in the images makes them so.
std::map<std::string, double> measure_laws(const LawInput& input);

}  // namespace noonmark
