// What the map's pass draws, exactly: the depth along a light-side ray of the surfaces that the pass keeps. The bias may
// move the casters, the settings may cull faces, and the near and far planes clip.
//
//   const DrawnMap drawn(traced, view, surface, silhouettes, view.frame(), settings.map, bias, offset);
//   drawn.depths(1, &x, &hit, &depth);   // window depth at place x; hit: the scene's first hit there
#pragma once
#include <optional>
#include <span>

#include "raytrace/embree_scene.h"
#include "raytrace/light_view.h"
#include "raytrace/own_surface.h"
#include "raytrace/polygon_offset.h"
#include "raytrace/traced_scene.h"
#include "technique/bias.h"
#include "technique/settings.h"

namespace noonmark::raytrace {

class DrawnMap {
 public:
  // view: the scene as the map's light sees it. map: the frame whose texels the bias is measured in; that of the view,
  // or the map whose lattice the view has (technique/placements.h). traced must outlive this object.
  // surface, silhouettes: of the view.
  DrawnMap(const TracedScene& traced, const LightView& view, const OwnSurface& surface, const Silhouettes& silhouettes,
           const LightFrame& map, const MapSettings& settings, const Bias& bias,
           const std::optional<PolygonOffset>& offset);
  DrawnMap(const DrawnMap&) = delete;
  DrawnMap& operator=(const DrawnMap&) = delete;

  // Window depths in [0,1] at these places; 1 if nothing is drawn there. count: 1 ... 16. hits: what the rays of the
  // scene meet first there. Beside a silhouette a ray of float may pass on its wrong side; there the first hit is
  // found in double.
  // no_silhouettes: none is near any of these places (Silhouettes::none_between), so that none is looked for.
  void depths(int count, const glm::dvec3* places, const uint32_t* hits, float* depths,
              bool no_silhouettes = false) const;
  // Of a rectangle of texels of the view's frame in which this triangle is the first hit for sure: whether the map's depths there
  // are those of the triangle's plane. Parallel rays only.
  bool draws_plane_of(uint32_t hit, glm::ivec2 low, glm::ivec2 high) const;
  // Those depths, at `count` texels from `first` on along its row.
  void depths_on_plane(uint32_t hit, glm::ivec2 first, int count, float* depths) const {
    view_.window_depths(hit, first, count, depths);
  }
  bool no_silhouettes_between(std::span<const glm::dvec3> corners) const { return silhouettes_.none_between(corners); }

  // Whether the pass draws other surfaces than the scene's (moved casters, culled faces). They have no first hits in
  // double: rays of float find them.
  bool uses_rays() const { return own_tree_.has_value(); }

 private:
  float depth_of(uint32_t hit, glm::dvec3 place) const;

  std::optional<Scene> moved_;
  LightView view_;
  const OwnSurface& surface_;
  const Silhouettes& silhouettes_;
  bool depth_clamp_;
  std::optional<PolygonOffset> offset_;
  std::optional<EmbreeScene> own_tree_;  // of moved vertices, or without the culled faces
  const EmbreeScene& scenes_tree_;
  bool nothing_kept_ = false;
};

}  // namespace noonmark::raytrace
