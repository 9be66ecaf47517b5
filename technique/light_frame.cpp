#include "technique/light_frame.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "scenes/camera_fit.h"
#include "scenes/camera_frame.h"
#include "technique/cascades.h"
#include "technique/chosen_light.h"
#include "technique/map_fit.h"
#include "technique/setting_rules.h"
#include "technique/sun.h"

namespace noonmark {

// OpenGL 4.5 core, table 8.19: the axes s and t of each face.
const CubeFace& cube_face(int face) {
  static const std::array<CubeFace, 6> faces = {{
      {{0, 0, -1}, {0, -1, 0}, {1, 0, 0}},
      {{0, 0, 1}, {0, -1, 0}, {-1, 0, 0}},
      {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
      {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
      {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}},
      {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
  }};
  return faces.at(static_cast<size_t>(face));
}

int cube_face_of(glm::dvec3 d) {
  const glm::dvec3 a = glm::abs(d);
  const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  return 2 * axis + (d[axis] < 0 ? 1 : 0);
}

glm::dvec3 LightFrame::to_world(glm::dvec3 light) const {
  return origin_m + light.x * right + light.y * up + light.z * forward;
}

bool LightFrame::has_depth(TileDepth depth) const {
  for (int index = 0; index < tiles; ++index)
    if (tile(index).depth == depth) return true;
  return false;
}

glm::dmat4 LightFrame::clip_from_world(const MapTile& t) const {
  LightFrame unsnapped = *this;
  unsnapped.anchor_m.reset();
  return unsnapped.drawn_clip_from_world(t);
}

glm::dmat4 LightFrame::drawn_clip_from_world(const MapTile& t) const {
  const glm::dvec3 from = drawn_origin_m();
  const glm::dvec2 centre = anchor_m ? glm::dvec2(0) : t.centre_m;  // a snapped map's place is anchor_texels
  const auto in_world = [&](glm::dvec3 axis) { return axis.x * right + axis.y * up + axis.z * forward; };
  const glm::dvec3 axes[3] = {in_world(t.right), in_world(t.up), in_world(t.forward)};
  const double range = t.far_m - t.near_m;
  glm::dvec3 rows[4];
  double offsets[4] = {0, 0, 0, 0};
  if (t.orthographic) {
    const glm::dvec2 half = t.half_m();
    rows[0] = axes[0] * (1 / half.x);
    rows[1] = axes[1] * (1 / half.y);
    rows[2] = axes[2] * (2 / range);
    rows[3] = glm::dvec3(0);
    offsets[0] -= centre.x / half.x;
    offsets[1] -= centre.y / half.y;
    offsets[2] = -2 * t.near_m / range - 1;
    offsets[3] = 1;
  } else {
    const glm::dvec2 shift = 2.0 * t.shift_texels / static_cast<double>(t.resolution);
    rows[0] = axes[0] / t.half - axes[2] * shift.x;
    rows[1] = axes[1] / t.half - axes[2] * shift.y;
    rows[2] = axes[2] * ((t.far_m + t.near_m) / range);
    rows[3] = axes[2];
    offsets[2] = -2 * t.far_m * t.near_m / range;
  }
  glm::dmat4 matrix(0);  // column-major: matrix[column][row]
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 3; ++column) matrix[column][row] = rows[row][column];
    matrix[3][row] = offsets[row] - glm::dot(rows[row], from);
  }
  return matrix;
}

float LightFrame::snapped_step() const {
  const auto longer = static_cast<float>(std::max(resolution, rows));
  return std::ldexp(1.0f, std::ilogb(4.0f * longer) - std::numeric_limits<float>::digits + 1);
}

std::vector<LightFrame::Cell> LightFrame::snapped_cells() const {
  struct Piece {
    int cell, first, end, to;
  };
  const auto along = [](double texels, int side) {
    const int cell = static_cast<int>(std::floor(texels / side));
    const int before = static_cast<int>(texels - static_cast<double>(cell) * side);
    std::vector<Piece> parts = {{cell, before, side, 0}};
    if (before > 0) parts.push_back({cell + 1, 0, before, side - before});
    return parts;
  };
  std::vector<Cell> cells;
  for (const Piece& v : along(anchor_texels.y, rows))
    for (const Piece& u : along(anchor_texels.x, resolution))
      cells.push_back({{u.cell, v.cell}, {u.first, v.first}, {u.end, v.end}, {u.to, v.to}});
  return cells;
}

double LightFrame::depth_per_bias_unit(BiasUnit unit, glm::dvec3 point) const {
  switch (unit) {
    case BiasUnit::depth:
      return bias_scale;
    case BiasUnit::m:
      return bias_scale * window_depth_slope(point);
    case BiasUnit::texel:
      return bias_scale * texel_m(point) * window_depth_slope(point);
  }
  throw std::logic_error("unknown bias unit");
}

MapVolume fit_map(const Scene& scene, const Light& light) {
  return kind_of_light(light.kind).fit(scene, kind_of_light(light.kind).axes(light), {});
}

namespace {

// The rounding of an angle that is computed from the scene's positions; a set angle this near to it is the same.
constexpr double same_angle_deg = 1e-9;

// From the light's target to its position: as far as the scene's light stands from its target, in the direction of the
// sun. A setting that is empty, or gives the angle of the scene's light, leaves that angle.
glm::dvec3 way_to_sun(const Light& scenes, const LightSettings& settings) {
  const glm::dvec3 way = scenes.position_m - scenes.target_m;
  const double distance = glm::length(way);
  const SunPlace old = distance > 0 ? place_of_sun(way) : SunPlace();
  const auto differs = [](std::optional<double> set, double angle) {
    return set && !(std::abs(std::remainder(*set - angle, 360)) <= same_angle_deg);
  };
  if (distance > 0 && !differs(settings.azimuth_deg, old.azimuth_deg) &&
      !differs(settings.elevation_deg, old.elevation_deg))
    return way;
  const glm::dvec3 direction = direction_to_sun(
      {settings.azimuth_deg.value_or(old.azimuth_deg), settings.elevation_deg.value_or(old.elevation_deg)});
  return direction * (distance > 0 ? distance : 1);
}

// The light of the motion's frame.
void move_light(Light& light, const MotionSettings& motion) {
  if (!motion.moves_light() || motion.frame == 0) return;
  const double n = motion.frame;
  const double times = motion.light_period > 0 ? std::sin(2 * std::numbers::pi * n / motion.light_period) : n;
  if (motion.light_turn_deg) {
    const glm::dmat3 turn = rotation_of(times * *motion.light_turn_deg);
    const glm::dvec3 pivot = motion.light_pivot_m.value_or(light.target_m);
    light.position_m = pivot + turn * (light.position_m - pivot);
    light.target_m = pivot + turn * (light.target_m - pivot);
  }
  if (motion.light_move_m) {
    light.position_m += times * *motion.light_move_m;
    light.target_m += times * *motion.light_move_m;
  }
}

// Of frame 0, without its size.
Light placed_light(const Scene& scene, const LightSettings& s) {
  const Light own = chosen_light(scene, s).light;
  Light light = own;
  if (s.position_m) light.position_m = *s.position_m;
  if (s.target_m) light.target_m = *s.target_m;
  if (!s.azimuth_deg && !s.elevation_deg) return light;
  const glm::dvec3 way = way_to_sun(own, s);
  // The sum of the scene's own target and way is its own position but for rounding.
  const bool scenes_own = light.target_m == own.target_m && way == own.position_m - own.target_m;
  light.position_m = scenes_own ? own.position_m : light.target_m + way;
  return light;
}

// Which setting makes the light another one than the scene's own, for which its map volume was chosen: "light.kind is
// not the scene's", "light.position_m moves the light"; empty: none.
std::string why_not_the_scenes(const Scene& scene, const Settings& settings) {
  const LightSettings& s = settings.light;
  const Light light = placed_light(scene, s);
  if (light.kind != scene.light.kind && chosen_light(scene, s).made_up) return "light.kind is not the scene's";
  if (!chosen_light(scene, s).first) return "they are those of the scene's first light, and this is another";
  if (light.position_m != scene.light.position_m) {
    if (s.azimuth_deg) return "light.azimuth_deg moves the light";
    if (s.elevation_deg) return "light.elevation_deg moves the light";
    return s.position_m ? "light.position_m moves the light" : "light.target_m moves the light";
  }
  if (kind_of_light(light.kind).is_aimed() && light.target_m != scene.light.target_m)
    return "light.target_m turns the light";
  // All frames of a motion have the same volume.
  if (settings.view.motion.light_turn_deg.value_or(glm::dvec3(0)) != glm::dvec3(0))
    return "motion.light_turn_deg moves the light";
  return settings.view.motion.light_move_m.value_or(glm::dvec3(0)) != glm::dvec3(0)
             ? "motion.light_move_m moves the light"
             : "";
}

}  // namespace

Light effective_light(const Scene& scene, const Settings& settings) {
  const LightSettings& s = settings.light;
  Light light = placed_light(scene, s);
  move_light(light, settings.view.motion);
  if (s.angular_diameter_deg) light.angular_diameter_deg = *s.angular_diameter_deg;
  if (s.radius_m) light.radius_m = *s.radius_m;
  if (s.cone_deg) light.cone_deg = *s.cone_deg;
  light.shape = s.shape;
  return light;
}

namespace {

std::optional<FittedMap> moved_fit(const Scene& scene, const Settings& settings, const LightFrame& axes,
                                   const ViewSlice* slice) {
  if (settings.map.fit == MapFit::view) return fit_to_view(scene, settings.view, settings.map, axes, slice);
  if (settings.map.fit == MapFit::sphere) return fit_to_sphere(scene, settings, axes, slice);
  if (fits_corners(settings.map.fit)) return fit_to_corners(scene, settings, axes, slice);
  if (settings.map.fit == MapFit::casters) return fit_to_casters(scene, settings, axes);
  return std::nullopt;
}

}  // namespace

std::string map_fit_note(const Scene& scene, const Settings& settings) {
  if (!scene.map || settings.map.fit != MapFit::scene) return "";
  const std::string why = why_not_the_scenes(scene, settings);
  if (why.empty()) return "";
  const KindOfLight& kind = kind_of_light(placed_light(scene, settings.light).kind);
  std::vector<std::string> fitted, values, keeps;
  const auto add = [&](bool given, const char* name, double scenes, const char* setting) {
    if (given) return;
    fitted.emplace_back(name);
    values.push_back(fmt::format("{:.4g} m", scenes));
    keeps.emplace_back(setting);
  };
  // The extent of a spot light's map and of a cube follows from the light.
  if (kind.rays().have_one_direction() && scene.light.kind == LightKind::directional)
    add(settings.map.extent_m.has_value(), "extent", scene.map->extent_m, "map.extent_m");
  add(settings.map.near_m.has_value(), "near", scene.map->near_m, "map.near_m");
  add(settings.map.far_m.has_value(), "far", scene.map->far_m, "map.far_m");
  if (fitted.empty()) return "";
  return fmt::format("{}: {} of the map {} fitted in place of the scene's own {}, because {}; {} can keep {}",
                     scene.name, fmt::join(fitted, ", "), fitted.size() == 1 ? "is" : "are", fmt::join(values, ", "),
                     why, fmt::join(keeps, ", "), fitted.size() == 1 ? "it" : "them");
}

namespace {

// Law 33 wants one extent in every frame.
std::string moving_splits_note(const Scene& scene, const Settings& settings) {
  if (settings.cascades.count == 1 || !settings.view.motion.any() || !settings.map.snap) return "";
  if (settings.cascades.depths == CascadeDepths::visible)
    return "cascades.depths = visible: the slices reach from the nearest to the farthest surface of each frame's "
           "picture, "
           "so their maps' sizes change from frame to frame, and their texels flicker although map.snap is set; set "
           "cascades.depths = planes, or a cascades.radius_round_m";
  std::vector<std::string> open;
  if (!settings.view.near_m && !scene.camera.near_m) open.emplace_back("view.near_m");
  if (!settings.map.reach_m && !settings.view.far_m && !scene.camera.far_m) open.emplace_back("map.reach_m");
  if (open.empty() && settings.view.motion.zoom != 1 && !settings.map.fit_fov_deg)
    return "motion.zoom changes the angle that the maps are fitted to: their sizes change from frame to frame, and "
           "their "
           "texels flicker although map.snap is set; set map.fit_fov_deg to the widest angle";
  if (open.empty()) return "";
  return fmt::format(
      "cascades reach from the camera's near to its far plane, which are fitted anew in each frame: their sizes change "
      "from frame to frame, and their texels flicker although map.snap is set; set {}",
      fmt::join(open, " and "));
}

// A map is fitted to the camera's angle at least.
std::string narrow_fit_note(const Scene& scene, const Settings& settings) {
  const Camera camera = effective_camera(scene, settings.view);
  const std::optional<double> asked = settings.map.fit_fov_deg;
  const bool fits = settings.map.fit == MapFit::sphere || fits_corners(settings.map.fit);
  if (!asked || !fits || settings.view.motion.zoom != 1 || camera.projection != Projection::perspective ||
      *asked >= camera.fov_y_deg)
    return "";
  return fmt::format("map.fit_fov_deg = {:g} has no effect: the camera's own angle, {:g} degrees, is wider", *asked,
                     camera.fov_y_deg);
}

// map.fit = view has nothing to fit the map to where a slice holds no part of the scene.
std::string empty_slices_note(const Scene& scene, const Settings& settings) {
  if (settings.cascades.count == 1 || settings.map.fit != MapFit::view ||
      settings.cascades.depths == CascadeDepths::visible)  // these slices are known only when the picture is drawn
    return "";
  const Light light = effective_light(scene, settings);
  const LightFrame axes = kind_of_light(light.kind).axes(light);
  const std::vector<ViewSlice> slices = fitted_slices(scene, settings);
  std::vector<std::string> empty;
  for (size_t k = 0; k < slices.size(); ++k)
    if (!fit_to_view(scene, settings.view, settings.map, axes, &slices[k]))
      empty.push_back(fmt::format("{} ({:.3g} to {:.3g} m)", k + 1, slices[k].begin_m, slices[k].end_m));
  if (empty.empty()) return "";
  return fmt::format(
      "no part of the scene lies in the slice of cascade {}, so {} over the whole scene and nothing is looked up in "
      "{}; set other cascades.splits, a smaller cascades.count, or view.near_m and map.reach_m closer to the scene",
      fmt::join(empty, ", "), empty.size() == 1 ? "its map is laid" : "their maps are laid",
      empty.size() == 1 ? "it" : "them");
}

}  // namespace

std::vector<std::string> light_notes(const Scene& scene, const Settings& settings) {
  std::vector<std::string> notes;
  for (const auto& note_of : {first_of_several_note, made_up_light_note, map_fit_note, moving_splits_note,
                              narrow_fit_note, empty_slices_note})
    if (std::string note = note_of(scene, settings); !note.empty()) notes.push_back(std::move(note));
  return notes;
}

namespace {

LightFrame rolled(LightFrame frame, double roll_deg) {
  if (roll_deg == 0) return frame;
  const double angle = glm::radians(roll_deg), c = std::cos(angle), s = std::sin(angle);
  const glm::dvec3 right = c * frame.right + s * frame.up;
  frame.up = c * frame.up - s * frame.right;
  frame.right = right;
  return frame;
}

struct LaidMap {
  LightFrame axes;
  MapVolume volume;
  glm::dvec2 middle_m{0};
};

LaidMap laid_map(const Scene& scene, const Settings& settings, const KindOfLight& kind, const LightFrame& axes,
                 const ViewSlice* slice) {
  if (const std::optional<FittedMap> moved = moved_fit(scene, settings, axes, slice))
    return {axes, moved->volume, moved->middle_m};
  // The scene's own map volume fits only the scene's own light.
  if (scene.map && settings.map.fit == MapFit::scene && why_not_the_scenes(scene, settings).empty())
    return {axes, *scene.map, {}};
  return {axes, kind.fit(scene, axes, settings.map), {}};
}

// Of all rotations the one whose texels are smallest, or of which a map of the box's own shape needs the fewest. A square
// repeats after 90 degrees, a rectangle after 180. There are several minima, each narrower than a step of 3 degrees only
// where it is shallow too.
LaidMap smallest_map(const Scene& scene, const Settings& settings, const KindOfLight& kind, const LightFrame& axes,
                     const ViewSlice* slice) {
  constexpr double coarse_deg = 3, fine_deg = 0.5;
  double best_deg = 0;
  LaidMap best = laid_map(scene, settings, kind, axes, slice);
  const auto size = [&](const MapVolume& volume) {
    return settings.map.aspect ? volume.extent_m : volume.extent_m * volume.height_m.value_or(volume.extent_m);
  };
  const auto try_at = [&](double deg) {
    LaidMap one = laid_map(scene, settings, kind, rolled(axes, deg), slice);
    if (size(one.volume) < size(best.volume)) best = one, best_deg = deg;
  };
  for (double deg = coarse_deg; deg < (settings.map.aspect == 1 ? 90 : 180); deg += coarse_deg) try_at(deg);
  for (double step = -coarse_deg + fine_deg, around = best_deg; step < coarse_deg; step += fine_deg)
    try_at(around + step);
  return best;
}

}  // namespace

LightFrame make_light_frame(const Scene& scene, const Settings& settings, const ViewSlice* slice) {
  const Light light = effective_light(scene, settings);
  validate(settings, light.kind);
  const KindOfLight& kind = kind_of_light(light.kind);
  const bool cube = kind.map_shape() == MapShape::cube;
  const LightFrame axes = kind.axes(light);
  LaidMap laid = settings.map.roll_deg
                     ? laid_map(scene, settings, kind, cube ? axes : rolled(axes, *settings.map.roll_deg), slice)
                     : smallest_map(scene, settings, kind, axes, slice);
  LightFrame frame = laid.axes;
  MapVolume volume = laid.volume;
  if (settings.map.depth_range == DepthRange::scene && kind.rays().have_one_direction()) {
    const MapVolume whole = fit_map(scene, light);
    volume.near_m = whole.near_m;
    volume.far_m = whole.far_m;
  }
  frame.origin_m += laid.middle_m.x * frame.right + laid.middle_m.y * frame.up;
  frame.near_m = settings.map.near_m.value_or(volume.near_m);
  frame.far_m = settings.map.far_m.value_or(volume.far_m);
  frame.resolution = frame.rows = settings.map.resolution;
  frame.tiles = kind.tiles(settings.map);
  frame.texel_block = texel_block(settings);
  if (!(frame.near_m < frame.far_m) || !std::isfinite(frame.far_m - frame.near_m))
    throw SettingConflict("map.far_m",
                          fmt::format("the map's near plane ({} m) is not before its far plane ({} m); set "
                                      "map.near_m and map.far_m",
                                      frame.near_m, frame.far_m));
  kind.lay_map(frame, light, volume, settings.map);
  if (settings.cascades.count > 1) {  // the middle as centre_m
    const glm::dvec3 middle = frame.origin_m - axes.origin_m;
    frame.centre_m = {glm::dot(middle, frame.right), glm::dot(middle, frame.up)};
    frame.origin_m = axes.origin_m;
  }
  return frame;
}

}  // namespace noonmark
