// The checks of where the frame's pixels are: its positions, its visibility beside them, and its coverage.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "frames/alignment.h"
#include "frames/check_outcome.h"

namespace noonmark {
namespace {

// The largest share of receivers of given positions that may project outside their own pixel, or lie off the scene.
constexpr double most_stray = 0.01;

// Whether the given receivers are what the camera sees if near and far are exchanged, and not what it sees as declared. Rays
// of such a camera go the wrong way: they find the surface that is hidden by all others. Only pixels tell it whose first and
// last surface lie apart.
bool is_reversed(const CheckEvidence& e) {
  size_t other = 0;
  for (size_t i = 0; i < e.seen.size(); ++i)
    other += e.receivers.primitive[i] != no_primitive && e.receivers.primitive[i] != e.seen[i];
  if (other < enough) return false;
  glm::dmat4 exchanged(1);
  exchanged[2][2] = -1;
  const ViewMatrix turned(exchanged * e.frame.view.clip_from_world());
  const ReceiverImage first = resolve_receivers(e.scene, e.frame.view, e.seen),
                      last = resolve_receivers(e.scene, turned,
                                               e.tracer.seen_primitives(turned, e.seen.width, e.seen.height));
  const Image<float> pixel_m = pixel_width_m(e.frame.view, first);
  size_t of_first = 0, of_last = 0;
  for (size_t i = 0; i < e.seen.size(); ++i) {
    const glm::dvec3 p = e.frame.positions[i], a(first.position[i]), b(last.position[i]);
    if (first.primitive[i] == no_primitive || last.primitive[i] == no_primitive || !std::isfinite(p.x)) continue;
    if (!(glm::length(a - b) > OutlineAlignment::apart_px * pixel_m[i])) continue;
    of_first += glm::length(p - a) < pixel_m[i];
    of_last += glm::length(p - b) < pixel_m[i];
  }
  return of_last >= enough && of_first * 10 < of_last;
}

// 1 for each triangle that the camera's near plane cuts. A rasteriser puts new vertices there and rounds them to its grid, which
// moves the whole triangle: SwiftShader's by a quarter of a pixel.
std::vector<uint8_t> cut_by_near_plane(const Scene& scene, const ViewMatrix& view) {
  std::vector<uint8_t> is_before(scene.positions.size());
  for (size_t i = 0; i < is_before.size(); ++i) {
    const glm::dvec4 clip = view.clip_from_world() * glm::dvec4(scene.positions[i], 1);
    is_before[i] = clip.z < -clip.w;
  }
  std::vector<uint8_t> cut(scene.triangles.size());
  for (size_t t = 0; t < cut.size(); ++t) {
    const glm::uvec3 v = scene.triangles[t];
    cut[t] = is_before[v.x] != is_before[v.y] || is_before[v.y] != is_before[v.z];
  }
  return cut;
}

// Where positions lie in the picture, seen from the centres of their pixels.
struct Offsets {
  std::vector<double> x, y;
  void add(glm::dvec2 off) { x.push_back(off.x), y.push_back(off.y); }
  glm::dvec2 median() const { return {quantile(x, 0.5), quantile(y, 0.5)}; }
};
// A camera moves all surfaces. What the near plane cuts is moved by a wrong camera if it is by half a pixel.
constexpr double most_off_px = 0.1, most_off_of_cut_px = 0.5;

// What the positions say of one surface: a part of the scene, or all triangles that are in none.
struct SurfacePositions {
  std::string name;
  std::array<Offsets, 2> offsets;  // by whether the near plane cuts the triangle
  // Positions on it, and how far those lie off it that are off the scene.
  size_t count = 0;
  std::vector<double> stray_m;
  // Pixels at which the scene shows it, and those of them whose position lies before or behind it.
  size_t seen = 0, gone = 0;

  bool is_cut() const { return offsets[0].x.size() < enough; }
  bool told() const { return offsets[is_cut()].x.size() >= enough; }
  glm::dvec2 median() const { return offsets[is_cut()].median(); }
  bool is_moved() const { return told() && glm::length(median()) > (is_cut() ? most_off_of_cut_px : most_off_px); }
};

// A tenth of a surface's positions: more than its outline. Half of its pixels: a surface that is nowhere near.
constexpr double most_stray_of_surface = 0.1, most_gone = 0.5;

std::vector<uint32_t> surface_of_triangles(const Scene& scene) {
  std::vector<uint32_t> surface(scene.triangles.size(), static_cast<uint32_t>(scene.parts.size()));
  for (size_t p = 0; p < scene.parts.size(); ++p)
    std::fill_n(surface.begin() + scene.parts[p].first_triangle, scene.parts[p].triangle_count,
                static_cast<uint32_t>(p));
  return surface;
}

// How far a position lies off the scene, beyond what a step of its depth moves it. Depths of 24 bits, and floats near 1, have
// steps of 2^-24; where the near plane is close, one of them is wide far away.
double off_scene_m(const CheckEvidence& e, int x, int y) {
  const size_t i = e.moved_m.index(x, y);
  if (e.frame.receivers != GivenReceivers::depth || !(e.moved_m[i] > 0)) return e.moved_m[i];
  const glm::dvec3 p = e.frame.positions[i];
  const int width = e.moved_m.width, height = e.moved_m.height;
  const double depth = e.frame.view.pixel_of(p, width, height).z;  // of clip space, where the step is twice that
  const double step_m = glm::length(e.frame.view.world_at(x, y, depth - 0x1p-23, width, height) - p);
  return std::max(0.0, e.moved_m[i] - step_m);
}

std::vector<SurfacePositions> positions_by_surface(const CheckEvidence& e, double least_stray_m) {
  const Scene& scene = e.scene;
  std::vector<SurfacePositions> surfaces(scene.parts.size() + 1);
  for (size_t p = 0; p < scene.parts.size(); ++p)
    surfaces[p].name = scene.parts[p].name.empty() ? fmt::format("part {}", p) : "'" + scene.parts[p].name + "'";
  surfaces.back().name = "the surface";
  const std::vector<uint32_t> surface_of = surface_of_triangles(scene);
  const std::vector<uint8_t> cut = cut_by_near_plane(scene, e.frame.view);
  const ReceiverImage first = resolve_receivers(scene, e.frame.view, e.seen);
  const Image<float> pixel_m = pixel_width_m(e.frame.view, first);
  const int width = e.seen.width, height = e.seen.height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const size_t i = e.seen.index(x, y);
      const glm::dvec3 p = e.frame.positions[i];
      if (!std::isfinite(p.x)) continue;
      if (const uint32_t triangle = e.receivers.primitive[i]; triangle != no_primitive) {
        SurfacePositions& on = surfaces[surface_of[triangle]];
        ++on.count;
        on.offsets[cut[triangle]].add(glm::dvec2(e.frame.view.pixel_of(p, width, height)) -
                                      glm::dvec2(x + 0.5, y + 0.5));
        if (const double off = off_scene_m(e, x, y); off > least_stray_m) on.stray_m.push_back(off);
      }
      if (e.seen[i] == no_primitive) continue;
      SurfacePositions& shown = surfaces[surface_of[e.seen[i]]];
      ++shown.seen;
      shown.gone += std::abs(glm::dot(glm::dvec3(first.normal[i]), p - glm::dvec3(first.position[i]))) >
                    OutlineAlignment::apart_px * pixel_m[i];
    }
  return surfaces;
}

// Good frames of five renderers differ by 0.3% to 1% of the pixels on the scene's outline, frames that are half a pixel
// off by 16% and more.
constexpr double most_of_outline = 0.05;

bool covers(const Coverage& of_frame, const Coverage& of_scene) {
  return static_cast<double>(differing(of_frame, of_scene)) <=
         most_of_outline * static_cast<double>(outline_pixels(of_scene)) + 8;
}
bool covers(const CheckEvidence& e) { return covers(coverage_of_frame(e.frame), coverage_of(e.seen)); }

// What a shift of the samples says that leaves less than seven tenths of the pixels whose coverage differs; empty of another.
std::string cause_of(const Shift& shift, size_t differ) {
  if (shift.differing * 10 >= differ * 7 || shift.pixels == glm::dvec2(0)) return "";
  const bool halves = shift.pixels.x != std::round(shift.pixels.x) || shift.pixels.y != std::round(shift.pixels.y);
  // It is the furthest that was tried, or explains only a part.
  const bool part = 2 * shift.differing > differ;
  const std::string cause =
      halves
          ? fmt::format("it is one of these{}: samples are not at the pixels' centres, or multisampling was resolved",
                        part ? "" : " two")
          : "rows or columns are missing or doubled";
  return fmt::format("a shift of ({:+g}, {:+g}) pixels (x to the right, y down) leaves {} of them, so {}{}",
                     shift.pixels.x, shift.pixels.y, shift.differing, cause,
                     part ? ", or the picture is shifted further, or the camera is another one" : "");
}

// Whether pixels differ at the outline of `fixed` alone, and nearly all of them to one side: what `changed` does there; null
// if not.
const char* edges_alone(const Coverage& changed, const Coverage& fixed) {
  size_t grown = 0, shrunk = 0, apart = 0;
  for (int y = 0; y < fixed.height; ++y)
    for (int x = 0; x < fixed.width; ++x) {
      if (changed.at(x, y) == fixed.at(x, y)) continue;
      ++(changed.at(x, y) ? grown : shrunk);
      bool beside = false;
      for (int v = std::max(0, y - 1); v <= std::min(fixed.height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(fixed.width - 1, x + 1); ++u)
          beside = beside || fixed.at(u, v) != fixed.at(x, y);
      apart += !beside;
    }
  if (apart * 20 > grown + shrunk) return nullptr;
  if (grown > 9 * shrunk) return "has surfaces that are too large";
  return shrunk > 9 * grown ? "has surfaces that are too small" : nullptr;
}

// Of the pixels that have a position: how far it lies from the pixel's centre and from the scene, and how large its numbers are.
struct GivenPositions {
  Offsets all;
  std::vector<double> off_px, moved_m, size_m;
  size_t half = 0;  // whose three numbers are half floats
};
GivenPositions given_positions(const CheckEvidence& e) {
  const int width = e.frame.visibility.width, height = e.frame.visibility.height;
  GivenPositions given;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const size_t i = e.moved_m.index(x, y);
      const glm::dvec3 p = e.frame.positions[i];
      if (!std::isfinite(p.x)) continue;
      const glm::dvec2 at = glm::dvec2(e.frame.view.pixel_of(p, width, height)) - glm::dvec2(x + 0.5, y + 0.5);
      given.all.add(at);
      given.off_px.push_back(glm::length(at));
      given.moved_m.push_back(off_scene_m(e, x, y));
      given.size_m.push_back(glm::length(p));
      given.half += is_half(p.x) && is_half(p.y) && is_half(p.z);
    }
  return given;
}

// Fails where positions lie beside their pixels. Surfaces that nothing but the near plane can have moved are asked; where
// there are none, the picture as a whole, whose median this is.
std::optional<Outcome> beside_their_pixels(const std::vector<SurfacePositions>& surfaces, glm::dvec2 median) {
  size_t told = 0, moved_surfaces = 0;
  double others_px = 0;
  const SurfacePositions* worst = nullptr;
  for (const SurfacePositions& one : surfaces) {
    if (!one.told()) continue;
    ++told;
    if (!one.is_moved())
      others_px = std::max(others_px, glm::length(one.median()));
    else if (++moved_surfaces; !worst || glm::length(one.median()) > glm::length(worst->median()))
      worst = &one;
  }
  if (told == 0 ? glm::length(median) > most_off_px : moved_surfaces == told) {
    const glm::dvec2 by = glm::length(median) > most_off_px ? median : worst->median();
    return failed(
        fmt::format("half of the positions lie more than ({:+.2f}, {:+.2f}) pixels (x to the right, y down) from "
                    "the centre of their pixel: the camera is another one, or the picture is shifted, flipped or "
                    "jittered",
                    by.x, by.y));
  }
  if (!worst) return std::nullopt;
  return failed(fmt::format(
      "the positions on {} lie ({:+.2f}, {:+.2f}) pixels (x to the right, y down) from the centres of their pixels "
      "in the "
      "median, and those on {} other surfaces {:.3f} at most: {}",
      worst->name, worst->median().x, worst->median().y, told - moved_surfaces, others_px,
      moved_surfaces == 1
          ? "it is drawn with another camera or pose than its positions"
          : fmt::format("{} surfaces are drawn with another camera or pose than their positions", moved_surfaces)));
}

// Fails where one surface is elsewhere, and the rest is where the scene has it. stray: the share of all positions off the scene.
std::optional<Outcome> off_one_surface(const std::vector<SurfacePositions>& surfaces, double stray) {
  if (!(stray < most_gone)) return std::nullopt;
  const auto of = [](size_t part, size_t whole) { return static_cast<double>(part) / static_cast<double>(whole); };
  for (const SurfacePositions& one : surfaces) {
    if (one.seen >= enough && of(one.gone, one.seen) > most_gone)
      return failed(
          fmt::format("at {:.0f}% of the {} pixels where the scene shows {} the positions lie before or behind it: it "
                      "is elsewhere in the frame, or was not drawn",
                      100 * of(one.gone, one.seen), one.seen, one.name));
    if (one.count >= enough && of(one.stray_m.size(), one.count) > most_stray_of_surface)
      return failed(
          fmt::format("{:.0f}% of the {} positions on {} lie off it, half of these by more than {:.2g} m: its pose "
                      "in the frame is another one, or its shape",
                      100 * of(one.stray_m.size(), one.count), one.count, one.name, quantile(one.stray_m, 0.5)));
  }
  return std::nullopt;
}

// What the checks below say of a picture in another place.
constexpr std::string_view misplaced = "the picture is flipped or shifted";

}  // namespace

Outcome check_positions(const CheckEvidence& e, const FrameStatistics&) {
  if (e.frame.receivers == GivenReceivers::none)
    return not_checked(
        "no positions or depths were given: the receivers are those of rays through the pixels' centres");
  GivenPositions given = given_positions(e);
  std::vector<double>& moved = given.moved_m;
  if (moved.empty()) return failed("no pixel has a position; write the world position of every pixel with a surface");
  const auto count = static_cast<double>(moved.size());
  const double median_size = quantile(given.size_m, 0.5), median_moved = quantile(moved, 0.5);
  // A half float has 11 bits. Positions that are halves by chance, as on a grid of powers of two, have no rounding that moves
  // them in the picture.
  if (e.frame.receivers == GivenReceivers::positions && static_cast<double>(given.half) == count &&
      quantile(given.off_px, 0.95) > 0.01)
    return failed(
        fmt::format("every position is a half float, which puts one of twenty more than {:.2g} pixels beside its "
                    "place: write the positions as 32-bit floats",
                    quantile(given.off_px, 0.95)));
  const double least_stray_m = 0x1p-12 * median_size;
  const std::vector<SurfacePositions> surfaces = positions_by_surface(e, least_stray_m);
  const glm::dvec2 median = given.all.median();
  if (std::optional<Outcome> beside = beside_their_pixels(surfaces, median)) return *beside;
  if (is_reversed(e))
    return failed(
        "where a surface hides another, the positions are the hidden one's: the depths are reversed, so check the "
        "camera's 'reversed'; or the frame does not draw what hides it",
        "the camera's depths are reversed, or surfaces are missing");
  const double stray =
      static_cast<double>(std::count_if(moved.begin(), moved.end(), [&](double m) { return m > least_stray_m; })) /
      count;
  if (std::optional<Outcome> elsewhere = off_one_surface(surfaces, stray)) return *elsewhere;
  if (stray > most_stray)
    return failed(
        fmt::format("{:.1f}% of the positions lie off the scene, half of all by more than {:.2g} m: the scene, its "
                    "pose, its unit or its axes are others",
                    100 * stray, median_moved));
  std::string says = fmt::format(
      "positions lie on the scene (half of them within {:.1g} m) and in their own pixels (off by "
      "({:+.3f}, {:+.3f}) in the median)",
      median_moved, median.x, median.y);
  for (const SurfacePositions& one : surfaces)
    if (const Offsets& cut = one.offsets[1]; cut.x.size() >= enough && glm::length(cut.median()) > most_off_px)
      says += fmt::format("; {}, which the camera's near plane cuts, is moved by ({:+.2f}, {:+.2f}) pixels", one.name,
                          cut.median().x, cut.median().y);
  return passed(std::move(says));
}

// A renderer writes both from the same samples: frames of five engines differ at no pixel.
constexpr size_t enough_to_differ = 20;

Outcome check_alignment(const CheckEvidence& e, const FrameStatistics& s) {
  const std::optional<SurfaceAlignment> surfaces = surface_alignment(e.frame);
  if (surfaces && surfaces->misplaced()) {
    const std::string found =
        fmt::format("{} pixels have a surface in the visibility or in the receivers alone", surfaces->differing);
    return failed(surfaces->flip ? fmt::format("{}, and {} if the visibility is {}: write both the same way up", found,
                                               surfaces->left, surfaces->flip->says)
                                 : fmt::format("{}, and {} if the visibility is moved back by ({:+d}, {:+d}) pixels (x "
                                               "to the right, y down): it is shifted against them",
                                               found, surfaces->left, surfaces->shift.x, surfaces->shift.y),
                  misplaced);
  }
  if (surfaces && surfaces->differing >= enough_to_differ) {
    const Coverage of_visibility = coverage_of_visibility(e.frame);
    const Shift shift = best_shift(e.tracer, e.frame.view, of_visibility, coverage_of(e.seen));
    const size_t differ = differing(of_visibility, coverage_of(e.seen));
    if (const std::string cause = cause_of(shift, differ); !cause.empty() && 2 * shift.differing <= differ)
      return failed(fmt::format("{} pixels have a surface in the visibility or in the receivers alone; {}",
                                surfaces->differing, cause),
                    misplaced);
    if (const char* const change = edges_alone(of_visibility, coverage_of_positions(e.frame)))
      return failed(fmt::format("{} pixels have a surface in the visibility or in the receivers alone, all of them at "
                                "the outline, and the visibility {} there: multisampling was resolved",
                                surfaces->differing, change),
                    misplaced);
    return failed(
        fmt::format(
            "{} pixels have a surface in the visibility or in the receivers alone, and neither a flip nor a shift "
            "by a pixel explains it: the two are of different frames, or shifted further, or some surfaces have no "
            "visibility",
            surfaces->differing),
        misplaced);
  }
  if (e.frame.marks_no_surface && e.frame.receivers == GivenReceivers::none && !covers(e))
    return not_checked("the surfaces of the picture are not where the scene has them: see coverage");
  // A shift first: of a scene that is almost symmetric, the picture that is shifted is almost the one that is flipped.
  const OutlineAlignment& outlines = s.outlines;
  if (const glm::ivec2 shift = outlines.shift(); shift != glm::ivec2(0))
    return failed(
        fmt::format("at the outlines of surfaces the pixels on one side have the visibility of the surface behind the "
                    "outline, and those on the other side their own: the "
                    "visibility is shifted by a pixel or more towards ({:+d}, {:+d}) (x to the right, y down)",
                    shift.x, shift.y),
        misplaced);
  const ValueAlignment values = value_alignment(e.frame, e.truth);
  const auto least = std::min_element(values.by_flip.begin(), values.by_flip.end(),
                                      [](const auto& a, const auto& b) { return a.flipped < b.flipped; });
  if (least->count < enough)
    return not_checked(
        fmt::format("{} receivers face the light and have a visibility both as delivered and flipped; {} are needed",
                    least->count, enough));
  if (const PictureFlip* const flip = values.flip()) {
    const ValueAlignment::Compared& c = values.by_flip[static_cast<size_t>(flip - flips.data())];
    return failed(
        fmt::format("the visibility differs from the truth by {:.3f} in the mean as delivered, and by {:.3f} if it is "
                    "{}: it is {}, or the light is mirrored",
                    c.delivered, c.flipped, flip->says, flip->says),
        misplaced);
  }
  const std::string not_flipped = fmt::format(
      "the visibility differs from the truth by {:.3f} in the mean as delivered, flipped by {:.3f} at least",
      least->delivered, least->flipped);
  if (surfaces)
    return passed(fmt::format("{}; {} pixels have a surface in the visibility or in the receivers alone", not_flipped,
                              surfaces->differing));
  // The check of the coverage sees a shift by the scene's outline.
  if (e.frame.marks_no_surface && e.frame.receivers == GivenReceivers::none) return passed(not_flipped);
  if (outlines.told_x() && outlines.told_y())
    return passed(not_flipped + ", and at the outlines of surfaces every side has its own visibility");
  size_t fewest = std::numeric_limits<size_t>::max();
  for (const OutlineAlignment::Side* side : {&outlines.left, &outlines.right, &outlines.above, &outlines.below})
    fewest = std::min({fewest, side->lit, side->dark});
  return not_checked(
      fmt::format("{}; a shift of a pixel cannot be seen: no pixel is without a surface, and where a lit and a "
                  "shadowed surface meet that "
                  "lie apart in depth, one of the sides has {} pixels, and {} are needed",
                  not_flipped, fewest, OutlineAlignment::enough));
}

Outcome check_coverage(const CheckEvidence& e, const FrameStatistics&) {
  if (!e.frame.marks_no_surface)
    return not_checked(
        "no pixel says that it has no surface (-1, NaN, or alpha 0): a wrong camera or a shift of the picture "
        "cannot be seen here");
  const Coverage of_frame = coverage_of_frame(e.frame), of_scene = coverage_of(e.seen);
  const size_t outline = outline_pixels(of_scene);
  const size_t differ = differing(of_frame, of_scene);
  if (covers(of_frame, of_scene))
    return passed(
        fmt::format("{} of {} pixels have a surface in the frame or in the scene alone; its outline has {} pixels",
                    differ, of_scene.size(), outline));
  const std::string found = fmt::format(
      "{} of {} pixels have a surface in the frame or in the scene alone, and the scene's outline has {} pixels",
      differ, of_scene.size(), outline);
  // The flip that explains most must explain nine tenths. A shift must explain three tenths: the row that it brings in at
  // the border of the picture stays.
  size_t least = differ;
  const char* flip = "";
  for (const PictureFlip& one : flips)
    if (const size_t left = differing(flipped(of_frame, one.left_to_right, one.upside_down), of_scene); left < least) {
      least = left;
      flip = one.says;
    }
  if (least * 10 < differ) return failed(fmt::format("{}: the picture is {}", found, flip), misplaced);
  const Shift shift = best_shift(e.tracer, e.frame.view, of_frame, of_scene);
  if (const std::string cause = cause_of(shift, differ); !cause.empty())
    return failed(fmt::format("{}: {}", found, cause));
  const size_t lost = lost_surfaces(of_frame, of_scene);
  if (lost * 10 > differ * 9)
    return failed(
        fmt::format("{}, nearly all of them where only the scene has one: multisampling was resolved, or surfaces "
                    "of the scene are not in the frame, or pixels have no visibility",
                    found));
  return failed(fmt::format(
      "{}, and no flip or shift of up to a pixel explains them: the camera or the scene is another one", found));
}

}  // namespace noonmark
