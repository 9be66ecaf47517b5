// Spot and point lights: R1, R2, R3 and the exact map against closed forms, in random scenes.
#include "tests/raytrace/central_form.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <tbb/parallel_for.h>

#include "scenes/camera_frame.h"
#include "technique/map_address.h"
#include "tests/raytrace/central_form_scenes.h"
#include "tests/raytrace/fixture.h"

namespace noonmark::raytrace {
namespace {

using namespace test;

// What was compared and found, over many scenes.
struct Tally {
  int64_t scenes = 0, facing = 0, ambiguous = 0, taps_ambiguous = 0;
  int64_t edge_on = 0;  // in a plane through the light: P's rounding decides its side
  int64_t banded = 0;   // between a sphere's inner and outer form
  int64_t faces = 0, r1 = 0, r2 = 0, r3 = 0, clipped = 0, depth = 0, texel = 0;  // disagreements of sure receivers
  int64_t depth_either = 0;    // texels at an outline or a crease: either surface's depth is right
  int64_t by_rounding = 0;     // decided by rounding of the vertices, so that no form can tell
  int64_t hidden = 0;          // disagreements of ambiguous receivers
  int64_t far_from_edges = 0;  // ambiguous, yet no outline or crease is near
  int64_t taps = 0, dark_taps = 0, differ = 0, by_jumps = 0, jumped = 0, walked_off = 0, other_face = 0, near = 0;

  int64_t wrong() const { return faces + r1 + r2 + r3 + clipped + depth + texel; }

  auto columns() const {
    using N = std::pair<const char*, int64_t Tally::*>;
    return std::array{N{"scenes", &Tally::scenes},
                      N{"facing", &Tally::facing},
                      N{"ambiguous", &Tally::ambiguous},
                      N{"taps_ambiguous", &Tally::taps_ambiguous},
                      N{"edge_on", &Tally::edge_on},
                      N{"banded", &Tally::banded},
                      N{"wrong_facing", &Tally::faces},
                      N{"wrong_r1", &Tally::r1},
                      N{"wrong_r2", &Tally::r2},
                      N{"wrong_r3", &Tally::r3},
                      N{"wrong_clipped", &Tally::clipped},
                      N{"wrong_depth", &Tally::depth},
                      N{"wrong_texel", &Tally::texel},
                      N{"depth_either", &Tally::depth_either},
                      N{"hidden", &Tally::hidden},
                      N{"by_rounding", &Tally::by_rounding},
                      N{"far_from_edges", &Tally::far_from_edges},
                      N{"taps", &Tally::taps},
                      N{"dark_taps", &Tally::dark_taps},
                      N{"taps_that_differ", &Tally::differ},
                      N{"decided_by_jumps", &Tally::by_jumps},
                      N{"with_a_jump", &Tally::jumped},
                      N{"walks_that_end_early", &Tally::walked_off},
                      N{"taps_on_another_face", &Tally::other_face},
                      N{"taps_clipped_by_near", &Tally::near}};
  }
  void add(const Tally& other) {
    for (const auto& [name, n] : columns()) this->*n += other.*n;
  }
  void record() const {
    for (const auto& [name, n] : columns()) testing::Test::RecordProperty(name, static_cast<int>(this->*n));
  }
};

// How far a ray may miss its exact place: the rounding of its float start (half a last place in each of three
// coordinates) and of the edge tests over the scene's size, the light included.
double ray_error_m(const Scene& scene) {
  double largest = 0;
  glm::dvec3 low = scene.light.position_m, high = low;
  for (const glm::vec3& p : scene.positions) {
    const glm::dvec3 q(p);
    largest = std::max({largest, std::abs(q.x), std::abs(q.y), std::abs(q.z)});
    low = glm::min(low, q), high = glm::max(high, q);
  }
  return 0x1p-24 * (std::sqrt(3.0) * largest + 4 * glm::length(high - low));
}

// The nearest triangle on each pixel's ray. All triangles are tested one by one.
ReceiverImage picture(const Scene& scene, int width, int height) {
  const CameraFrame frame = make_camera_frame(scene.camera, width, height);
  Image<uint32_t> seen(width, height, no_primitive);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Ray ray = frame.pixel_ray(x, y, width, height);
      double nearest = std::numeric_limits<double>::infinity();
      for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
        const glm::uvec3 v = scene.triangles[t];
        const glm::dvec3 a = glm::dvec3(scene.positions[v.x]) - ray.origin,
                         b = glm::dvec3(scene.positions[v.y]) - ray.origin,
                         c = glm::dvec3(scene.positions[v.z]) - ray.origin;
        const double ab = glm::dot(glm::cross(a, b), ray.direction), bc = glm::dot(glm::cross(b, c), ray.direction),
                     ca = glm::dot(glm::cross(c, a), ray.direction);
        if (!((ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0))) continue;
        const glm::dvec3 n = glm::cross(b - a, c - a);
        const double along = glm::dot(n, a) / glm::dot(n, ray.direction);
        if (along > 0 && along < nearest) nearest = along, seen.at(x, y) = t;
      }
    }
  }
  return resolve_receivers(scene, scene.camera, seen);
}

// Random points, as many on a small triangle as on a large one, rounded to float. Their normals are on the light's
// side, or on the outside.
ReceiverImage points_on_faces(const Scene& scene, bool facing_light, int count, uint32_t seed) {
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
    if (glm::dot(glm::dvec3(out.normal[i]), scene.light.position_m - glm::dvec3(out.position[i])) < 0)
      out.normal[i] = -out.normal[i];
  return out;
}

// An ambiguous receiver has an outline or a crease within this many ray errors: its four test places are one error from
// P, each of their rays may err by one more, and P itself is rounded.
constexpr double ambiguous_reach = 4;

// On a flat map the places of the lookup are floats. A tap this near (in texels) to another texel may be in either.
constexpr double texel_rounding = 1e-3;

struct Verdict {
  bool edge_on = false, banded = false, ambiguous = false, faces = false, r1 = false, far = false;
  bool rounding = false;   // a verdict that rounding of the vertices decides
  std::string taps_wrong;  // each one: number, F and V by formula, F and V by rays
  Tally taps;
  bool any() const { return faces || r1 || taps.wrong() > 0; }
};

class Comparison {
 public:
  Comparison(const CentralSpec& spec, const Modelled& model, const LightFrame& frame)
      : spec_(spec),
        model_(model),
        frame_(frame),
        inner_(model.inner, frame),
        outer_(model.outer, frame),
        rounded_(model.inner, frame, vertex_rounding_m(model.scene)) {
    error_ = ray_error_m(model.scene);
    // A float's rounding of the depth, and double's of the plane it lies on.
    depth_step_ = 0x1p-24 + 1e-12 * (inner_.size_m() * frame.window_depth_slope(frame.near_m));
  }

  void compare(const Tracer& tracer, const ReceiverImage& receivers, Tally& tally) const {
    const ReceiverTruth truth = tracer.receiver_truth(receivers, frame_, {});
    const Settings settings = settings_of(spec_);
    LookupProbe probe = probe_of(receivers, frame_);
    probe.pattern = tap_pattern(settings.filter);
    if (probe.pattern.scaled_by_view) {
      probe.radius = Image<float>(receivers.width(), receivers.height());
      for (size_t i = 0; i < probe.radius.size(); ++i)
        probe.radius[i] = static_cast<float>(
            (1 + glm::length(glm::dvec3(receivers.position[i]) - model_.scene.camera.eye_m) / frame_.far_m) / 25);
    }
    if (frame_.kind == LightKind::point) address_cube(receivers, probe);
    const LookupTruth lookup =
        model_.round ? LookupTruth() : tracer.lookup_truth(receivers, truth, probe, frame_, settings.map);
    std::vector<Verdict> verdicts(receivers.primitive.size());
    tbb::parallel_for(size_t{0}, verdicts.size(), [&](size_t i) {
      if (receivers.primitive[i] != no_primitive) verdicts[i] = ask(receivers, truth, probe, lookup, i);
    });
    for (size_t i = 0; i < verdicts.size(); ++i) count(receivers, truth, i, verdicts[i], tally);
  }

 private:
  // The texel of every tap by the closed form.
  void address_cube(const ReceiverImage& receivers, LookupProbe& probe) const {
    const int n = frame_.resolution;
    probe.cube_texel.resize(receivers.primitive.size() * static_cast<size_t>(probe.taps()));
    for (size_t i = 0; i < receivers.primitive.size(); ++i)
      for (int tap = 0; tap < probe.taps(); ++tap) {
        const glm::dvec2 at = inner_.texels_of(inner_.way_of_tap(receivers.position[i], probe.offset(i, tap)));
        const glm::ivec2 texel(std::min(static_cast<int>(at.x), n - 1), static_cast<int>(at.y));
        probe.cube_texel[i * static_cast<size_t>(probe.taps()) + static_cast<size_t>(tap)] =
            static_cast<uint32_t>(std::min(texel.y, 6 * n - 1) * n + texel.x);
      }
  }

  // Whether the frame and OpenGL's table agree where a tap lies.
  bool frame_agrees(glm::dvec3 p, glm::dvec3 offset) const {
    const glm::dvec2 mine = inner_.texels_of(inner_.way_of_tap(p, offset)),
                     its = frame_.map_texels(frame_.tap_place(frame_.to_light(p), offset));
    const glm::dvec2 off = glm::abs(mine - its);
    return std::max(off.x, off.y) <= texel_rounding ||
           glm::any(glm::lessThan(glm::abs(mine - glm::round(mine / static_cast<double>(frame_.resolution)) *
                                                      static_cast<double>(frame_.resolution)),
                                  glm::dvec2(texel_rounding)));
  }

  Verdict ask(const ReceiverImage& receivers, const ReceiverTruth& truth, const LookupProbe& probe,
              const LookupTruth& lookup, size_t i) const {
    Verdict v;
    const auto [shape, face] = model_.owner[receivers.primitive[i]];
    const Place place{receivers.position[i], shape, face};
    const Shape& own = model_.inner[static_cast<size_t>(shape)];
    const glm::dvec3 normal = receivers.normal[i];
    v.edge_on = inner_.edge_on(place);
    v.faces = inner_.facing(place.p, normal) != (truth.facing[i] != 0);
    if (!truth.facing[i] || v.edge_on) return v;
    const bool lit = inner_.lit(place);
    v.banded = in_band(place.p, shape) || in_band(frame_.origin_m, -1) || (model_.round && lit != outer_.lit(place)) ||
               (own.kind == ShapeKind::sphere && glm::dot(place.p - own.at, normal) < 0);  // seen from inside
    v.rounding = lit != rounded_.lit(place);
    v.ambiguous = truth.ambiguous[i];
    v.r1 = !v.banded && lit != (truth.lit[i] != 0);
    if (model_.round) return v;
    v.far = v.ambiguous && !inner_.near_edge(inner_.way_to(place.p), ambiguous_reach * error_);
    for (int tap = 0; tap < probe.taps(); ++tap)
      ask_tap(place, lit, probe.offset(i, tap), probe.texel(i, tap),
              lookup.taps.taps[i * static_cast<size_t>(probe.taps()) + static_cast<size_t>(tap)], lookup.exact_map, tap,
              v);
    return v;
  }

  void ask_tap(const Place& place, bool lit, glm::dvec3 offset, glm::ivec2 texel, uint8_t bits, const Image<float>& map,
               int tap, Verdict& v) const {
    const glm::dvec3 x = inner_.way_of_tap(place.p, offset), c = inner_.way_of_texel(texel);
    const bool at_p = offset == glm::dvec3(0);
    const CentralForm::Answer f = at_p ? CentralForm::Answer{lit} : inner_.answer_at(place, x, lit),
                              at_texel = inner_.answer_at(place, c, lit);
    v.rounding |= at_texel.lit != rounded_.answer_at(place, c, lit).lit ||
                  (!at_p && f.lit != rounded_.answer_at(place, x, lit).lit);
    const bool exact_lit = bits & tap_exact_lit, texel_lit = bits & tap_texel_lit;
    Tally& t = v.taps;
    ++t.taps;
    t.taps_ambiguous += (bits & tap_unsure) != 0;
    t.dark_taps += !f.lit, t.differ += f.lit != at_texel.lit;
    t.by_jumps += at_texel.by_jumps, t.jumped += at_texel.by_jumps && !at_texel.lit;
    t.walked_off += at_texel.walked_off;
    t.other_face +=
        frame_.kind == LightKind::point &&
        texel.y / frame_.resolution != static_cast<int>(inner_.texels_of(inner_.way_to(place.p)).y) / frame_.resolution;
    t.texel += !frame_agrees(place.p, offset);
    t.r2 += f.lit != exact_lit, t.r3 += at_texel.lit != texel_lit;
    if (f.lit != exact_lit || at_texel.lit != texel_lit)
      v.taps_wrong += " tap " + std::to_string(tap) + ": " + std::to_string(f.lit) + std::to_string(at_texel.lit) +
                      " for " + std::to_string(exact_lit) + std::to_string(texel_lit);
    const double near = inner_.near_depth(c), first = inner_.first_depth(c), cut = inner_.first_depth(c, near);
    t.clipped += (first < near) != ((bits & tap_near_clipped) != 0);
    t.near += first < near;
    if (!inside_map(texel, frame_.map_size())) return;
    const double expected = std::isfinite(cut) ? inner_.window_depth(cut) : 1, found = map.at(texel.x, texel.y);
    if (std::abs(found - expected) <= depth_step_) return;
    // The surfaces behind the first one are tried in turn, as long as a ray may meet them.
    const double reach = error_;
    bool either = inner_.near_edge(c, reach);
    for (double from = near; !either && std::isfinite(from);) {
      const double at = inner_.first_depth(c, from);
      if (!inner_.may_be_first(c, near, at, 0, reach)) break;
      either = std::abs(inner_.window_depth(at) - found) <= depth_step_;
      from = std::nextafter(at, 1e300);
    }
    ++(either ? t.depth_either : t.depth);
  }

  // Whether p is between the inner and the outer form of a sphere other than `own`.
  bool in_band(glm::dvec3 p, int own) const {
    for (size_t s = 0; s < model_.inner.size(); ++s) {
      if (model_.inner[s].kind != ShapeKind::sphere || static_cast<int>(s) == own) continue;
      const double distance = glm::length(p - model_.inner[s].at);
      if (distance > model_.inner[s].radius - error_ && distance < model_.outer[s].radius + error_) return true;
    }
    return false;
  }

  void count(const ReceiverImage& receivers, const ReceiverTruth& truth, size_t i, const Verdict& v,
             Tally& tally) const {
    if (receivers.primitive[i] == no_primitive) return;
    tally.edge_on += v.edge_on;
    if (v.edge_on) return;
    tally.faces += v.faces;
    if (!truth.facing[i]) {
      if (v.faces) log(receivers, truth, i, v);
      return;
    }
    ++tally.facing;
    tally.banded += v.banded;
    const Tally& t = v.taps;
    tally.taps += t.taps, tally.dark_taps += t.dark_taps, tally.differ += t.differ;
    tally.by_jumps += t.by_jumps, tally.jumped += t.jumped, tally.walked_off += t.walked_off;
    tally.other_face += t.other_face, tally.near += t.near;
    tally.by_rounding += v.rounding;
    if (v.rounding) return;
    tally.far_from_edges += v.far;
    if (v.ambiguous || t.taps_ambiguous > 0) {
      ++(v.ambiguous ? tally.ambiguous : tally.taps_ambiguous);
      tally.hidden += v.any();
      if (v.far) log(receivers, truth, i, v);
      return;
    }
    tally.r1 += v.r1, tally.r2 += t.r2 > 0, tally.r3 += t.r3 > 0, tally.clipped += t.clipped > 0;
    tally.depth += t.depth > 0, tally.texel += t.texel > 0, tally.depth_either += t.depth_either;
    if (v.any()) log(receivers, truth, i, v);
  }

  void log(const ReceiverImage& receivers, const ReceiverTruth& truth, size_t i, const Verdict& v) const {
    const glm::vec3 p = receivers.position[i];
    const auto [shape, face] = model_.owner[receivers.primitive[i]];
    RC_LOG() << "receiver " << i << " (" << p.x << ' ' << p.y << ' ' << p.z << ") on shape " << shape << " face "
             << face << ", R1 " << static_cast<int>(truth.lit[i]) << (v.far ? ", ambiguous far from edges" : "")
             << ": wrong facing " << v.faces << " R1 " << v.r1 << " R2 " << v.taps.r2 << " R3 " << v.taps.r3
             << " clipped " << v.taps.clipped << " depth " << v.taps.depth << " texel " << v.taps.texel << v.taps_wrong
             << '\n';
  }

  const CentralSpec& spec_;
  const Modelled& model_;
  LightFrame frame_;
  CentralForm inner_, outer_, rounded_;
  double error_ = 0, depth_step_ = 0;
};

struct Posed {
  Modelled model;
  LightFrame frame;
};

Posed posed(const CentralSpec& spec, int segments) {
  CentralSpec s = spec;
  for (ShapeSpec& shape : s.scene.shapes)
    if (shape.kind == static_cast<int>(ShapeKind::disc)) shape.kind = static_cast<int>(ShapeKind::sphere);
  Posed p{model_of(s.scene, at_origin, segments), {}};
  place_light(s, at_origin, p.model);
  p.frame = make_light_frame(p.model.scene, settings_of(s));
  p.frame.near_m += 0.01 * s.scene.near_cut * (p.frame.far_m - p.frame.near_m);
  return p;
}

void compare_scene(const CentralSpec& spec, int segments, int points, Tally& tally) {
  const Posed p = posed(spec, segments);
  const Tracer tracer(p.model.scene);
  const Comparison comparison(spec, p.model, p.frame);
  ++tally.scenes;
  comparison.compare(tracer, points_on_faces(p.model.scene, spec.scene.seed % 2, points, spec.scene.seed), tally);
  comparison.compare(tracer, picture(p.model.scene, 24, 14), tally);
}

// Every run has the same scenes, so that a failure means a change of the program. NOONMARK_SEED selects other scenes,
// and NOONMARK_SCENES sets their number.
rc::detail::TestParams parameters(int scenes) {
  rc::detail::TestParams given;
  const char *seed = std::getenv("NOONMARK_SEED"), *more = std::getenv("NOONMARK_SCENES");
  given.seed = seed ? std::strtoull(seed, nullptr, 10) : 20240229;
  given.disableShrinking = true;  // a smaller scene has its light elsewhere, so it is another case
  given.maxSuccess = more ? std::atoi(more) : scenes;
  return given;
}

struct Sweep {
  const char* name;
  bool point;
  int kinds, segments, scenes;
  double ambiguous, edge_on;  // largest shares of the facing receivers
};

class CentralFormSweep : public testing::TestWithParam<Sweep> {};

TEST_P(CentralFormSweep, TracerAgrees) {
  const Sweep& sweep = GetParam();
  Tally all;
  const auto result = rc::detail::checkTestable(
      [&] {
        const CentralSpec spec = *any_central(sweep.point, sweep.kinds);
        Tally tally;
        compare_scene(spec, sweep.segments, 300, tally);
        all.add(tally);
        RC_ASSERT(tally.wrong() == 0);
        RC_ASSERT(tally.far_from_edges == 0);
      },
      rc::detail::TestMetadata{}, parameters(sweep.scenes));
  if (!result.template is<rc::detail::SuccessResult>()) {
    std::ostringstream text;
    rc::detail::printResultMessage(result, text);
    ADD_FAILURE() << text.str();
  }
  all.record();
  // Points on faces of all sizes, pictures from anywhere, and lights 0.1 mm from a face are harder cases than a
  // person's scenes. So the bounds are a few times what was seen.
  EXPECT_EQ(all.wrong(), 0);
  EXPECT_EQ(all.far_from_edges, 0);
  EXPECT_GT(all.facing, 100 * sweep.scenes);
  EXPECT_LT(static_cast<double>(all.ambiguous + all.taps_ambiguous + all.by_rounding),
            sweep.ambiguous * static_cast<double>(all.facing));
  EXPECT_LT(static_cast<double>(all.edge_on), sweep.edge_on * static_cast<double>(all.facing));
  EXPECT_LT(static_cast<double>(all.depth_either), 1e-4 * static_cast<double>(all.taps));
  if (sweep.kinds > 2) return;
  EXPECT_GT(all.taps, 1000 * sweep.scenes);
  EXPECT_GT(all.dark_taps, all.taps / 20);
  EXPECT_GT(all.differ, 10 * sweep.scenes);
  EXPECT_GT(all.jumped, 5 * sweep.scenes);
  EXPECT_GT(all.walked_off, all.taps / 20);
  EXPECT_GT(all.near, all.taps / 20);
  if (sweep.point) {
    EXPECT_GT(all.other_face, all.taps / 200);
  }
}

// Seen in 1500 scenes each: 0.24%, 0.22%, 0.6% and 0.47% ambiguous, up to 0.7% in a plane through the light.
INSTANTIATE_TEST_SUITE_P(Random, CentralFormSweep,
                         testing::Values(Sweep{"FlatSpot", false, 2, 8, 120, 0.01, 0.05},
                                         Sweep{"FlatPoint", true, 2, 8, 120, 0.01, 0.05},
                                         Sweep{"RoundSpot", false, 4, 48, 40, 0.02, 0.05},
                                         Sweep{"RoundPoint", true, 4, 48, 40, 0.02, 0.05}),
                         [](const auto& given) { return given.param.name; });

}  // namespace
}  // namespace noonmark::raytrace
