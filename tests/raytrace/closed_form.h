// The truth by formula: scenes of rectangles, boxes, discs and spheres as analytic shapes, in double. It uses no
// triangles, no rays through a tree and no code of raytrace/. The results of the tracer in such scenes are compared
// with it.
//
//   ClosedForm truth(shapes, frame);
//   truth.lit({P, shape, face});                        // R1
//   truth.lit_at({P, shape, face}, frame.texel_centre({i, j}));   // V(P, x)
//
// Everything is computed in the light's plane: a directional light meets each shape in a range of places x (inside the
// shape's outline), at a depth that is a smooth function of x. So the first hit is a lower envelope, shadow edges are
// outlines, and along a straight way the first-hit depth jumps only where the way crosses an outline.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <utility>
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

// Whether two faces may have been parts of one plane before rounding moved their corners by up to moved_m. The plane of
// a narrow face has a larger error when it is continued beyond the face.
bool may_be_one_plane(const FlatFace& a, const FlatFace& b, double moved_m);

// How far rounding may have moved a vertex of the scene, in metres: a float step on each of three axes.
double vertex_rounding_m(const Scene& scene);

struct Place {
  glm::dvec3 p{0};
  int shape = 0;
  int face = 0;
};

class ClosedForm {
 public:
  // moved_m: 0, or how far rounding may have moved the corners. In the second case a step that rounding can have made
  // is not an edge. If a form with 0 and a form with moved_m differ, the answer depends on rounding.
  ClosedForm(const std::vector<Shape>& shapes, const LightFrame& frame, double moved_m = 0);

  // R1: whether nothing lies between the light and P. P is taken to lie on its own face. It must not lie on a sphere's
  // far side.
  bool lit(const Place& place) const;

  // The depth, in metres along the light, of the first hit at x from z_from on; infinity if there is none.
  double first_depth(glm::dvec2 x, double z_from = -std::numeric_limits<double>::infinity()) const;

  // V(P, x); not for P on a sphere, whose sheet depends on its triangles.
  bool lit_at(const Place& place, glm::dvec2 x) const { return answer_at(place, x).lit; }
  struct Answer {
    bool lit = true;
    bool by_jumps = false;  // decided by the first-hit depth's jumps between P and x
    double jump_m = 0;      // the largest of them
  };
  Answer answer_at(const Place& place, glm::dvec2 x) const;

  // Whether a map may hold depth z_m at x, to within error_m. It may hold the first depth from z_from on, or that of a
  // surface so little behind it that a ray up to reach_m from x may meet it. If an outline is within reach_m, it may
  // hold any depth.
  bool may_be_first(glm::dvec2 x, double z_from, double z_m, double error_m, double reach_m) const;

  // R0: the share of the sun's disc that P sees above its own horizon (normal: on the viewer's side). The disc is cut
  // into chords. On a chord every shape covers an interval that is known exactly.
  double seen(const Place& place, glm::dvec3 normal, double angular_diameter_deg, int chords = 512) const;

  // Whether x is within `reach` metres of an outline, or of a place where two shapes' depths cross.
  bool near_edge(glm::dvec2 x, double reach) const;

  glm::dvec2 in_plane(glm::dvec3 p) const { return glm::dvec2(frame_.to_light(p)); }
  double size_m() const { return size_m_; }

 private:
  // One smooth range of depths in the light's plane: a parallelogram, an ellipse, or the near half of a sphere.
  struct Piece {
    int shape, face;
    ShapeKind kind;       // rectangle, disc or sphere
    glm::dvec3 at, u, v;  // light coordinates
    glm::dvec3 world_at, world_u, world_v;
    double radius;
    glm::dvec2 gradient{0};  // of the depth; flat pieces only
    bool edge_on = false;    // its outline encloses no area
    bool front = true;       // a box's face: its outside is towards the light
  };
  struct Interval {
    double begin = 1, end = 0;
    bool empty() const { return !(begin <= end); }
  };

  glm::dvec2 local(const Piece& piece, glm::dvec2 x) const;
  bool covers(const Piece& piece, glm::dvec2 x) const;
  double depth(const Piece& piece, glm::dvec2 x) const;
  Interval along(const Piece& piece, glm::dvec2 from, glm::dvec2 to) const;
  const Piece& own_piece(const Place& place) const;
  double sheet_depth(const Place& place, glm::dvec2 x) const;
  double largest_jump(const Piece& own, glm::dvec2 from, glm::dvec2 to) const;
  double tie(const Piece& a, const Piece& b) const;
  double steepest(glm::dvec2 x) const;
  double outline_distance(const Piece& piece, glm::dvec2 x) const;
  Interval shaded(const Piece& piece, glm::dvec3 p, glm::dvec3 start, glm::dvec3 way) const;

  static FlatFace flat(const Piece& p) { return {p.at, p.u, p.v}; }
  bool one_plane(const Piece& a, const Piece& b) const;
  bool is_step(const Piece& before, const Piece& after, double jump_m) const;

  LightFrame frame_;
  std::vector<Piece> pieces_;
  double size_m_ = 0, moved_m_;
};

}  // namespace noonmark::test
