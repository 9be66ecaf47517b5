// What a light sees of a scene through the lattice of a map's placements (technique/placements.h): the scene in the
// lattice's frame, its silhouettes and its triangles as scan conversion reads them. It follows from the scene and that frame
// alone, so the views of a scene share it (TracedScene::lattice_side).
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
