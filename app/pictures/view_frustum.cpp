#include "app/pictures/view_frustum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "app/pictures/view_colors.h"

namespace noonmark {
namespace {

constexpr double half_width_px = 1.1;
constexpr double dash_px = 5;  // length of a dash and of a gap
constexpr double hidden_strength = 0.5;
constexpr double mark_radius_px = 7;
// A line in a surface must not be hidden by that surface. The receiver's depth at the pixel's centre and the line's
// depth differ by the surface's slope over one pixel.
constexpr double in_front = 5e-3;

using Corners = std::array<glm::dvec3, 4>;

// The corners of a tile at a depth along its axis.
Corners corners_at(const LightFrame& light, const MapTile& tile, double z) {
  const glm::dvec2 half = tile.orthographic ? tile.half_m() : glm::dvec2(z * tile.half);
  const glm::dvec2 shift = 2.0 * tile.shift_texels / double(tile.resolution) * half;
  Corners c;
  for (size_t k = 0; k < 4; ++k) {
    const double u = (k == 1 || k == 2 ? half.x : -half.x) + shift.x, v = (k >= 2 ? half.y : -half.y) + shift.y;
    c[k] = light.to_world(u * tile.right + v * tile.up + z * tile.forward);
  }
  return c;
}

// The rim of the light's cone at a depth along its axis. radius: in metres.
WorldLine rim(const LightFrame& light, double z, double radius, Color color) {
  constexpr int steps = 96;
  WorldLine line{{}, color};
  for (int i = 0; i <= steps; ++i) {
    const double a = 2 * std::numbers::pi * (i % steps) / steps;
    line.points.push_back(light.to_world({radius * std::cos(a), radius * std::sin(a), z}));
  }
  return line;
}

// The share of the line's colour in a pixel, from 0 to 1, for seen and for hidden parts.
struct Coverage {
  Image<float> seen, hidden;
};

double receiver_depth(const CameraFrame& camera, const ReceiverImage& receivers, size_t i) {
  if (receivers.primitive[i] == no_primitive) return std::numeric_limits<double>::infinity();
  return glm::dot(glm::dvec3(receivers.position[i]) - camera.eye_m, camera.forward);
}

// along_px: where the segment begins on the whole line, so that dashes continue.
void cover(const ScreenSegment& s, double along_px, const CameraFrame& camera, const ReceiverImage& receivers,
           Coverage& out) {
  const glm::dvec2 way = s.to - s.from;
  const double length = glm::length(way);
  const glm::dvec2 unit = length > 0 ? way / length : glm::dvec2(1, 0);
  const bool wide = std::abs(way.x) >= std::abs(way.y);
  const int main = wide ? 0 : 1, side = 1 - main;
  const int size[2] = {out.seen.width, out.seen.height};
  const double reach = half_width_px + 1, across = reach * std::numbers::sqrt2;
  const int first = std::max(0, static_cast<int>(std::floor(std::min(s.from[main], s.to[main]) - reach)));
  const int last = std::min(size[main] - 1, static_cast<int>(std::ceil(std::max(s.from[main], s.to[main]) + reach)));
  const bool perspective = camera.camera.projection == Projection::perspective;
  for (int m = first; m <= last; ++m) {
    const double t_main = way[main] != 0 ? std::clamp((m + 0.5 - s.from[main]) / way[main], 0.0, 1.0) : 0;
    const double centre = s.from[side] + t_main * way[side];
    const int low = std::max(0, static_cast<int>(std::floor(centre - across)));
    const int high = std::min(size[side] - 1, static_cast<int>(std::ceil(centre + across)));
    for (int n = low; n <= high; ++n) {
      const int x = wide ? m : n, y = wide ? n : m;
      const glm::dvec2 pixel(x + 0.5, y + 0.5);
      const double along = std::clamp(glm::dot(pixel - s.from, unit), 0.0, length);
      const double covered = half_width_px + 0.5 - glm::length(pixel - s.from - along * unit);
      if (!(covered > 0)) continue;
      const double t = length > 0 ? along / length : 0;
      // 1 / depth is linear in the picture of a perspective camera.
      const double depth =
          perspective ? 1 / ((1 - t) / s.from_depth + t / s.to_depth) : (1 - t) * s.from_depth + t * s.to_depth;
      const size_t i = out.seen.index(x, y);
      const double nearest = receiver_depth(camera, receivers, i);
      const bool hidden = depth > nearest + in_front * std::abs(nearest);
      if (hidden && std::fmod(along_px + along, 2 * dash_px) >= dash_px) continue;
      float& value = hidden ? out.hidden[i] : out.seen[i];
      value = std::max(value, static_cast<float>(std::min(covered, 1.0)));
    }
  }
}

void blend(Image<Color>& picture, const Image<float>& coverage, Color color, double strength) {
  for (size_t i = 0; i < picture.size(); ++i) {
    if (coverage[i] == 0) continue;
    picture[i] =
        Color(glm::mix(glm::vec3(picture[i]), glm::vec3(color), coverage[i] * static_cast<float>(strength)) + 0.5f);
  }
}

void mark(Image<Color>& picture, glm::dvec2 at, Color color) {
  const double reach = mark_radius_px + 2;
  const auto low = glm::max(glm::ivec2(glm::floor(at - reach)), glm::ivec2(0));
  const auto high = glm::min(glm::ivec2(glm::ceil(at + reach)), glm::ivec2(picture.width - 1, picture.height - 1));
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) {
      const double from_centre = glm::length(glm::dvec2(x + 0.5, y + 0.5) - at);
      const auto disc = [&](double radius) {
        return static_cast<float>(std::clamp(radius + 0.5 - from_centre, 0.0, 1.0));
      };
      glm::vec3 c(picture.at(x, y));
      c = glm::mix(c, glm::vec3(255), disc(mark_radius_px + 1.5));
      c = glm::mix(c, glm::vec3(color), disc(mark_radius_px));
      picture.at(x, y) = Color(c + 0.5f);
    }
}

}  // namespace

std::vector<WorldLine> frustum_lines(const LightFrame& light) {
  std::vector<WorldLine> sides, far, near;
  for (int index = 0; index < light.tiles; ++index) {
    const MapTile tile = light.tile(index);
    const Corners nearest = corners_at(light, tile, tile.near_m), farthest = corners_at(light, tile, tile.far_m);
    // The tiles of a cube share their edges: one line for each.
    const auto add = [](std::vector<WorldLine>& lines, glm::dvec3 a, glm::dvec3 b, Color color) {
      const bool known = std::any_of(lines.begin(), lines.end(), [&](const WorldLine& line) {
        return (line.points[0] == a && line.points[1] == b) || (line.points[0] == b && line.points[1] == a);
      });
      if (!known) lines.push_back({{a, b}, color});
    };
    for (size_t k = 0; k < 4; ++k) {
      add(sides, nearest[k], farthest[k], side_line);
      add(far, farthest[k], farthest[(k + 1) % 4], far_line);
      add(near, nearest[k], nearest[(k + 1) % 4], near_line);
    }
  }
  std::vector<WorldLine> lines = std::move(sides);
  if (const std::optional<double> tangent = light.light().tan_half_cone(light)) {
    for (double z : {light.far_m, light.near_m}) lines.push_back(rim(light, z, z * *tangent, cone_line));
  }
  lines.insert(lines.end(), far.begin(), far.end());
  lines.insert(lines.end(), near.begin(), near.end());
  return lines;
}

bool project_segment(const CameraFrame& camera, int width, int height, glm::dvec3 a, glm::dvec3 b, double margin_px,
                     ScreenSegment& out) {
  const bool perspective = camera.camera.projection == Projection::perspective;
  // x and y in units of the picture's half sides, times w. w is the depth, or 1 for an orthographic camera.
  const auto seen = [&](glm::dvec3 p) {
    const glm::dvec3 d = p - camera.eye_m;
    const double depth = glm::dot(d, camera.forward);
    return glm::dvec4(glm::dot(d, camera.right) / camera.half_width, glm::dot(d, camera.up) / camera.half_height, depth,
                      perspective ? depth : 1);
  };
  const glm::dvec4 p = seen(a), q = seen(b);
  const double wide = 1 + 2 * margin_px / width, high = 1 + 2 * margin_px / height;
  const double near_m = camera.camera.near_m.value(), least_depth = perspective ? 1e-3 * near_m : near_m;
  // Liang and Barsky 1984, in homogeneous coordinates: each plane keeps the part where its function is not negative.
  double first = 0, last = 1;
  const auto keep = [&](auto side) {
    const double from = side(p), to = side(q);
    if (from < 0 && to < 0) return false;
    if (from < 0) first = std::max(first, from / (from - to));
    if (to < 0) last = std::min(last, from / (from - to));
    return first < last || (first == last && from >= 0 && to >= 0);
  };
  if (!keep([&](glm::dvec4 v) { return v.z - least_depth; }) || !keep([&](glm::dvec4 v) { return wide * v.w - v.x; }) ||
      !keep([&](glm::dvec4 v) { return wide * v.w + v.x; }) || !keep([&](glm::dvec4 v) { return high * v.w - v.y; }) ||
      !keep([&](glm::dvec4 v) { return high * v.w + v.y; }))
    return false;
  const auto place = [&](double t, glm::dvec2& at, double& depth) {
    const glm::dvec4 v = p + t * (q - p);
    at = {(v.x / v.w + 1) / 2 * width, (1 - v.y / v.w) / 2 * height};
    depth = v.z;
  };
  place(first, out.from, out.from_depth);
  place(last, out.to, out.to_depth);
  return true;
}

void draw_frustum(Image<Color>& picture, const LightFrame& light, const CameraFrame& camera,
                  const ReceiverImage& receivers, std::optional<Color> color) {
  const int width = picture.width, height = picture.height;
  std::vector<WorldLine> lines = frustum_lines(light);
  if (color)
    for (WorldLine& line : lines) line.color = *color;
  for (size_t begin = 0;
       begin < lines.size();) {  // runs of one colour are drawn as one, so that joints are not drawn twice
    Coverage coverage{Image<float>(width, height, 0), Image<float>(width, height, 0)};
    size_t end = begin;
    for (; end < lines.size() && lines[end].color == lines[begin].color; ++end) {
      double along_px = 0;
      for (size_t k = 1; k < lines[end].points.size(); ++k) {
        ScreenSegment segment;
        if (!project_segment(camera, width, height, lines[end].points[k - 1], lines[end].points[k], 4 * half_width_px,
                             segment))
          continue;
        cover(segment, along_px, camera, receivers, coverage);
        along_px += glm::length(segment.to - segment.from);
      }
    }
    blend(picture, coverage.hidden, lines[begin].color, hidden_strength);
    blend(picture, coverage.seen, lines[begin].color, 1);
    begin = end;
  }
  ScreenSegment light_itself;
  if (light.light().rays().start_at_light() &&
      project_segment(camera, width, height, light.origin_m, light.origin_m, mark_radius_px, light_itself))
    mark(picture, light_itself.from, light_mark);
}

}  // namespace noonmark
