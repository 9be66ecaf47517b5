#include "app/sweep/kept_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "app/pictures/point_pictures.h"
#include "base/error.h"
#include "base/text.h"
#include "compare/results/quantities.h"
#include "compare/store/fingerprint.h"
#include "compare/store/schema.h"

namespace noonmark {
namespace {

std::string key_of(const std::map<std::string, std::string>& settings, const std::string& scene_digest) {
  std::string key = scene_digest + "\n";
  for (const auto& [name, value] : settings) key += name + "=" + value + "\n";
  return key;
}

// Whether the stored point has the curve over curve.over that its part of the experiment asks for.
bool has_asked_over(const PointRecord& stored, const Experiment& part, const Settings& settings) {
  const ParameterValues& over = part.curve.over;
  const bool asked = part.curve_enabled && has_curve_over(settings, over.setting) && !nothing_judged(stored);
  if (!asked) return stored.over_curve.empty();
  const std::vector<double> values = values_of(over, settings);
  return std::equal(
      stored.over_curve.begin(), stored.over_curve.end(), values.begin(), values.end(),
      [&](const LookupCurvePoint& at, double value) { return at.parameter == over.setting && at.value == value; });
}

// Whether the stored point has the curve that its part of the experiment asks for, or can have it without a measurement.
bool has_asked_curve(const PointRecord& stored, const Experiment& part, const Settings& settings) {
  // The window of a reduction was judged when it was measured, by these bounds.
  if (stored.lookup_bounds && (!part.curve_enabled || *stored.lookup_bounds != part.curve)) return false;
  if (!stored.lookup_bounds && part.curve_enabled && has_reduction_curve(settings) && !nothing_judged(stored))
    return false;
  const bool asked = part.curve_enabled && curve_part(settings) && !nothing_judged(stored);
  if (stored.curve.has_value() != asked) return false;
  if (!asked) return true;
  const BiasCurve& curve = *stored.curve;
  const CurveOptions& options = part.curve;
  return curve.bias_depth == biases_of(options) &&
         (static_cast<const CauseBounds&>(curve) == options || curve.steps.can_judge(options));
}

// Times that are asked for and not there are measured after all points.
bool has_asked_times(const PointRecord& stored, bool timed) { return timed || !stored.metrics.contains("map_ms"); }

// The numbers of a frame of several lights are computed at every run that asks for them, and are of no use to another.
bool has_asked_lights(const PointRecord& stored, bool lights) {
  return lights || !stored.metrics.contains("lights_error");
}

// Finds a stored point for each planned one. In three rounds, because parts may have points with the same settings: the
// point that is where it was comes first, then one of the same part, then any.
std::vector<const PointRecord*> find_points(const std::vector<PointRecord>& stored, const AskedPoints& asked) {
  const auto& [experiment, planned, wanted, scenes] = asked;
  std::map<std::string, std::vector<const PointRecord*>> free;
  for (const PointRecord& point : stored) free[key_of(point.settings, point.scene_digest)].push_back(&point);
  const bool timed = times_measured(experiment);
  std::vector<const PointRecord*> found(planned.size());
  for (const int round : {0, 1, 2})
    for (const int64_t id : wanted) {
      const auto i = static_cast<size_t>(id);
      if (found[i]) continue;
      const Settings& settings = planned[i];
      const auto candidates = free.find(key_of(settings_map(settings), scenes.of(settings)));
      if (candidates == free.end()) continue;
      const Experiment& part = part_of_point(experiment, id);
      std::vector<const PointRecord*>& list = candidates->second;
      const auto one = std::find_if(list.begin(), list.end(), [&](const PointRecord* point) {
        return (round > 1 || point->part == part.part) && (round > 0 || point->id == id) &&
               has_asked_times(*point, timed) && has_asked_lights(*point, experiment.lights) &&
               has_asked_curve(*point, part, settings) && has_asked_over(*point, part, settings);
      });
      if (one == list.end()) continue;
      found[i] = *one;
      list.erase(one);
    }
  return found;
}

// The scenes of the points that are not found, but stored with other contents.
std::vector<std::string> edited_scenes(const std::vector<PointRecord>& stored, const AskedPoints& asked,
                                       const std::vector<const PointRecord*>& found) {
  std::map<std::string, std::set<std::string>> digests;
  for (const PointRecord& point : stored) digests[key_of(point.settings, "")].insert(point.scene_digest);
  std::set<std::string> edited;
  for (const int64_t id : asked.wanted) {
    const Settings& point = asked.planned[static_cast<size_t>(id)];
    if (found[static_cast<size_t>(id)] || edited.contains(point.scene.name)) continue;
    const auto known = digests.find(key_of(settings_map(point), ""));
    if (known != digests.end() && !known->second.contains(asked.scenes.of(point))) edited.insert(point.scene.name);
  }
  return {edited.begin(), edited.end()};
}

}  // namespace

void require_own_results(const std::string& folder, const std::string& fingerprint, const AskedPoints& asked) {
  const ResultStore store = ResultStore::open(folder + "/results.sqlite");
  std::set<std::string> stored;
  for (const PointRecord& point : store.all_points()) stored.insert(key_of(point.settings, point.scene_digest));
  const bool common = std::any_of(asked.wanted.begin(), asked.wanted.end(), [&](int64_t id) {
    const Settings& point = asked.planned[static_cast<size_t>(id)];
    return stored.contains(key_of(settings_map(point), asked.scenes.of(point)));
  });
  if (!common || !same_facts(without_scenes(fingerprint), without_scenes(store.fingerprint())))
    throw Error(ErrorKind::usage,
                fmt::format("{}: holds the results of another experiment ({}); give another --out, or "
                            "pass --overwrite to lose them",
                            folder, store.facts().info.experiment));
}

std::string KeptPoints::text(size_t planned, const std::string& folder) const {
  std::string text;
  if (kept > 0) {
    text = fmt::format("{} of {} {} in {} already", kept, counted(planned, "point"), planned == 1 ? "is" : "are",
                       printable(folder));
    if (rejudged > 0)
      text += fmt::format("; the bias curve{} of {} {} judged by other bounds", rejudged == 1 ? "" : "s", rejudged,
                          rejudged == 1 ? "is" : "are");
  }
  for (const std::string& scene : edited)
    text += fmt::format("{}the contents of {} have changed since its points were stored, so they are measured again",
                        text.empty() ? "" : "; ", printable(scene));
  if (aside > 0)
    text +=
        fmt::format("{}{} that this experiment does not have {} in the store for a later one", text.empty() ? "" : "; ",
                    counted(static_cast<size_t>(aside), "point"), aside == 1 ? "stays" : "stay");
  return text;
}

KeptPoints keep_points(ResultStore& store, const AskedPoints& asked, const std::string& folder,
                       const std::string& fingerprint) {
  const Experiment& experiment = asked.experiment;
  const std::string plan = noonmark::fingerprint(experiment, {});
  const std::vector<PointRecord> stored = store.all_points();
  const std::vector<const PointRecord*> found = find_points(stored, asked);
  KeptPoints result;
  result.edited = edited_scenes(stored, asked, found);
  std::vector<std::pair<int64_t, PointRecord>> changed;
  std::map<int64_t, bool> used;
  for (size_t i = 0; i < found.size(); ++i) {
    if (!found[i]) continue;
    const PointRecord& before = *found[i];
    const auto id = static_cast<int64_t>(i);
    const Experiment& part = part_of_point(experiment, id);
    used[before.id] = true;
    ++result.kept;
    PointRecord now = before;
    now.id = id;
    now.part = part.part;
    const bool other_bounds = now.curve && static_cast<const CauseBounds&>(*now.curve) != part.curve;
    if (other_bounds) {
      judge_window(*now.curve, part.curve);
      ++result.rejudged;
    }
    if (now.id != before.id || now.part != before.part || other_bounds) changed.emplace_back(before.id, std::move(now));
  }

  int64_t next = first_aside;
  for (const PointRecord& point : stored) next = std::max(next, point.id + 1);
  for (const PointRecord& point : stored) {
    if (used.contains(point.id)) continue;
    ++result.aside;
    if (point.id >= first_aside) continue;
    PointRecord aside = point;
    aside.id = next++;
    aside.pictures.clear();
    aside.images.clear();
    remove_pictures(point, folder);
    changed.emplace_back(point.id, std::move(aside));
  }
  // The files before the store: if the program is killed between the two, the store's pictures are not there and are made
  // again.
  std::vector<std::pair<int64_t, PointRecord*>> moved;
  for (auto& [before, point] : changed)
    if (point.id != before) moved.emplace_back(before, &point);
  move_pictures(moved, folder);
  if (!changed.empty()) store.replace(changed);
  if (store.plan() != plan || store.fingerprint() != fingerprint) store.set_plan(fingerprint, plan);
  return result;
}

}  // namespace noonmark
