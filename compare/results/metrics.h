// The table of metrics: each row describes one number of a point, with its unit and its meaning. The store, the bounds,
// the experiment file and the report read it. The metrics are computed from the ladder (compare/ladder/ladder.h).
#pragma once
#include <span>
#include <string_view>

namespace noonmark {

struct Metric {
  // What its row says of it: whether a chart over the sweep makes sense, and of what alone it is measured.
  enum Is : unsigned {
    number = 0,
    plot = 1,
    placements = 2,  // map.placements above 1
    motion = 4,      // a [motion]
    frames = 8,      // another renderer's frame (frames/judge.h)
    lights = 16,     // a frame of several lights (measure/lights_frame.h)
    cascades = 32,   // cascades.count above 1
    moments = 64,    // a lookup in a map of moments (lookup.kind)
    unbounded = 128  // a receiver more or less can change it by any amount; of other fractions by its share at most
  };
  constexpr Metric(std::string_view its_name, std::string_view its_unit, std::string_view its_help, unsigned is)
      : name(its_name),
        unit(its_unit),
        help(its_help),
        plotted(is & plot),
        of_placements(is & placements),
        of_motion(is & motion),
        of_frames(is & frames),
        of_lights(is & lights),
        of_cascades(is & cascades),
        of_moments(is & moments),
        of_any_size(is & unbounded) {}

  std::string_view name;
  std::string_view
      unit;  // "fraction", "m", "depth", "texels", "pixels", "deg", "count", "bytes", "ms"; "": a plain number
  std::string_view help;  // one sentence
  bool plotted, of_placements, of_motion, of_frames, of_lights, of_cascades, of_moments, of_any_size;
  bool optional() const { return of_placements || of_motion || of_frames || of_lights || of_cascades || of_moments; }
};

std::span<const Metric> metrics_table();
// Whether it is a metric of a frame of several lights.
bool is_of_lights(std::string_view name);
// Throws Error(usage) that suggests the nearest name.
const Metric& find_metric(std::string_view name);
// Throws that error. names: those among which the name is not.
[[noreturn]] void refuse_metric(std::string_view name, std::span<const std::string_view> names);

}  // namespace noonmark
