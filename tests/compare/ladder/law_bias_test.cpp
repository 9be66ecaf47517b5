// Law 1 for every light: its closed forms compared with planes that are intersected ray by ray.
#include "compare/ladder/law_bias.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "compare/ladder/law_metrics.h"
#include "technique/placements.h"

namespace noonmark {
namespace {

double random_in(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
glm::dvec3 random_way(std::mt19937& random) {
  for (;;) {
    const glm::dvec3 v(random_in(random, -1, 1), random_in(random, -1, 1), random_in(random, -1, 1));
    if (glm::length(v) > 0.1 && glm::length(v) < 1) return glm::normalize(v);
  }
}

LightFrame random_frame(std::mt19937& random, LightKind kind) {
  LightFrame f;
  f.kind = kind;
  f.tiles = f.light().tiles(MapSettings{});
  f.origin_m = 3.0 * random_way(random);
  if (kind != LightKind::point) {
    f.forward = random_way(random);
    f.right = glm::normalize(glm::cross(f.forward, random_way(random)));
    f.up = glm::cross(f.right, f.forward);
  } else {
    f.forward = {0, 0, 1};
  }
  f.extent_m = random_in(random, 2, 20);
  f.near_m = random_in(random, 0.1, 0.5);
  f.far_m = random_in(random, 10, 40);
  if (kind == LightKind::spot) {
    f.tan_half_fov = random_in(random, 0.2, 1.5);
    f.shift_texels = {random_in(random, -1, 1), random_in(random, -1, 1)};
  }
  f.resolution = f.rows = 16 + static_cast<int>(random() % 1000);
  return f;
}

struct Plane {
  glm::dvec3 point, normal;  // in the world; the normal is turned to the light
};

// A plane through a point in the map. It is rarely steeper than 75 degrees to the ray.
Plane random_plane(std::mt19937& random, const LightFrame& f) {
  glm::dvec3 light(random_in(random, -2, 2), random_in(random, -2, 2), random_in(random, 2, 8));
  if (f.kind == LightKind::spot)
    light = {light.z * f.tan_half_fov * light.x / 3, light.z * f.tan_half_fov * light.y / 3, light.z};
  if (f.kind == LightKind::point) light = random_in(random, 1, 8) * random_way(random);
  const glm::dvec3 point = f.to_world(light);
  for (;;) {
    const glm::dvec3 normal = random_way(random);
    if (glm::dot(normal, f.direction_to_light(point)) > (random() % 10 == 0 ? 0.05 : 0.25)) return {point, normal};
  }
}

// The window depth at which the plane meets the ray through a place.
double depth_at(const LightFrame& f, const Plane& plane, glm::dvec3 place) {
  const glm::dvec3 from = f.light().rays().have_one_direction() ? f.to_world({place.x, place.y, 0}) : f.origin_m;
  const glm::dvec3 way = f.light().rays().have_one_direction() ? f.forward : f.to_world(place) - f.origin_m;
  const double t = glm::dot(plane.point - from, plane.normal) / glm::dot(way, plane.normal);
  return f.window_depth(f.to_light(from + t * way));
}

LookupProbe probe_of(const FilterSettings& filter, std::string_view reference = "own_depth") {
  LookupProbe probe;
  probe.pattern = tap_pattern(filter);
  probe.tap_reference = &tap_reference(reference);
  probe.bias_unit = Image<float>(1, 1, 1);
  return probe;
}
FilterSettings filter_of(const std::string& kind, int size = 3) {
  FilterSettings filter;
  filter.kind = kind;
  filter["size"] = size;
  return filter;
}

// The window depth of a plane is affine in texels: the step is the same at every texel and equals the formula. It also
// equals the gradient from the inverse transposed matrix of the light.
TEST(DepthGradient, IsThePlanesStepFromTexelToTexel) {
  std::mt19937 random(1);
  for (int i = 0; i < 400; ++i) {
    const LightFrame f = random_frame(random, i % 2 ? LightKind::spot : LightKind::directional);
    const Plane plane = random_plane(random, f);
    const glm::dvec2 gradient = depth_gradient(f, plane.point, plane.normal);
    const glm::ivec2 at(glm::floor(f.map_texels(f.place(f.to_light(plane.point)))));
    const auto depth = [&](int x, int y) { return depth_at(f, plane, f.texel_place(at + glm::ivec2(x, y))); };
    const double scale = std::abs(gradient.x) + std::abs(gradient.y);
    for (int step : {-2, -1, 1, 2}) {
      EXPECT_NEAR(depth(step, 0) - depth(0, 0), step * gradient.x, 1e-8 * scale + 1e-12);
      EXPECT_NEAR(depth(0, step) - depth(0, 0), step * gradient.y, 1e-8 * scale + 1e-12);
    }
    const glm::dvec4 clip = glm::transpose(glm::inverse(f.clip_from_world(0))) *
                            glm::dvec4(plane.normal, -glm::dot(plane.normal, plane.point));
    EXPECT_NEAR(-clip.x / clip.z / f.resolution, gradient.x, 1e-8 * scale + 1e-12);
    EXPECT_NEAR(-clip.y / clip.z / f.resolution, gradient.y, 1e-8 * scale + 1e-12);
  }
}

// The bias that a lookup of the plane itself needs: the largest difference between the reference and the depth of the
// plane at the centre of a tap's texel.
double need(const LightFrame& f, const Plane& plane, const LookupProbe& probe) {
  const glm::dvec3 light = f.to_light(plane.point);
  const glm::dvec2 at = f.map_texels(f.place(light));
  double most = 0;
  for (int t = 0; t < probe.taps(); ++t) {
    const glm::dvec3 offset(probe.offset(0, t));
    const glm::dvec3 place = f.tap_place(light, offset);
    const glm::dvec2 tap = f.kind == LightKind::point ? f.map_texels(place) : at + glm::dvec2(offset);
    const glm::dvec3 centre = f.texel_place(glm::ivec2(glm::floor(tap)));
    // A ray that misses the plane causes no acne on it.
    if (!f.light().rays().have_one_direction() &&
        glm::dot(plane.point - f.origin_m, plane.normal) / glm::dot(f.to_world(centre) - f.origin_m, plane.normal) <= 0)
      continue;
    double reference = f.window_depth(light);
    if (probe.tap_reference->name == "receiver_plane") {
      const double cap = static_cast<double>(probe.plane_cap) * probe.bias_unit[0];
      reference += std::clamp(glm::dot(depth_gradient(f, plane.point, plane.normal), glm::dvec2(offset)), -cap, cap);
    }
    most = std::max(most, reference - depth_at(f, plane, centre));
  }
  return most;
}

// No alignment needs more than the law, and some need almost as much.
TEST(AcneLaw, IsTheLeastUpperBoundOverAlignmentsOfAFlatMap) {
  std::mt19937 random(2);
  // The cap limits some of the planes and not the others.
  LookupProbe capped = probe_of(filter_of("box", 5), "receiver_plane");
  capped.plane_cap = 0.5f;
  capped.bias_unit[0] = 0x1p-6f;
  for (const LightKind kind : {LightKind::directional, LightKind::spot}) {
    for (const LookupProbe& probe :
         {probe_of(filter_of("none")), probe_of(filter_of("box", 5)), probe_of(filter_of("hardware")),
          probe_of(filter_of("gaussian", 3)), probe_of(filter_of("box", 5), "receiver_plane"), capped}) {
      for (int plane_number = 0; plane_number < 10; ++plane_number) {
        LightFrame f = random_frame(random, kind);
        const Plane plane = random_plane(random, f);
        const double law = AcneLaw(f, probe).at(0, plane.point, plane.normal);
        double most = 0;
        // All alignments of a fine grid: the origin or the texels are moved by fractions of a texel.
        const glm::dvec3 origin = f.origin_m;
        const glm::dvec2 shift = f.shift_texels;
        constexpr int steps = 40;
        for (int y = 0; y < steps; ++y)
          for (int x = 0; x < steps; ++x) {
            const glm::dvec2 by(static_cast<double>(x) / steps, static_cast<double>(y) / steps);
            if (f.light().rays().have_one_direction())
              f.origin_m = origin + f.texel_m(glm::dvec3(0)) * (by.x * f.right + by.y * f.up);
            else
              f.shift_texels = shift + by;
            most = std::max(most, need(f, plane, probe));
          }
        EXPECT_LE(most, law * (1 + 1e-9) + 1e-14);
        // The worst alignment is at most one step away along each axis.
        EXPECT_GE(most, law * (1 - 2.0 / steps));
      }
    }
  }
}

TEST(AcneLaw, AsksNothingOfTheTexelPlane) {
  std::mt19937 random(3);
  const LookupProbe probe = probe_of(filter_of("box", 5), "texel_plane");
  const LightFrame f = random_frame(random, LightKind::spot);
  const Plane plane = random_plane(random, f);
  EXPECT_EQ(AcneLaw(f, probe).at(0, plane.point, plane.normal), 0);
}

std::vector<LookupProbe> cube_probes() {
  FilterSettings grid = filter_of("cube_grid"), disk = filter_of("cube_disk");
  grid["offset_m"] = 0.2;
  disk["radius_m"] = 0.1;
  std::vector<LookupProbe> probes = {probe_of(filter_of("none")), probe_of(grid), probe_of(disk)};
  disk["disk"] = 1;
  probes.push_back(probe_of(disk));
  probes.back().radius = Image<float>(1, 1, 0.07f);
  return probes;
}

// Samples half a texel around the place of each tap. No sample may be nearer than the law says, and one must be as
// near.
TEST(AcneLaw, OfACubeIsTheNearestOfTheSquareAroundEachTap) {
  std::mt19937 random(4);
  for (const LookupProbe& probe : cube_probes()) {
    for (int i = 0; i < 20; ++i) {
      LightFrame f = random_frame(random, LightKind::point);
      if (i % 2)
        f.resolution = f.rows = 4 + i;  // the squares are so wide that the nearest place is on a side or inside
      if (i % 4 > 1) f = Placements(3).frame(f, 1 + i % 8);
      Plane plane = random_plane(random, f);
      if (i % 4 == 1) plane.normal = f.direction_to_light(plane.point);
      const glm::dvec3 light = f.to_light(plane.point);
      double nearest = f.window_depth(light);
      const double own = nearest;
      constexpr int steps = 60;
      for (int t = 0; t < probe.taps(); ++t) {
        const glm::dvec3 place = f.tap_place(light, glm::dvec3(probe.offset(0, t)));
        const MapTile face = f.tile_at(place);
        const double ahead = glm::dot(place, face.forward), half = 1.0 / f.resolution;
        for (int y = 0; y <= steps; ++y)
          for (int x = 0; x <= steps; ++x) {
            const double s = glm::dot(place, face.right) / ahead + half * (2.0 * x / steps - 1);
            const double u = glm::dot(place, face.up) / ahead + half * (2.0 * y / steps - 1);
            const glm::dvec3 way = face.forward + std::clamp(s, half - 1, 1 - half) * face.right +
                                   std::clamp(u, half - 1, 1 - half) * face.up;
            if (glm::dot(way, plane.normal) >= 0) continue;
            nearest = std::min(nearest, depth_at(f, plane, way));
          }
      }
      const double law = AcneLaw(f, probe).at(0, plane.point, plane.normal);
      EXPECT_GE(law, own - nearest - 1e-13);
      EXPECT_LE(law, (own - nearest) * 1.05 + 1e-6) << "the law exceeds the samples by more than their step";
    }
  }
}

TEST(AcneLaw, OfACubeIsNoLessThanAnyGridNeeds) {
  std::mt19937 random(5);
  double tightest = 0;
  for (const LookupProbe& probe : cube_probes()) {
    for (int i = 0; i < 3000; ++i) {
      const LightFrame f = random_frame(random, LightKind::point);
      const Plane plane = random_plane(random, f);
      const double law = AcneLaw(f, probe).at(0, plane.point, plane.normal), needed = need(f, plane, probe);
      ASSERT_LE(needed, law * (1 + 1e-9) + 1e-14);
      if (probe.taps() == 1) tightest = std::max(tightest, needed / law);
    }
  }
  EXPECT_GT(tightest, 0.95);
}

// The law of a face is that of a plane for every place on it. With flat maps it is the same number. Under a point light
// it is an upper bound, at most a small multiple of what the worst place needs.
TEST(AcneLaw, OfAFaceBoundsEveryPlaceOnIt) {
  std::mt19937 random(6);
  for (const LightKind kind : {LightKind::directional, LightKind::spot, LightKind::point}) {
    std::vector<LookupProbe> probes = cube_probes();
    if (kind != LightKind::point) probes = {probe_of(filter_of("box", 3))};
    for (const LookupProbe& probe : probes) {
      for (int i = 0; i < 60; ++i) {
        const LightFrame f = random_frame(random, kind);
        const Plane plane = random_plane(random, f);
        const glm::dvec3 across = glm::normalize(glm::cross(plane.normal, random_way(random)));
        const glm::dvec3 corners[3] = {plane.point, plane.point + 1.5 * across,
                                       plane.point + glm::cross(across, plane.normal)};
        const AcneLaw law(f, probe);
        const double of_face = law.of_face(corners, 3.0 * plane.normal);
        double most = 0;
        for (int n = 0; n < 200; ++n) {
          double a = random_in(random, 0, 1), b = random_in(random, 0, 1);
          if (n < 3) a = n == 1, b = n == 2;
          if (a + b > 1) a = 1 - a, b = 1 - b;
          const glm::dvec3 p = corners[0] + a * (corners[1] - corners[0]) + b * (corners[2] - corners[0]);
          most = std::max(most, law.at(0, p, plane.normal));
        }
        EXPECT_LE(most, of_face * (1 + 1e-9));
        if (kind != LightKind::point)
          EXPECT_NEAR(of_face / most, 1, 1e-9);
        else
          // The bound uses the diagonal of a square instead of its side, a texel in the middle of a face instead of one
          // in a corner, and the longest offset instead of those along the slope. Each is a factor of at most 3, and
          // they rarely occur together.
          EXPECT_LE(of_face, 6 * most + 1e-6);
      }
    }
  }
}

// The metrics under a spot light: the largest need of all receivers, in depth and in metres; the largest step of the
// format in metres; areas perpendicular to each receiver's ray.
TEST(LawMetrics, UnderASpotLightAreTheWorstReceivers) {
  LightFrame f;
  f.kind = LightKind::spot;
  f.near_m = 0.5;
  f.far_m = 20;
  f.tan_half_fov = 0.5;
  f.cos_half_cone = 0.9;
  f.resolution = f.rows = 100;
  const glm::dvec3 normal(0.6, 0, 0.8);
  Ladder ladder;
  ladder = empty_ladder(3, 1);
  for (Ladder::RungImage& rung : ladder.rungs) rung.lit = Image<float>(3, 1, 1);
  ladder.flags = Image<uint8_t>(3, 1, flag_facing);
  ladder.flags[2] = 0;
  const ReceiverImage receivers{Image<glm::vec3>(3, 1, glm::vec3(0, 0, -2)), Image<glm::vec3>(3, 1, glm::vec3(normal)),
                                Image<uint32_t>(3, 1, 0)};
  ReceiverImage apart = receivers;
  apart.position[1] = {0, 0, -4};
  apart.position[2] = {0, 0, -16};  // not counted
  const LookupProbe probe = probe_of(filter_of("none"));
  const Scene nothing;
  const Camera camera{.eye_m = {0, 0, 1}, .target_m = {0, 0, -1}};
  const auto metrics = measure_laws({ladder, nothing, apart, camera, f, DepthFormat::d16, probe});
  // dd/di = far near / (far - near) * 0.6 / (0.8 z) * 2 / 2 / 100: smaller at larger distances.
  const double q = 1 / 65535.0, nearer = 10 / 19.5 * 0.75 / 2 / 100 / 2;
  constexpr double float_normal = 1e-6;
  EXPECT_NEAR(metrics.at("acne_free_bias_law_depth") / (nearer + q / 2), 1, float_normal);
  EXPECT_NEAR(metrics.at("acne_free_bias_law_m") / ((nearer / 2 + q / 2) * 19.5 / 10 * 16), 1, float_normal)
      << "the same depth is more metres at the farther receiver";
  EXPECT_NEAR(metrics.at("depth_quantum_m"), q * 19.5 / 10 * 16, 1e-12);
  EXPECT_NEAR(metrics.at("texel_m"), 0.04, 1e-12);  // the median of two is the upper one
  // Parallel view rays see equal pixels. So the areas are proportional to the cosines to each receiver's own light ray.
  apart.position[1] = {1, 0, -4};
  const Camera parallel{.projection = Projection::orthographic, .eye_m = {0, 0, 1}, .target_m = {0, 0, -1}};
  const Image<double> areas = light_plane_areas(parallel, f, apart);
  EXPECT_NEAR(areas[1] / areas[0], (4 * 0.8 - 0.6) / std::sqrt(17.0) / 0.8, float_normal);
}

}  // namespace
}  // namespace noonmark
