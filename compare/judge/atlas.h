// The atlas of failures: for one known failure and one technique, whether the technique holds, and where it stops. The
// rows are experiments with an [atlas] section (app/definition/atlas_reader.h); their parts are the techniques.
//
//   AtlasCell cell = judge_technique(entry, "texel plane", points_of_that_part);
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/results/records.h"

namespace noonmark {

// What an experiment's [atlas] section says (docs/reference/experiment.md). It changes no measurement.
struct AtlasEntry {
  std::string failure;                  // its name: "grazing light"
  std::string cause;                    // the metric that carries it: "acne"
  std::string driver;                   // the setting that is swept through the cliff
  std::string cure;                     // the part that has the cure; its bounds hold
  std::string without;                  // "name=value": with it the bounds of that part break
  std::string note;                     // one or two sentences for a reader; empty: none
  std::string thread;                   // address of a public report of this failure; empty: none
  std::string answer;                   // the sentence that would answer the thread; only with `thread`
  std::map<std::string, double> limit;  // metrics that must not be larger at any point, beside the thresholds below

  bool operator==(const AtlasEntry&) const = default;
};

// The members that are texts, by their keys in the file. Entry: AtlasEntry, const or not.
template <class Entry>
auto atlas_texts(Entry& entry) {
  using Text = std::pair<std::string_view, decltype(&entry.failure)>;
  return std::array<Text, 8>{{{"failure", &entry.failure},
                              {"cause", &entry.cause},
                              {"driver", &entry.driver},
                              {"cure", &entry.cure},
                              {"without", &entry.without},
                              {"note", &entry.note},
                              {"thread", &entry.thread},
                              {"answer", &entry.answer}}};
}

// Ordered from good to bad, so that the worst point decides.
enum class AtlasVerdict {
  holds,    // every point is within the thresholds
  fragile,  // some point is only so at some placements of the texel grid, or in a narrow window of biases
  fails,    // at some point no bias is within the thresholds
  nothing   // at some point there was no receiver to judge
};
std::string_view name_of(AtlasVerdict verdict);

// The largest bias of a window divided by its least. A narrower window is fragile: 2 is one doubling of the map's
// texel, such as the next step of a quality setting that keeps its bias in metres (law 1: the least bias is
// proportional to the texel).
inline constexpr double atlas_window_factor = 2;
// The largest share of wrong weight by acne, by Peter Panning and by coverage. It is the default of the usable window
// (docs/reference/experiment.md, curve.acne_bound).
inline constexpr double atlas_share = 0.001;

struct AtlasPoint {
  AtlasVerdict verdict = AtlasVerdict::holds;
  std::string why;  // empty if it holds
};
// A point with a bias curve is judged by its window, at the worst placement if there are several. A point without a
// curve is judged by its acne and Peter Panning. Coverage and entry.limit are judged at every point. A number that is
// missing or not finite fails.
AtlasPoint judge_point(const AtlasEntry& entry, const PointRecord& point);

struct AtlasCell {
  std::string technique;  // the part's name
  AtlasVerdict verdict = AtlasVerdict::holds;
  std::string cliff;   // value of the swept setting (entry.driver) at the first point that does not hold; empty:
                       // every point holds
  std::string why;     // of the point that decides
  int64_t point = -1;  // the point that decides: the first one with the worst verdict
  double left = 0;     // its error: at the best bias if it has a curve; NaN if nothing was judged
  double cost = 0;     // its texel_work
};
// points: those of one part in the order of the sweep, at least one.
AtlasCell judge_technique(const AtlasEntry& entry, const std::string& technique, std::span<const PointRecord> points);

// One cell for each part, in the order of the points.
std::vector<AtlasCell> judge_atlas(const AtlasEntry& entry, std::span<const PointRecord> points);

}  // namespace noonmark
