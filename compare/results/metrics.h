// The metrics: each row describes one number of a point, with its unit and its meaning. The store, the bounds, the
// experiment file and the report read it. The metrics are computed from the ladder (compare/ladder/ladder.h).
//
//   find_metric("error_worst").unit;     // "fraction"
//   stored_name("error@worst");          // "error_worst": so it stands in stores, tables and pages
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace noonmark {

struct Metric {
  // What its row says of it beside name, unit and meaning.
  enum Is : unsigned {
    number = 0,
    plot = 1,  // a chart over the sweep makes sense
    // Of what alone it is measured.
    placements = 2,   // map.placements above 1
    motion = 4,       // a [motion]
    frames = 8,       // another renderer's frame (frames/judge.h)
    lights = 16,      // a frame of several lights (measure/lights_frame.h)
    cascades = 32,    // cascades.count above 1
    moments = 64,     // a lookup in a map of moments (lookup.kind)
    unbounded = 128,  // a receiver more or less can change it by any amount; of other fractions by its share at most
    // What else there is of it, as metrics of their own whose names are made from its own.
    placed = 256,  // mean, worst and best over the placements of the texel grid
    timed = 512,   // low and high, the ends of the interval of its median (measure/pass_times.h)
    // Where `render` prints it; without one of these nowhere, or with words of its own.
    share = 1024,         // in the list of shares (of the counted receivers, or of the points of a motion)
    value = 2048,         // in the list of values below the shares, with its unit
    above_1 = 4096,       // in the list of values, but only where it is above 1
    one_receiver = 8192,  // in the list of shares of one receiver's full light
    made = 16384,         // its row is made from another row, which is placed or timed
    csv = 32768           // results.csv has it also where the experiment does not name it
  };

  std::string_view name;
  std::string_view
      unit;  // "fraction", "m", "depth", "texels", "pixels", "deg", "count", "bytes", "ms"; "": a plain number
  std::string_view help;  // one sentence
  unsigned facts = number;
  constexpr bool is(Is fact) const { return facts & fact; }
  bool optional() const { return facts & (placements | motion | frames | lights | cascades | moments); }
};

// The rows. noonmark settings lists them.
std::span<const Metric> metric_rows();
// All that a point can have: the rows, and what they have also.
std::span<const Metric> metrics_table();
// The names of the metrics that are made from a row, as a reader may write them: "error@mean". Empty: none are.
std::vector<std::string> also_names(const Metric& row);
// What follows the row's help where rows are listed: " Also error@mean, error@worst, error@best." or "".
std::string also_text(const Metric& row);
// The name under which a number stands in stores and tables. What follows an @ is moved before the unit: map_ms@low is
// map_low_ms, window_min_m@worst is window_min_worst_m. Any other name is itself.
std::string stored_name(std::string_view name);

// The metric of a stored name; null if there is none.
const Metric* metric_named(std::string_view name);
// Whether it is a metric of a frame of several lights.
bool is_of_lights(std::string_view name);
// Throws Error(usage) that suggests the nearest name.
const Metric& find_metric(std::string_view name);
// Throws that error. names: those among which the name is not.
[[noreturn]] void refuse_metric(std::string_view name, std::span<const std::string_view> names);

}  // namespace noonmark
