// Metrics for which the laws of shadow maps have closed forms: lengths of the map, the bias that law 1 requires, and
// errors summed over the light's plane, which do not depend on the place of the camera.
//
//   metrics.merge(measure_laws({ladder, scene, receivers, camera, frame, settings.map.format, probe}));
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

// What measure_laws() gives, and what the number of several maps is.
struct LawMetric {
  const char* name;
  // counted: of the maps with a counted receiver. The median is that of all counted receivers, where the number is the same at
  // all receivers of a map.
  enum Join { median, largest, largest_of_counted, sum_of_counted } join;
};
inline constexpr LawMetric law_metrics[] = {{"texel_m", LawMetric::median},
                                            {"map_range_m", LawMetric::largest},
                                            {"depth_quantum_m", LawMetric::largest},
                                            {"acne_free_bias_law_depth", LawMetric::largest_of_counted},
                                            {"acne_free_bias_law_m", LawMetric::largest_of_counted},
                                            {"acne_free_bias_scene_law_depth", LawMetric::largest},
                                            {"acne_free_bias_scene_law_m", LawMetric::largest},
                                            {"counted_area_m2", LawMetric::sum_of_counted},
                                            {"filter_area_m2", LawMetric::sum_of_counted},
                                            {"displacement_area_m2", LawMetric::sum_of_counted},
                                            {"aliasing_area_m2", LawMetric::sum_of_counted},
                                            {"acne_area_m2", LawMetric::sum_of_counted},
                                            {"peter_panning_area_m2", LawMetric::sum_of_counted}};

// One step of the map's format in window depth. For 32-bit float it is the largest step in [0,1].
double depth_quantum(DepthFormat format);

// The area of the light's plane that the surface behind each pixel covers, in m2. It is the pixel's solid angle, scaled
// to the receiver's distance, projected from the view to the surface and from the surface to the light. The rays of a
// spot or point light have no common plane; there it is the area perpendicular to the light's ray at the receiver. It
// is exact to the first order of the pixel's size, because the whole pixel is assumed to show the surface at its
// centre. 0 for background.
Image<double> light_plane_areas(const Camera& camera, const LightFrame& frame, const ReceiverImage& receivers);

// Law 1 is of a lookup that compares depths: other ladders lack the bias that it requires. Without a counted receiver, the areas
// and the law's bias are NaN. Values in the images that are not finite make them
// NaN too.
std::map<std::string, double> measure_laws(const LawInput& input);

}  // namespace noonmark
