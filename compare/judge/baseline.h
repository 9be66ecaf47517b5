// A baseline: the values that an experiment had when its state was accepted, in a small text file that stands beside the
// experiment in a repository. A later run is compared with it and says what has become worse.
//
//   const Baseline before = parse_baseline(read_file("shadows.baseline.json"), "shadows.baseline.json");
//   const BaselineComparison found = compare_with_baseline(before, now, "shadows.baseline.json", {});
//   for (const std::string& line : found.worse) print(line);
//
// The file is JSON with sorted keys and one value per line. It holds no path (a scene's file is named without its
// folder) and no time of writing, so the same results give the same bytes.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compare/judge/bounds.h"
#include "compare/results/records.h"

namespace noonmark {

// Which change of a value is for the worse. It follows from the bounds that name the metric. Without a bound, or with
// limits on both sides, the better side is not known; then any change counts as worse, because it must not be missed.
enum class Better { smaller, larger, unknown };

struct BaselineValue {
  double value = 0;  // not a number: not measured
  Better better = Better::unknown;
  bool time = false;  // of unit "ms"
  double room = 0;    // ambiguous_room(): the receivers that are left out may change the value by so much
  // What it is at worst; not a number if that is not known. The file holds this, so a value that becomes ambiguous is worse.
  double at_worst() const;
};

struct BaselinePoint {
  std::string part;  // the experiment's part; empty if it has no parts
  // Every setting, of a frame those that it has; a scene's file without its folder.
  std::map<std::string, std::string> settings;
  std::string scene;                            // digest of the contents of a scene's file; empty: a built-in scene
  std::map<std::string, BaselineValue> values;  // by the name of a metric or of a quantity of the curve
};

struct Baseline {
  std::string opengl;  // the renderer that drew the maps, for a note where it differs
  std::vector<BaselinePoint> points;
};

// The digits to which a value is written. Values that do not depend on times are the same in every run of one program
// on one machine; sums in double over up to 1e7 pixels in another order differ by at most 1e7 * 2^-53 = 1e-9 of
// their size.
inline constexpr int baseline_digits = 8;

// The values of one point that a baseline keeps: those that `plot` names, and those that the bounds which the point
// matches name; with map.placements also the values of all placements that a bound judges. times: also those of unit
// "ms". scene: as BaselinePoint::scene.
BaselinePoint baseline_point(const PointRecord& point, std::span<const Bound> bounds, std::span<const std::string> plot,
                             bool times, const std::string& scene);

std::string baseline_text(const Baseline& baseline);

// Reads what baseline_text writes. Values have no `better`. path: for messages. Throws Error(usage) for any other text.
Baseline parse_baseline(std::string_view text, const std::string& path);

// Points are matched by their part and the values that it sweeps, before or now. So a point keeps its name when a fixed
// setting or the model changes; what changed is said beside what became worse. A setting that the file does not name has its
// default there, because it is newer than the file. A value changed if it differs by more than one unit of the last digit
// that the file holds: half of it is the file's rounding, half is for sums in another order. time_share: a time is compared
// only if it is given, and changed if it differs by more than this share of the time before. A point of the file that was
// not measured is worse, with the settings that differ from the nearest point; a new point or value is a note.
// parts: only points of these parts are compared; empty: all.
// Throws Error(usage) if no point is in both.
BaselineComparison compare_with_baseline(const Baseline& before, const Baseline& now, const std::string& path,
                                         std::optional<double> time_share, std::span<const std::string> parts = {});

// "no worse than the baseline: 12 values at 3 points ...": the comparison in one line, for the verdict.
std::string baseline_verdict(const BaselineComparison& comparison);

}  // namespace noonmark
