// Cells of the light's plane in which R1, and the first hit of a light-side ray, is known without a ray. Every answer is
// the one that the program's own rays give, with certainty; where that cannot be proved, the answer is `unknown`, and the
// rays are cast.
//
//   LightCells cells(adjacency, view, traced.embree.near_distance(), 1024);  // built once for a light
//   LightCells::Reader reader(cells);                                // one for each thread
//   LightCells::Answer a = reader.at(frame.to_light(P), primitive);  // of a receiver that is not grazing
//   std::optional<uint32_t> triangle = reader.first_hit(x);          // of the light-side ray through a place
//
// A square of the light's plane is *good* if one surface F lies before everything else in it. The receivers on F are
// lit there, all others are dark. A square that is not good is divided into four, down to `finest` on a side.
// Squares are made when a receiver is first looked up in them. What a square says follows from the scene, the light and
// the square alone, so answers and ray counts do not depend on the order of the questions, nor on threads.
//
// ---- Why a good square answers as the rays do
//
// Let e be LightView::start_error_m, how far a receiver's five rays start beside P and more than a float ray passes
// beside its exact place, and `near` be EmbreeScene::near_distance(), below which is_occluder() decides in double, or
// 64 e if that is more. All statements are about the square widened by reach_m = e + Silhouettes::reach_of, which is at
// least e + 2 ray_error_m (and where no mask is cut, 3 e). The five rays lie at most e beside P, and each is off by at
// most ray_error_m, so the widened square holds all that they can meet.
// The triangles of the widened square are listed without gaps. Copies are not among them, because no ray meets them.
//   1. F covers the widened square. It is one triangle that covers it, or a sheet: a triangle together with all
//      triangles that follow over the edges at which the surface goes on (each_beyond(), the rule of the silhouettes).
//      All these edges go on, wherever they touch the widened square, so the sheet has no border in it.
//   2. F covers each place only once: of two triangles of the sheet, an edge of one separates their shadows on the
//      light's plane. This excludes sheets that wind around a point and lie above themselves.
//   3. Everything else lies deeper than F by more than gap_m = 4 near.
//   4. The receiver is not grazing: N.L >= least_cosine = 1/16. Its five rays start beside its own plane, by the rounding
//      of P along the ray (ShadowStart::beside(): at most 2^-23 * 2 |P| / (1/16) < near / 64) and by e times the slope
//      of the plane (16 e <= near / 4).
// A receiver on F is lit: what lies deeper lies behind the start of all its rays. Other triangles of F are met only
// beyond the edges of its own triangle. If F is more than one triangle, P must lie in its own triangle and more than
// reach_m from its edges. So each ray can meet its own triangle only, which is no occluder.
// A receiver that is not on F is dark: each ray meets F, at a distance of more than gap_m - near > near and of more than
// twice its own plane's. There is_occluder() is true, whatever the triangle. Edges that go on have bitwise equal ends,
// and Embree's robust test lets no ray pass between such triangles.
// All five rays agree, so the receiver is not ambiguous.
//
// If F is a sheet, whether a receiver is on it is read off its depth: F ends before split_m, everything else lies behind
// it, each by 2 near.
// In a finest square that is not good, the same is asked of the place of P itself: a square without extent, widened by
// reach_m. Beside a silhouette most receivers are answered so.
//
// A light-side ray passes at most e beside its place. So where one triangle covers the widened square of the place and
// everything else lies deeper by gap_m, it is the first hit.
//
// ---- Why the rays to all of a sun meet the same
//
// A ray from P to a place of the disc is, s metres nearer to the light, at most s tangent beside P. A square is *out of
// reach* if a ray is nearer to the light than all that is in the square before it comes there. If all squares are either
// good or out of reach, and P's own square is good:
//   - F is the first surface at each place of a good square, so it is one continuous surface over neighbouring good
//     squares. Where its slope times tangent is at most 1/2, s metres of a ray bring it at least s / 2 further from F.
//   - A ray from a receiver on F never meets F again: it leaves its own triangle at least reach_m beside P, and is then at
//     least reach_m / (2 tangent) before F; a float ray, e beside it, is nearer to F by at most e / (2 tangent). Where it
//     enters a square out of reach, it lies before everything there and, at the border, before F. So each receiver that
//     is lit sees the whole disc.
//   - A ray from a receiver behind F ends before everything. On its way F is continuous until it is before F, so it meets
//     F, at a distance of at least 2 / 3 of gap_m > near. So each dark receiver sees nothing of the disc.
//   - No ray starts below the receiver's own horizon, because N.L is greater than tangent.
//
// ---- Why V is one verdict in a rectangle
//
// If the rectangle lies in good squares, the first hit at each place in it belongs to the F of that square, and all else lies
// deeper by gap_m. If the triangle of the receiver covers the rectangle too, by more than reach_m, it is the receiver's sheet
// at each place: V compares F and this triangle only (OwnSurface::known_in). If F is several triangles, the receiver's is one of
// them where its plane is before split_m in all the rectangle, and lies behind them where it is behind split_m. The same holds
// of a triangle to which the walk from P to each place of the rectangle leads (OwnSurface::known_on_sheet). If the walks end, S is
// at most the depth of P's plane: V is lit where everything in the squares is deeper than that.
// In a finest square that is not good, or whose front is a sheet, the first of this is asked of a square around what it holds of the
// rectangle.
//
// Only parallel rays have cells so far.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "raytrace/adjacency.h"
#include "raytrace/light_view.h"

namespace noonmark {

// Bytes of the cells of a light, which are made where receivers lie [11 for each pixel, FlightHelmet at 1280 x 720], under 192 MiB.
inline double light_cell_bytes(double pixels) { return std::min(40 * pixels, 202e6); }

class LightCells {
 public:
  static constexpr double least_cosine = 1.0 / 16;
  // Squares take at most so much memory. When it is used up, no square is divided any more.
  static constexpr size_t most_bytes = size_t{192} << 20;

  // near_m: EmbreeScene::near_distance(). finest: about the number of the finest squares along a side. adjacency must
  // outlive it.
  LightCells(const Adjacency& adjacency, const LightView& view, double near_m, int finest);
  // What is worth its time for so many receivers.
  static int finest_for(const ReceiverImage& receivers);
  int finest() const { return finest_; }
  double gap_m() const { return gap_m_; }
  ~LightCells();
  LightCells(const LightCells&) = delete;
  LightCells& operator=(const LightCells&) = delete;

  enum class Answer : uint8_t { unknown, lit, dark };
  class Reader;

  // A square of the light's plane; widened.
  struct Square {
    glm::dvec2 middle;
    double half;  // of its side
    bool touches(glm::dvec2 low, glm::dvec2 high) const {
      return middle.x - half <= high.x && middle.x + half >= low.x && middle.y - half <= high.y &&
             middle.y + half >= low.y;
    }
  };
  // The front of a good square.
  struct Front {
    uint32_t triangle = no_primitive;     // or no_primitive, if it is a sheet of several triangles
    double split_m = 0;                   // of a sheet: it ends before this depth, and everything else lies behind it
    double nearest_m = 0;                 // nothing is nearer to the light
    std::span<const uint32_t> triangles;  // of a sheet: all that touch the square, those of the sheet among them
    Square square;
  };
  // Whether one of `triangles` belongs to the sheet.
  bool in_sheet(const Front& front, uint32_t triangle) const {
    return part(triangle, outline(triangle), front.square).least < front.split_m;
  }

  // The triangles among which the exact ray through a place meets its first one, in the order of
  // LightView::nearest_m(); no value if they are not known.
  std::optional<std::span<const uint32_t>> candidates(glm::dvec3 at);

 private:
  enum class Kind : uint8_t { mixed, nothing, triangle, sheet };
  struct Four;
  // What is known of a widened square.
  struct Judged {
    Kind kind = Kind::mixed;
    uint32_t front = no_primitive;                               // Kind::triangle: F
    double split_m = 0;                                          // Kind::sheet
    double nearest_m = std::numeric_limits<double>::infinity();  // no triangle is nearer to the light
    double slope = 0;  // good squares: how much deeper F becomes for a metre, at most
  };
  struct Cell : Judged {
    uint8_t divisions = 0;  // how many times it can be divided
    std::atomic<Four*> four{nullptr};
    // That touch the widened square; empty if one covers all others, or if it is divided. If it will not be divided
    // any more, they are in the order of LightView::nearest_m().
    std::vector<uint32_t> triangles;
    bool ends_here() const { return kind != Kind::mixed || divisions == 0; }
  };
  // The triangles of the undivided squares: those of square i are listed[begin[i]] to listed[begin[i + 1] - 1].
  struct Lists {
    std::vector<uint32_t> begin, listed;
  };
  // A triangle as the light sees it.
  struct Outline {
    glm::dvec2 corner[3];
    glm::dvec2 low, high;
    double sign;  // of its orientation
    // Twice the area of the triangle of an edge and a place; positive if the place lies on the edge's inner side.
    double inside(int edge, glm::dvec2 place) const {
      const glm::dvec2 from = corner[edge], way = corner[(edge + 1) % 3] - from, to = place - from;
      return sign * (way.x * to.y - way.y * to.x);
    }
    // How much that differs at most within a square.
    double spread(int edge, double half) const {
      const glm::dvec2 way = corner[(edge + 1) % 3] - corner[edge];
      return half * (std::abs(way.x) + std::abs(way.y));
    }
  };
  // What a triangle is within a square.
  struct Part {
    uint32_t triangle;
    Outline outline;
    double least, most;    // depth
    double at_middle = 0;  // of its plane
    glm::dvec2 gradient{0};
    bool flat = true;     // the plane is not edge-on
    bool covers = false;  // all of the square
  };

  // The finest square of a place; false if it lies outside all squares.
  bool fine_at(glm::dvec2 light, uint32_t& x, uint32_t& y) const {
    const glm::dvec2 at = place(light);
    const double size = fine_size_;
    if (!(at.x >= 0 && at.y >= 0 && at.x < size && at.y < size)) return false;
    x = static_cast<uint32_t>(static_cast<int32_t>(at.x));
    y = static_cast<uint32_t>(static_cast<int32_t>(at.y));
    return true;
  }
  // Places in units of the finest squares.
  glm::dvec2 place(glm::dvec2 light) const { return (light - low_) * fine_per_m_; }
  Square square_at(uint32_t x, uint32_t y, int divisions) const;
  Outline outline(uint32_t triangle) const;
  static bool touches(const Outline& triangle, const Square& square);
  static bool edge_touches(const Outline& triangle, int edge, const Square& square);
  static bool apart(const Outline& a, const Outline& b);
  std::optional<Lists> list_base() const;
  Cell* base_cell(uint32_t x, uint32_t y);
  Four* divide(Cell& cell, uint32_t x, uint32_t y);  // x, y: of a finest square in it
  // Null if there is no memory to divide it.
  Four* parts_of(Cell& cell, uint32_t x, uint32_t y) {
    Four* const made = cell.four.load(std::memory_order_acquire);
    return made ? made : divide(cell, x, y);
  }
  const Cell& cell_at(uint32_t x, uint32_t y);  // the smallest one
  void judge(Cell& cell, const Square& square) const;
  // Whether the rectangle around any of the triangles holds the square: no other can cover it.
  bool any_may_cover(std::span<const uint32_t> triangles, const Square& square) const;
  Part part(uint32_t triangle, const Outline& outline, const Square& square) const;
  // parts: of all triangles that touch the square, but perhaps without some that come no nearer to the light than
  // others_m and lie deeper than a triangle that covers the square, by more than gap_m.
  Judged judge(const std::vector<Part>& parts, double others_m, const Square& square) const;
  bool judge_triangle(const std::vector<Part>& parts, const Square& square, Judged& judged) const;
  bool judge_sheet(const std::vector<Part>& parts, double others_m, const Square& square, Judged& judged) const;
  // Lists those of a cell's triangles that touch a square in it, for judge(): what is before others_m. No value if they are too
  // many.
  std::optional<double> list_parts(std::span<const uint32_t> triangles, const Square& square,
                                   std::vector<Part>& parts) const;
  // The square without extent at this place of a cell.
  Judged judge_place(const Cell& cell, glm::dvec2 at) const;
  // The triangle that is the front of a cell's part of a rectangle, if one is. triangles, cell: its own.
  std::optional<uint32_t> front_of_part(std::span<const uint32_t> triangles, const Square& cell, glm::dvec2 low,
                                        glm::dvec2 high) const;
  // Whether holds(part, x, y) is true of the cell's four parts, each with its first finest square; false if it is not divided.
  template <class Holds>
  bool all_parts_hold(Cell& cell, uint32_t x, uint32_t y, const Holds& holds);
  // Whether the cell is out of reach of the disc as `at` sees it, or good, or divided into such cells.
  bool disc_is_certain(Cell& cell, uint32_t x, uint32_t y, glm::dvec3 at, double tangent);
  // Whether visit(front) is true of the cell, or of all its parts that touch the rectangle.
  template <class Visit>
  bool each_front_in(Cell& cell, uint32_t x, uint32_t y, glm::dvec2 low, glm::dvec2 high, const Visit& visit);
  // Of a cell that is not divided.
  bool visit_front(const Cell& cell, uint32_t x, uint32_t y, glm::dvec2 low, glm::dvec2 high, const auto& visit) const {
    const Square square = square_at(x, y, cell.divisions);
    if (cell.kind == Kind::triangle || cell.kind == Kind::sheet)
      return visit(Front{cell.front, cell.split_m, cell.nearest_m, cell.triangles, square});
    if (cell.kind == Kind::nothing || !cell.ends_here()) return false;
    if (!Square{square.middle, square.half - reach_m_}.touches(low, high))
      return true;  // it holds nothing of the rectangle
    const std::optional<uint32_t> front = front_of_part(cell.triangles, square, low, high);
    return front && visit(Front{*front, 0, cell.nearest_m, {}, square});
  }
  // Whether all in the parts of the cell that touch the rectangle is deeper than this.
  bool all_deeper(Cell& cell, uint32_t x, uint32_t y, double depth_m, glm::dvec2 low, glm::dvec2 high);
  void free_below(Cell& cell);

  int finest_;
  const Adjacency& adjacency_;
  LightView view_;
  double reach_m_, gap_m_;
  uint32_t triangles_ = 0;                                      // without copies
  double nearest_m_ = std::numeric_limits<double>::infinity();  // of the scene
  glm::dvec2 low_{0};
  double fine_per_m_ = 0;
  uint32_t base_size_ = 0;  // undivided squares on a side
  int divisions_ = 0;       // of an undivided square
  uint32_t fine_size_ = 0;  // finest squares on a side; 0: there are no squares
  Lists lists_;
  std::vector<std::atomic<Cell*>> base_;
  std::atomic<size_t> bytes_{0};
  std::mutex locks_[64];
};

struct LightCells::Four {
  Cell cell[4];
};

template <class Holds>
bool LightCells::all_parts_hold(Cell& cell, uint32_t x, uint32_t y, const Holds& holds) {
  Four* const four = cell.divisions > 0 ? parts_of(cell, x, y) : nullptr;
  if (!four) return false;
  const uint32_t half = 1u << (cell.divisions - 1);
  for (uint32_t i = 0; i < 4; ++i)
    if (!holds(four->cell[i], x + i % 2 * half, y + i / 2 * half)) return false;
  return true;
}

template <class Visit>
bool LightCells::each_front_in(Cell& cell, uint32_t x, uint32_t y, glm::dvec2 low, glm::dvec2 high,
                               const Visit& visit) {
  // Widened: squares beside the rectangle may be asked too.
  if (!square_at(x, y, cell.divisions).touches(low, high)) return true;
  if (cell.ends_here()) return visit_front(cell, x, y, low, high, visit);
  return all_parts_hold(
      cell, x, y, [&](Cell& part, uint32_t px, uint32_t py) { return each_front_in(part, px, py, low, high, visit); });
}

// Remembers the square of the last question, because neighbouring pixels mostly lie in one square.
class LightCells::Reader {
 public:
  explicit Reader(LightCells& cells) : cells_(cells) {}

  // at: P in the light's frame. primitive: its triangle, and no copy. Its N.L is at least least_cosine.
  Answer at(glm::dvec3 at, uint32_t primitive) {
    if (!find(at)) return Answer::unknown;
    return cell_->kind == Kind::mixed ? answer(cells_.judge_place(*cell_, glm::dvec2(at)), at, primitive)
                                      : answer(*cell_, at, primitive);
  }

  // The triangle that the ray through this place meets first, or no_primitive; no value where the float ray may meet
  // another one than the exact ray.
  std::optional<uint32_t> first_hit(glm::dvec3 at) {
    if (!find(at)) return std::nullopt;
    if (cell_->kind == Kind::triangle) return cell_->front;
    if (cell_->kind == Kind::nothing) return no_primitive;
    const Judged place = cells_.judge_place(*cell_, glm::dvec2(at));
    if (place.kind == Kind::triangle) return place.front;
    if (place.kind == Kind::nothing) return no_primitive;
    return std::nullopt;
  }

  // The triangle that covers a rectangle of the light's plane before everything else, by gap_m() or more; no value if no
  // triangle is known to.
  std::optional<uint32_t> front_in(glm::dvec2 low, glm::dvec2 high);
  // Calls visit(front) for the squares that hold the rectangle. False if one of them is empty, or not good also in what it
  // holds of the rectangle, or if visit returns false.
  template <class Visit>
  bool each_front_in(glm::dvec2 low, glm::dvec2 high, const Visit& visit);
  // Whether all that lies in the rectangle, for sure, is deeper than this.
  bool all_deeper(double depth_m, glm::dvec2 low, glm::dvec2 high);
  // Whether the triangle covers the rectangle, and reach_m around it.
  bool covers(uint32_t triangle, glm::dvec2 low, glm::dvec2 high) {
    if (inner_.triangle != triangle) inner_ = Inner(cells_, triangle);
    return inner_.holds(low) && inner_.holds(high) && inner_.holds({low.x, high.y}) && inner_.holds({high.x, low.y});
  }
  const LightCells& cells() const { return cells_; }

  // at() for all rays to a disc of directions, whose radius is `tangent`: lit if no such ray meets an occluder, dark
  // if all do. The receiver's N.L is at least least_cosine + tangent.
  Answer disc_at(glm::dvec3 at, uint32_t primitive, double tangent);

 private:
  // Finds the square of a place; false if it lies outside all squares.
  bool find(glm::dvec3 at) {
    uint32_t x = 0, y = 0;
    if (!cells_.fine_at(glm::dvec2(at), x, y)) return false;
    if (((x ^ x_) | (y ^ y_)) >> shift_) find(x, y);
    return true;
  }
  void find(uint32_t x, uint32_t y);
  Answer answer(const Judged& square, glm::dvec3 at, uint32_t primitive) {
    if (square.kind == Kind::triangle) return square.front == primitive ? Answer::lit : Answer::dark;
    if (square.kind != Kind::sheet) return Answer::unknown;
    if (at.z > square.split_m) return Answer::dark;
    if (inner_.triangle != primitive) inner_ = Inner(cells_, primitive);
    return inner_.holds(glm::dvec2(at)) ? Answer::lit : Answer::unknown;
  }

  // The part of a triangle that is more than reach_m from its edges.
  struct Inner {
    uint32_t triangle = no_primitive;
    struct Edge {
      glm::dvec2 corner{0}, way{0};
      double least = 0;  // twice the area of the triangle of the edge and a place at that distance
    } edge[3];

    Inner() = default;
    Inner(const LightCells& cells, uint32_t of);
    bool holds(glm::dvec2 place) const {
      for (const Edge& e : edge) {
        const glm::dvec2 to = place - e.corner;
        if (!(e.way.x * to.y - e.way.y * to.x > e.least)) return false;
      }
      return true;
    }
  };

  LightCells& cells_;
  Inner inner_;  // of the last triangle that was asked for
  const Cell* cell_ = nullptr;
  uint32_t x_ = ~0u, y_ = ~0u;  // a finest square in it
  int shift_ = 0;               // its side is 2^shift finest squares
};

template <class Visit>
bool LightCells::Reader::each_front_in(glm::dvec2 low, glm::dvec2 high, const Visit& visit) {
  uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  if (!cells_.fine_at(low, x0, y0) || !cells_.fine_at(high, x1, y1)) return false;
  find(glm::dvec3(low, 0));
  if (!(((x0 ^ x1) | (y0 ^ y1)) >> shift_))  // all in one square
    return cells_.visit_front(*cell_, x0, y0, low, high, visit);
  const int divisions = cells_.divisions_;
  for (uint32_t y = y0 >> divisions; y <= y1 >> divisions; ++y)
    for (uint32_t x = x0 >> divisions; x <= x1 >> divisions; ++x)
      if (!cells_.each_front_in(*cells_.base_cell(x << divisions, y << divisions), x << divisions, y << divisions, low,
                                high, visit))
        return false;
  return true;
}

}  // namespace noonmark
