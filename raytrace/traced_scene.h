// A scene as its rays see it: of triangles that coincide, only the first is in it.
#pragma once
#include "raytrace/adjacency.h"
#include "raytrace/embree_scene.h"
#include "scenes/scene.h"

namespace noonmark::raytrace {

struct TracedScene {
  explicit TracedScene(const Scene& s) : scene(s), adjacency(s), embree(device, s, adjacency.without_copies()) {}

  const Scene& scene;
  EmbreeDevice device;
  Adjacency adjacency;
  EmbreeScene embree;
};

}  // namespace noonmark::raytrace
