// A second check of R1: every triangle of a scene is tested, one by one, in double. Also: how much of the truth of real
// pictures is ambiguous.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <array>

#include "raytrace/embree_scene.h"
#include "scenes/builtin.h"
#include "scenes/camera_frame.h"
#include "scenes/gltf/gltf.h"
#include "tests/raytrace/closed_form.h"
#include "tests/raytrace/fixture.h"

namespace noonmark::raytrace {
namespace {

using namespace test;

// Uses no bins, no tree and no boxes: only every triangle's three edge functions, and the depth of its plane along the
// light.
class EveryTriangle {
 public:
  EveryTriangle(const Scene& scene, glm::dvec3 to_light) {
    const glm::dvec3 w = to_light,
                     u = glm::normalize(glm::cross(w, std::abs(w.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    axes_ = {u, glm::cross(w, u), w};
    for (const glm::uvec3 t : scene.triangles) {
      Corners c;
      for (int i = 0; i < 3; ++i) c[static_cast<size_t>(i)] = turned(scene.positions[t[i]]);
      corners_.push_back(c);
    }
  }

  // Whether P, moved along the ray to its own triangle's plane, is behind another triangle.
  bool occluded(glm::dvec3 world, uint32_t own) const {
    const glm::dvec3 p = turned(world);
    const Plane at_own = plane(own, p);
    for (uint32_t t = 0; t < corners_.size(); ++t) {
      const Corners& c = corners_[t];
      const double ab = side(c[0], c[1], p), bc = side(c[1], c[2], p);
      if (ab * bc < 0) continue;
      const double ca = side(c[2], c[0], p);
      if (ca * ab < 0 || ca * bc < 0 || t == own) continue;
      const Plane other = plane(t, p);
      if (other.height - at_own.height > other.rounding + at_own.rounding) return true;
    }
    return false;
  }

 private:
  using Corners = std::array<glm::dvec3, 3>;
  struct Plane {
    double height = 0;    // towards the light, over P
    double rounding = 0;  // of that, in double: some hundred times 2^-53, grown by the plane's slope
  };

  glm::dvec3 turned(glm::dvec3 world) const {
    return {glm::dot(world, axes_[0]), glm::dot(world, axes_[1]), glm::dot(world, axes_[2])};
  }
  static double side(glm::dvec3 a, glm::dvec3 b, glm::dvec3 p) {
    return (a.x - p.x) * (b.y - p.y) - (a.y - p.y) * (b.x - p.x);
  }
  Plane plane(uint32_t t, glm::dvec3 p) const {
    const Corners& c = corners_[t];
    const glm::dvec3 n = glm::cross(c[1] - c[0], c[2] - c[0]);
    if (n.z == 0) return {-std::numeric_limits<double>::infinity(), 0};  // edge-on: it shades nothing
    const double scale = glm::length(c[0]) + glm::length(p) + glm::length(c[1] - c[0]) + glm::length(c[2] - c[0]);
    return {c[0].z - p.z - (n.x * (p.x - c[0].x) + n.y * (p.y - c[0].y)) / n.z,
            1e-13 * scale * glm::length(n) / std::abs(n.z)};
  }

  std::array<glm::dvec3, 3> axes_;
  std::vector<Corners> corners_;
};

ReceiverImage picture_of(const Scene& scene, int width, int height) {
  const EmbreeDevice device;
  const EmbreeScene embree(device, scene);
  const CameraFrame camera = make_camera_frame(scene.camera, width, height);
  Image<uint32_t> primitives(width, height, no_primitive);
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const Ray ray = camera.pixel_ray(x, y, width, height);
      primitives.at(x, y) = embree.first_hit({glm::vec3(ray.origin), glm::vec3(ray.direction)});
    }
  });
  return resolve_receivers(scene, scene.camera, primitives);
}

// A random sample of at most `count` receivers that face the light, as an image one pixel high.
ReceiverImage sample_of(const ReceiverImage& all, glm::dvec3 to_light, int count, uint32_t seed) {
  std::vector<size_t> facing;
  for (size_t i = 0; i < all.primitive.size(); ++i)
    if (all.primitive[i] != no_primitive && glm::dot(glm::dvec3(all.normal[i]), to_light) > 0) facing.push_back(i);
  std::mt19937 random(seed);
  std::shuffle(facing.begin(), facing.end(), random);
  facing.resize(std::min(facing.size(), static_cast<size_t>(count)));
  const int n = static_cast<int>(facing.size());
  ReceiverImage out{Image<glm::vec3>(n, 1), Image<glm::vec3>(n, 1), Image<uint32_t>(n, 1)};
  for (size_t i = 0; i < facing.size(); ++i) {
    out.position[i] = all.position[facing[i]];
    out.normal[i] = all.normal[facing[i]];
    out.primitive[i] = all.primitive[facing[i]];
  }
  return out;
}

struct Counted {
  int facing = 0, lit = 0, ambiguous = 0, wrong = 0, hidden = 0;
};

Counted compare(const Scene& scene, const ReceiverImage& receivers) {
  const LightFrame frame = frame_of(scene);
  const ReceiverTruth truth = Tracer(scene).receiver_truth(receivers, frame, {});
  const EveryTriangle every(scene, frame.direction_to_light());
  std::vector<uint8_t> lit(receivers.primitive.size());
  tbb::parallel_for(size_t{0}, lit.size(), [&](size_t i) {
    if (truth.facing[i]) lit[i] = !every.occluded(receivers.position[i], receivers.primitive[i]);
  });
  Counted c;
  for (size_t i = 0; i < lit.size(); ++i) {
    if (!truth.facing[i]) continue;
    ++c.facing;
    c.lit += lit[i];
    c.ambiguous += truth.ambiguous[i];
    (truth.ambiguous[i] ? c.hidden : c.wrong) += lit[i] != truth.lit[i];
  }
  testing::Test::RecordProperty(scene.name + ".facing", c.facing);
  testing::Test::RecordProperty(scene.name + ".lit", c.lit);
  testing::Test::RecordProperty(scene.name + ".ambiguous", c.ambiguous);
  testing::Test::RecordProperty(scene.name + ".disagreements", c.wrong);
  testing::Test::RecordProperty(scene.name + ".disagreements_of_ambiguous", c.hidden);
  return c;
}

class Witness : public testing::TestWithParam<const char*> {};

TEST_P(Witness, EveryTriangleAgreesWithR1) {
  const std::string path = shared_model(GetParam());
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  Scene scene = load_gltf(path);
  const glm::dvec3 to_light = frame_of(scene).direction_to_light();
  scene.name = "picture";
  const Counted seen = compare(scene, sample_of(picture_of(scene, 960, 540), to_light, 12000, 1));
  EXPECT_GE(seen.facing, 10000);
  scene.name = "surface";
  const Counted surface = compare(scene, random_receivers(scene, to_light, true, 12000, 2));
  for (const Counted& c : {seen, surface}) {
    EXPECT_EQ(c.wrong, 0);
    EXPECT_GT(c.lit, c.facing / 10);
    EXPECT_LT(c.lit, c.facing);
    EXPECT_LE(c.ambiguous, c.facing / 1000);
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, Witness, testing::Values("FlightHelmet", "Lantern"),
                         [](const auto& given) { return given.param; });

// The check itself is compared with the closed form, on boxes whose corners floats hold exactly.
TEST(WitnessItself, AgreesWithTheClosedForm) {
  Scene scene;
  std::vector<Shape> shapes;
  std::vector<std::pair<int, int>> owner;
  const auto box = [&](glm::dvec3 low, glm::dvec3 high) {
    const glm::dvec3 size = high - low;
    add_box(scene, "box", low, high);
    shapes.push_back({ShapeKind::box, low, {glm::dvec3(size.x, 0, 0), {0, size.y, 0}, {0, 0, size.z}}, 0});
    for (int t = 0; t < 12; ++t) owner.push_back({static_cast<int>(shapes.size()) - 1, t / 2});
  };
  box({-4, -0.5, -4}, {4, 0, 4});
  box({-1, 0, -0.5}, {0.25, 1.5, 1});
  box({0.5, 0.75, -2}, {2, 0.875, 2});
  box({-2, 0.5, -2}, {-1.75, 3, -1.75});
  scene.light = {.position_m = {-2, 4, -1}, .target_m = {0, 0, 0}};
  const LightFrame frame = frame_of(scene);
  const ClosedForm truth(shapes, frame);
  const EveryTriangle every(scene, frame.direction_to_light());
  const ReceiverImage receivers = random_receivers(scene, frame.direction_to_light(), true, 20000, 3);
  int dark = 0, wrong = 0;
  for (size_t i = 0; i < receivers.primitive.size(); ++i) {
    const auto [shape, face] = owner[receivers.primitive[i]];
    const bool lit = truth.lit({receivers.position[i], shape, face});
    dark += !lit;
    wrong += lit == every.occluded(receivers.position[i], receivers.primitive[i]);
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(dark, 2000);
  EXPECT_LT(dark, 18000);
}

// A picture may leave out fewer than one receiver in a thousand: those with an unsure R1 or an unsure tap of a 3x3 lookup.
// The tap of a 1x1 lookup is the middle one of these, so it needs no lookup of its own.
void expect_few_ambiguous(const Scene& scene, int width, int height) {
  const LightFrame frame = frame_of(scene, 1024);
  const ReceiverImage receivers = picture_of(scene, width, height);
  const Tracer tracer(scene);
  const ReceiverTruth truth = tracer.receiver_truth(receivers, frame, {});
  int facing = 0, by_receiver = 0;
  for (size_t i = 0; i < truth.facing.size(); ++i) facing += truth.facing[i], by_receiver += truth.ambiguous[i];
  testing::Test::RecordProperty(scene.name + ".facing", facing);
  testing::Test::RecordProperty(scene.name + ".ambiguous_r1", by_receiver);
  EXPECT_GT(facing, 10000);
  const LookupTruth lookup = tracer.lookup_truth(receivers, truth, probe_of(receivers, frame, box(3)), frame, {});
  int ambiguous = 0;
  constexpr size_t taps = 9;
  for (size_t i = 0; i < truth.facing.size(); ++i) {
    bool any = truth.ambiguous[i];
    for (size_t t = 0; t < taps; ++t) any |= (lookup.taps.taps[i * taps + t] & tap_unsure) != 0;
    ambiguous += any;
  }
  testing::Test::RecordProperty(scene.name + ".ambiguous", ambiguous);
  EXPECT_LT(ambiguous, facing / 1000.0) << scene.name;
}

TEST(Ambiguous, UnderOneInAThousandOfEveryBuiltinPicture) {
  for (const BuiltinScene& given : builtin_scenes()) {
    Scene scene = builtin(std::string(given.name));
    scene.name = given.name;
    expect_few_ambiguous(scene, 640, 360);
  }
}

TEST(Ambiguous, UnderOneInAThousandOfTheModelsPictures) {
  for (const char* name : {"FlightHelmet", "Lantern"}) {
    const std::string path = shared_model(name);
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    Scene scene = load_gltf(path);
    scene.name = name;
    expect_few_ambiguous(scene, 800, 450);  // the models fill less of their pictures
  }
}

}  // namespace
}  // namespace noonmark::raytrace
