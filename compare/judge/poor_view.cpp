#include "compare/judge/poor_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "compare/judge/no_flicker.h"
#include "compare/judge/undecided.h"
#include "compare/results/quantities.h"

namespace noonmark {
namespace {

double number(const PointRecord& point, std::string_view name) {
  return quantity(point, name).value_or(std::numeric_limits<double>::quiet_NaN());
}

double pixels_of(const PointRecord& point) {
  double pixels = 1;
  for (const char* name : {"view.width_px", "view.height_px"}) {
    const auto side = point.settings.find(name);
    pixels *= side == point.settings.end() ? std::numeric_limits<double>::quiet_NaN()
                                           : std::strtod(side->second.c_str(), nullptr);
  }
  return pixels;
}

// view.fit_depths fits the planes that the scene's file gives. It does not change those of view.near_m and view.far_m.
std::string advice_on_depths(const PointRecord& point) {
  const auto setting = [&](const char* name) {
    const auto found = point.settings.find(name);
    return found == point.settings.end() ? std::string() : found->second;
  };
  const bool fitted = setting("view.fit_depths") == "true";
  std::string back;
  for (const char* name : {"view.near_m", "view.far_m"})
    if (const std::string given = setting(name); !given.empty() && given != "auto")
      back += fmt::format("{}{} = auto", back.empty() ? "" : " and ", name);
  if (back.empty())  // a fitted near plane cuts off surfaces much nearer than the rest (scenes/camera_fit.h)
    return fitted ? "set view.near_m, or move the camera" : "set view.fit_depths = true, or view.near_m and view.far_m";
  return fmt::format("set {}{}", back,
                     fitted ? "" : " (with view.fit_depths = true, where the scene's file gives a near or far plane)");
}

std::string cut_off(const PointRecord& point) {
  return fmt::format("at {:.0f} pixels the camera's near or far plane cuts the surface off; {}",
                     number(point, "clipped"), advice_on_depths(point));
}

// For a picture with few surfaces: the reason why surfaces are not seen, or advice on the camera's direction.
std::string why_few_surfaces(const PointRecord& point) {
  const double receivers = number(point, "receivers"), culled = number(point, "culled"),
               clipped = number(point, "clipped");
  if (culled > receivers && !(clipped > culled))
    return fmt::format(
        "{:.0f} pixels see only backs of single-sided faces, which glTF's cameras do not see; look from the other "
        "side, or make the material doubleSided",
        culled);
  if (clipped > receivers) return cut_off(point);
  if (number(point, "scene_behind") == 1)
    return "the whole scene is behind the camera; set view.eye_m or view.target_m";
  return "the camera looks past the scene, or sees it too small; set view.eye_m, view.target_m or view.fov_deg";
}

}  // namespace

std::string why_poor_view(const PointRecord& point) {
  const double pixels = pixels_of(point), counted = number(point, "counted"), receivers = number(point, "receivers"),
               facing = number(point, "facing"), few = std::max(1.0, few_receivers_share * pixels);
  if (!(counted < few)) {
    if (number(point, "lit") == 0)
      return fmt::format(
          "all of the {:.0f} pixels that can be judged are in shadow: the light reaches nothing that "
          "the camera sees, so no bias can be too small; {}",
          counted,
          number_of(setting_of(point, "light.elevation_deg")).value_or(0) < 0
              ? "the sun is below the horizon: raise light.elevation_deg"
              : "for a test of leaks that is right, for all else move the light or the camera out of what encloses it");
    return number(point, "clipped") >= few ? cut_off(point) : ambiguous_note(point);
  }
  std::string text = counted == 0 ? fmt::format("no pixel of {:.0f} can be judged: ", pixels)
                                  : fmt::format("only {:.0f} of {:.0f} pixels can be judged: ", counted, pixels);
  if (receivers < few)
    text += why_few_surfaces(point);
  else if (facing < few)
    text += fmt::format(
        "of {:.0f} that see a surface {:.0f} see one that faces away from the light, or lies outside "
        "its cone; move the camera or the light",
        receivers, receivers - facing);
  else
    text +=
        fmt::format("{:.0f} face the light, but the truth of {:.0f} of them is ambiguous", facing, facing - counted);
  return text;
}

std::string poor_view_note(std::span<const PointRecord> points) {
  size_t count = 0;
  const PointRecord* first = nullptr;
  for (const PointRecord& point : points) {
    if (why_poor_view(point).empty()) continue;
    ++count;
    if (!first) first = &point;
  }
  if (!first) return "";
  const std::string why = why_poor_view(*first);
  if (points.size() == 1) return why;
  return count == 1 ? fmt::format("point {}: {}", first->id, why)
                    : fmt::format("the picture is poor at {} of {} points; at point {}, {}", count, points.size(),
                                  first->id, why);
}

std::vector<std::string> doubts_of(std::span<const PointRecord> points) {
  std::vector<std::string> doubts = {poor_view_note(points), no_flicker_note(points), undecided_note(points)};
  std::erase(doubts, "");
  return doubts;
}

}  // namespace noonmark
