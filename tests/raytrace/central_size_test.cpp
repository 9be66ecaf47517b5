// R0 of spot and point lights with a size against areas and solid angles, and polygon offset against finite
// differences.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/raytrace/fixture.h"

namespace noonmark::raytrace {
namespace {

using namespace test;

// The fraction of a unit disc on the side x > at of a line.
double disc_beyond(double at) {
  if (at <= -1) return 1;
  if (at >= 1) return 0;
  return (std::acos(at) - at * std::sqrt(1 - at * at)) / std::numbers::pi;
}

// The share of the light's sphere that P sees, in double: an even lattice over its solid angle, where `free` tells
// whether a direction is free. Only the cells on an edge are uncertain, some 1 / 128 of all, and their errors fall
// about equally on both sides.
double sphere_seen(glm::dvec3 centre, double radius, const std::function<bool(glm::dvec3)>& free) {
  constexpr int rings = 128, around = 128;
  const double distance = glm::length(centre);
  const glm::dvec3 axis = centre / distance;
  const glm::dvec3 right =
      glm::normalize(glm::cross(axis, std::abs(axis.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0)));
  const glm::dvec3 up = glm::cross(right, axis);
  const double least = std::sqrt(1 - radius / distance * radius / distance);
  int seen = 0;
  for (int i = 0; i < rings; ++i) {
    const double cosine = 1 - (1 - least) * (i + 0.5) / rings, sine = std::sqrt(1 - cosine * cosine);
    for (int j = 0; j < around; ++j) {
      const double phi = 2 * std::numbers::pi * (j + 0.5 + 0.618 * i) / around;
      seen += free(cosine * axis + sine * (std::cos(phi) * right + std::sin(phi) * up));
    }
  }
  return seen / static_cast<double>(rings * around);
}
constexpr double lattice_error = 2e-3;

// The light is 2 m above the origin. A floor is at y = 0, and above it, at y = 1, a half-plane over x < 0.
constexpr double light_m = 2, edge_m = 1;
Scene half_plane(LightKind kind, LightShape shape, double radius_m) {
  Scene scene;
  add_quad(scene, "floor", {-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
  add_quad(scene, "half-plane", {-64, edge_m, -64}, {0, 0, 128}, {64, 0, 0});
  scene.light = {.kind = kind, .position_m = {0, light_m, 0}, .target_m = {0, 0, 0}};
  scene.light.radius_m = radius_m, scene.light.shape = shape, scene.light.cone_deg = 120;
  return scene;
}

ReceiverImage on_floor(const Scene& scene, double half_m, int count, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> in(-half_m, half_m);
  std::vector<Placed> points;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 p(in(random), 0, in(random));
    points.push_back({p, p.z + 2 <= p.x + 2 ? 1u : 0u});
  }
  return receivers_at(scene, points, {0, 1, 0}, true);
}

struct Errors {
  int compared = 0, partial = 0, beyond_three = 0, wrong = 0;
  double mean = 0;
};

// Each receiver must be within five of its standard errors. The samples are spread evenly in every prefix, so their
// errors are below those of independent samples. The largest error of some thousands of those stays under five standard
// errors.
constexpr double most_errors = 5, standard_error = 0.02;

Errors errors_of(const Scene& scene, const ReceiverImage& receivers, double formula_error,
                 const std::function<double(glm::dvec3)>& expected) {
  const ReceiverTruth truth = Tracer(scene).receiver_truth(receivers, frame_of(scene), {scene.light, standard_error});
  Errors e;
  for (size_t i = 0; i < receivers.primitive.size(); ++i) {
    if (!truth.facing[i]) continue;
    const glm::dvec3 p = receivers.position[i];
    const double exact = expected(p), error = truth.soft[i] - exact;
    ++e.compared;
    e.partial += exact > 0.01 && exact < 0.99;
    e.beyond_three += std::abs(error) > 3 * standard_error + formula_error;
    e.mean += error;
    if (std::abs(error) > most_errors * standard_error + formula_error && ++e.wrong <= 5)
      ADD_FAILURE() << "at " << p.x << ' ' << p.y << ' ' << p.z << ": " << truth.soft[i] << ", not " << exact;
  }
  e.mean /= e.compared;
  return e;
}

void expect_sound(const Errors& e, double formula_error) {
  EXPECT_EQ(e.wrong, 0);
  EXPECT_GT(e.partial, 300);
  EXPECT_LE(e.beyond_three, e.compared / 100);
  EXPECT_LT(std::abs(e.mean), 4 * standard_error / std::sqrt(e.partial) + formula_error);
  testing::Test::RecordProperty("partial", e.partial);
  testing::Test::RecordProperty("mean_error_1e6", static_cast<int>(1e6 * e.mean));
}

// The plane through P and the half-plane's edge cuts the light's disc, which lies flat at light_m, in a line.
TEST(LightSize, ASpotsDiscBehindAnEdgeIsASegment) {
  const double radius = 0.2;
  const Scene scene = half_plane(LightKind::spot, LightShape::disc, radius);
  const ReceiverImage receivers = on_floor(scene, 0.6, 3000, 1);
  const Errors e = errors_of(scene, receivers, 0, [&](glm::dvec3 p) {
    const double line =
        p.x + (0 - p.x) * light_m / edge_m;  // where a ray from P over the edge reaches the disc's height
    return disc_beyond(line / radius);
  });
  expect_sound(e, 0);
}

// A point light's disc faces each receiver.
TEST(LightSize, APointsDiscBehindAnEdgeIsASegment) {
  const double radius = 0.2;
  const Scene scene = half_plane(LightKind::point, LightShape::disc, radius);
  const ReceiverImage receivers = on_floor(scene, 0.6, 3000, 2);
  const Errors e = errors_of(scene, receivers, 0, [&](glm::dvec3 p) {
    // The plane through P and the edge (x = 0, y = edge_m, along z). Its distance from the light's centre is divided by
    // the sine of its angle to the disc, which gives the line on the disc.
    const glm::dvec3 centre = glm::dvec3(0, light_m, 0) - p, axis = glm::normalize(centre);
    const glm::dvec3 n = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), glm::dvec3(-p.x, edge_m, 0)));  // towards -x
    const glm::dvec3 across = n - glm::dot(n, axis) * axis;
    return disc_beyond(glm::dot(n, centre) / (radius * glm::length(across)));
  });
  expect_sound(e, 0);
}

TEST(LightSize, ASphereBehindAnEdgeIsItsSolidAngle) {
  for (LightKind kind : {LightKind::spot, LightKind::point}) {
    for (double radius : {0.05, 0.3, 0.9}) {
      const Scene scene = half_plane(kind, LightShape::sphere, radius);
      const ReceiverImage receivers = on_floor(scene, std::min(0.9, 3 * radius), 400, 3);
      const Errors e = errors_of(scene, receivers, lattice_error, [&](glm::dvec3 p) {
        return sphere_seen(glm::dvec3(0, light_m, 0) - p, radius, [&](glm::dvec3 d) {
          const double to_light = glm::dot(d, glm::dvec3(0, light_m, 0) - p);
          const double beside2 =
              glm::dot(glm::dvec3(0, light_m, 0) - p, glm::dvec3(0, light_m, 0) - p) - to_light * to_light;
          const double reach = to_light - std::sqrt(std::max(0.0, radius * radius - beside2));
          const double at_edge = edge_m / d.y;  // where the ray is as high as the half-plane
          return at_edge > reach || p.x + at_edge * d.x > 0;
        });
      });
      EXPECT_EQ(e.wrong, 0) << radius;
      EXPECT_GT(e.partial, 80) << radius;
      EXPECT_LT(std::abs(e.mean), 4 * standard_error / std::sqrt(e.partial) + lattice_error) << radius;
    }
  }
}

// Nothing shades the receiver, but a part of the sphere is below the receiver's own horizon. The receivers are on a
// wall near the light.
TEST(LightSize, OwnHorizonCutsTheSphere) {
  Scene scene;
  const double radius = 0.3;
  add_quad(scene, "wall", {0, 0, -1}, {0, 2, 0}, {0, 0, 2});  // in x = 0, its front to +x
  scene.light = {.kind = LightKind::point, .position_m = {0.1, 1, 0}};
  scene.light.radius_m = radius;
  const ReceiverImage all = random_receivers(scene, {1, 0, 0}, true, 600, 4);
  const Errors e = errors_of(scene, all, lattice_error, [&](glm::dvec3 p) {
    const glm::dvec3 centre = glm::dvec3(glm::vec3(scene.light.position_m)) - p;
    if (glm::length(centre) <= radius) return 1.0;  // inside
    return sphere_seen(centre, radius, [&](glm::dvec3 d) { return d.x > 0; });
  });
  expect_sound(e, lattice_error);
}

TEST(LightSize, InsideTheSphereAllOfItIsSeen) {
  Scene scene;
  add_quad(scene, "floor", {-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
  add_quad(scene, "shelf", {-1, 0.05, -1}, {0, 0, 2}, {2, 0, 0});  // between the floor and the light
  scene.light = {.kind = LightKind::point, .position_m = {0, 0.1, 0}};
  scene.light.radius_m = 0.5;
  const ReceiverImage receivers = on_floor(scene, 1, 2000, 5);
  const ReceiverTruth truth = Tracer(scene).receiver_truth(receivers, frame_of(scene), {scene.light, 0.02});
  int inside = 0, dark = 0;
  for (size_t i = 0; i < receivers.primitive.size(); ++i) {
    const double distance = glm::length(glm::dvec3(receivers.position[i]) - glm::dvec3(glm::vec3(0, 0.1f, 0)));
    if (std::abs(distance - 0.5) < 1e-6) continue;
    if (distance < 0.5) {
      ++inside;
      EXPECT_EQ(truth.soft[i], 1) << i;
      EXPECT_EQ(truth.lit[i], 0) << i;  // R1 tests the centre alone
    } else {
      dark += truth.soft[i] < 0.5;
    }
  }
  EXPECT_GT(inside, 300);
  EXPECT_GT(dark, 300);
}

// The depth of a plane in the exact map, in double, from the place of a texel alone.
struct TiltedPlane {
  Scene scene;
  LightFrame frame;
  glm::dvec3 normal, at;

  double window_depth(glm::dvec2 texel) const {  // at a texel's coordinates, 0.5 more at its centre
    const glm::dvec2 ndc = 2.0 * texel / static_cast<double>(frame.resolution) - 1.0;
    if (frame.kind == LightKind::directional) {
      const glm::dvec3 start = frame.origin_m + frame.extent_m / 2 * (ndc.x * frame.right + ndc.y * frame.up);
      const double z = glm::dot(normal, at - start) / glm::dot(normal, frame.forward);
      return (z - frame.near_m) / (frame.far_m - frame.near_m);
    }
    const glm::dvec3 way = frame.forward + frame.tan_half_fov * (ndc.x * frame.right + ndc.y * frame.up);
    const double z = glm::dot(normal, at - frame.origin_m) / glm::dot(normal, way);
    return frame.far_m * (z - frame.near_m) / (z * (frame.far_m - frame.near_m));
  }
};

TiltedPlane tilted(LightKind kind, double tilt_deg, double turn_deg, int resolution) {
  TiltedPlane plane;
  const double tilt = tilt_deg * std::numbers::pi / 180, turn = turn_deg * std::numbers::pi / 180;
  plane.normal = {std::sin(tilt) * std::cos(turn), std::cos(tilt), std::sin(tilt) * std::sin(turn)};
  const glm::dvec3 u = glm::normalize(glm::cross(plane.normal, glm::dvec3(0.3, 0.2, 1))),
                   v = glm::cross(plane.normal, u);
  add_quad(plane.scene, "plane", -3.0 * u - 3.0 * v, 6.0 * u, 6.0 * v);
  plane.scene.light = {.kind = kind, .position_m = {0.5, 5, 0.25}, .target_m = {0, 0, 0}};
  plane.scene.light.cone_deg = 40;
  plane.frame = frame_of(plane.scene, resolution);
  // The plane through its float corners.
  const auto& p = plane.scene.positions;
  plane.at = p[0];
  plane.normal = glm::normalize(glm::cross(glm::dvec3(p[1]) - glm::dvec3(p[0]), glm::dvec3(p[2]) - glm::dvec3(p[0])));
  return plane;
}

TEST(PolygonOffsetMap, IsThePlanePlusFactorTimesItsSteepestTexelStep) {
  // A depth below 1 rounds to float within 2^-25. The tolerance has as much again for the four float corners, which are
  // not exactly in one plane.
  constexpr double tolerance = 0x1p-24;
  const double unit = 0x1p-23;  // of a 24-bit map
  int compared = 0;
  double largest = 0, most_steps = 0;
  for (LightKind kind : {LightKind::directional, LightKind::spot})
    for (double tilt : {0.0, 20.0, 55.0})
      for (double turn : {0.0, 30.0, 110.0})
        for (double factor : {0.0, 1.0, 2.5})
          for (double units : {0.0, 4.0, 4096.0}) {
            const TiltedPlane plane = tilted(kind, tilt, turn, 64);
            const ReceiverImage receivers = random_receivers(plane.scene, plane.normal, true, 300, 6);
            Tracer tracer(plane.scene);
            const ReceiverTruth truth = tracer.receiver_truth(receivers, plane.frame, {});
            MapSettings map;
            map.resolution = 64;
            BiasSettings bias;
            bias["polygon_factor"] = factor, bias["polygon_units"] = units;
            const LookupProbe probe = probe_of(receivers, plane.frame);
            const LookupTruth lookup = tracer.lookup_truth(receivers, truth, probe, plane.frame, map, Bias(bias), unit);
            for (size_t i = 0; i < receivers.primitive.size(); ++i) {
              const glm::ivec2 texel = probe.texel(i, 0);
              if (!truth.facing[i] || texel.x < 0 || texel.y < 0 || texel.x > 63 || texel.y > 63) continue;
              const double found = lookup.exact_map.at(texel.x, texel.y);
              if (found == 1) continue;  // a centre beyond the plane's border, or behind far
              // Window depth is affine in the map's texels, so that differences over whole texels are its slope.
              const glm::dvec2 c = glm::dvec2(texel) + 0.5;
              const double m = std::max(
                  std::abs(plane.window_depth(c + glm::dvec2(0.5, 0)) - plane.window_depth(c - glm::dvec2(0.5, 0))),
                  std::abs(plane.window_depth(c + glm::dvec2(0, 0.5)) - plane.window_depth(c - glm::dvec2(0, 0.5))));
              const double expected = std::clamp(plane.window_depth(c) + factor * m + units * unit, 0.0, 1.0);
              ++compared;
              largest = std::max(largest, std::abs(found - expected));
              most_steps = std::max(most_steps, m);
            }
          }
  EXPECT_GT(compared, 10000);
  EXPECT_GT(most_steps, 0.01);
  EXPECT_LT(largest, tolerance);
  RecordProperty("compared", compared);
  RecordProperty("largest_1e9", static_cast<int>(1e9 * largest));
}

}  // namespace
}  // namespace noonmark::raytrace
