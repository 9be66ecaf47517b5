// The truth by formula. A scene consists of analytic shapes: rectangles, boxes, discs and spheres. The light may be of
// any kind. Everything is computed in double. The tests compare the tracer's results for such scenes with these
// formulas, so nothing here uses triangles, an acceleration structure or code of raytrace/. Of technique/light_frame.h
// only the numbers are used that say where the light and its map are.
//
//   ClosedForm truth(shapes, frame);
//   truth.lit({P, shape, face});                                     // R1
//   truth.lit_at({P, shape, face}, truth.ray_of_texel({i, j}));      // V(P, x)
//
// The rays of a light are the lines through one point, the light's centre. Under a directional light this point is at
// infinity. So one set of formulas is enough for lights of every kind:
// - A ray meets a shape if it passes inside the shape's outline. The depth of the hit is a smooth function of the ray.
// - The depth of the first hit is the smallest depth of all shapes that the ray meets (a lower envelope).
// - Shadow edges are outlines. On the straight way from one ray to another, the depth of the first hit can jump only
//   where the way crosses an outline.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "technique/light_frame.h"

namespace noonmark::test {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

enum class ShapeKind { rectangle, box, disc, sphere };

// - rectangle: the points at + s edge[0] + t edge[1] for s and t from 0 to 1. cross(edge[0], edge[1]) points to its
//   front.
// - box: any parallelepiped. Its three edges start at the corner `at` and are right-handed.
// - disc: its centre is `at`. It lies in the plane of edge[0] and edge[1], which are orthogonal.
// - sphere: its centre is `at`.
struct Shape {
  ShapeKind kind = ShapeKind::rectangle;
  glm::dvec3 at{0};
  std::array<glm::dvec3, 3> edge{};
  double radius = 0;
};

// The faces 0 to 5 of a box are its ends along the edges: -0, +0, -1, +1, -2, +2 (the order of add_box). Any other
// shape has one face, 0.
struct FlatFace {
  glm::dvec3 at, u, v;  // cross(u, v) points out of the box
};
FlatFace face_of(const Shape& shape, int face);

// The largest distance, in metres, by which rounding can have moved a vertex of the scene: one float step along each
// axis, which is 2^-23 of the largest coordinate on that axis. raytrace/vertex_rounding.h gives the reason for a whole
// step.
double vertex_rounding_m(const Scene& scene);

// A receiver P and the face that it lies on.
struct Place {
  glm::dvec3 p{0};
  int shape = 0;
  int face = 0;
};

// The point at depth d is start + d way. Its coordinates are metres from the frame's origin, along the world's axes.
struct LightRay {
  glm::dvec3 start, way;
};

// All lines through one point, which may be at infinity. Along a straight way from one ray to another, one member of
// their LightRay is constant. The other is affine; if it is `way`, this does not hold for its length.
struct Rays {
  bool parallel = true;
  glm::dvec3 centre{0};  // the common point; if parallel: the common direction, of length 1
  glm::dvec3 axis{0};    // depths are measured along this axis; 0: along each ray

  double nearest() const { return parallel ? -infinity : 0; }  // least depth of a hit
  LightRay through(glm::dvec3 p) const;
  LightRay between(const LightRay& from, const LightRay& to, double t) const;

 private:
  glm::dvec3 normal(glm::dvec3 way) const;
};

// A part of the way from one ray (0) to another (1).
struct Interval {
  double begin = 1, end = 0;
  bool empty() const { return !(begin <= end); }
  void keep_positive(double a, double b);  // keeps only the part where a + b s >= 0
};

// A shape, or one face of a box, and the rays through one point that may meet it.
struct Piece {
  int shape, face;
  ShapeKind kind;                    // rectangle, disc or sphere
  std::array<glm::dvec3, 4> corner;  // disc and sphere: corner[0] is the centre
  double radius;
  glm::dvec3 n{0};  // of length 1
  Rays rays{};
  bool edge_on = false;  // its plane contains the rays' common point: no ray meets it
  bool front = true;     // n points to the side from which the rays come

  Piece seen_by(const Rays& rays) const;
  bool covers(const LightRay& ray) const;
  // The smallest depth of at least `from` at which the ray meets the surface; infinity if there is none. The surface of
  // a flat piece is continued beyond its outline. If the ray passes beside a sphere, the depth of the place where it is
  // nearest to the centre counts instead.
  double depth(const LightRay& ray, double from) const;
  double depth(const LightRay& ray) const { return depth(ray, rays.nearest()); }
  double slope(const LightRay& ray) const;  // of the surface: depth per metre across the ray; 0 for spheres
  Interval along(const LightRay& from, const LightRay& to) const;
  double outline_distance(const LightRay& ray) const;  // metres; for a disc it is an upper bound

 private:
  double side(size_t edge, const LightRay& ray) const;
  struct Cone;
  Cone cone(const LightRay& ray) const;
};

class ClosedForm {
 public:
  // moved_m: 0, or the distance by which rounding may have moved the corners (vertex_rounding_m). With such a distance,
  // a step that rounding can have made is not a shadow edge. If the answers with 0 and with this distance differ, the
  // answer depends on rounding.
  ClosedForm(const std::vector<Shape>& shapes, const LightFrame& frame, double moved_m = 0);

  LightRay ray_to(glm::dvec3 world) const { return rays_.through(world - frame_.origin_m); }
  // The ray of one tap at P. The offset is in texels for a flat map, in metres of the world for a cube map.
  LightRay ray_of_tap(glm::dvec3 p, glm::dvec3 offset) const;
  LightRay ray_of_texel(glm::ivec2 texel) const;
  // The position of a ray in the map's image, in texels (OpenGL 4.5 core, section 8.13 and table 8.19).
  glm::dvec2 texels_of(const LightRay& ray) const;

  // Depths are those that the map measures: metres along a directional light or a spot light's axis, or the distance
  // from a point light.
  double window_depth(double depth_m) const;
  double near_depth(const LightRay& ray) const;  // where the ray crosses the map's near plane

  bool facing(glm::dvec3 p, glm::dvec3 normal) const;
  // Whether the plane of P's face contains the ray to P. Then the rounding of P decides on which side of the plane the
  // light is.
  bool edge_on(const Place& place) const { return own_piece(place).edge_on; }

  // R1: whether no other surface lies between the light and P. P is moved along the ray onto its own face. Not for P on
  // the inside of a sphere, because the sphere itself is not tested.
  bool lit(const Place& place) const;

  // V(P, x). Not for P on a sphere, because its sheet depends on the sphere's triangles.
  bool lit_at(const Place& place, const LightRay& x) const { return answer_at(place, x).lit; }
  struct Answer {
    bool lit = true;
    bool by_jumps = false;    // the jumps of the first-hit depth between P and x decided the answer
    double jump_m = 0;        // the largest of these jumps
    bool walked_off = false;  // P's sheet ended before x
  };
  Answer answer_at(const Place& place, const LightRay& x) const;

  // The smallest depth of a hit that is at least `from`; infinity if there is no such hit.
  double first_depth(const LightRay& x, double from) const;
  double first_depth(const LightRay& x) const { return first_depth(x, rays_.nearest()); }

  // If a ray passes up to reach_m beside x, the depth at which it meets one of x's surfaces differs by at most this.
  double beside_m(const LightRay& x, double reach_m) const;

  // Whether a map may hold this window depth at x, within `error`, if its ray may pass up to reach_m beside x. `from`
  // is where the near plane cuts the ray.
  // - It may hold the depth of the first surface behind `from`.
  // - It may hold the depth of a surface that is so little behind the first one that the ray may meet either first. The
  //   first one may also be so near to `from` that the near plane cuts it.
  // - It may hold any depth if x passes an outline within reach_m.
  bool may_hold(const LightRay& x, double from, double window, double error, double reach_m) const;

  // R0 under a sun: the fraction of the sun's disc that P sees above its own horizon. The normal is that of P, on the
  // viewer's side. The disc is divided into chords, because the interval of a chord that a shape covers is known
  // exactly.
  double seen(const Place& place, glm::dvec3 normal, double angular_diameter_deg, int chords = 512) const;

  // Whether the ray passes within `reach` metres of an outline, or of a place where the depths of two shapes cross.
  bool near_edge(const LightRay& x, double reach) const;

  double size_m() const { return size_m_; }  // no shape is further than this from the frame's origin

 private:
  const Piece& own_piece(const Place& place) const;
  struct Sheet {
    double depth_m;    // S
    double slope;      // of the plane that S was computed from
    bool ended_early;  // the sheet ended before x
  };
  Sheet sheet(const Piece& own, const LightRay& from, const LightRay& x) const;
  double largest_jump(const Piece& own, const LightRay& from, const LightRay& to, double apart_m) const;
  double half_width_m(double depth_m) const;
  double tie(double slope_a, double slope_b) const;
  bool one_plane(const Piece& a, const Piece& b) const;
  bool is_step(const Piece& before, const Piece& after, const LightRay& at, double jump_m) const;

  LightFrame frame_;
  Rays rays_;
  std::vector<Piece> pieces_;
  double size_m_ = 0, moved_m_;
};

}  // namespace noonmark::test
