#include "measure/flicker_stage.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "scenes/camera_fit.h"
#include "scenes/camera_frame.h"
#include "scenes/library.h"
#include "technique/point_maps.h"

namespace noonmark {
namespace {

// The pixel at which a camera sees a point, or no_pixel.
constexpr uint32_t no_pixel = 0xffffffffu;
uint32_t pixel_seen_at(const CameraFrame& camera, glm::dvec3 world, int width, int height) {
  const glm::dvec3 p = camera.in_axes(world);
  if (!(p.z >= *camera.camera.near_m) || !(p.z <= *camera.camera.far_m)) return no_pixel;
  const double depth = camera.camera.projection == Projection::perspective ? p.z : 1;
  const double x = std::floor((p.x / (depth * camera.half_width) + 1) / 2 * width);
  const double y = std::floor((1 - p.y / (depth * camera.half_height)) / 2 * height);
  if (!(x >= 0 && x < width && y >= 0 && y < height)) return no_pixel;
  return static_cast<uint32_t>(y) * static_cast<uint32_t>(width) + static_cast<uint32_t>(x);
}

bool same_light(const LightFrame& a, const LightFrame& b) {
  if (a.kind != b.kind || a.cos_half_cone != b.cos_half_cone) return false;
  if (a.light().rays().have_one_direction()) return a.ray_direction == b.ray_direction;
  return a.origin_m == b.origin_m && a.forward == b.forward;
}

// Whether two frames have the same map and the same lookup, bit for bit.
bool same_map(const LightFrame& a, const LightFrame& b) {
  return a.kind == b.kind && a.origin_m == b.origin_m && a.anchor_m == b.anchor_m &&
         a.anchor_texels == b.anchor_texels && a.centre_m == b.centre_m && a.ray_direction == b.ray_direction &&
         a.right == b.right && a.up == b.up && a.forward == b.forward && a.extent_m == b.extent_m &&
         a.tan_half_fov == b.tan_half_fov && a.cos_half_cone == b.cos_half_cone && a.shift_texels == b.shift_texels &&
         a.cube_axes == b.cube_axes && a.near_m == b.near_m && a.far_m == b.far_m && a.tile_size() == b.tile_size();
}

// How far from the place looked up a tap may read, in texels of a flat map: its offset, the texel (of the mip level) that it
// snaps to or blends with, and a texel for parts of a bias that move the lookup.
double reach_of_taps(const TapPattern& pattern) {
  double reach = 0;
  for (int variant = 0; variant < pattern.variants; ++variant)
    for (int tap = 0; tap < pattern.taps; ++tap) {
      const glm::vec3 o = glm::abs(pattern.offset(variant, tap));
      reach = std::max<double>({reach, o.x, o.y});
    }
  return reach + 2 + pattern.block;
}

// Whether the map holds a point of the world and all its taps.
bool holds(const LightFrame& frame, glm::dvec3 world, double reach) {
  const glm::dvec3 p = frame.to_light(world);
  const double depth = frame.window_depth(p);
  if (!(depth >= 0 && depth <= 1)) return false;
  if (frame.map_shape() == MapShape::cube) return true;
  const glm::dvec2 at = frame.map_texels(p);
  return at.x >= reach && at.y >= reach && at.x <= frame.resolution - reach && at.y <= frame.rows - reach;
}

bool same_place(const Camera& a, const Camera& b) {
  return a.eye_m == b.eye_m && a.target_m == b.target_m && a.up == b.up && a.fov_y_deg == b.fov_y_deg &&
         a.height_m == b.height_m && a.projection == b.projection;
}

// The scene of the next frame: its camera and light can differ from those of this frame, its triangles cannot.
Scene still_scene(const Scene& now, const SceneSettings& next) {
  Scene scene = make_scene(next);
  if (scene.positions != now.positions || scene.triangles != now.triangles)
    throw Error(
        ErrorKind::usage,
        "motion.time_s: the scene's triangles move from this frame to the next, and flicker is measured at points "
        "that stand still; take a file whose animation moves only the camera or the light, or motion.time_s = 0");
  return scene;
}

// The next frame: its camera, and its maps with the choice that it makes of them. scene: of this frame, with the next one's camera and
// light.
struct NextFrame {
  NextFrame(const FlickerInput& in, const Scene& of, const Settings& settings)
      : scene(of), camera(effective_camera(of, settings.view)) {
    const ReceiverImage& receivers = in.view.receivers;
    const bool several = in.techniques.size() > 1;
    std::optional<ViewSlice> visible;  // in the next frame's picture
    if (several && settings.cascades.depths == CascadeDepths::visible)
      visible = visible_depths(settings, in.stages.take_view(in.renderer, scene, settings.view).receivers, camera);
    techniques = techniques_of(scene, settings, visible);
    if (several) in.renderer.load_receivers(receivers, camera.eye_m);
    choice = in.renderer.choose_maps(techniques.front());
  }
  const Scene& scene;
  Camera camera;
  std::vector<Technique> techniques;
  MapChoice choice;
};

// Whether each map that has a part in the receiver's result holds it.
bool all_hold(std::span<const Technique> techniques, const MapChoice& choice, size_t i, glm::dvec3 place,
              double reach) {
  for (size_t k = 0; k < techniques.size(); ++k)
    if (choice.share(i, static_cast<int>(k)) > 0 && !holds(techniques[k].frame, place, reach)) return false;
  return true;
}

// The receivers that count. pixels: becomes where the next frame sees each of them.
FlickerPoints counted_points(const FlickerInput& in, const NextFrame& next, const Settings& settings,
                             Image<uint32_t>& pixels) {
  const ReceiverImage& receivers = in.view.receivers;
  const int width = receivers.width(), height = receivers.height();
  const CameraFrame camera_frame = make_camera_frame(next.camera, width, height);
  const bool still = same_place(next.camera, in.view.camera);
  const LightFrame& next_light = next.techniques.front().frame;
  std::optional<raytrace::SeenReceivers> seen;
  std::optional<ReceiverTruth> truth;
  if (!still) seen = in.loaded.tracer->seen_by(receivers, next.camera);
  if (!same_light(in.techniques.front().frame, next_light))
    truth = in.loaded.tracer->receiver_truth(receivers, next_light, {effective_light(next.scene, settings)});
  const ReceiverTruth& before = in.truth.receivers;
  const ReceiverTruth& after = truth ? *truth : before;
  FlickerPoints points{Image<uint8_t>(width, height, 0), Image<uint8_t>(width, height, 0)};
  const double reach = reach_of_taps(next.techniques.front().taps);
  for (size_t i = 0; i < pixels.size(); ++i) {
    pixels[i] = static_cast<uint32_t>(i);
    if (!before.facing[i] || before.ambiguous[i]) continue;
    const glm::dvec3 place(receivers.position[i]);
    if (!still) {
      const uint32_t pixel = pixel_seen_at(camera_frame, place, width, height);
      if (pixel == no_pixel) {
        ++points.outside;
        continue;
      }
      if (!seen->seen[i] || seen->ambiguous[i]) {
        ++points.hidden;
        points.ambiguous += seen->ambiguous[i];
        continue;
      }
      pixels[i] = pixel;
    }
    if (!after.facing[i] || after.ambiguous[i]) {
      ++points.unlit;
      points.ambiguous += after.facing[i] && after.ambiguous[i];
      continue;
    }
    ++points.shared;
    if (before.lit[i] != after.lit[i]) {
      ++points.truth_changed;
      continue;
    }
    points.counted[i] = 1;
    points.held[i] = all_hold(in.techniques, in.choice, i, place, reach) &&
                     all_hold(in.techniques, next.choice, i, place, reach) &&
                     all_hold(next.techniques, next.choice, i, place, reach);
  }
  return points;
}

bool same_maps(std::span<const Technique> a, std::span<const Technique> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Technique& x, const Technique& y) { return same_map(x.frame, y.frame); });
}

}  // namespace

Settings next_frame(const Settings& settings) {
  Settings next = settings;
  ++next.view.motion.frame;
  if (settings.view.motion.time_s != 0)
    next.scene.time_s = settings.scene.time_s.value_or(0) + settings.view.motion.time_s;
  return next;
}

Flicker trace_flicker(const FlickerInput& in) {
  const ReceiverImage& receivers = in.view.receivers;
  const Settings& settings = in.techniques.front().settings;
  const Settings of_next = next_frame(settings);
  std::optional<Scene> moved;
  if (settings.view.motion.time_s != 0) moved = still_scene(*in.loaded.scene, of_next.scene);
  const NextFrame next(in, moved ? *moved : *in.loaded.scene, of_next);
  Image<uint32_t> pixels(receivers.width(), receivers.height(), 0);
  FlickerPoints points = counted_points(in, next, of_next, pixels);

  // Each lookup differs from the one before it in one respect. With several maps, the next frame says which map a receiver uses.
  const auto shown = [&](std::span<const Technique> techniques) {
    const MapStage map = in.stages.draw_maps(in.renderer, next.scene, techniques);
    return mixed_results(in.stages.look_up(in.renderer, *map.map, techniques), next.choice);
  };
  const bool several = in.techniques.size() > 1;
  std::optional<Image<float>> choice;
  std::vector<Technique> same_depths = next.techniques;
  for (size_t k = 0; k < same_depths.size(); ++k) {
    const LightFrame& now = in.techniques[k].frame;
    same_depths[k].frame.near_m = now.near_m;
    same_depths[k].frame.far_m = now.far_m;
  }
  if (several) {  // the next frame's choice, with its eye, in this frame's maps
    std::vector<Technique> chosen(in.techniques.begin(), in.techniques.end());
    for (size_t k = 0; k < chosen.size(); ++k) chosen[k].cascade = next.techniques[k].cascade;
    choice = shown(chosen);
  }
  const Image<float>& before_grid = choice ? *choice : in.r5;
  const Image<float> grid = same_maps(same_depths, in.techniques) ? before_grid : shown(same_depths);
  const Image<float> depth = same_maps(next.techniques, same_depths) ? grid : shown(next.techniques);
  Image<float> last = depth;
  const TapPattern& taps = next.techniques.front().taps;
  const bool turns = taps.variants > 1 || taps.scaled_by_view;
  if (turns) {
    in.renderer.load_receivers(receivers, next.camera.eye_m, &pixels);
    last = shown(next.techniques);
  }
  if (turns || several) in.renderer.load_receivers(receivers, in.view.camera.eye_m);
  return flicker_of({in.r5, before_grid, grid, depth, last}, std::move(points));
}

}  // namespace noonmark
