#include "compare/ladder/shadow_edges.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "compare/ladder/numbers.h"

namespace noonmark {
namespace {

// A visibility that only the steps have changed that move edges.
double drawn_visibility(const Ladder& ladder, size_t i) {
  double visibility = ladder.truth()[i];
  for (Cause cause : {Cause::filter, Cause::displacement, Cause::aliasing_dark, Cause::aliasing_light})
    visibility += ladder[cause][i];
  return visibility;
}

// Receivers by the side of one half that they are on, and by their surface. Facing ones only.
struct Sides {
  static constexpr uint32_t no_surface = no_primitive;
  Image<uint32_t> surface;
  Image<uint8_t> drawn_lit, truly_lit;

  Sides(const Ladder& ladder, const ReceiverImage& receivers, std::span<const uint32_t> surfaces)
      : surface(receivers.width(), receivers.height(), no_surface),
        drawn_lit(receivers.width(), receivers.height()),
        truly_lit(receivers.width(), receivers.height()) {
    for (size_t i = 0; i < surface.size(); ++i) {
      if (!(ladder.flags[i] & flag_facing)) continue;
      surface[i] = surfaces.empty() ? 0 : surfaces[receivers.primitive[i]];
      drawn_lit[i] = drawn_visibility(ladder, i) >= 0.5;
      truly_lit[i] = ladder.truth()[i] >= 0.5f;
    }
  }

  bool is_edge(const Image<uint8_t>& lit, int x, int y) const {
    const size_t i = surface.index(x, y);
    const auto other_side = [&](int nx, int ny) {
      if (nx < 0 || ny < 0 || nx >= surface.width || ny >= surface.height) return false;
      const size_t n = surface.index(nx, ny);
      return surface[n] == surface[i] && lit[n] != lit[i];
    };
    return surface[i] != no_surface &&
           (other_side(x - 1, y) || other_side(x + 1, y) || other_side(x, y - 1) || other_side(x, y + 1));
  }
};

// The pixels of one surface, and the drawn edge pixels on it that are no edge pixels of the truth on the same side.
struct MovedEdge {
  int left = 0, right = -1, top = 0, bottom = -1;
  std::vector<size_t> pixels;
};

// The part of the picture that holds the surface, with one pixel more on each side, which belongs to no surface.
class SurfaceCrop {
 public:
  SurfaceCrop(const Sides& sides, uint32_t surface, const MovedEdge& edge)
      : sides_(sides),
        surface_(surface),
        left_(edge.left - 1),
        top_(edge.top - 1),
        width_(edge.right - edge.left + 3),
        height_(edge.bottom - edge.top + 3) {}

  // The distance from each pixel of the crop to the nearest for which `is(x, y)` holds.
  template <class Is>
  Image<float> distance(const Is& is) const {
    Image<uint8_t> mask(width_, height_);
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) mask.at(x, y) = is(x + left_, y + top_);
    return distance_to(mask);
  }
  bool holds(int x, int y) const {
    return x >= 0 && y >= 0 && x < sides_.surface.width && y < sides_.surface.height &&
           sides_.surface.at(x, y) == surface_;
  }
  size_t index(size_t pixel) const {
    const auto width = static_cast<size_t>(sides_.surface.width);
    const int x = static_cast<int>(pixel % width) - left_, y = static_cast<int>(pixel / width) - top_;
    return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
  }

 private:
  const Sides& sides_;
  uint32_t surface_;
  int left_, top_, width_, height_;
};

void add_displacements(const Sides& sides, uint32_t surface, const MovedEdge& edge, std::vector<double>& found) {
  const SurfaceCrop crop(sides, surface, edge);
  const Image<float> to_end = crop.distance([&](int x, int y) { return !crop.holds(x, y); });
  for (const bool lit : {false, true}) {
    const Image<float> to_edge = crop.distance([&](int x, int y) {
      return crop.holds(x, y) && (sides.truly_lit.at(x, y) != 0) == lit && sides.is_edge(sides.truly_lit, x, y);
    });
    for (const size_t pixel : edge.pixels)
      if ((sides.drawn_lit[pixel] != 0) == lit)
        found.push_back(std::min(to_edge[crop.index(pixel)], to_end[crop.index(pixel)]));
  }
}

}  // namespace

EdgeDisplacements edge_displacements(const Ladder& ladder, const ReceiverImage& receivers,
                                     std::span<const uint32_t> surfaces) {
  const Sides sides(ladder, receivers, surfaces);
  const Image<uint32_t>& surface = sides.surface;
  std::vector<double> found;
  std::map<uint32_t, MovedEdge> moved;
  for (int y = 0; y < surface.height; ++y) {
    for (int x = 0; x < surface.width; ++x) {
      const size_t i = surface.index(x, y);
      if (!is_counted(ladder, i)) continue;
      if (std::isnan(drawn_visibility(ladder, i))) return {not_a_number, not_a_number, not_a_number};
      if (!sides.is_edge(sides.drawn_lit, x, y)) continue;
      if (sides.drawn_lit[i] == sides.truly_lit[i] && sides.is_edge(sides.truly_lit, x, y))
        found.push_back(0);
      else
        moved[surface[i]].pixels.push_back(i);
    }
  }
  if (found.empty() && moved.empty()) return {};
  for (auto& [id, edge] : moved) edge.left = surface.width, edge.top = surface.height;
  for (int y = 0; y < surface.height && !moved.empty(); ++y) {
    for (int x = 0; x < surface.width; ++x) {
      const auto edge = moved.find(surface.at(x, y));
      if (edge == moved.end()) continue;
      MovedEdge& box = edge->second;
      box.left = std::min(box.left, x), box.right = std::max(box.right, x);
      box.top = std::min(box.top, y), box.bottom = std::max(box.bottom, y);
    }
  }
  for (const auto& [id, edge] : moved) add_displacements(sides, id, edge, found);
  EdgeDisplacements result;
  for (const double displacement : found) result.mean += displacement;
  result.mean /= static_cast<double>(found.size());
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(0.95 * static_cast<double>(found.size()))) - 1;
  std::nth_element(found.begin(), found.begin() + rank, found.end());
  result.p95 = found[static_cast<size_t>(rank)];
  result.largest = *std::max_element(found.begin(), found.end());
  return result;
}

namespace {

// d[i] = min over j of (i - j)^2 + f[j]: the lower envelope of the parabolas rooted at every j with finite f.
void transform(const std::vector<float>& f, std::vector<float>& d, std::vector<int>& root, std::vector<double>& from) {
  const int n = static_cast<int>(f.size());
  int k = -1;
  for (int q = 0; q < n; ++q) {
    if (f[q] == infinity_f) continue;
    double start = -infinity;  // double: beyond 4096 a float cannot separate this place from a neighbouring pixel
    while (k >= 0) {
      const double p = root[k];
      start = ((f[q] + static_cast<double>(q) * q) - (f[root[k]] + p * p)) / (2.0 * (q - p));
      if (start > from[k]) break;
      start = -infinity;
      --k;
    }
    ++k;
    root[k] = q;
    from[k] = start;
  }
  for (int q = 0, i = 0; q < n; ++q) {
    if (k < 0) {
      d[q] = infinity_f;
      continue;
    }
    while (i < k && from[i + 1] < q) ++i;
    const float away = static_cast<float>(q - root[i]);
    d[q] = away * away + f[root[i]];
  }
}

}  // namespace

Image<float> distance_to(const Image<uint8_t>& mask) {
  const int width = mask.width, height = mask.height;
  Image<float> squared(width, height, infinity_f);
  const auto lines = [](int count, int length, const auto& get, const auto& set) {
    tbb::parallel_for(tbb::blocked_range<int>(0, count), [&](const tbb::blocked_range<int>& range) {
      std::vector<float> f(length), d(length);
      std::vector<double> from(length);
      std::vector<int> root(length);
      for (int line = range.begin(); line != range.end(); ++line) {
        for (int i = 0; i < length; ++i) f[i] = get(line, i);
        transform(f, d, root, from);
        for (int i = 0; i < length; ++i) set(line, i, d[i]);
      }
    });
  };
  lines(
      width, height, [&](int x, int y) { return mask.at(x, y) ? 0.0f : infinity_f; },
      [&](int x, int y, float d) { squared.at(x, y) = d; });
  lines(
      height, width, [&](int y, int x) { return squared.at(x, y); },
      [&](int y, int x, float d) { squared.at(x, y) = std::sqrt(d); });
  return squared;
}

}  // namespace noonmark
