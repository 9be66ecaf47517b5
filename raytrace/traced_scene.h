// A scene as its rays see it (of triangles that coincide, only the first is in it), and as its light sees it.
#pragma once
#include <algorithm>
#include <memory>
#include <vector>

#include "raytrace/adjacency.h"
#include "raytrace/embree_scene.h"
#include "raytrace/light_cells.h"
#include "raytrace/light_view.h"
#include "raytrace/silhouettes.h"
#include "raytrace/tracer.h"
#include "scenes/scene.h"

namespace noonmark::raytrace {

// The first of `kept_values` for which is() holds, or else one that make() gives. It comes to the front; the one that was used
// the longest ago makes room for a new one, before that is made, because they are large. most: how many are kept, at least 1.
template <class T, class Is, class Make>
T& last_used(std::vector<T>& kept_values, size_t most, const Is& is, const Make& make) {
  const auto found = std::find_if(kept_values.begin(), kept_values.end(), is);
  if (found != kept_values.end()) {
    std::rotate(kept_values.begin(), found, found + 1);
  } else {
    if (kept_values.size() >= most) kept_values.resize(most - 1);
    kept_values.insert(kept_values.begin(), make());
  }
  return kept_values.front();
}

// What a light sees of a scene, whatever its map is. The silhouettes and the cells are made when they are first asked
// for.
class LightSide {
 public:
  // kept: for how many sizes of picture the cells are kept at the same time.
  LightSide(const Adjacency& adjacency, const EmbreeScene& embree, const LightView& view, size_t kept)
      : adjacency_(adjacency), embree_(embree), view_(view), kept_(kept) {}
  const LightView& view() const { return view_; }
  const Silhouettes& silhouettes() {
    if (!silhouettes_) silhouettes_ = std::make_unique<Silhouettes>(adjacency_, view_, Silhouettes::reach_of(view_));
    return *silhouettes_;
  }
  // Null for lights that have none. Pictures of very different size have cells of their own.
  LightCells* cells(const ReceiverImage& receivers) {
    if (!view_.rays().have_one_direction()) return nullptr;
    const int finest = LightCells::finest_for(receivers);
    const auto& made = last_used(
        cells_, kept_, [&](const auto& cells) { return cells->finest() == finest; },
        [&] { return std::make_unique<LightCells>(adjacency_, view_, embree_.near_distance(), finest); });
    return made.get();
  }

 private:
  const Adjacency& adjacency_;
  const EmbreeScene& embree_;
  LightView view_;
  std::unique_ptr<Silhouettes> silhouettes_;
  size_t kept_;
  std::vector<std::unique_ptr<LightCells>> cells_;  // the last used one first
};

class LatticeSide;

// Bytes of what a second light sees of the scene (400 for each triangle), and of the lattice of the last placements (260).
inline double second_light_bytes(double triangles) { return 660 * triangles; }

class TracedScene {
 public:
  explicit TracedScene(const Scene& s) : scene(s), adjacency(s), embree(device, s, adjacency.without_copies()) {}

  // Points of a sweep come in an order in which neighbours mostly share their light. The last two are remembered, because a
  // point at all placements comes back to its own light after its worst placement, whose map lies elsewhere. Call it from
  // one thread.
  std::shared_ptr<LightSide> lit_by(const LightFrame& frame) {
    return last_used(
        lights_, kept(), [&](const auto& light) { return light->view().same_light(frame); },
        [&] { return std::make_shared<LightSide>(adjacency, embree, LightView(scene, frame), kept()); });
  }

  // The same of the lattice of a map's placements, of which the last one is remembered where two lights are: the views of a
  // scene share it.
  // lattice: Placements::lattice() of a flat map.
  std::shared_ptr<const LatticeSide> lattice_side(const LightFrame& lattice);

  const Scene& scene;
  EmbreeDevice device;
  Adjacency adjacency;
  EmbreeScene embree;

 private:
  size_t kept() const { return scene.triangles.size() <= most_triangles_of_two_lights ? 2 : 1; }

  std::vector<std::shared_ptr<LightSide>> lights_;  // the last used one first
  std::shared_ptr<const LatticeSide> lattice_;
};

}  // namespace noonmark::raytrace
