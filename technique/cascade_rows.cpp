// The rows of the settings of cascades (CascadeSettings), for the table in technique/settings.cpp.
#include <algorithm>

#include "technique/cascade_blends.h"
#include "technique/cascade_selections.h"
#include "technique/cascade_splits.h"
#include "technique/light_kind.h"
#include "technique/setting_rows.h"
#include "technique/setting_rules.h"

namespace noonmark::setting_rows {
namespace {

std::string without_cascades(const Settings& s, LightKind) {
  return s.cascades.count == 1 ? "with cascades.count = 1" : "";
}

// A setting that only some of the split schemes read.
std::function<std::string(const Settings&, LightKind)> without_split_that_reads(std::string_view setting) {
  return [setting](const Settings& s, LightKind light) -> std::string {
    if (std::string why = without_cascades(s, light); !why.empty()) return why;
    const std::vector<std::string_view>& reads = find_cascade_split(s.cascades.splits).reads;
    return std::find(reads.begin(), reads.end(), setting) == reads.end() ? "with cascades.splits = " + s.cascades.splits
                                                                         : "";
  };
}

// What a point with several cascades cannot have.
std::string cascades_with(const Settings& s, std::optional<LightKind> light) {
  if (s.cascades.count == 1) return "";
  if (!light && s.light.kind != LightChoice::automatic)  // before the scene is loaded
    light = static_cast<LightKind>(static_cast<int>(s.light.kind) - 1);
  if (light && !kind_of_light(*light).rays().have_one_direction())
    return fmt::format("cascades need a directional light, and this one is a {} light; set cascades.count = 1",
                       kind_of_light(*light).name());
  if (!fits_view(s.map.fit))
    return fmt::format(
        "each cascade is fitted to a slice of the view, but map.fit = {}; set map.fit = sphere, view or corner_*, or "
        "cascades.count = 1",
        find_setting("map.fit").get(s));
  if (s.map.extent_m)
    return "map.extent_m gives one extent, and each cascade has its own; leave map.extent_m out, or set cascades.count "
           "= 1";
  return "";
}

std::string bounds_of_another_count(const Settings& s, std::optional<LightKind>) {
  if (s.cascades.count == 1 || s.cascades.splits != "manual") return "";
  const size_t wanted = static_cast<size_t>(s.cascades.count) - 1;
  if (s.cascades.bounds_m.size() == wanted) return "";
  return fmt::format(
      "cascades.splits = manual needs the ends of all cascades but the last: {} for cascades.count = {}, and "
      "cascades.bounds_m has {}",
      wanted, s.cascades.count, s.cascades.bounds_m.size());
}

std::string bounds_of_visible_depths(const Settings& s, std::optional<LightKind>) {
  if (s.cascades.count == 1 || s.cascades.depths == CascadeDepths::planes || s.cascades.splits != "manual") return "";
  return "cascades.depths = visible moves the ends of the slices with the picture, and cascades.splits = manual gives "
         "them; set one of them";
}

std::string without_blend(const Settings& s, LightKind light) {
  if (std::string why = without_cascades(s, light); !why.empty()) return why;
  return s.cascades.blend > 0 ? "" : "with cascades.blend = 0";
}

// It says where the band by depth begins, to which the maps are fitted also where another way than the depth chooses them.
std::string without_band_by_depth(const Settings& s, LightKind light) {
  if (std::string why = without_blend(s, light); !why.empty()) return why;
  return s.cascades.select == "depth" || s.cascades.cover_band
             ? ""
             : fmt::format("with cascades.select = {} and cascades.cover_band = false", s.cascades.select);
}

std::string spheres_without_sphere(const Settings& s, std::optional<LightKind>) {
  if (s.cascades.count == 1 || s.cascades.select != "sphere" || s.map.fit == MapFit::sphere) return "";
  return fmt::format(
      "cascades.select = sphere needs the spheres of map.fit = sphere, and map.fit = {}; set one of them",
      find_setting("map.fit").get(s));
}

// A list with a number for each cascade.
std::function<std::string(const Settings&, std::optional<LightKind>)> numbers_of_another_count(
    std::string_view setting, const std::vector<double>* (*list)(const Settings&)) {
  return [setting, list](const Settings& s, std::optional<LightKind>) -> std::string {
    const size_t given = list(s)->size(), wanted = static_cast<size_t>(s.cascades.count);
    if (s.cascades.count == 1 || given == 0 || given == wanted) return "";
    return fmt::format("{} needs one number for each of the {} cascades, and has {}", setting, wanted, given);
  };
}

}  // namespace

#define MEMBER(path) [](Settings& s) -> decltype((s.cascades.path)) { return s.cascades.path; }

std::vector<Setting> cascade_rows() {
  return {
      integer(
          "cascades.count", "", 1, most_cascades,
          "directional: cascaded shadow maps (CSM), how many maps share the view, each for a slice of its depth, from "
          "the camera's near plane to "
          "map.reach_m or the camera's far plane. Each has map.resolution, and is fitted to its slice by map.fit = "
          "sphere, view or corner_*; by sphere where no map.fit is given. What lies beyond the last slice is looked up "
          "in the last map.",
          MEMBER(count))
          .refused(cascades_with),
      choice("cascades.depths", {"planes", "visible"},
             "Between which depths the slices lie. planes: from the camera's near plane to map.reach_m or its far "
             "plane; visible: from the nearest to the farthest surface that a pixel of the picture shows, and at most "
             "to map.reach_m, as sample distribution shadow maps do (Lauritzen, Salvi, Lefohn 2011). Where all pixels "
             "show one depth, as planes.",
             MEMBER(depths))
          .idle(without_cascades)
          .refused(bounds_of_visible_depths),
      named("cascades.splits", "At which depths the slices end.", cascade_splits(), MEMBER(splits))
          .idle(without_cascades),
      real("cascades.lambda", "", 0, 1, "practical: 0 is even, 1 is logarithmic.", MEMBER(lambda))
          .idle(without_split_that_reads("cascades.lambda")),
      real("cascades.exponent", "", 1, 16, "exponent: how many times as deep each slice is as the one before; 1: even.",
           MEMBER(exponent))
          .idle(without_split_that_reads("cascades.exponent")),
      real("cascades.first_m", "m", 1e-6, 1e9,
           "first_bound: the depth at which the first slice ends; auto: a tenth of the last.", MEMBER(first_m))
          .idle(without_split_that_reads("cascades.first_m")),
      number_list(ValueType::list, "cascades.bounds_m", "m", 1e-6, 1e9,
                  "manual: the depths at which all slices but the last end, in ascending order.", MEMBER(bounds_m))
          .idle(without_split_that_reads("cascades.bounds_m"))
          .refused(bounds_of_another_count),
      named("cascades.select",
            "By what the lookup chooses the cascade of a receiver; what no other holds is looked up in the last.",
            cascade_selections(), MEMBER(select))
          .idle(without_cascades)
          .refused(spheres_without_sphere),
      real("cascades.blend", "", 0, 0.5,
           "The part of a cascade, before its end, in which the next one is blended in: its weight grows from 0 to 1. "
           "By "
           "cascades.select = map or sphere it is a part of the way from the middle to the edge. 0: none.",
           MEMBER(blend))
          .idle(without_cascades),
      choice("cascades.blend_of", {"slice", "end", "square"},
             "Of what cascades.blend is a part by depth: by cascades.select = map or sphere too the maps are fitted to "
             "this "
             "band, if cascades.cover_band = true. slice: of the depth of the slice, as in "
             "Babylon.js; end: of the depth at which it ends, as in Bevy; square: of the square of that depth over the "
             "way from near to the reach, half of it before the end and half after it, as three.js's CSM fades "
             "(cascades.blend = 0.25).",
             MEMBER(blend_of))
          .idle(without_band_by_depth),
      named("cascades.blend_shape", "How the weight of the next cascade grows over the band.", cascade_blends(),
            MEMBER(blend_shape))
          .idle(without_blend),
      flag("cascades.cover_band",
           "Whether the map of a cascade is fitted to the band too in which it is blended in. Without it, what the map "
           "does not hold there is wrong by its coverage. With cascades.blend_of = square and map.fit = corner_* the "
           "square is wider by the band, as in three.js's CSM.",
           MEMBER(cover_band))
          .idle(without_blend),
      number_list(ValueType::whole_list, "cascades.resolutions", "texels", 1, 16384,
                  "A resolution for each cascade, near ones first; auto: all have map.resolution.", MEMBER(resolutions))
          .idle(without_cascades)
          .refused(numbers_of_another_count("cascades.resolutions",
                                            [](const Settings& s) { return &s.cascades.resolutions; })),
      number_list(
          ValueType::real_list, "cascades.bias_scales", "", 1e-6, 1e6,
          "A factor for each cascade, near ones first, of the bias of the compared depth (bias.constant, bias.slope "
          "...), as engines have it; what moves the lookup is not scaled. auto: 1 in all.",
          MEMBER(bias_scales))
          .idle(without_cascades)
          .refused(numbers_of_another_count("cascades.bias_scales",
                                            [](const Settings& s) { return &s.cascades.bias_scales; })),
      real("cascades.radius_round_m", "m", 0, 1e6,
           "map.fit = sphere and corner_*, also with one map: the radius of the sphere, or half of the square's side, "
           "is "
           "rounded up to a multiple of this, as engines do whose radius changes by rounding from frame to frame; 0: "
           "not rounded.",
           MEMBER(radius_round_m))
          .idle(setting_rules::without_slice_fit),
  };
}

#undef MEMBER

}  // namespace noonmark::setting_rows
