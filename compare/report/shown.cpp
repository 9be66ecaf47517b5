#include "compare/report/shown.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_set>
#include <utility>

#include "compare/judge/recommendation.h"
#include "compare/report/speed.h"
#include "compare/report/speed_reading.h"
#include "compare/report/text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

// Indices of the points that the page speaks of, the most important first.
std::vector<size_t> spoken_of(const ShownPoints& shown) {
  const std::vector<ComparedGroup>& groups = shown.groups;
  std::vector<size_t> out;
  std::map<int64_t, size_t> place;
  for (size_t i = 0; i < shown.all.points.size(); ++i) place.emplace(shown.all.points[i].id, i);
  const auto add = [&](int64_t id) {
    if (const auto found = place.find(id); found != place.end()) out.push_back(found->second);
  };
  if (shown.all.points.front().part.empty()) {
    for (const PointRecord* point : shown.recommended.choice.points) add(point->id);
  }
  for (const BoundResult& bound : shown.all.bounds) add(bound.point);
  for (const LawResult& law : shown.all.laws)
    if (law.worst >= 0) add(law.samples[static_cast<size_t>(law.worst)].point);
  const auto error_of = [](const PointRecord& point) {
    const double error = metric_of(point, "error");
    return std::isnan(error) ? -1 : error;
  };
  const auto worst = std::max_element(shown.all.points.begin(), shown.all.points.end(),
                                      [&](const auto& a, const auto& b) { return error_of(a) < error_of(b); });
  add(worst->id);
  const std::string& error = shown.error_first;
  for (const ComparedGroup& group : groups) {
    std::vector<size_t> named = front_of(group, shown.all.info.cost, error);
    if (group.recommended) named.push_back(*group.recommended);
    for (size_t i : named)
      if (const PointRecord* at = value_of(group.choices[i], error).at) add(at->id);
  }
  for (int64_t id : answer_points(groups, shown.techniques, shown.all)) add(id);
  for (size_t i = 0; i < shown.all.points.size(); ++i)
    if (!shown.all.points[i].pictures.empty()) out.push_back(i);
  return out;
}

// Evenly spaced numbers below `count`, with both ends; `keep` of them.
std::set<size_t> evenly(size_t count, size_t keep) {
  std::set<size_t> out;
  for (size_t i = 0; i < keep; ++i) out.insert(keep == 1 ? 0 : i * (count - 1) / (keep - 1));
  return out;
}

// Indices of the points of a smaller grid; empty if the points are not a grid. said: "100 values of extent, of which 10
// are shown".
std::vector<size_t> smaller_grid(const Results& results, std::string& said) {
  if (!results.points.front().part.empty()) return {};
  std::vector<std::vector<std::string>> values;
  double product = 1;
  std::vector<size_t> keep;
  for (const std::string& name : results.info.swept) {
    values.push_back(values_of(results, name));
    keep.push_back(values.back().size());
    product *= static_cast<double>(values.back().size());
  }
  if (product != static_cast<double>(results.points.size())) return {};
  while (product > static_cast<double>(max_even_points)) {
    size_t& most = *std::max_element(keep.begin(), keep.end());
    product = product / static_cast<double>(most) * static_cast<double>(most - 1);
    --most;
  }
  std::vector<std::unordered_set<std::string>> kept(values.size());
  for (size_t axis = 0; axis < values.size(); ++axis) {
    for (size_t i : evenly(values[axis].size(), keep[axis])) kept[axis].insert(values[axis][i]);
    if (keep[axis] < values[axis].size())
      said += fmt::format("{}{} of the {} values of {}", said.empty() ? "" : ", ", keep[axis], values[axis].size(),
                          setting_label(results.info.swept[axis]));
  }
  std::vector<size_t> out;
  for (size_t i = 0; i < results.points.size(); ++i) {
    bool in = true;
    for (size_t axis = 0; axis < values.size() && in; ++axis)
      in = kept[axis].contains(setting_of(results.points[i], results.info.swept[axis]));
    if (in) out.push_back(i);
  }
  return out;
}

}  // namespace

ShownPoints shown_points(const Results& results) {
  const size_t count = results.points.size();
  ShownPoints shown(results);
  shown.costs = costs_of(results);
  shown.errors = errors_of(results);
  shown.error_first = error_shown_first(results);
  if (count <= most_whole_points) {
    shown.results = results;
    return shown;
  }
  std::string said;
  std::vector<size_t> even = smaller_grid(results, said);
  if (even.empty()) {
    said.clear();
    for (size_t i : evenly(count, max_even_points)) even.push_back(i);
  }
  std::set<size_t> chosen(even.begin(), even.end());
  const size_t from_the_grid = chosen.size();
  for (size_t i : spoken_of(shown)) {
    if (chosen.size() == from_the_grid + max_marked_points) break;
    chosen.insert(i);
  }
  Results& out = shown.results;
  out.info = results.info;
  out.planned_points = results.planned_points;
  out.bounds = results.bounds;
  out.laws = results.laws;
  for (size_t i : chosen) out.points.push_back(results.points[i]);
  shown.note = paragraph(
      css("note thinned"),
      prose("Shown here: {}, so that the page opens quickly: {}, and the points that this page names. Verdicts, "
            "findings, means and the Pareto front in the table are of all points. All points are in {} and {} beside "
            "this page.",
            bold(prose("{} of {} points", chosen.size(), count)),
            said.empty() ? "evenly chosen points of the sweep" : said, code("results.csv"), code("results.sqlite")));
  return shown;
}

}  // namespace noonmark::report
