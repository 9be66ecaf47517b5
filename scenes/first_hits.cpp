#include "scenes/first_hits.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

namespace noonmark {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// A fraction of a depth. A triangle that is nearer than a hit by less than this counts as hidden by it. So of many
// triangles that coincide only the first is tested, whatever rounding does to their depths.
constexpr double sameness = 0x1p-20;

struct Triangle {
  glm::dvec3 a, b, c, normal;
  double nearest;  // along the view
  bool back, single_sided;
};

// A triangle's part before the eye, in pixels: a convex polygon of up to four corners.
class Outline {
 public:
  Outline(const Triangle& t, const CameraFrame& frame, int rays) {
    const bool perspective = frame.camera.projection == Projection::perspective;
    std::array<glm::dvec3, 3> seen;
    double farthest = -infinity;
    for (size_t k = 0; k < 3; ++k) {
      const glm::dvec3 way = (k == 0 ? t.a : k == 1 ? t.b : t.c) - frame.eye_m;
      seen[k] = {glm::dot(way, frame.right), glm::dot(way, frame.up), glm::dot(way, frame.forward)};
      farthest = std::max(farthest, seen[k].z);
    }
    if (!(farthest > 0)) return;
    const double least = perspective ? 1e-6 * farthest : -infinity;  // nearer than that rays meet nothing
    const auto add = [&](const glm::dvec3& p) {
      const double w = perspective ? p.z : 1;
      corners_[count_++] = 0.5 * rays * glm::dvec2(1 + p.x / (w * frame.half_width), 1 - p.y / (w * frame.half_height));
    };
    for (size_t k = 0; k < 3; ++k) {
      const glm::dvec3 &p = seen[k], &q = seen[(k + 1) % 3];
      if (p.z >= least) add(p);
      if ((p.z >= least) != (q.z >= least)) {
        glm::dvec3 cut = p + (q - p) * ((least - p.z) / (q.z - p.z));
        cut.z = least;
        add(cut);
      }
    }
    glm::dvec2 low(infinity), high(-infinity);
    for (size_t k = 0; k < count_; ++k) {
      low = glm::min(low, corners_[k]);
      high = glm::max(high, corners_[k]);
    }
    const double side = rays;
    from = glm::clamp(first_centre(low), 0.0, side);
    to = glm::clamp(end_centre(high), 0.0, side);
  }

  // The pixels that it may cover: from <= pixel < to.
  glm::ivec2 from{0}, to{0};

  // Those of row y.
  std::pair<int, int> columns(int y) const {
    double low = infinity, high = -infinity;
    const double above = y + 0.5 - slack_px, below = y + 0.5 + slack_px;
    for (size_t k = 0; k < count_; ++k) {
      const glm::dvec2 &p = corners_[k], &q = corners_[(k + 1) % count_];
      if (std::max(p.y, q.y) < above || std::min(p.y, q.y) > below) continue;
      for (const double row : {above, below}) {
        const double way = p.y == q.y ? (row == above ? 0 : 1) : std::clamp((row - p.y) / (q.y - p.y), 0.0, 1.0);
        low = std::min(low, p.x + (q.x - p.x) * way);
        high = std::max(high, p.x + (q.x - p.x) * way);
      }
    }
    if (!(low <= high)) return {0, 0};
    const double least = from.x, most = to.x;
    return {static_cast<int>(std::clamp(first_centre(glm::dvec2(low)).x, least, most)),
            static_cast<int>(std::clamp(end_centre(glm::dvec2(high)).x, least, most))};
  }

 private:
  // Far more than rounding moves a corner; the rays themselves decide.
  static constexpr double slack_px = 1e-3;
  // The first pixel whose centre lies at or after p, and the first whose centre lies after it.
  static glm::dvec2 first_centre(const glm::dvec2& p) { return glm::ceil(p - 0.5 - slack_px); }
  static glm::dvec2 end_centre(const glm::dvec2& p) { return glm::floor(p - 0.5 + slack_px) + 1.0; }

  std::array<glm::dvec2, 4> corners_;
  size_t count_ = 0;
};

// The hits that the rays have found so far. Rays are grouped into tiles; a triangle that lies behind every hit of a
// tile is not tested against that tile's rays (the hierarchical z-buffer of Greene, Kass and Miller, SIGGRAPH 1993,
// with one level).
class Picture {
 public:
  Picture(const CameraFrame& frame, int side)
      : hits{Image<float>(side, side, FirstHits::nothing), Image<uint8_t>(side, side), Image<uint8_t>(side, side)},
        side_(side),
        tiles_((side + tile - 1) / tile),
        columns_(static_cast<size_t>(side)),
        farthest_(static_cast<size_t>(tiles_ * tiles_), infinity),
        stale_(farthest_.size(), false) {
    rays_.reserve(hits.depth.size());
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) rays_.push_back(frame.pixel_ray(x, y, side, side));
  }

  void draw(const Triangle& t, const Outline& outline) {
    if (outline.from.x >= outline.to.x || outline.from.y >= outline.to.y) return;  // no ray meets it
    int known_to = 0;  // the row up to which columns_ holds this triangle's
    for (int v = outline.from.y / tile; v * tile < outline.to.y; ++v) {
      for (int u = outline.from.x / tile; u * tile < outline.to.x; ++u) {
        const glm::ivec2 begin = glm::max(outline.from, glm::ivec2(u, v) * tile);
        const glm::ivec2 end = glm::min(outline.to, glm::ivec2(u + 1, v + 1) * tile);
        const double hidden_from = (1 - sameness) * farthest(u, v);
        if (t.nearest >= hidden_from || least_depth(t, begin, end) >= hidden_from) continue;
        bool drawn = false;
        for (int y = begin.y; y < end.y; ++y) {
          if (known_to <= y) columns_[static_cast<size_t>(y)] = outline.columns(y);
          const auto [first, last] = columns_[static_cast<size_t>(y)];
          for (int x = std::max(first, begin.x); x < std::min(last, end.x); ++x) drawn = draw_at(t, x, y) || drawn;
        }
        known_to = end.y;
        if (drawn) stale_[index(u, v)] = true;
      }
    }
  }

  // What all rays have met lies before this; infinite where one has met nothing.
  double farthest() {
    double most = 0;
    for (int v = 0; v < tiles_; ++v)
      for (int u = 0; u < tiles_ && most < infinity; ++u) most = std::max(most, farthest(u, v));
    return most;
  }

  FirstHits hits;

 private:
  static constexpr int tile = 8;

  size_t index(int u, int v) const { return static_cast<size_t>(v * tiles_ + u); }
  const Ray& ray(int x, int y) const { return rays_[static_cast<size_t>(y * side_ + x)]; }

  double farthest(int u, int v) {
    const size_t at = index(u, v);
    if (stale_[at]) {
      farthest_[at] = 0;
      for (int y = v * tile; y < std::min(side_, (v + 1) * tile); ++y)
        for (int x = u * tile; x < std::min(side_, (u + 1) * tile); ++x)
          farthest_[at] = std::max(farthest_[at], static_cast<double>(hits.depth.at(x, y)));
      stale_[at] = false;
    }
    return farthest_[at];
  }

  // The direction's part along the view is 1, so that this is a depth.
  static double depth_along(const Triangle& t, const Ray& r) {
    return glm::dot(t.normal, t.a - r.origin) / glm::dot(t.normal, r.direction);
  }

  // Of the triangle's plane over these pixels; 0 where that is not known. The depth of parallel rays, and one over it
  // of rays from one eye, is linear in the pixel: it is least at a corner, if all corners' rays meet the plane.
  double least_depth(const Triangle& t, glm::ivec2 begin, glm::ivec2 end) const {
    double least = infinity;
    for (const int y : {begin.y, end.y - 1}) {
      for (const int x : {begin.x, end.x - 1}) {
        const double depth = depth_along(t, ray(x, y));
        if (!(depth > 0) || !(depth < infinity)) return 0;
        least = std::min(least, depth);
      }
    }
    return least;
  }

  bool draw_at(const Triangle& t, int x, int y) {
    ++hits.asked;
    const Ray& r = ray(x, y);
    const double depth = depth_along(t, r);
    if (!(depth > 0) || !(depth < static_cast<double>(hits.depth.at(x, y)))) return false;
    const glm::dvec3 p = r.origin + depth * r.direction;
    const auto left_of = [&](const glm::dvec3& from, const glm::dvec3& to) {
      return glm::dot(glm::cross(to - from, p - from), t.normal) >= 0;
    };
    if (!left_of(t.a, t.b) || !left_of(t.b, t.c) || !left_of(t.c, t.a)) return false;
    hits.depth.at(x, y) = static_cast<float>(depth);
    hits.back.at(x, y) = t.back;
    hits.single_sided.at(x, y) = t.single_sided;
    return true;
  }

  int side_, tiles_;
  std::vector<std::pair<int, int>> columns_;
  std::vector<Ray> rays_;
  std::vector<double> farthest_;  // of each tile, of its rays; not up to date where stale
  std::vector<bool> stale_;
};

struct Corners {
  glm::dvec3 a, b, c;
};
Corners corners_of(const Scene& scene, size_t i) {
  const glm::uvec3& t = scene.triangles[i];
  return {scene.positions[t.x], scene.positions[t.y], scene.positions[t.z]};
}

// Depths before the first corner by their exponent and eight bits more: so that the order is fine near the eye.
constexpr int bucket_shift = 15;
constexpr size_t bucket_count = (0x7f800000u >> bucket_shift) + 1;
size_t bucket_of(double depth, double first) {
  return std::bit_cast<uint32_t>(static_cast<float>(std::max(0.0, depth - first))) >> bucket_shift;
}

// Bucket by bucket, the nearest first; without those of infinite depth.
std::vector<uint32_t> front_to_back(const std::vector<double>& nearest, double first) {
  std::vector<uint32_t> begins(bucket_count + 1);
  for (const double depth : nearest)
    if (depth != infinity) ++begins[bucket_of(depth, first) + 1];
  for (size_t b = 1; b < begins.size(); ++b) begins[b] += begins[b - 1];
  std::vector<uint32_t> order(begins.back());
  for (size_t i = 0; i < nearest.size(); ++i)
    if (nearest[i] != infinity) order[begins[bucket_of(nearest[i], first)]++] = static_cast<uint32_t>(i);
  return order;
}

}  // namespace

FirstHits first_hits(const Scene& scene, const CameraFrame& frame, int rays, Backs backs) {
  const bool perspective = frame.camera.projection == Projection::perspective;
  std::vector<double> nearest(scene.triangles.size(), infinity);  // infinite: behind the eye
  for (size_t i = 0; i < scene.triangles.size(); ++i) {
    const Corners t = corners_of(scene, i);
    const auto depth = [&](const glm::dvec3& p) { return glm::dot(p - frame.eye_m, frame.forward); };
    const auto [least, most] = std::minmax({depth(t.a), depth(t.b), depth(t.c)});
    if (most > 0) nearest[i] = least;
  }
  const double first = nearest.empty() ? 0 : *std::min_element(nearest.begin(), nearest.end());
  Picture picture(frame, rays);
  size_t bucket = 0;
  for (const uint32_t i : front_to_back(nearest, first)) {
    if (const size_t now = bucket_of(nearest[i], first); now != bucket) {
      bucket = now;
      if (bucket > bucket_of(picture.farthest(), first)) break;  // all the rest is hidden
    }
    const Corners at = corners_of(scene, i);
    Triangle t{at.a, at.b, at.c, glm::cross(at.b - at.a, at.c - at.a), nearest[i], false, false};
    t.back = glm::dot(t.normal, perspective ? t.a - frame.eye_m : frame.forward) > 0;
    t.single_sided = !scene.single_sided.empty() && scene.single_sided[i];
    if (t.back && t.single_sided && backs == Backs::seen_of_double_sided) continue;
    picture.draw(t, Outline(t, frame, rays));
  }
  return std::move(picture.hits);
}

}  // namespace noonmark
