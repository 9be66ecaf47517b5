#include "compare/ladder/section.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "base/error.h"
#include "compare/ladder/receiver_taps.h"
#include "compare/ladder/thresholds.h"
#include "compare/ladder/wrong_patch.h"
#include "technique/casters.h"

namespace noonmark {
namespace {

// A section shows at least this much on both sides, so that the texel looked up and its neighbours are whole.
constexpr double least_reach = 2.5;
// Beyond this, columns are too narrow for a figure of 400 pixels. The plan of the taps shows the rest.
constexpr double most_reach = 7.5;
// Points of a cut where depth is no linear function of s. The largest distance between chord and curve falls with the
// square of their number; 1/64 of that of the whole cut is less than a drawn line's width.
constexpr int curve_steps = 8;

glm::dvec3 axes_of(const LightFrame& frame, glm::dvec3 world) {
  return {glm::dot(world, frame.right), glm::dot(world, frame.up), glm::dot(world, frame.forward)};
}

// Metres of depth per texel of the plane through `point` with this normal, at a position in the map. All in the light's
// frame. On a perspective tile the plane is z = c / (n.f + x n.r + y n.u) over the ray f + x r + y u.
glm::dvec2 plane_gradient_m(const MapTile& tile, glm::dvec3 point, glm::dvec3 normal, glm::dvec2 at) {
  const double per_texel = 2 * tile.half / tile.resolution;
  if (tile.orthographic) return -per_texel / normal.z * glm::dvec2(normal);
  const glm::dvec3 ray = tile.place_at(at);
  const double c = glm::dot(normal, point), z = c / glm::dot(normal, ray);
  const glm::dvec2 gradient =
      -z * z / c * per_texel * glm::dvec2(glm::dot(normal, tile.right), glm::dot(normal, tile.up));
  if (tile.depth != TileDepth::distance) return gradient;
  const double length = glm::length(ray);
  return gradient * length + z / length * per_texel * glm::dvec2(glm::dot(ray, tile.right), glm::dot(ray, tile.up));
}

// Cuts the scene's triangles by the plane that holds the section's rays. A side of the plane, and of the ray at each end
// of the section, is the sign of a linear function of a point's place (technique/light_frame.h).
class Knife {
 public:
  Knife(const LightFrame& frame, const MapTile& tile, const ReceiverSection& section)
      : frame_(frame), tile_(tile), section_(section) {
    const glm::dvec3 middle = tile.place_at(section.place);
    plane_ = glm::normalize(glm::cross(middle, tile.place_at(section.place + section.direction)));
    for (const double end : {-section.reach, section.reach}) {
      glm::dvec3 side = glm::cross(plane_, tile.place_at(section.place + end * section.direction));
      if (glm::dot(side, middle) < 0) side = -side;
      (end < 0 ? first_ : last_) = side;
    }
  }

  // corners: in the light's frame. Empty if the plane misses the triangle, or cuts it beyond the section's ends.
  std::vector<glm::dvec2> cut(const std::array<glm::dvec3, 3>& corners) const {
    std::array<double, 3> side{};
    for (size_t k = 0; k < 3; ++k) side[k] = glm::dot(plane_, frame_.place(corners[k]));
    std::vector<glm::dvec3> ends;
    for (size_t k = 0; k < 3; ++k) {
      const size_t next = (k + 1) % 3;
      if ((side[k] < 0) != (side[next] < 0))
        ends.push_back(glm::mix(corners[k], corners[next], side[k] / (side[k] - side[next])));
    }
    if (ends.size() != 2) return {};
    for (const glm::dvec3& limit : {first_, last_}) {
      const double a = glm::dot(limit, frame_.place(ends[0])), b = glm::dot(limit, frame_.place(ends[1]));
      if (a < 0 && b < 0) return {};
      if (a < 0) ends[0] = glm::mix(ends[0], ends[1], a / (a - b));
      if (b < 0) ends[1] = glm::mix(ends[1], ends[0], b / (b - a));
    }
    const int steps = tile_.orthographic ? 1 : curve_steps;
    std::vector<glm::dvec2> points;
    for (int k = 0; k <= steps; ++k) {
      const glm::dvec3 point = glm::mix(ends[0], ends[1], static_cast<double>(k) / steps);
      // A triangle through a spot light's own position has a place there only in the limit.
      if (!tile_.orthographic && !(tile_.along(point) > 0)) continue;
      points.emplace_back(glm::dot(tile_.texels(frame_.place(point)) - section_.place, section_.direction),
                          tile_.depth_m(point));
    }
    if (points.size() < 2) return {};
    if (points.front().x > points.back().x) std::reverse(points.begin(), points.end());
    return points;
  }

 private:
  const LightFrame& frame_;
  const MapTile& tile_;
  const ReceiverSection& section_;
  glm::dvec3 plane_{0}, first_{0}, last_{0};
};

std::vector<SectionLine> cut_scene(const SectionInput& in, const MapTile& tile, const ReceiverSection& section) {
  const LightFrame& frame = in.technique.frame;
  const Knife knife(frame, tile, section);
  std::vector<SectionLine> lines;
  for (size_t t = 0; t < in.scene.triangles.size(); ++t) {
    const glm::uvec3& corners = in.scene.triangles[t];
    const auto at = [&](uint32_t vertex) { return frame.to_light(glm::dvec3(in.scene.positions[vertex])); };
    if (std::vector<glm::dvec2> points = knife.cut({at(corners.x), at(corners.y), at(corners.z)}); !points.empty())
      lines.push_back({static_cast<uint32_t>(t), std::move(points)});
  }
  return lines;
}

// Where a line of the map's image passes from one texel to the next: s from -reach to reach, both included.
std::vector<double> crossings(const ReceiverSection& section) {
  std::vector<double> all{-section.reach, section.reach};
  for (int axis = 0; axis < 2; ++axis) {
    const double along = section.direction[axis];
    if (along == 0) continue;
    const double a = section.place[axis] - section.reach * along, b = section.place[axis] + section.reach * along;
    for (double edge = std::ceil(std::min(a, b)); edge <= std::max(a, b); ++edge)
      all.push_back(std::clamp((edge - section.place[axis]) / along, -section.reach, section.reach));
  }
  std::sort(all.begin(), all.end());
  return all;
}

class StoredMap {
 public:
  explicit StoredMap(const std::function<Image<float>(int, int)>& rows) : rows_(rows) {}
  float at(glm::ivec2 texel) {
    auto row = read_.find(texel.y);
    if (row == read_.end()) row = read_.emplace(texel.y, rows_(texel.y, 1)).first;
    return row->second.at(texel.x, 0);
  }

 private:
  const std::function<Image<float>(int, int)>& rows_;
  std::map<int, Image<float>> read_;
};

std::vector<SectionColumn> columns_of(const SectionInput& in, const MapTile& tile, const ReceiverSection& section) {
  // A passage through a texel's corner is no column: it is shorter than the rounding of a place in the map.
  const double shortest = std::max(1.0, glm::length(section.place)) * 0x1p-44;
  const MapDepths& exact = in.evidence.exact_map;
  const glm::ivec2 size = in.technique.frame.map_size();
  StoredMap stored(in.stored_rows);
  std::vector<SectionColumn> columns;
  const std::vector<double> ends = crossings(section);
  for (size_t k = 0; k + 1 < ends.size(); ++k) {
    if (ends[k + 1] - ends[k] <= shortest) continue;
    SectionColumn column;
    column.from = ends[k];
    column.to = ends[k + 1];
    column.texel = glm::ivec2(glm::floor(section.place + (ends[k] + ends[k + 1]) / 2 * section.direction));
    const glm::ivec2 in_tile = column.texel - tile.corner;
    const bool in_this_tile = inside_map(in_tile, glm::ivec2(tile.size()));
    if (!in_this_tile && in.technique.frame.tiles > 1) continue;  // a line of one face says nothing of the next
    column.inside = in_this_tile;
    const glm::dvec2 centre = glm::dvec2(column.texel) + 0.5 - section.place;
    column.centre = glm::dot(centre, section.direction);
    column.beside = section.direction.x * centre.y - section.direction.y * centre.x;
    const glm::ivec2 read = wrapped(column.texel, size, in.technique.settings.map.wrap);
    column.border = read.x < 0;
    const auto metres = [&](float window) { return tile.depth_of_window(static_cast<double>(window)); };
    column.stored_m = metres(column.border ? border_depth : stored.at(read));
    if (column.border)
      column.exact_m = metres(border_depth);
    else if (exact.texels->has(read))
      column.exact_m = metres(exact.at(read));
    columns.push_back(column);
  }
  return columns;
}

std::vector<SectionTap> taps_of(const SectionInput& in, const MapTile& tile, const ReceiverSection& section, size_t i,
                                float bias) {
  const LookupEvidence& e = in.evidence;
  ReceiverTaps read;
  read.read(e, i);
  const double whole = whole_weight(e.probe);
  std::vector<SectionTap> taps;
  for (size_t t = 0; t < read.size(); ++t) {
    const Tap& tap = read[t];
    const Tap shown = read.on(in.stored, in.technique.settings.map.format, t);
    const uint8_t bits = e.taps.bits(i, static_cast<int>(t));
    const auto metres = [&](float window) { return tile.depth_of_window(static_cast<double>(window)); };
    SectionTap out;
    out.tap = static_cast<int>(t);
    out.texel = e.probe.texel(i, out.tap);
    if (in.technique.frame.tiles > 1) out.tile = e.probe.tile(i, out.tap);
    out.same_tile = out.tile == section.tile;
    out.centre = glm::dvec2(out.texel) + 0.5 - section.place;
    out.along = glm::dot(out.centre, section.direction);
    out.reference_m = metres(tap.reference);
    out.compared_m = metres(tap.reference - bias);
    out.exact_m = metres(tap.depth);
    out.stored_m = metres(shown.depth);
    out.threshold_m =
        tap.always_lit ? 0 : out.reference_m - metres(tap.reference - lit_threshold(tap.reference, tap.depth));
    out.weight = tap.weight / whole;
    out.exact_lit = tap.exact_lit;
    out.moved_lit = tap.moved_lit;
    out.texel_lit = tap.texel_lit;
    out.lit = tap.lit(bias);
    out.shown_lit = shown.lit(bias);
    out.inside = inside_map(out.texel, in.technique.frame.map_size());
    out.near_clipped = (bits & tap_near_clipped) != 0;
    out.cause = tap_cause(tap, out.lit);
    taps.push_back(out);
  }
  return taps;
}

// The heaviest of these taps, of equally heavy ones the nearest to the place looked up; null without one.
template <class Is>
const SectionTap* heaviest_tap(const ReceiverSection& section, const Is& is) {
  const SectionTap* best = nullptr;
  for (const SectionTap& tap : section.taps)
    if (is(tap) && (!best || tap.weight > best->weight ||
                    (tap.weight == best->weight && glm::length(tap.centre) < glm::length(best->centre))))
      best = &tap;
  return best;
}

// One that has the pixel's cause; of precision and of a right pixel, one whose verdict OpenGL's map turns. Otherwise the middle tap.
size_t key_tap_of(const ReceiverSection& section, int middle) {
  const bool turned = section.cause == Cause::precision || section.cause == Cause::none;
  const SectionTap* best = heaviest_tap(
      section, [&](const SectionTap& tap) { return turned ? tap.lit != tap.shown_lit : tap.cause == section.cause; });
  return best ? static_cast<size_t>(best - section.taps.data()) : static_cast<size_t>(middle);
}

void require_finite(const ReceiverSection& section) {
  const auto require = [&](double value, const char* what) {
    if (!std::isfinite(value))
      throw Error(ErrorKind::defect,
                  fmt::format("the section through pixel {},{} has a number that is not finite ({}); report this with "
                              "the command and the output of noonmark doctor",
                              section.pixel.x, section.pixel.y, what));
  };
  require(section.place.x + section.place.y, "the place looked up");
  require(section.direction.x + section.direction.y, "the direction");
  require(section.gradient_m.x + section.gradient_m.y, "the slope");
  require(section.reference_m + section.receiver_m + section.receiver_s, "the receiver's depth");
  require(section.bias_m, "the bias");
  for (const SectionColumn& column : section.columns)
    require(column.stored_m + column.exact_m.value_or(0), "a stored depth");
  for (const SectionTap& tap : section.taps)
    require(tap.reference_m + tap.compared_m + tap.exact_m + tap.stored_m + tap.threshold_m, "the depth of a tap");
  for (const SectionLine& line : section.surfaces)
    for (const glm::dvec2& point : line.points) require(point.x + point.y, "a surface");
}

// The depth of a cut at s = 0, if it passes there.
std::optional<double> depth_at_place(const SectionLine& line) {
  for (size_t k = 0; k + 1 < line.points.size(); ++k) {
    const glm::dvec2 &a = line.points[k], &b = line.points[k + 1];
    if (a.x <= 0 && b.x >= 0 && a.x < b.x) return a.y + (b.y - a.y) * (-a.x / (b.x - a.x));
  }
  return std::nullopt;
}

// A triangle on the light's ray through a place of the map's image.
struct OnRay {
  uint32_t triangle = 0;
  double depth_m = 0;
};

// Those of the scene with these vertices, before depth before_m, the first one first.
std::vector<OnRay> on_ray(const SectionInput& in, const MapTile& tile, std::span<const glm::vec3> positions,
                          glm::dvec2 place, double before_m) {
  ReceiverSection through;
  through.place = place;
  through.reach = 1;
  const LightFrame& frame = in.technique.frame;
  const Knife knife(frame, tile, through);
  std::vector<OnRay> all;
  for (size_t t = 0; t < in.scene.triangles.size(); ++t) {
    const glm::uvec3& corners = in.scene.triangles[t];
    const auto at = [&](uint32_t vertex) { return frame.to_light(glm::dvec3(positions[vertex])); };
    const SectionLine line{static_cast<uint32_t>(t), knife.cut({at(corners.x), at(corners.y), at(corners.z)})};
    if (const auto depth = depth_at_place(line); depth && *depth < before_m) all.push_back({line.triangle, *depth});
  }
  std::sort(all.begin(), all.end(), [](const OnRay& a, const OnRay& b) { return a.depth_m < b.depth_m; });
  return all;
}

const Part& part_of(const Scene& scene, uint32_t triangle) {
  return *std::find_if(scene.parts.begin(), scene.parts.end(), [&](const Part& part) {
    return triangle >= part.first_triangle && triangle - part.first_triangle < part.triangle_count;
  });
}

std::optional<MissingBlocker> missing_blocker(const SectionInput& in, const MapTile& tile,
                                              const ReceiverSection& section, const SectionTap& tap) {
  const Technique& technique = in.technique;
  const Scene& scene = in.scene;
  const std::vector<glm::vec3> moved =
      technique.moves_casters() ? caster_positions(scene, technique.frame, technique.settings.map, technique.bias)
                                : std::vector<glm::vec3>();
  const std::span<const glm::vec3> drawn = moved.empty() ? std::span(scene.positions) : std::span(moved);
  const glm::dvec2 centre = section.place + tap.centre;
  const std::vector<OnRay> met = on_ray(in, tile, scene.positions, centre, tap.reference_m);
  if (met.empty()) return std::nullopt;
  const auto culled = [&](uint32_t t) {
    const glm::uvec3& c = scene.triangles[t];
    const glm::dvec3 a = drawn[c.x], b = drawn[c.y], d = drawn[c.z];
    const bool front = glm::dot(glm::cross(b - a, d - a), technique.frame.direction_to_light((a + b + d) / 3.0)) > 0;
    return technique.settings.map.cull == (front ? CulledFaces::front : CulledFaces::back);
  };
  const Part& part = part_of(scene, met.front().triangle);
  MissingBlocker missing{part.name, culled(met.front().triangle), {}};
  for (const OnRay& one : on_ray(in, tile, drawn, centre, std::numeric_limits<double>::infinity()))
    if (!missing.drawn_m && !culled(one.triangle) && &part_of(scene, one.triangle) == &part)
      missing.drawn_m = one.depth_m;
  return missing;
}

size_t checked_pixel(const SectionInput& in, glm::ivec2 pixel) {
  const int width = in.receivers.width(), height = in.receivers.height();
  const auto wrong = [&](const std::string& why) {
    return Error(ErrorKind::usage, fmt::format("pixel {},{} {}", pixel.x, pixel.y, why));
  };
  if (pixel.x < 0 || pixel.y < 0 || pixel.x >= width || pixel.y >= height)
    throw wrong(fmt::format("lies outside the picture, whose pixels are 0,0 (top left) to {},{}; give another --pixel",
                            width - 1, height - 1));
  const size_t i = in.receivers.primitive.index(pixel.x, pixel.y);
  if (in.receivers.primitive[i] == no_primitive) throw wrong("shows no surface; give another --pixel");
  if (!(in.ladder.flags[i] & flag_facing))
    throw wrong("shows a surface that gets no light from its front, so no map is asked there; give another --pixel");
  if (!in.evidence.probe.asks(i)) throw wrong("is looked up where the light's map has no place; give another --pixel");
  return i;
}

}  // namespace

std::optional<glm::ivec2> typical_pixel(const Ladder& ladder, size_t cause, bool in_all, const ProbeOf& probe_of) {
  const Image<float>& steps = ladder.causes.at(cause).step;
  const auto has = [&](size_t i) { return is_counted(ladder, i) && steps[i] != 0 && probe_of(i).asks(i); };
  float most = 0;
  for (size_t i = 0; i < steps.size(); ++i)
    if (has(i)) most = std::max(most, std::abs(steps[i]));
  Image<uint8_t> mask(steps.width, steps.height);
  for (size_t i = 0; i < steps.size(); ++i)
    mask[i] = has(i) && (in_all ? ladder.cause[i] == cause : std::abs(steps[i]) == most);
  const std::vector<glm::ivec2> patch = largest_patch(std::move(mask));
  if (patch.empty()) return in_all && most > 0 ? typical_pixel(ladder, cause, false, probe_of) : std::nullopt;
  return deepest_in(patch);
}

std::vector<glm::ivec2> section_pixels(const PointRecord& record, const Ladder& ladder, const ProbeOf& probe_of) {
  std::vector<glm::ivec2> pixels;
  const auto add = [&](int x, int y) {
    if (x < 0 || std::find(pixels.begin(), pixels.end(), glm::ivec2(x, y)) != pixels.end()) return;
    const size_t i = ladder.flags.index(x, y);
    if ((ladder.flags[i] & flag_facing) && probe_of(i).asks(i)) pixels.emplace_back(x, y);
  };
  if (record.worst.error != 0) add(record.worst.x, record.worst.y);
  for (const PointRecord::WorstOf& worst : record.worst_of) {
    const auto named = [&](const Ladder::CauseImage& cause) { return cause.name == worst.metric; };
    if (std::any_of(ladder.causes.begin(), ladder.causes.end(), named)) add(worst.x, worst.y);
  }
  return pixels;
}

ReceiverSection section_of(const SectionInput& in, glm::ivec2 pixel) {
  const size_t i = checked_pixel(in, pixel);
  const LookupProbe& probe = in.evidence.probe;
  const Technique& technique = in.technique;
  const LightFrame& frame = technique.frame;
  ReceiverSection section;
  section.pixel = pixel;
  section.position_m = in.receivers.position[i];
  section.normal = in.receivers.normal[i];
  section.light = frame.light().name();
  if (technique.cascade) section.cascade = technique.cascade->index + 1;
  section.map_size = frame.map_size();

  const glm::dvec3 receiver = frame.to_light(section.position_m);
  const glm::dvec3 looked_up = frame.to_light(technique.bias.looked_up(frame, section.position_m, section.normal));
  section.moved = technique.bias.moves_lookup();
  section.moved_m = glm::length(looked_up - receiver);
  section.tile = frame.tile_of(looked_up);
  const MapTile tile = frame.tile(section.tile);
  section.axial = tile.depth != TileDepth::distance;
  section.near_m = tile.near_m;
  section.far_m = tile.far_m;
  section.place = probe.cube_resolution > 0 ? frame.map_texels(looked_up) : glm::dvec2(probe.map_texels[i]);
  section.texel_m = tile.texel_m(looked_up);
  section.gradient_m = plane_gradient_m(tile, receiver, axes_of(frame, section.normal), section.place);
  // A change of depth within a texel that the rounding of the receiver's float position can make is no slope.
  const double slope = glm::length(section.gradient_m);
  section.has_slope = slope > tile.depth_m(receiver) * 0x1p-23;
  if (section.has_slope) section.direction = section.gradient_m / slope;

  const float bias = technique.bias.at(probe, i), reference = probe.reference[i];
  section.bias_depth = static_cast<double>(bias);
  section.reference_m = tile.depth_of_window(static_cast<double>(reference));
  section.bias_m = section.reference_m - tile.depth_of_window(static_cast<double>(reference - bias));
  section.beyond_far = reference > 1.0f;
  section.receiver_s = glm::dot(tile.texels(frame.place(receiver)) - section.place, section.direction);
  section.receiver_m = tile.depth_m(receiver);
  section.casters_moved = technique.moves_casters() || technique.bias.polygon_offset().has_value();

  section.soft_truth = in.ladder.soft_truth()[i];
  section.truth = in.ladder.truth()[i];
  section.on_exact_map = in.ladder[Rung::on_exact_map][i];
  section.shown = in.ladder[Rung::shown][i];
  section.ambiguous = !is_counted(in.ladder, i);
  if (in.ladder.cause[i] < in.ladder.built_in()) section.cause = static_cast<Cause>(in.ladder.cause[i]);
  section.largest = section.cause;

  section.share = in.share;
  section.taps = taps_of(in, tile, section, i, bias);
  if (section.share != 1) {  // the ladder has the mix of two maps
    double on_exact_map = 0, shown = 0;
    for (const SectionTap& tap : section.taps) {
      if (tap.lit) on_exact_map += tap.weight;
      if (tap.shown_lit) shown += tap.weight;
    }
    section.on_exact_map = static_cast<float>(on_exact_map);
    section.shown = static_cast<float>(shown);
  }
  section.key_tap = key_tap_of(section, probe.middle_tap());
  double reach = least_reach;
  for (const SectionTap& tap : section.taps)
    if (tap.same_tile) reach = std::max(reach, std::abs(tap.along) + 1);
  section.reach = std::min(reach, most_reach);
  section.columns = columns_of(in, tile, section);
  section.surfaces = cut_scene(in, tile, section);
  // The receiver's own surface does not block it: a few last places of floats in its depth, in the map's range, and in the
  // place looked up, which moves the depth by the slope.
  const double rounding_m = (section.receiver_m + section.far_m - section.near_m) * 0x1p-21 +
                            slope * std::max(1.0, glm::length(section.place)) * 0x1p-21;
  for (const SectionLine& line : section.surfaces)
    if (const std::optional<double> depth = depth_at_place(line); depth && *depth < section.reference_m - rounding_m)
      section.blocker_m = std::max(section.blocker_m.value_or(*depth), *depth);
  const auto panning = [](const SectionTap& one) { return one.cause == Cause::peter_panning; };
  if (const auto* tap = heaviest_tap(section, panning); tap && tap->same_tile && tap->exact_m >= tap->reference_m)
    section.missing = missing_blocker(in, tile, section, *tap);
  require_finite(section);
  return section;
}

void explain(ReceiverSection& section, Cause cause) {
  const bool has =
      std::any_of(section.taps.begin(), section.taps.end(), [&](const SectionTap& tap) { return tap.cause == cause; });
  if (!has) return;
  section.cause = cause;
  section.key_tap = key_tap_of(section, static_cast<int>(section.key_tap));
}

}  // namespace noonmark
