// What `noonmark inspect` says of a model.
//
//   const ModelReport report = inspect_model(settings);       // settings.scene.name is the path
//   fmt::print("{}", report_text(report));
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/gltf/contents.h"
#include "technique/settings.h"

namespace noonmark {

struct TexelSize {
  int resolution = 0;  // texels on a side
  double texel_m = 0;  // width of a texel at the middle of the scene's box
};

// How the triangles join, by exactly equal positions of their corners (raytrace/adjacency.h).
struct SurfaceReport {
  uint64_t open_edges = 0;         // edges of one triangle only; 0: the surface is closed
  uint64_t branched_edges = 0;     // edges of three triangles or more
  uint64_t doubled_triangles = 0;  // exact copies of other triangles
};

struct ModelReport {
  std::string path;
  ModelContents contents;
  Scene scene;  // as measured, with what the settings add
  SurfaceReport surface;
  glm::dvec3 low_m{0}, high_m{0};                 // axis-aligned box
  double farthest_m = 0;                          // largest coordinate of a vertex, without its sign
  double float_step_m = 0;                        // between neighbouring floats there
  double shortest_edge_m = 0, median_edge_m = 0;  // of the triangles' edges; of those longer than 0
  bool room = false;                              // a closed room (scenes/interior.h)
  bool ground = false;                            // has_ground (scenes/floor.h)
  std::string light;                              // name of the kind of light that is measured
  std::vector<TexelSize> texels;                  // of the map as the settings fit it
};

// Throws Error(file) for a file that cannot be used, Error(usage) for settings that cannot be.
ModelReport inspect_model(const Settings& settings);

std::string report_text(const ModelReport& report);
// The same numbers as one JSON object, in SI units; picture: the path of the picture.
std::string report_json(const ModelReport& report, const std::string& picture);

}  // namespace noonmark
