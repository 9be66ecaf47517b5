// What the camera of another renderer sees, and the surfaces on which its receivers lie.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "raytrace/own_surface.h"
#include "raytrace/shadow_start.h"
#include "raytrace/traced_scene.h"
#include "raytrace/tracer.h"
#include "scenes/number_ranges.h"

namespace noonmark::raytrace {
namespace {

struct Corners {
  glm::dvec3 a, b, c;
  Corners(const Scene& scene, uint32_t triangle)
      : a(scene.positions[scene.triangles[triangle].x]),
        b(scene.positions[scene.triangles[triangle].y]),
        c(scene.positions[scene.triangles[triangle].z]) {}
  glm::dvec3 cross() const { return glm::cross(b - a, c - a); }
};

bool single_sided(const Scene& scene, uint32_t triangle) {
  return !scene.single_sided.empty() && scene.single_sided[triangle];
}

// The first triangle on a ray of the camera that has a side to show.
class FirstSeen {
 public:
  FirstSeen(const TracedScene& traced, const Ray& ray)
      : traced_(traced), ray_(ray), cast_{glm::vec3(ray.origin), glm::vec3(ray.direction)} {}

  uint32_t operator()() {
    const uint32_t first = traced_.embree.first_hit(cast_);
    if (first == no_primitive || shows(first)) return first;
    std::vector<uint32_t> met;
    traced_.embree.all_hits(cast_, met);
    uint32_t nearest = no_primitive;
    double least = std::numeric_limits<double>::infinity();
    for (const uint32_t triangle : met)
      if (const double at = distance(triangle); shows(triangle) && at >= 0 && at < least) {
        least = at;
        nearest = triangle;
      }
    return nearest;
  }

 private:
  // Of triangles that coincide the rays know the first: it is seen if one of them is.
  bool shows(uint32_t triangle) const {
    return !single_sided(traced_.scene, triangle) ||
           glm::dot(Corners(traced_.scene, triangle).cross(), ray_.direction) < 0;
  }
  double distance(uint32_t triangle) const {
    const Corners t(traced_.scene, triangle);
    return glm::dot(t.cross(), t.a - ray_.origin) / glm::dot(t.cross(), ray_.direction);
  }

  const TracedScene& traced_;
  const Ray ray_;
  const LightRay cast_;
};

}  // namespace

Image<uint32_t> Tracer::seen_primitives(const ViewMatrix& view, int width, int height) const {
  Image<uint32_t> seen(width, height, no_primitive);
  tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const tbb::blocked_range<int>& rows) {
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < width; ++x) {
        const Ray ray = view.pixel_ray(x, y, width, height);
        // The near plane lies at infinity if the matrix has no far plane and its depths are not reversed as declared.
        if (!is_in_world(ray.origin) || !has_direction(ray.direction)) continue;
        const uint32_t hit = FirstSeen(*traced_, ray)();
        if (hit == no_primitive) continue;
        const Corners t(traced_->scene, hit);
        const double along = glm::dot(t.cross(), t.a - ray.origin) / glm::dot(t.cross(), ray.direction);
        if (view.pixel_of(ray.origin + along * ray.direction, width, height).z <= 1) seen.at(x, y) = hit;
      }
  });
  return seen;
}

OnSurface Tracer::on_surface(const Image<glm::dvec3>& points, const Image<uint8_t>& present,
                             const ViewMatrix& view) const {
  const int width = points.width, height = points.height;
  OnSurface found{{Image<glm::vec3>(width, height, glm::vec3(0)), Image<glm::vec3>(width, height, glm::vec3(0)),
                   Image<uint32_t>(width, height, no_primitive)},
                  Image<float>(width, height, 0)};
  tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const tbb::blocked_range<int>& rows) {
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < width; ++x) {
        const size_t i = points.index(x, y);
        if (!present[i]) continue;
        const glm::dvec3 p = points[i], way = view.pixel_ray(x, y, width, height).direction;
        // A back that the camera does not see is taken only where nothing else is as near. What rounding of a float
        // position can move counts as equally near.
        const EmbreeScene::Nearest near = traced_->embree.nearest(p, 0x1p-22 * glm::length(p), [&](uint32_t triangle) {
          return !single_sided(traced_->scene, triangle) ||
                 glm::dot(Corners(traced_->scene, triangle).cross(), way) < 0;
        });
        if (near.primitive == no_primitive) continue;
        const Corners t(traced_->scene, near.primitive);
        const glm::dvec3 cross = t.cross();
        const double area = glm::length(cross);
        if (!(area > 0)) continue;
        found.receivers.primitive[i] = near.primitive;
        found.receivers.position[i] = glm::vec3(near.point);
        found.receivers.normal[i] = glm::vec3(cross / (glm::dot(cross, way) > 0 ? -area : area));
        found.moved_m[i] = static_cast<float>(glm::length(near.point - p));
      }
  });
  return found;
}

double edge_ring(int ring) { return (ring % 2 == 0 ? 0.25 : 0.375) * std::exp2(ring / 2); }

namespace {

// The places of a ring's spokes on a circle of radius 1: of even rings, and of odd ones, which are turned by half a spoke.
struct Spokes {
  std::array<glm::dvec2, edge_spokes> of_ring[2];
  Spokes() {
    for (int odd = 0; odd < 2; ++odd)
      for (int spoke = 0; spoke < edge_spokes; ++spoke) {
        const double turn = 2 * std::numbers::pi * (spoke + odd / 2.0) / edge_spokes;
        of_ring[odd][static_cast<size_t>(spoke)] = {std::cos(turn), std::sin(turn)};
      }
  }
  glm::dvec2 at(int ring, int spoke) const { return of_ring[ring % 2][static_cast<size_t>(spoke)]; }
};

}  // namespace

Image<uint8_t> Tracer::edge_within(const ReceiverImage& given, const ReceiverTruth& truth, const LightFrame& frame,
                                   const Image<uint8_t>& mask, const Image<float>& radius_m,
                                   const Image<float>& unit_m) const {
  std::optional<ReceiverImage> made;
  const ReceiverImage& receivers = on_first(given, made);
  const std::shared_ptr<LightSide> light = traced_->lit_by(frame);
  const LightView& view = light->view();
  LightCells* const cells = uses_cells() ? light->cells(receivers) : nullptr;
  const OwnSurface surface(traced_->embree, traced_->adjacency, view, light->silhouettes(), cells);
  const Spokes spokes;
  Image<uint8_t> near(receivers.width(), receivers.height(), 0);
  tbb::parallel_for(tbb::blocked_range<size_t>(0, mask.size(), 256), [&](const tbb::blocked_range<size_t>& pixels) {
    Silhouettes::Nearby nearby;
    std::optional<LightCells::Reader> reader;
    if (cells) reader.emplace(*cells);
    OwnSurface::Pair pair;
    for (size_t i = pixels.begin(); i != pixels.end(); ++i) {
      const double radius = radius_m[i], unit = unit_m[i];
      if (!mask[i] || !(radius > 0) || !(unit > 0)) continue;
      const glm::dvec3 p = receivers.position[i];
      const SurfacePoint point = surface.point(frame.to_light(p), receivers.primitive[i], truth.lit[i] != 0);
      glm::dvec3 right, up;
      frame.light().axes_across(frame, p, right, up);
      const auto place = [&](int ring, int spoke, double reach) {
        const glm::dvec2 way = spokes.at(ring, spoke);
        return view.place_of(frame.to_light(p + reach * (way.x * right + way.y * up)));
      };
      int last = 0;
      while (edge_ring(last) * unit < radius) ++last;
      std::array<glm::dvec3, edge_spokes> places;
      const auto places_on = [&](int ring) {
        for (int spoke = 0; spoke < edge_spokes; ++spoke)
          places[static_cast<size_t>(spoke)] = place(ring, spoke, edge_ring(ring) * unit);
      };
      // Whether V is R1 at all places in the rectangle around these. It holds all ways from P to them, and the rings within. A
      // receiver that is lit and has no silhouette there is lit at all of its places (OwnSurface::lit_at without a crossing).
      // A dark one may come out of its occluder without one.
      const auto is_same = [&] {
        if (point.lit) {
          light->silhouettes().list_nearby(places, nearby);
          return nearby.none();
        }
        if (!reader) return false;
        glm::dvec2 low(places[0]), high(places[0]);
        for (const glm::dvec3& at : places) low = glm::min(low, glm::dvec2(at)), high = glm::max(high, glm::dvec2(at));
        return surface.known_in(point, low, high, *reader, pair) == std::optional(false);
      };
      places_on(last);
      if (is_same()) continue;
      // Whether a change between P and this place of the last ring, found to 2^-10 of the way, lies within the radius.
      const auto changes_within = [&](int spoke) {
        double same = 0, other = 1;
        const double reach = edge_ring(last) * unit;
        for (int halving = 0; halving < 10; ++halving) {
          const double middle = (same + other) / 2;
          const glm::dvec3 x = place(last, spoke, middle * reach);
          uint32_t hit = no_primitive;
          view.first_hits(traced_->embree, 1, &x, &hit);
          (surface.lit_at(point, x, hit, nearby).lit == point.lit ? same : other) = middle;
        }
        return other * reach <= radius;
      };
      for (int ring = 0; ring <= last && !near[i]; ++ring) {
        places_on(ring);
        if (is_same()) continue;
        if (!point.lit) light->silhouettes().list_nearby(places, nearby);
        std::array<uint32_t, edge_spokes> hits;
        view.first_hits(traced_->embree, edge_spokes, places.data(), hits.data());
        for (int spoke = 0; spoke < edge_spokes && !near[i]; ++spoke) {
          const auto at = static_cast<size_t>(spoke);
          near[i] = surface.lit_at(point, places[at], hits[at], nearby).lit != point.lit &&
                    (ring < last || changes_within(spoke));
        }
      }
    }
  });
  return near;
}

}  // namespace noonmark::raytrace
