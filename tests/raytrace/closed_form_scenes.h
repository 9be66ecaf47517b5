// Random scenes for the property tests: analytic shapes under random lights, and the triangles that represent the
// shapes.
//
// Every corner lies on a grid whose points are exact in float. So the faces of a rotated box are exact planes after the
// rounding too, and its triangles are exactly the analytic box. The triangles of a sphere or a disc cannot be exactly
// the shape. So each of these has an inner and an outer shape, and its triangles lie between the two. Both are computed
// from the rounded vertices.
#pragma once
#include <rapidcheck.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <ostream>
#include <utility>
#include <vector>

#include "scenes/shapes.h"
#include "tests/raytrace/closed_form.h"
#include "tests/raytrace/fixture.h"

namespace noonmark::test {

struct ShapeSpec {
  int kind = 0;             // ShapeKind
  int x = 0, y = 0, z = 0;  // position, in thousandths of 4 m
  int a = 0, b = 0, c = 0;  // sizes, in thousandths of 2 m, divided by 10^decade
  int decade = 0;
  int yaw_deg = 0, pitch_deg = 0, roll_deg = 0;
};

// The position of the light. A directional light is always outside.
enum class LightPlace { outside, inside, near_the_floor, near_a_shape };

struct SceneSpec {
  std::vector<ShapeSpec> shapes;
  LightKind light = LightKind::directional;
  int place = 0;                                             // LightPlace
  int azimuth_deg = 0, elevation_deg = 45, distance = 1000;  // outside; distance in thousandths of 12 m
  // Inside and near the floor: the position, in thousandths of 4 m. Near a shape: the place on the face. For a spot
  // light also its target, in thousandths of 2 m.
  int x = 0, y = 0, z = 0;
  // Near a shape or the floor: the distance is 10^-decade m. At less than 0.1 mm Embree's own hits are uncertain.
  int shape = 0, decade = 1;
  int cone_deg = 60, extent_percent = 100;
  int resolution = 64, filter = 0;
  int camera_azimuth_deg = 0, camera_elevation_deg = 20;
  int near_cut = 0;  // percent of the fitted depth range that the near plane cuts off
  uint32_t seed = 1;
};

inline std::ostream& operator<<(std::ostream& out, const ShapeSpec& s) {
  static constexpr const char* names[] = {"rectangle", "box", "disc", "sphere"};
  return out << "\n  " << names[s.kind] << " at " << s.x << ' ' << s.y << ' ' << s.z << " size " << s.a << ' ' << s.b
             << ' ' << s.c << " / 10^" << s.decade << " turned " << s.yaw_deg << ' ' << s.pitch_deg << ' '
             << s.roll_deg;
}
inline std::ostream& operator<<(std::ostream& out, const SceneSpec& s) {
  static constexpr const char* places[] = {"outside", "inside", "near the floor", "near a shape"};
  for (const ShapeSpec& shape : s.shapes) out << shape;
  return out << "\n  light " << kind_of_light(s.light).name() << ' ' << places[s.place] << ", azimuth " << s.azimuth_deg
             << " elevation " << s.elevation_deg << " distance " << s.distance << ", at " << s.x << ' ' << s.y << ' '
             << s.z << ", shape " << s.shape << " decade " << s.decade << ", cone " << s.cone_deg << " map "
             << s.extent_percent << "%, resolution " << s.resolution << ", filter " << s.filter << ", camera "
             << s.camera_azimuth_deg << ' ' << s.camera_elevation_deg << ", near cut " << s.near_cut << "%, seed "
             << s.seed;
}

// Where in the world the scene is. Corners are rounded to multiples of grid_m, which are exact in float there. Sizes
// are multiplied by scale, so that small shapes survive the rounding.
struct Site {
  const char* name;
  glm::dvec3 origin_m;
  double grid_m;
  double scale;
  glm::dvec3 snapped(glm::dvec3 p) const { return glm::round(p / grid_m) * grid_m; }
};
inline constexpr double half_floor_m = 5;
inline const Site at_origin{"origin", {0, 0, 0}, 0x1p-20, 1};           // floats below 16 m: 2^-20 at the coarsest
inline const Site at_1_km{"1 km", {1000, -300, 700}, 0x1p-13, 1};       // below 2^11 m: 2^-13
inline const Site at_1000_km{"1000 km", {1e6, -3e5, 7e5}, 0x1p-4, 64};  // below 2^20 m: 2^-4

struct Modelled {
  Scene scene;
  std::vector<Shape> inner, outer;         // equal, except for spheres and discs
  std::vector<std::pair<int, int>> owner;  // of each triangle: shape and face
  bool round = false;                      // has spheres or discs
};

class Builder {
 public:
  Builder(const Site& site, int segments) : site_(site), segments_(segments) {}

  void add(const ShapeSpec& s) {
    const glm::dvec3 at = site_.snapped(site_.origin_m + site_.scale * 0.004 * glm::dvec3(s.x, s.y, s.z));
    const double unit = site_.scale * 0.002 * std::pow(10.0, -s.decade);
    glm::dmat4 turn = glm::rotate(glm::dmat4(1), glm::radians(static_cast<double>(s.yaw_deg)), {0, 1, 0});
    turn = glm::rotate(turn, glm::radians(static_cast<double>(s.pitch_deg)), {1, 0, 0});
    turn = glm::rotate(turn, glm::radians(static_cast<double>(s.roll_deg)), {0, 0, 1});
    // Small shapes are left out, for two reasons. A ray's error is one or two grid steps: a shape must be many times as
    // large as that to survive the rounding. And when the plane of a small face is continued across the scene, rounding
    // moves it: if the face is not many times as large as that movement, the formula and the program need not agree on
    // its edges.
    const bool flat = s.kind == static_cast<int>(ShapeKind::rectangle) || s.kind == static_cast<int>(ShapeKind::box);
    if (unit * (flat ? std::min({s.a, s.b, s.c}) : s.a) < 64 * site_.grid_m) return;
    const glm::dvec3 e[3] = {site_.snapped(glm::dvec3(turn[0]) * (unit * s.a)),
                             site_.snapped(glm::dvec3(turn[1]) * (unit * s.b)),
                             site_.snapped(glm::dvec3(turn[2]) * (unit * s.c))};
    switch (static_cast<ShapeKind>(s.kind)) {
      case ShapeKind::rectangle:
        return rectangle(at, e[2], e[0]);
      case ShapeKind::box:
        return box(at, e[0], e[1], e[2]);
      case ShapeKind::disc:
        return disc(at, unit * s.a, s.yaw_deg % 3);
      case ShapeKind::sphere:
        return sphere(at, unit * s.a);
    }
  }

  void rectangle(glm::dvec3 at, glm::dvec3 u, glm::dvec3 v) {
    if (!(glm::length(glm::cross(u, v)) > 0)) return;
    add_quad(m_.scene, "rectangle", at, u, v);
    finish({.kind = ShapeKind::rectangle, .at = at, .edge = {u, v, {}}}, 0);
  }

  void box(glm::dvec3 at, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    if (!(glm::dot(glm::cross(a, b), c) > 0)) return;  // too small for the grid
    const glm::dmat4 placed(glm::dvec4(a / 2.0, 0), glm::dvec4(b / 2.0, 0), glm::dvec4(c / 2.0, 0),
                            glm::dvec4(at + (a + b + c) / 2.0, 1));
    add_box(m_.scene, "box", glm::dvec3(1), placed);
    finish({.kind = ShapeKind::box, .at = at, .edge = {a, b, c}}, 1);
  }

  // The disc lies in a plane that has a grid of exact floats. For example, (2, 1, -2) and (1, 2, 2) are orthogonal, and
  // both have the length 3.
  void disc(glm::dvec3 at, double radius, int plane) {
    static const glm::dvec3 axes[3][2] = {{{0, 0, 3}, {3, 0, 0}}, {{2, 1, -2}, {1, 2, 2}}, {{1, 2, 2}, {2, -2, 1}}};
    const glm::dvec3 u = axes[plane][0] * site_.grid_m, v = axes[plane][1] * site_.grid_m;
    const double step = 3 * site_.grid_m;
    std::vector<glm::dvec3> rim;
    for (int i = 0; i < segments_; ++i) {
      const double turn = 2 * std::numbers::pi * i / segments_;
      rim.push_back(std::round(radius * std::cos(turn) / step) * u + std::round(radius * std::sin(turn) / step) * v);
    }
    Shape in{.kind = ShapeKind::disc, .at = at, .edge = {u, v, {}}, .radius = radius}, out = in;
    out.radius = 0;
    for (int i = 0; i < segments_; ++i) {
      const glm::dvec3 a = rim[static_cast<size_t>(i)], b = rim[static_cast<size_t>((i + 1) % segments_)];
      if (!(glm::dot(glm::cross(a, b), glm::cross(u, v)) > 0)) return;  // too small for the grid
      out.radius = std::max(out.radius, glm::length(a));
      in.radius = std::min(in.radius, glm::length(glm::cross(a, b)) / glm::length(b - a));
    }
    const uint32_t base = static_cast<uint32_t>(m_.scene.positions.size()), n = static_cast<uint32_t>(segments_);
    m_.scene.positions.push_back(glm::vec3(at));
    for (const glm::dvec3& p : rim) m_.scene.positions.push_back(glm::vec3(at + p));
    for (uint32_t i = 0; i < n; ++i) m_.scene.triangles.push_back({base, base + 1 + i, base + 1 + (i + 1) % n});
    finish(in, 0, &out);
  }

  void sphere(glm::dvec3 at, double radius) {
    if (radius < 64 * site_.grid_m) return;  // its rounded vertices would not lie on a sphere
    const size_t first = m_.scene.triangles.size();
    add_surface(m_.scene, "sphere", segments_, segments_ / 2, true, [&](double s, double t) {
      const double phi = 2 * std::numbers::pi * s, polar = std::numbers::pi * t;
      const double r = t == 0 || t == 1 ? 0 : std::sin(polar);
      return at + radius * glm::dvec3(r * std::sin(phi), -std::cos(polar), r * std::cos(phi));
    });
    Shape in{.kind = ShapeKind::sphere, .at = at, .edge = {}, .radius = radius}, out = in;
    out.radius = 0;
    for (size_t t = first; t < m_.scene.triangles.size(); ++t) {
      glm::dvec3 p[3];
      for (int i = 0; i < 3; ++i) {
        p[i] = glm::dvec3(m_.scene.positions[m_.scene.triangles[t][i]]) - at;
        out.radius = std::max(out.radius, glm::length(p[i]));
      }
      in.radius = std::min(in.radius, glm::dot(p[0], glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]))));
    }
    finish(in, 0, &out);
  }

  Modelled build() const { return m_; }

 private:
  void finish(const Shape& in, int faces_of_two, const Shape* out = nullptr) {
    const int shape = static_cast<int>(m_.inner.size());
    for (size_t t = m_.owner.size(), first = t; t < m_.scene.triangles.size(); ++t)
      m_.owner.push_back({shape, faces_of_two ? static_cast<int>((t - first) / 2) : 0});
    m_.inner.push_back(in);
    m_.outer.push_back(out ? *out : in);
    m_.round |= out != nullptr;
  }

  Site site_;
  int segments_;
  Modelled m_;
};

inline glm::dvec3 toward(int azimuth_deg, int elevation_deg) {
  const double a = glm::radians(static_cast<double>(azimuth_deg)), e = glm::radians(static_cast<double>(elevation_deg));
  return {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
}

// The light's position lies on the site's grid like every corner. So if a face's plane goes through the light, it does
// so exactly.
inline Light light_of(const SceneSpec& spec, const Site& site, const std::vector<Shape>& shapes) {
  const double little = std::pow(10.0, -spec.decade) * site.scale;
  glm::dvec3 at = site.origin_m + 0.004 * site.scale * glm::dvec3(spec.x, spec.y, spec.z);
  switch (static_cast<LightPlace>(spec.place)) {
    case LightPlace::outside:
      at = site.origin_m + 0.012 * site.scale * spec.distance * toward(spec.azimuth_deg, spec.elevation_deg);
      break;
    case LightPlace::inside:
      break;
    case LightPlace::near_the_floor:
      at.y = site.origin_m.y + little;
      break;
    case LightPlace::near_a_shape: {
      const Shape& s = shapes[static_cast<size_t>(spec.shape) % shapes.size()];
      if (s.kind == ShapeKind::sphere) {
        at = s.at + (s.radius + little) * toward(spec.azimuth_deg, spec.elevation_deg);
        break;
      }
      const FlatFace f = face_of(s, s.kind == ShapeKind::box ? spec.azimuth_deg % 6 : 0);
      const double u = 0.0005 * (spec.x + 1000), v = 0.0005 * (spec.z + 1000);
      at = f.at + u * f.u + v * f.v + little * glm::normalize(glm::cross(f.u, f.v));
      break;
    }
  }
  const bool at_middle =
      spec.light == LightKind::directional || static_cast<LightPlace>(spec.place) == LightPlace::inside;
  return {.kind = spec.light,
          .position_m = site.snapped(at),
          .target_m = site.origin_m + (at_middle ? 0 : 0.002 * site.scale) * glm::dvec3(spec.x, spec.y, spec.z),
          .cone_deg = static_cast<double>(spec.cone_deg)};
}

inline Modelled model_of(const SceneSpec& spec, const Site& site, int segments) {
  Builder builder(site, segments);
  const double half = std::round(half_floor_m * site.scale);
  const glm::dvec3 corner = glm::round(site.origin_m);
  builder.rectangle(corner + glm::dvec3(-half, 0, -half), {0, 0, 2 * half}, {2 * half, 0, 0});
  for (const ShapeSpec& s : spec.shapes) builder.add(s);
  Modelled m = builder.build();
  const glm::dvec3 target = site.origin_m;
  m.scene.name = site.name;
  m.scene.light = light_of(spec, site, m.inner);
  m.scene.camera = {.eye_m = target + 9 * site.scale * toward(spec.camera_azimuth_deg, spec.camera_elevation_deg),
                    .target_m = target + glm::dvec3(0, 0.5 * site.scale, 0),
                    .fov_y_deg = 40,
                    .near_m = 0.1,
                    .far_m = 100 * site.scale};
  return m;
}

inline Settings settings_of(const SceneSpec& spec) {
  const int size = spec.seed % 2 ? 5 : 3;
  const FilterSettings flat[] = {{},
                                 {"box", {{"size", size}}},
                                 {"box", {{"size", size}, {"step_texels", 1.5}}},
                                 {"hardware", {}},
                                 {"gaussian", {{"size", size}}},
                                 {"poisson", {{"radius_texels", 3}, {"rotate", 1}}}},
                       cube[] = {{},
                                 {},
                                 {"cube_grid", {{"offset_m", 0.1}}},
                                 {"cube_disk", {{"radius_m", 0.02}}},
                                 {"cube_disk", {{"radius_m", 0.5}}},
                                 {"cube_disk", {{"disk", 1}}}};
  Settings s;
  s.map.resolution = spec.resolution;
  s.map.extent_scale = spec.light == LightKind::spot ? 0.01 * spec.extent_percent : 1;
  s.filter = (spec.light == LightKind::point ? cube : flat)[spec.filter];
  // Every second cube is turned, by an angle that no other number of the scene depends on.
  if (spec.light == LightKind::point && spec.resolution % 2 == 1)
    s.map.turn_deg = glm::dvec3(spec.resolution % 7 - 3, spec.resolution % 11 - 5, spec.resolution % 13 - 6) * 15.5;
  return s;
}

struct Posed {
  Modelled model;
  LightFrame frame;
};
inline Posed posed(const SceneSpec& spec, const Site& site, int segments) {
  Posed p{model_of(spec, site, segments), {}};
  p.frame = make_light_frame(p.model.scene, settings_of(spec));
  p.frame.near_m += 0.01 * spec.near_cut * (p.frame.far_m - p.frame.near_m);
  return p;
}

// Random points, rounded to float. Each triangle is equally likely, so that small shapes get as many points as large
// ones. facing_light: normals are turned to the light's side; otherwise they are those of the counter-clockwise side,
// which is the outside of a box or a sphere.
inline ReceiverImage points_on_faces(const Scene& scene, const LightFrame& frame, bool facing_light, int count,
                                     uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> in(0, 1);
  std::vector<Placed> points;
  for (int i = 0; i < count; ++i) {
    const uint32_t t = static_cast<uint32_t>(random() % scene.triangles.size());
    const glm::dvec3 a = scene.positions[scene.triangles[t].x], b = scene.positions[scene.triangles[t].y],
                     c = scene.positions[scene.triangles[t].z];
    double u = in(random), v = in(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    points.push_back({a + u * (b - a) + v * (c - a), t});
  }
  ReceiverImage out = receivers_at(scene, points, {}, false);
  for (size_t i = 0; i < points.size() && facing_light; ++i)
    if (glm::dot(glm::dvec3(out.normal[i]), frame.direction_to_light(out.position[i])) < 0)
      out.normal[i] = -out.normal[i];
  return out;
}

inline constexpr int most_shapes = 14;

// rapidcheck begins with small numbers. The resize() here makes it draw every number from its whole range.
inline rc::Gen<ShapeSpec> any_shape(int kinds) {
  using rc::gen::inRange, rc::gen::set;
  const auto place = inRange(-1000, 1001);
  const auto size = inRange(20, 1001);
  // Each angle is 0 in half of the shapes, and so is y, the height of the floor. So there are many contacts and
  // coplanar faces.
  const auto turn = rc::gen::oneOf(rc::gen::just(0), inRange(0, 360));
  return rc::gen::resize(rc::kNominalSize, rc::gen::build<ShapeSpec>(
                                               set(&ShapeSpec::kind, inRange(0, kinds)), set(&ShapeSpec::x, place),
                                               set(&ShapeSpec::y, rc::gen::oneOf(rc::gen::just(0), inRange(-100, 500))),
                                               set(&ShapeSpec::z, place), set(&ShapeSpec::a, size),
                                               set(&ShapeSpec::b, size), set(&ShapeSpec::c, size),
                                               set(&ShapeSpec::decade, inRange(0, 3)), set(&ShapeSpec::yaw_deg, turn),
                                               set(&ShapeSpec::pitch_deg, turn), set(&ShapeSpec::roll_deg, turn)));
}

inline rc::Gen<SceneSpec> any_scene(LightKind light, int kinds) {
  using rc::gen::inRange, rc::gen::just, rc::gen::set;
  const bool sun = light == LightKind::directional;
  const auto place = inRange(-1000, 1001);
  return rc::gen::resize(
      rc::kNominalSize,
      rc::gen::build<SceneSpec>(
          set(&SceneSpec::shapes,
              rc::gen::resize(most_shapes, rc::gen::container<std::vector<ShapeSpec>>(any_shape(kinds)))),
          set(&SceneSpec::light, just(light)), set(&SceneSpec::place, inRange(0, sun ? 1 : 4)),
          set(&SceneSpec::azimuth_deg, inRange(0, 360)), set(&SceneSpec::elevation_deg, inRange(sun ? 5 : 0, 91)),
          set(&SceneSpec::distance, inRange(sun ? 1000 : 20, 1001)), set(&SceneSpec::x, place),
          set(&SceneSpec::y, inRange(-50, 700)), set(&SceneSpec::z, place),
          set(&SceneSpec::shape, inRange(0, most_shapes)), set(&SceneSpec::decade, inRange(1, 5)),
          set(&SceneSpec::cone_deg, inRange(20, 121)),
          set(&SceneSpec::extent_percent, rc::gen::oneOf(just(100), inRange(50, 150))),
          set(&SceneSpec::resolution, inRange(3, 600)), set(&SceneSpec::filter, inRange(0, 6)),
          set(&SceneSpec::camera_azimuth_deg, inRange(0, 360)), set(&SceneSpec::camera_elevation_deg, inRange(3, 90)),
          set(&SceneSpec::near_cut, rc::gen::oneOf(just(0), inRange(0, 80))),
          set(&SceneSpec::seed, inRange<uint32_t>(1, 1u << 30))));
}

}  // namespace noonmark::test
