// The table of metrics: each row describes one number of a point, with its unit and its meaning. The store, the bounds,
// the experiment file and the report read it. The metrics are computed from the ladder (compare/ladder/ladder.h).
#pragma once
#include <span>
#include <string_view>

namespace noonmark {

struct Metric {
  std::string_view name;
  std::string_view
      unit;  // "fraction", "m", "depth", "texels", "pixels", "deg", "count", "bytes", "ms"; "": a plain number
  std::string_view help;       // one sentence
  bool plotted;                // whether a chart over the sweep makes sense
  bool of_placements = false;  // measured only with map.placements above 1
  bool of_motion = false;      // measured only with a [motion]
  bool of_frames = false;      // measured only of another renderer's frame (frames/judge.h)
  bool of_lights = false;      // measured only in a frame of several lights (measure/lights_frame.h)
  bool of_cascades = false;    // measured only with cascades.count above 1
  bool of_moments = false;     // measured only of a lookup in a map of moments (lookup.kind)
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
