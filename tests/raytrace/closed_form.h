// The truth by formula: scenes of rectangles, boxes, discs and spheres as analytic shapes, in double, under a light of
// any kind. No triangles, no rays through a tree, no code of raytrace/, and of technique/light_frame.h only the numbers
// that say where the light and its map are: what the tracer says of such scenes is held against this.
//
//   ClosedForm truth(shapes, frame);
//   truth.lit({P, shape, face});                                     // R1
//   truth.lit_at({P, shape, face}, truth.ray_of_texel({i, j}));      // V(P, x)
//
// The centre of a light is one point, at infinity under a directional light, and its rays are the lines through that
// point. So one set of formulas is enough for all lights: a shape is met by the rays inside its outline, at a depth that
// is a smooth function of the ray. The first hit is a lower envelope, shadow edges are outlines, and every jump of the
// first-hit depth between two rays lies where the straight way between them crosses an outline.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "technique/light_frame.h"

namespace noonmark::test {

enum class ShapeKind { rectangle, box, disc, sphere };

// rectangle: at + s edge[0] + t edge[1], its front towards cross(edge[0], edge[1]); box: all three edges from the
// corner `at`, right-handed (any parallelepiped); disc: radius about `at` in the plane of edge[0] and edge[1], which
// are orthogonal; sphere: radius about `at`.
struct Shape {
  ShapeKind kind = ShapeKind::rectangle;
  glm::dvec3 at{0};
  std::array<glm::dvec3, 3> edge{};
  double radius = 0;
};

// A box's faces: -0, +0, -1, +1, -2, +2 along its edges (the order of add_box). Other shapes have one face.
struct FlatFace {
  glm::dvec3 at, u, v;  // cross(u, v) points out of the box
};
FlatFace face_of(const Shape& shape, int face);

// What rounding of the vertices may have moved a corner of the scene by, in metres: a float step in each of three axes.
double vertex_rounding_m(const Scene& scene);

struct Place {
  glm::dvec3 p{0};
  int shape = 0;
  int face = 0;
};

// The point at depth d is start + d way, in metres from the frame's origin along the world's axes.
struct LightRay {
  glm::dvec3 start, way;
};

// All lines through one point, which may be at infinity. Both members of their LightRay are affine along a straight way
// from one ray to another, up to the length of `way`: one of the two is constant.
struct Rays {
  bool parallel = true;
  glm::dvec3 centre{0};  // the common point; parallel: the common direction, of length 1
  glm::dvec3 axis{0};    // depths are measured along it; 0: along each ray

  double nearest() const { return parallel ? -std::numeric_limits<double>::infinity() : 0; }  // least depth of a hit
  LightRay through(glm::dvec3 p) const;
  LightRay between(const LightRay& from, const LightRay& to, double t) const;

 private:
  glm::dvec3 normal(glm::dvec3 way) const;
};

// A part of the way from one ray (0) to another (1).
struct Interval {
  double begin = 1, end = 0;
  bool empty() const { return !(begin <= end); }
  void keep_positive(double a, double b);  // the part where a + b s >= 0
};

// A shape, or a face of a box, and how the rays through one point see it.
struct Piece {
  int shape, face;
  ShapeKind kind;                    // rectangle, disc or sphere
  std::array<glm::dvec3, 4> corner;  // disc and sphere: the centre first
  double radius;
  glm::dvec3 n{0};  // of length 1
  Rays rays{};
  bool edge_on = false;  // has no outline to speak of
  bool front = true;     // n points against the rays

  Piece seen_by(const Rays& rays) const;
  bool covers(const LightRay& ray) const;
  // Of its surface on the ray from depth `from` on, also beyond a flat piece's outline; infinity if there is none.
  double depth(const LightRay& ray, double from) const;
  double depth(const LightRay& ray) const { return depth(ray, rays.nearest()); }
  double slope(const LightRay& ray) const;  // depth per metre across the ray; 0 for spheres
  Interval along(const LightRay& from, const LightRay& to) const;
  double outline_distance(const LightRay& ray) const;  // metres; of a disc: an upper bound

 private:
  double side(size_t edge, const LightRay& ray) const;
  struct Cone;
  Cone cone(const LightRay& ray) const;
};

class ClosedForm {
 public:
  // moved_m: 0, or what rounding may have moved the corners by: then no step that it can have made is an edge. Where
  // a form with 0 and one with moved_m differ, the answer depends on rounding.
  ClosedForm(const std::vector<Shape>& shapes, const LightFrame& frame, double moved_m = 0);

  LightRay ray_to(glm::dvec3 world) const { return rays_.through(world - frame_.origin_m); }
  // Of one tap at P: offset in texels of a flat map, in metres of the world for a cube.
  LightRay ray_of_tap(glm::dvec3 p, glm::dvec3 offset) const;
  LightRay ray_of_texel(glm::ivec2 texel) const;
  // Where a ray lies in the map's image, in texels: OpenGL 4.5 core, 8.13 and table 8.19.
  glm::dvec2 texels_of(const LightRay& ray) const;

  // Depths are what the map measures: metres along the light or a spot's axis, or from a point light.
  double window_depth(double depth_m) const;
  double near_depth(const LightRay& ray) const;

  bool facing(glm::dvec3 p, glm::dvec3 normal) const;
  // P's plane holds the ray to P: which side of it the light is on, P's rounding says.
  bool edge_on(const Place& place) const { return own_piece(place).edge_on; }

  // R1: nothing lies between the light and P, P taken on its own face (a sphere's inside is never asked for).
  bool lit(const Place& place) const;

  // V(P, x); not for P on a sphere, whose sheet depends on its triangles.
  bool lit_at(const Place& place, const LightRay& x) const { return answer_at(place, x).lit; }
  struct Answer {
    bool lit = true;
    bool by_jumps = false;    // the first-hit depth's jumps between P and x decided
    double jump_m = 0;        // the largest of them
    bool walked_off = false;  // the walk on P's sheet ended before x
  };
  Answer answer_at(const Place& place, const LightRay& x) const;

  // Depth of what the light meets first from `from` on; infinity where there is nothing.
  double first_depth(const LightRay& x, double from) const;
  double first_depth(const LightRay& x) const { return first_depth(x, rays_.nearest()); }

  // How far in depth a ray that passes up to reach_m beside may meet a surface that x meets.
  double beside_m(const LightRay& x, double reach_m) const;

  // May a map hold this window depth, to within `error`? That of the first surface from `from` on, or of one so little
  // behind it that a ray that passes up to reach_m beside may meet it (`from` may cut what is first, too); anything where
  // an outline is as near as that.
  bool may_hold(const LightRay& x, double from, double window, double error, double reach_m) const;

  // R0: the share of the sun's disc that P sees above its own horizon (normal: on the viewer's side). The disc is cut
  // into chords, on which every shape covers an interval that is known exactly.
  double seen(const Place& place, glm::dvec3 normal, double angular_diameter_deg, int chords = 512) const;

  // Is the ray within `reach` metres of an outline, or of a place where two shapes' depths cross?
  bool near_edge(const LightRay& x, double reach) const;

  double size_m() const { return size_m_; }

 private:
  const Piece& own_piece(const Place& place) const;
  struct Sheet {
    double depth_m;  // S
    double slope;    // of the plane that it was read off, there
    bool ended_early;
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
