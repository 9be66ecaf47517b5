// The scene in the frame of a lattice (technique/placements.h): the scene as this light sees it, its silhouettes, and its
// triangles for scan conversion. It depends on the scene and the frame only, not on the camera. So several views of a scene
// use the same one (TracedScene::lattice_side).
#pragma once
#include "raytrace/lattice_raster.h"
#include "raytrace/light_view.h"
#include "raytrace/silhouettes.h"
#include "raytrace/traced_scene.h"

namespace noonmark::raytrace {

class LatticeSide {
 public:
  // traced must outlive this object.
  LatticeSide(const TracedScene& traced, const LightFrame& lattice)
      : view(traced.scene, lattice),
        silhouettes(traced.adjacency, view, Silhouettes::reach_of(view)),
        raster(traced, view) {}
  LatticeSide(const LatticeSide&) = delete;
  LatticeSide& operator=(const LatticeSide&) = delete;

  const LightView view;
  const Silhouettes silhouettes;
  const LatticeRaster raster;
};

}  // namespace noonmark::raytrace
