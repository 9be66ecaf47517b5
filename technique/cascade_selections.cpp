#include "technique/cascade_selections.h"

#include <cmath>
#include <vector>

#include "base/find_row.h"
#include "technique/cascade_blends.h"
#include "technique/formulas.h"
#include "technique/technique.h"

#define precise
namespace noonmark::in_double {
namespace {
#include "technique/cascade_place.glsl"
}
}  // namespace noonmark::in_double
namespace noonmark::in_bounds {
namespace {
#include "technique/cascade_place.glsl"
}
}  // namespace noonmark::in_bounds
#undef precise

namespace noonmark {
namespace {

in_bounds::vec3 exact(glm::vec3 v) {  // which the shader has as it is
  return {Bounded(static_cast<double>(v.x)), Bounded(static_cast<double>(v.y)), Bounded(static_cast<double>(v.z))};
}
in_bounds::vec3 rounded(glm::dvec3 v) {
  const auto one = [](double x) { return Bounded(x, float_rounding * std::abs(x)); };
  return {one(v.x), one(v.y), one(v.z)};
}
Bounded exact(float value) { return Bounded(static_cast<double>(value)); }

template <class T>
const T& of(const std::vector<T>& list, int cascade) {
  return list.at(static_cast<size_t>(cascade));
}

double depth_in_double(const CascadePlace& p, int k, glm::dvec3 eye, glm::dvec3 at) {
  const glm::dvec2 ends(of(p.depths, k));
  return in_double::place_by_depth(at, eye, glm::dvec3(p.view_forward), ends.x, ends.y);
}
Bounded depth_in_bounds(const CascadePlace& p, int k, glm::dvec3 eye, glm::vec3 at) {
  const glm::vec2 ends = of(p.depths, k);
  return in_bounds::place_by_depth(exact(at), rounded(eye), exact(p.view_forward), exact(ends.x), exact(ends.y));
}

double map_in_double(const CascadePlace& p, int k, glm::dvec3, glm::dvec3 at) {
  const glm::dmat3 axes(p.light_axes);
  return in_double::place_by_map(at, glm::dvec3(of(p.middles, k)), axes[0], axes[1], axes[2],
                                 glm::dvec3(of(p.halves, k)));
}
Bounded map_in_bounds(const CascadePlace& p, int k, glm::dvec3, glm::vec3 at) {
  const glm::mat3& axes = p.light_axes;
  return in_bounds::place_by_map(exact(at), exact(of(p.middles, k)), exact(axes[0]), exact(axes[1]), exact(axes[2]),
                                 exact(of(p.halves, k)));
}

double sphere_in_double(const CascadePlace& p, int k, glm::dvec3, glm::dvec3 at) {
  return in_double::place_by_sphere(at, glm::dvec3(of(p.middles, k)), static_cast<double>(of(p.halves, k).x));
}
Bounded sphere_in_bounds(const CascadePlace& p, int k, glm::dvec3, glm::vec3 at) {
  return in_bounds::place_by_sphere(exact(at), exact(of(p.middles, k)), exact(of(p.halves, k).x));
}

}  // namespace

std::span<const CascadeSelection> cascade_selections() {
  static const std::vector<CascadeSelection> all = {
      {"depth", "shaders/cascade/by_depth.glsl", "by the depth along the view, as in Bevy and Godot", depth_in_double,
       depth_in_bounds},
      {"map", "shaders/cascade/by_map.glsl", "the first whose map holds the receiver with all its taps", map_in_double,
       map_in_bounds},
      {"sphere", "shaders/cascade/by_sphere.glsl",
       "map.fit = sphere: the first whose sphere holds the receiver, as in Unity", sphere_in_double, sphere_in_bounds},
  };
  return all;
}

const CascadeSelection& find_cascade_selection(std::string_view name) {
  return find_row(cascade_selections(), name, "cascade selection");
}

double weight_of_next(const CascadePlace& p, double place) {
  return p.shape->in_double(in_double::way_into_band(place, static_cast<double>(p.blend)));
}
Bounded weight_of_next(const CascadePlace& p, Bounded place) {
  return p.shape->in_bounds(in_bounds::way_into_band(place, exact(p.blend)));
}

}  // namespace noonmark
