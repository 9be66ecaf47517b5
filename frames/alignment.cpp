#include "frames/alignment.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "frames/check_statistics.h"

namespace noonmark {
namespace {

// A difference of a few pixels is explained by nothing.
constexpr size_t least_differing = 8;

bool has_both(const Coverage& coverage) {
  const auto [least, most] = std::minmax_element(coverage.pixels.begin(), coverage.pixels.end());
  return coverage.size() > 0 && *least != *most;
}

// What of `moved` lies at each pixel when the picture was shifted back. The border, which nothing is moved to, is left out.
size_t differing_after(const Coverage& moved, const Coverage& fixed, glm::ivec2 shift) {
  size_t count = 0;
  for (int y = std::max(0, -shift.y); y < fixed.height - std::max(0, shift.y); ++y)
    for (int x = std::max(0, -shift.x); x < fixed.width - std::max(0, shift.x); ++x)
      count += moved.at(x + shift.x, y + shift.y) != fixed.at(x, y);
  return count;
}

}  // namespace

std::optional<SurfaceAlignment> surface_alignment(const GivenFrame& frame) {
  if (frame.receivers == GivenReceivers::none) return std::nullopt;
  const Coverage shown = coverage_of_visibility(frame), given = coverage_of_positions(frame);
  if (!has_both(shown) || !has_both(given)) return std::nullopt;
  SurfaceAlignment found{.differing = differing(shown, given)};
  found.left = found.differing;
  if (found.differing < least_differing) return found;
  for (const PictureFlip& flip : flips)
    if (const size_t left = differing(flipped(shown, flip.left_to_right, flip.upside_down), given);
        left * 10 < found.differing && left < found.left)
      found.flip = &flip, found.left = left;
  if (found.flip) return found;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      if (const size_t left = differing_after(shown, given, {x, y});
          left * 10 < found.differing * 3 && left < found.left)
        found.shift = {x, y}, found.left = left;
  return found;
}

ValueAlignment value_alignment(const GivenFrame& frame, const ReceiverTruth& truth) {
  const Image<float>& v = frame.visibility;
  ValueAlignment found;
  for (size_t k = 0; k < flips.size(); ++k) {
    ValueAlignment::Compared& sum = found.by_flip[k];
    for (int y = 0; y < v.height; ++y)
      for (int x = 0; x < v.width; ++x) {
        const size_t i = v.index(x, y);
        const float here = v[i], there = v.at(flips[k].left_to_right ? v.width - 1 - x : x,
                                              flips[k].upside_down ? v.height - 1 - y : y);
        if (!truth.facing[i] || truth.ambiguous[i] || std::isnan(here) || std::isnan(there)) continue;
        ++sum.count;
        sum.delivered += std::abs(here - truth.soft[i]);
        sum.flipped += std::abs(there - truth.soft[i]);
      }
    if (sum.count == 0) continue;
    sum.delivered /= static_cast<double>(sum.count);
    sum.flipped /= static_cast<double>(sum.count);
  }
  return found;
}

const PictureFlip* ValueAlignment::flip() const {
  // So many pixels must be wrong that no small shadow decides.
  constexpr double least_wrong_pixels = 100;
  // Of a picture that is flipped back. A frame of a worse shadow is nearer to the truth by chance.
  constexpr double most_right = 0.1;
  const PictureFlip* best = nullptr;
  double least = 1;
  for (size_t k = 0; k < flips.size(); ++k) {
    const Compared& c = by_flip[k];
    if (c.delivered * static_cast<double>(c.count) >= least_wrong_pixels && 3 * c.flipped < c.delivered &&
        c.flipped < std::min(least, most_right)) {
      best = &flips[k];
      least = c.flipped;
    }
  }
  return best;
}

namespace {

void take_means(OutlineAlignment::Side& sums) {
  const auto of = [](size_t count) { return static_cast<double>(std::max<size_t>(1, count)); };
  sums.lit_wrong /= of(sums.lit), sums.dark_wrong /= of(sums.dark);
  sums.lit_pull /= of(sums.lit_inside), sums.dark_pull /= of(sums.dark_inside);
  sums.lit_next /= of(sums.lit_inside), sums.dark_next /= of(sums.dark_inside);
}

// The values across an outline, from inside the lit surface to inside the dark one.
void add_step(OutlineAlignment::Side& side, float lit_inside, float lit, float dark, float dark_inside) {
  const float step = lit_inside - dark_inside;
  if (!(step > 0.5f)) return;
  ++side.steps;
  side.ramps += lit - dark < step / 2 && std::abs(lit + dark - lit_inside - dark_inside) < step / 2;
}

class Outlines {
 public:
  explicit Outlines(const CheckEvidence& e)
      : e_(e), width_(e.frame.visibility.width), height_(e.frame.visibility.height), whole_(width_, height_, 0) {
    Image<uint8_t> at_step(width_, height_, 0);
    Image<float> reach(width_, height_, 0);
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        const size_t i = at_step.index(x, y);
        if (e.receivers.primitive[i] == no_primitive) continue;
        at_step[i] =
            is_step(x, y, x - 1, y) || is_step(x, y, x + 1, y) || is_step(x, y, x, y - 1) || is_step(x, y, x, y + 1);
        reach[i] = static_cast<float>(OutlineAlignment::outline_reach_px * e.pixel_m[i]);
      }
    // A true edge may end where the outline hides the surface, as at the foot of a block: rays tell it.
    const Image<uint8_t> has_edge = e.tracer.edge_within(e.receivers, e.truth, e.light, at_step, reach, e.pixel_m);
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) whole_.at(x, y) = at_step.at(x, y) && !has_edge.at(x, y) && is_seen_whole(x, y);
  }

  // Books the outline between the pixel and its neighbour.
  void book(OutlineAlignment::Side& side, int x, int y, int u, int v) const {
    const Image<float>& visibility = e_.frame.visibility;
    if (!is_step(x, y, u, v) || !whole_.at(x, y) || !whole_.at(u, v)) return;
    const size_t i = visibility.index(x, y), j = visibility.index(u, v);
    const bool lit = e_.truth.soft[i] == 1;
    ++(lit ? side.lit : side.dark);
    (lit ? side.lit_wrong : side.dark_wrong) += std::abs(visibility[i] - e_.truth.soft[i]);
    const std::optional<size_t> inside = same_surface(i, x, y, x - u, y - v);
    if (!inside || std::isnan(visibility[*inside])) return;
    if (const std::optional<size_t> beyond = same_surface(j, u, v, u - x, v - y); lit && beyond)
      add_step(side, visibility[*inside], visibility[i], visibility[j], visibility[*beyond]);
    const float next = visibility.at(x + (x - u), y + (y - v));
    const double darker = visibility[*inside] - visibility[i],
                 next_darker = std::isnan(next) ? 0 : visibility[*inside] - next;
    if (lit)
      ++side.lit_inside, side.lit_pull += darker, side.lit_next += next_darker;
    else
      ++side.dark_inside, side.dark_pull -= darker, side.dark_next -= next_darker;
  }

 private:
  bool apart(size_t a, size_t b) const {
    const ReceiverImage& r = e_.receivers;
    const glm::dvec3 way = glm::dvec3(r.position[b]) - glm::dvec3(r.position[a]);
    const double least = OutlineAlignment::apart_px * std::max(e_.pixel_m[a], e_.pixel_m[b]);
    return std::abs(glm::dot(glm::dvec3(r.normal[a]), way)) > least &&
           std::abs(glm::dot(glm::dvec3(r.normal[b]), way)) > least;
  }
  // Whether the two lie apart in depth, and one of them is lit and the other not.
  bool is_step(int x, int y, int u, int v) const {
    if (u < 0 || v < 0 || u >= width_ || v >= height_) return false;
    const size_t i = whole_.index(x, y), j = whole_.index(u, v);
    return e_.receivers.primitive[j] != no_primitive && std::abs(e_.truth.soft[i] - e_.truth.soft[j]) == 1 &&
           apart(i, j);
  }
  // Whether all receivers nearby that may lie on the pixel's own surface have its truth.
  bool is_seen_whole(int x, int y) const {
    constexpr int reach = OutlineAlignment::outline_reach_px;
    const size_t i = whole_.index(x, y);
    for (int v = std::max(0, y - reach); v <= std::min(height_ - 1, y + reach); ++v)
      for (int u = std::max(0, x - reach); u <= std::min(width_ - 1, x + reach); ++u) {
        const size_t j = whole_.index(u, v);
        if (e_.receivers.primitive[j] == no_primitive || apart(i, j)) continue;
        if (!e_.truth.facing[j] || e_.truth.ambiguous[j] || e_.truth.soft[j] != e_.truth.soft[i]) return false;
      }
    return true;
  }
  // The pixel `inside_px` from pixel i in this direction, if it shows the same surface.
  std::optional<size_t> same_surface(size_t i, int x, int y, int dx, int dy) const {
    const int u = x + OutlineAlignment::inside_px * dx, v = y + OutlineAlignment::inside_px * dy;
    if (u < 0 || v < 0 || u >= width_ || v >= height_) return std::nullopt;
    const size_t j = whole_.index(u, v);
    return e_.receivers.primitive[j] == no_primitive || apart(i, j) ? std::nullopt : std::optional(j);
  }

  const CheckEvidence& e_;
  int width_, height_;
  Image<uint8_t> whole_;  // 1: at an outline, and no true edge of the surface is near, seen or hidden
};

}  // namespace

OutlineAlignment outline_alignment(const CheckEvidence& e) {
  const Outlines outlines(e);
  OutlineAlignment found;
  for (int y = 0; y < e.frame.visibility.height; ++y)
    for (int x = 0; x < e.frame.visibility.width; ++x) {
      if (e.receivers.primitive[e.seen.index(x, y)] == no_primitive || std::isnan(e.frame.visibility.at(x, y)))
        continue;
      outlines.book(found.left, x, y, x - 1, y);
      outlines.book(found.right, x, y, x + 1, y);
      outlines.book(found.above, x, y, x, y - 1);
      outlines.book(found.below, x, y, x, y + 1);
    }
  for (OutlineAlignment::Side* side : {&found.left, &found.right, &found.above, &found.below}) take_means(*side);
  return found;
}

OutlineAlignment::Side OutlineAlignment::all() const {
  Side sum;
  for (const Side* side : {&left, &right, &above, &below}) {
    sum.lit += side->lit, sum.dark += side->dark;
    sum.lit_wrong += side->lit_wrong * static_cast<double>(side->lit);
    sum.dark_wrong += side->dark_wrong * static_cast<double>(side->dark);
    sum.lit_inside += side->lit_inside, sum.dark_inside += side->dark_inside;
    sum.lit_pull += side->lit_pull * static_cast<double>(side->lit_inside);
    sum.dark_pull += side->dark_pull * static_cast<double>(side->dark_inside);
    sum.lit_next += side->lit_next * static_cast<double>(side->lit_inside);
    sum.dark_next += side->dark_next * static_cast<double>(side->dark_inside);
  }
  take_means(sum);
  return sum;
}

OutlineAlignment::Ramps OutlineAlignment::ramps() const {
  const Ramps along_x{left.steps + right.steps, left.ramps + right.ramps};
  const Ramps along_y{above.steps + below.steps, above.ramps + below.ramps};
  return along_y.of_blur() && (!along_x.of_blur() || along_y.ramps > along_x.ramps) ? along_y : along_x;
}

glm::ivec2 OutlineAlignment::shift() const {
  const auto along = [](const Side& before, const Side& after) {
    if (!before.told() || !after.told()) return 0;
    if (before.of_neighbour() && after.of_itself()) return 1;
    return after.of_neighbour() && before.of_itself() ? -1 : 0;
  };
  return {along(left, right), along(above, below)};
}

Image<float> pixel_width_m(const ViewMatrix& view, const ReceiverImage& receivers) {
  const int width = receivers.width(), height = receivers.height();
  Image<float> size(width, height, 0);
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const size_t i = size.index(x, y);
      if (receivers.primitive[i] == no_primitive) continue;
      const double depth = view.pixel_of(receivers.position[i], width, height).z;
      const glm::dvec3 here = view.world_at(x, y, depth, width, height);
      size[i] = static_cast<float>(std::max(glm::length(view.world_at(x + 1, y, depth, width, height) - here),
                                            glm::length(view.world_at(x, y + 1, depth, width, height) - here)));
    }
  });
  return size;
}

}  // namespace noonmark
