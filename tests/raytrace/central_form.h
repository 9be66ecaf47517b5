// The truth of spot and point lights by formula: scenes of rectangles, boxes and spheres as analytic shapes, in double,
// under a light whose rays all come from one point. It uses no triangles, no rays through a tree and no code of
// raytrace/, and of technique/light_frame.h only the numbers that say where the light stands. The results of the tracer
// are compared with it.
//
//   CentralForm truth(shapes, frame);
//   truth.lit({P, shape, face});                                        // R1
//   truth.lit_at({P, shape, face}, truth.way_of_texel({i, j}));         // V(P, x)
//
// A *way* is a direction in the world from the light. For a spot light its part along the axis is 1 m long; for a point
// light its own length is 1. A parallelogram is met in the ways between four planes through the light, at a depth that
// is a smooth function of the way. So the first hit is a lower envelope, shadow edges are outlines, and between two
// ways the first-hit depth jumps only where the arc between them crosses an outline.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "tests/raytrace/closed_form.h"  // Shape, Place

namespace noonmark::test {

class CentralForm {
 public:
  // moved_m: as in ClosedForm.
  CentralForm(const std::vector<Shape>& shapes, const LightFrame& frame, double moved_m = 0);

  glm::dvec3 way_to(glm::dvec3 world) const { return normal(world - frame_.origin_m); }
  // The way of one tap at P. The offset is in texels for a flat map, in metres of the world for a cube map.
  glm::dvec3 way_of_tap(glm::dvec3 p, glm::dvec3 offset) const;
  glm::dvec3 way_of_texel(glm::ivec2 texel) const;
  // Where a way lies in the map's image, in texels: OpenGL 4.5 core, 8.13 and table 8.19.
  glm::dvec2 texels_of(glm::dvec3 way) const;

  // The map measures these depths: metres along a spot light's axis, or from a point light.
  double window_depth(double depth_m) const;
  double near_depth(glm::dvec3 way) const;

  bool facing(glm::dvec3 p, glm::dvec3 normal) const;
  // Whether P's plane goes through the light. Then only P's rounding decides on which side of it the light is.
  bool edge_on(const Place& place) const { return own_piece(place).edge_on; }

  // R1: whether nothing lies between the light and P. P is taken to lie on its own face. It must not lie on the inner
  // side of a sphere.
  bool lit(const Place& place) const;

  // V(P, x); flat shapes only. p_lit: the result of lit(place).
  struct Answer {
    bool lit = true;
    bool by_jumps = false;    // decided by the first-hit depth's jumps between P and x
    bool walked_off = false;  // the walk ended before x
  };
  Answer answer_at(const Place& place, glm::dvec3 way, bool p_lit) const;

  // The depth of the first hit from depth_from on; infinity if there is none.
  double first_depth(glm::dvec3 way, double depth_from = 0) const;

  // Whether a map may hold this depth, to within error_m. It may hold the first depth from depth_from on, or that of a
  // surface so little behind it that a ray up to reach_m from the exact one may meet it. If an outline is within
  // reach_m, it may hold any depth.
  bool may_be_first(glm::dvec3 way, double depth_from, double depth_m, double error_m, double reach_m) const;

  // Whether the ray is within `reach` metres of an outline, or of a place where two shapes' depths cross.
  bool near_edge(glm::dvec3 way, double reach) const;

  double size_m() const { return size_m_; }

 private:
  // One smooth range of depths: a parallelogram or a sphere. From the light, in the world's axes.
  struct Piece {
    int shape, face;
    bool round;
    std::array<glm::dvec3, 4> corner;  // round: the centre first
    double radius;
    glm::dvec3 n{0};
    double height = 0;                 // n . corner: 0 when the light lies in its plane
    std::array<glm::dvec3, 4> wall{};  // planes through the light and an outline edge; ways over the piece are inside
    bool edge_on = false;
    bool front = true;  // a box's face: its outside is towards the light
  };
  struct Interval {
    double begin = 1, end = 0;
    bool empty() const { return !(begin <= end); }
  };

  glm::dvec3 normal(glm::dvec3 way) const;
  bool covers(const Piece& piece, glm::dvec3 way) const;
  double plane_depth(const Piece& piece, glm::dvec3 way) const;
  double slope(const Piece& piece, glm::dvec3 way) const;
  double tie(const Piece& a, const Piece& b, glm::dvec3 way) const;
  Interval along(const Piece& piece, glm::dvec3 from, glm::dvec3 to) const;
  const Piece& own_piece(const Place& place) const;
  struct Sheet {
    double depth_m;  // the depth S of the sheet
    double slope;    // of the plane that gave S, at that place
    bool ended_early;
  };
  Sheet sheet(const Piece& own, glm::dvec3 from, glm::dvec3 way) const;
  bool one_plane(const Piece& a, const Piece& b) const;
  bool is_step(const Piece& before, const Piece& after, glm::dvec3 way, double jump_m) const;
  bool has_jump(const Piece& own, glm::dvec3 from, glm::dvec3 to) const;

  LightFrame frame_;
  bool spot_;
  std::vector<Piece> pieces_;
  double size_m_ = 0, moved_m_;
};

}  // namespace noonmark::test
