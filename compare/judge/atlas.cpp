#include "compare/judge/atlas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/judge/curve_reading.h"
#include "compare/judge/undecided.h"
#include "compare/results/quantities.h"

namespace noonmark {
namespace {

void worsen(AtlasPoint& point, AtlasVerdict verdict, const std::string& why) {
  if (verdict <= point.verdict) return;
  point.verdict = verdict;
  point.why = why;
}

// The largest value of a metric over the placements, and that of the map as the settings place it.
struct Shares {
  double worst, first;
};
Shares shares_of(const PointRecord& point, const std::string& metric) {
  Shares shares{metric_of(point, metric), metric_of(point, metric)};
  if (!has_placements(point)) return shares;
  for (const std::string& name : placed_names(metric).largest) {
    const double value = metric_of(point, name);
    if (!(value <= shares.worst)) shares.worst = value;  // also a NaN
  }
  return shares;
}

void judge_share(AtlasPoint& judged, const PointRecord& point, const std::string& metric, double most) {
  const Shares shares = shares_of(point, metric);
  const double room = ambiguous_room(point, metric);
  if (!std::isfinite(shares.worst) || !std::isfinite(shares.first))
    worsen(judged, AtlasVerdict::fails, fmt::format("{} is not finite", metric));
  else if (room > 0 && shares.worst <= most && shares.worst + room > most)
    worsen(judged, AtlasVerdict::fails,
           fmt::format("{} is not known: {:.3g} ± {:.3g}, and at most {:.3g} is allowed", metric, shares.worst, room,
                       most));
  else if (shares.first > most)
    worsen(judged, AtlasVerdict::fails,
           fmt::format("{} is {:.3g}, and at most {:.3g} is allowed", metric, shares.first, most));
  else if (shares.worst > most)
    worsen(judged, AtlasVerdict::fragile,
           fmt::format("{} is {:.3g} at one placement of the grid, and at most {:.3g} is allowed", metric, shares.worst,
                       most));
}

void judge_window(AtlasPoint& judged, const PointRecord& point) {
  const BiasCurve& curve = *point.curve;
  if (hides_window(point))
    return worsen(judged, AtlasVerdict::fails, fmt::format("the window of usable biases is {}", window_not_known));
  const bool placed = curve.placements > 1;
  const auto& min = placed ? curve.window_min_worst_depth : curve.window_min_depth;
  const auto& max = placed ? curve.window_max_worst_depth : curve.window_max_depth;
  if (!min || !max) {
    if (placed && curve.window_min_depth && curve.window_max_depth)
      worsen(judged, AtlasVerdict::fragile, "no bias is usable at every placement of the grid");
    else
      worsen(judged, AtlasVerdict::fails, "no bias is usable");
  } else if (!std::isfinite(*min) || std::isnan(*max)) {
    worsen(judged, AtlasVerdict::fails, "the window of usable biases is not finite");
  } else if (*max < atlas_window_factor * *min || *max == 0) {
    worsen(judged, AtlasVerdict::fragile,
           fmt::format("the usable biases span a factor of {:.2f}", *min > 0 ? *max / *min : 1.0));
  }
}

}  // namespace

std::string_view name_of(AtlasVerdict verdict) {
  switch (verdict) {
    case AtlasVerdict::holds:
      return "holds";
    case AtlasVerdict::fragile:
      return "fragile";
    case AtlasVerdict::fails:
      return "fails";
    case AtlasVerdict::nothing:
      return "nothing to judge";
  }
  return "";
}

AtlasPoint judge_point(const AtlasEntry& entry, const PointRecord& point) {
  if (nothing_judged(point)) return {AtlasVerdict::nothing, "no receiver is counted"};
  AtlasPoint judged;
  if (point.curve) {
    judge_window(judged, point);
  } else {
    judge_share(judged, point, "acne", atlas_share);
    judge_share(judged, point, "peter_panning", atlas_share);
  }
  judge_share(judged, point, "coverage", atlas_share);
  for (const auto& [metric, most] : entry.limit) judge_share(judged, point, metric, most);
  return judged;
}

AtlasCell judge_technique(const AtlasEntry& entry, const std::string& technique, std::span<const PointRecord> points) {
  AtlasCell cell;
  cell.technique = technique;
  const PointRecord* decides = nullptr;
  for (const PointRecord& point : points) {
    const AtlasPoint judged = judge_point(entry, point);
    if (judged.verdict != AtlasVerdict::holds && cell.cliff.empty()) cell.cliff = setting_of(point, entry.driver);
    if (decides && judged.verdict <= cell.verdict) continue;
    decides = &point;
    cell.verdict = judged.verdict;
    cell.why = judged.why;
  }
  // Where all points hold, the last one is shown: the driver's end.
  if (cell.verdict == AtlasVerdict::holds) decides = &points.back();
  cell.point = decides->id;
  cell.left = cell.verdict == AtlasVerdict::nothing ? std::numeric_limits<double>::quiet_NaN()
              : decides->curve                      ? decides->curve->best_error
                                                    : metric_of(*decides, "error");
  cell.cost = metric_of(*decides, "texel_work");
  return cell;
}

std::vector<AtlasCell> judge_atlas(const AtlasEntry& entry, std::span<const PointRecord> points) {
  std::vector<AtlasCell> cells;
  for (size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    end = begin + 1;
    while (end < points.size() && points[end].part == points[begin].part) ++end;
    cells.push_back(judge_technique(entry, points[begin].part, points.subspan(begin, end - begin)));
  }
  return cells;
}

}  // namespace noonmark
