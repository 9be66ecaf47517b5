// The second witness: every triangle of a scene, one by one, in double, against R1; and how much of the truth of real
// pictures is ambiguous.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cstdio>

#include "closed_form.h"
#include "raytrace/embree_scene.h"
#include "raytrace_fixture.h"
#include "scenes/camera_frame.h"

namespace noonmark::raytrace {
namespace {

using namespace test;

// No bins, no tree, no light's plane: the ray from P towards the light against each triangle in world space.
class EveryTriangle {
 public:
  EveryTriangle(const Scene& scene, glm::dvec3 to_light) : scene_(scene), way_(to_light) {}

  // Is P, taken along the ray to its own triangle's plane, behind another one?
  bool occluded(glm::dvec3 p, uint32_t own) const {
    const Hit at_own = meet(own, p);
    const double from = at_own.edge_on ? 0 : at_own.t;
    for (uint32_t t = 0; t < scene_.triangles.size(); ++t) {
      if (t == own) continue;
      const Hit hit = meet(t, p);
      if (hit.inside && hit.t > from + hit.rounding + at_own.rounding) return true;
    }
    return false;
  }

 private:
  struct Hit {
    double t = 0;         // distance to the plane
    double rounding = 0;  // of t, in double
    bool inside = false, edge_on = false;
  };

  // Edge functions: the signed volumes that the ray spans with each edge.
  Hit meet(uint32_t triangle, glm::dvec3 p) const {
    const glm::uvec3 v = scene_.triangles[triangle];
    const glm::dvec3 a = glm::dvec3(scene_.positions[v.x]) - p, b = glm::dvec3(scene_.positions[v.y]) - p,
                     c = glm::dvec3(scene_.positions[v.z]) - p;
    const double ab = glm::dot(glm::cross(a, b), way_), bc = glm::dot(glm::cross(b, c), way_),
                 ca = glm::dot(glm::cross(c, a), way_);
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const double slope = glm::dot(n, way_);
    Hit hit;
    hit.edge_on = slope == 0;
    if (hit.edge_on) return hit;
    hit.inside = (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
    hit.t = glm::dot(n, a) / slope;
    hit.rounding = 1e-13 * (glm::length(a) + glm::length(p)) * glm::length(n) / std::abs(slope);
    return hit;
  }

  const Scene& scene_;
  glm::dvec3 way_;
};

ReceiverImage picture_of(const Scene& scene, int width, int height) {
  const EmbreeDevice device;
  const EmbreeScene embree(device, scene);
  const CameraFrame camera = make_camera_frame(scene.camera, width, height);
  Image<uint32_t> primitives(width, height, no_primitive);
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const Ray ray = camera.pixel_ray(x, y, width, height);
      primitives.at(x, y) = embree.first_hit(glm::vec3(ray.origin), glm::vec3(ray.direction));
    }
  });
  return resolve_receivers(scene, scene.camera, primitives);
}

// Every step-th of the receivers that face the light, as an image one pixel high.
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
  const Counted seen = compare(scene, sample_of(picture_of(scene, 640, 360), to_light, 10000, 1));
  EXPECT_GE(seen.facing, 10000);
  scene.name = "surface";
  const Counted surface = compare(scene, random_receivers(scene, to_light, true, 2000, 2));
  for (const Counted& c : {seen, surface}) {
    EXPECT_EQ(c.wrong, 0);
    EXPECT_GT(c.lit, c.facing / 10);
    EXPECT_LT(c.lit, c.facing);
    EXPECT_LE(c.ambiguous, c.facing / 1000);
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, Witness, testing::Values("FlightHelmet", "Lantern"),
                         [](const auto& given) { return given.param; });

// The witness is held to the closed form: boxes whose corners floats hold exactly.
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

// What a picture leaves out: under one receiver in a thousand, of R1 and of the taps of a 3x3 lookup alike.
void expect_few_ambiguous(const Scene& scene) {
  const LightFrame frame = frame_of(scene, 1024);
  const ReceiverImage receivers = picture_of(scene, 640, 360);
  const Tracer tracer(scene);
  const ReceiverTruth truth = tracer.receiver_truth(receivers, frame, {});
  int facing = 0, by_receiver = 0;
  for (size_t i = 0; i < truth.facing.size(); ++i) facing += truth.facing[i], by_receiver += truth.ambiguous[i];
  testing::Test::RecordProperty(scene.name + ".facing", facing);
  testing::Test::RecordProperty(scene.name + ".ambiguous_r1", by_receiver);
  EXPECT_GT(facing, 10000);
  for (int kernel : {1, 3}) {
    const LookupTruth lookup =
        tracer.lookup_truth(receivers, truth, probe_of(receivers, frame), frame, {}, kernel);
    int ambiguous = 0;
    const size_t taps = static_cast<size_t>(kernel * kernel);
    for (size_t i = 0; i < truth.facing.size(); ++i) {
      bool any = truth.ambiguous[i];
      for (size_t t = 0; t < taps; ++t) any |= (lookup.taps.taps[i * taps + t] & tap_ambiguous) != 0;
      ambiguous += any;
    }
    testing::Test::RecordProperty(scene.name + ".ambiguous_kernel_" + std::to_string(kernel), ambiguous);
    std::printf("%s kernel %d: facing %d R1 %d all %d, texel %.1f ms, taps %.1f ms %lu rays\n", scene.name.c_str(), kernel, facing, by_receiver, ambiguous, lookup.texel_stage.milliseconds, lookup.tap_stage.milliseconds, (unsigned long)lookup.tap_stage.rays);
    EXPECT_LT(ambiguous, facing / 1000.0) << scene.name << ", kernel " << kernel;
  }
}

TEST(Ambiguous, UnderOneInAThousandOfEveryBuiltinPicture) {
  for (const BuiltinScene& given : builtin_scenes()) {
    Scene scene = builtin(std::string(given.name));
    scene.name = given.name;
    expect_few_ambiguous(scene);
  }
}

TEST(Ambiguous, UnderOneInAThousandOfTheModelsPictures) {
  for (const char* name : {"FlightHelmet", "Lantern"}) {
    const std::string path = shared_model(name);
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    Scene scene = load_gltf(path);
    scene.name = name;
    expect_few_ambiguous(scene);
  }
}

}  // namespace
}  // namespace noonmark::raytrace
