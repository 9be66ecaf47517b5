// A scene as its rays see it (of triangles that coincide, only the first is in it), and as its light sees it.
#pragma once
#include <memory>

#include "raytrace/adjacency.h"
#include "raytrace/embree_scene.h"
#include "raytrace/light_cells.h"
#include "raytrace/light_view.h"
#include "raytrace/silhouettes.h"
#include "scenes/scene.h"

namespace noonmark::raytrace {

// What a light sees of a scene, whatever its map is. The silhouettes and the cells are made when they are first asked
// for.
class LightSide {
 public:
  LightSide(const Adjacency& adjacency, const EmbreeScene& embree, const LightView& view)
      : adjacency_(adjacency), embree_(embree), view_(view) {}
  const LightView& view() const { return view_; }
  const Silhouettes& silhouettes() {
    if (!silhouettes_) silhouettes_ = std::make_unique<Silhouettes>(adjacency_, view_, Silhouettes::reach_of(view_));
    return *silhouettes_;
  }
  // Null for lights that have none. They are made again for pictures of very different size.
  LightCells* cells(const ReceiverImage& receivers) {
    if (!view_.rays().have_one_direction()) return nullptr;
    const int finest = LightCells::finest_for(receivers);
    if (cells_ && cells_->finest() == finest) return cells_.get();
    cells_.reset();  // before making the next: they are large
    cells_ = std::make_unique<LightCells>(adjacency_, view_, embree_.near_distance(), finest);
    return cells_.get();
  }

 private:
  const Adjacency& adjacency_;
  const EmbreeScene& embree_;
  LightView view_;
  std::unique_ptr<Silhouettes> silhouettes_;
  std::unique_ptr<LightCells> cells_;
};

class TracedScene {
 public:
  explicit TracedScene(const Scene& s) : scene(s), adjacency(s), embree(device, s, adjacency.without_copies()) {}

  // Points of a sweep come in an order in which neighbours mostly share their light: the last one is remembered. Call
  // it from one thread.
  std::shared_ptr<LightSide> lit_by(const LightFrame& frame) {
    if (!light_ || !light_->view().same_light(frame)) {
      light_.reset();  // before making the next: it is large
      light_ = std::make_shared<LightSide>(adjacency, embree, LightView(scene, frame));
    }
    return light_;
  }

  const Scene& scene;
  EmbreeDevice device;
  Adjacency adjacency;
  EmbreeScene embree;

 private:
  std::shared_ptr<LightSide> light_;
};

}  // namespace noonmark::raytrace
