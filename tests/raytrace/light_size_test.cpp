// R0 of lights with a size. Suns are compared with closed forms in random scenes. Spot and point lights behind an edge
// are compared with the area or the solid angle of the part that is seen.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/raytrace/closed_form_scenes.h"
#include "tests/raytrace/fixture.h"

namespace noonmark::raytrace {
namespace {

using namespace test;

// The fraction of a unit disc where x > at.
double disc_beyond(double at) {
  if (at <= -1) return 1;
  if (at >= 1) return 0;
  return (std::acos(at) - at * std::sqrt(1 - at * at)) / std::numbers::pi;
}

// The fraction of a spherical light that is seen. It is counted on an even lattice over the light's solid angle, in
// double; free() says whether a direction is seen. Only cells on an edge can be counted wrongly, about 1 / 128 of all.
// About half of these errors have the opposite sign of the others, so most of the sum cancels.
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

// The light is 2 m above the origin, and the floor is at y = 0. Above the floor, at y = 1, a half-plane covers x < 0.
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

// The error of a receiver may be up to five times its standard error. Any first n of the samples are evenly spread, so
// their errors are smaller than those of independent samples. Of some thousands of receivers with independent samples,
// the largest error stays below five standard errors.
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
      ADD_FAILURE() << "at " << p.x << ' ' << p.y << ' ' << p.z << ": R0 by rays " << truth.soft[i] << ", by formula "
                    << exact;
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

// The light's disc is horizontal, at the height light_m. The plane through P and the half-plane's edge cuts it along a
// line, and the part beyond this line is seen.
TEST(LightSize, ASpotsDiscBehindAnEdgeIsASegment) {
  const double radius = 0.2;
  const Scene scene = half_plane(LightKind::spot, LightShape::disc, radius);
  const ReceiverImage receivers = on_floor(scene, 0.6, 3000, 1);
  const Errors e = errors_of(scene, receivers, 0, [&](glm::dvec3 p) {
    const double line =
        p.x + (0 - p.x) * light_m / edge_m;  // where the ray from P over the edge is as high as the disc
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
    // The plane through P and the edge (x = 0, y = edge_m, along z) cuts the disc along a line. The distance from the
    // disc's centre to this line is its distance to the plane, divided by the sine of the angle between plane and disc.
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
      EXPECT_EQ(e.wrong, 0) << "radius " << radius;
      EXPECT_GT(e.partial, 80) << "radius " << radius;
      EXPECT_LT(std::abs(e.mean), 4 * standard_error / std::sqrt(e.partial) + lattice_error) << "radius " << radius;
    }
  }
}

// The receivers are on a wall beside the light. No other surface shades them, but a part of the sphere is below their
// own horizon.
TEST(LightSize, OwnHorizonCutsTheSphere) {
  Scene scene;
  const double radius = 0.3;
  add_quad(scene, "wall", {0, 0, -1}, {0, 2, 0}, {0, 0, 2});  // at x = 0, front towards +x
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
      EXPECT_EQ(truth.soft[i], 1) << "receiver " << i;
      EXPECT_EQ(truth.lit[i], 0) << "receiver " << i;  // R1 is that of the light's centre only
    } else {
      dark += truth.soft[i] < 0.5;
    }
  }
  EXPECT_GT(inside, 300);
  EXPECT_GT(dark, 300);
}

// The error of each receiver is bounded by its standard error, and the mean error of all receivers is near 0.
TEST(ClosedForm, SunsOfAnySize) {
  constexpr double chord_error = 1e-3;  // the error of 256 chords is smaller
  int compared = 0, partial = 0, wrong = 0, beyond_three = 0, banded = 0, contacts = 0;
  double mean = 0;
  for (int seed = 1; seed <= 48; ++seed) {
    const SceneSpec spec =
        any_scene(LightKind::directional, seed % 2 ? 2 : 4)(rc::Random(static_cast<uint64_t>(seed)), rc::kNominalSize)
            .value();
    const auto [model, frame] = posed(spec, seed % 3 == 0 ? at_1_km : at_origin, 96);
    const double diameter_deg = 0.5 * (1 << seed % 6);
    const ReceiverImage receivers = points_on_faces(model.scene, frame, true, 300, static_cast<uint32_t>(seed));
    const ReceiverTruth truth = Tracer(model.scene).receiver_truth(receivers, frame, sun(diameter_deg, standard_error));
    const ClosedForm inner(model.inner, frame), outer(model.outer, frame);
    for (size_t i = 0; i < receivers.primitive.size(); ++i) {
      const auto [shape, face] = model.owner[receivers.primitive[i]];
      if (!truth.facing[i] || model.inner[static_cast<size_t>(shape)].kind == ShapeKind::sphere) continue;
      const Place place{receivers.position[i], shape, face};
      const double most = inner.seen(place, receivers.normal[i], diameter_deg, 256),
                   least = outer.seen(place, receivers.normal[i], diameter_deg, 256);
      if (most > 0.99 && !inner.lit(place)) {  // a contact: P lies in the plane of a shape that touches P's shape
        ++contacts;
        continue;
      }
      const double above = truth.soft[i] - most, below = least - truth.soft[i];
      banded += most - least > standard_error;
      ++compared;
      partial += most > 0.01 && least < 0.99;
      beyond_three += std::max(above, below) > 3 * standard_error + chord_error;
      mean += std::max(above, 0.0) - std::max(below, 0.0);
      if (std::max(above, below) > most_errors * standard_error + chord_error && ++wrong <= 5)
        ADD_FAILURE() << spec << "\nreceiver " << i << " on shape " << shape << ": R0 by rays " << truth.soft[i]
                      << ", by formula " << least << " to " << most << ", diameter " << diameter_deg << ", face "
                      << face << ", R1 by rays " << static_cast<int>(truth.lit[i]) << ", by formula "
                      << inner.lit(place) << ", at " << place.p.x << ' ' << place.p.y << ' ' << place.p.z << " normal "
                      << receivers.normal[i].x << ' ' << receivers.normal[i].y << ' ' << receivers.normal[i].z;
    }
  }
  RecordProperty("compared", compared);
  RecordProperty("partial", partial);
  RecordProperty("beyond_three", beyond_three);
  RecordProperty("banded", banded);
  RecordProperty("mean_error_1e6", static_cast<int>(1e6 * mean / compared));
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(partial, 100);
  EXPECT_LE(contacts, compared / 200);
  EXPECT_LE(beyond_three, compared / 200);
  EXPECT_LT(std::abs(mean / compared), 4 * standard_error / std::sqrt(partial) + 1e-4);
}

}  // namespace
}  // namespace noonmark::raytrace
