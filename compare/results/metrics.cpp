#include "compare/results/metrics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <deque>
#include <map>
#include <utility>

#include "base/error.h"
#include "base/text.h"

namespace noonmark {
namespace metrics {
namespace {

using enum Metric::Is;

// A metric that is made from a row: "error_worst" from the row "error".
struct Statistic {
  Metric::Is of, kept;  // kept: what it has of its row beside moments and unbounded
  std::string_view name;
  const char* words;  // its help; {} is the row's name
};

constexpr Statistic statistics[] = {
    {placed, number, "mean", "Mean over the placements of the texel grid (map.placements) of {}, on the exact map."},
    {placed, csv, "worst",
     "Largest over the placements of the texel grid (map.placements) of {}, on the exact map. The largest of all "
     "placements may be a tenth more."},
    {placed, number, "best", "Least over the placements of the texel grid (map.placements) of {}, on the exact map."},
    {timed, csv, "low",
     "The lower end of the interval of {}: the second smallest sample. The interval holds the true median with 96%; "
     "two times differ only if their intervals do not overlap."},
    {timed, csv, "high", "The upper end of the interval of {}: the second largest sample."},
};

// Stores have the statistics of these before the other ones, and a store with columns in another order is refused.
bool is_first(std::string_view row) {
  return row == "error" || row == "wrong" || row == "acne" || row == "peter_panning";
}

// All metrics, and the texts of those that are made from rows.
struct MetricTable {
  MetricTable() {
    bool placed_stand = false;
    for (const Metric& row : metric_rows()) {
      // Before what else is measured of placements.
      if (row.is(placements) && !std::exchange(placed_stand, true))
        for (const bool first : {true, false})
          for (const Metric& one : metric_rows())
            if (is_first(one.name) == first) add_also(one, placed, plot | placements);
      all.push_back(row);
      add_also(row, timed, number);
    }
    for (const Metric& metric : all) by_name.emplace(metric.name, &metric);
  }
  void add_also(const Metric& row, Metric::Is which, unsigned facts) {
    if (!row.is(which)) return;
    for (const Statistic& one : statistics)
      if (one.of == which)
        all.push_back({texts.emplace_back(stored_name(fmt::format("{}@{}", row.name, one.name))), row.unit,
                       texts.emplace_back(fmt::format(fmt::runtime(one.words), row.name)),
                       facts | made | (row.facts & (moments | unbounded | one.kept))});
  }

  std::deque<std::string> texts;
  std::vector<Metric> all;
  std::map<std::string_view, const Metric*> by_name;
};

const MetricTable& table() {
  static const MetricTable made;
  return made;
}

}  // namespace
}  // namespace metrics

std::span<const Metric> metrics_table() { return metrics::table().all; }

std::vector<std::string> also_names(const Metric& row) {
  std::vector<std::string> names;
  for (const metrics::Statistic& one : metrics::statistics)
    if (row.is(one.of)) names.push_back(fmt::format("{}@{}", row.name, one.name));
  return names;
}

std::string also_text(const Metric& row) {
  const std::vector<std::string> names = also_names(row);
  return names.empty() ? "" : fmt::format(" Also {}.", fmt::join(names, ", "));
}

std::string stored_name(std::string_view name) {
  const size_t at = name.find('@');
  if (at == name.npos) return std::string(name);
  const std::string_view stem = name.substr(0, at), which = name.substr(at + 1);
  for (const std::string_view unit : {"_depth", "_m", "_texels", "_ms"})
    if (stem.ends_with(unit)) return fmt::format("{}_{}{}", stem.substr(0, stem.size() - unit.size()), which, unit);
  return fmt::format("{}_{}", stem, which);
}

const Metric* metric_named(std::string_view name) {
  const auto found = metrics::table().by_name.find(name);
  return found == metrics::table().by_name.end() ? nullptr : found->second;
}

bool is_of_lights(std::string_view name) {
  const Metric* const metric = metric_named(name);
  return metric && metric->is(Metric::lights);
}

const Metric& find_metric(std::string_view name) {
  if (const Metric* const metric = metric_named(name)) return *metric;
  std::vector<std::string_view> names;
  for (const Metric& metric : metrics_table()) names.push_back(metric.name);
  refuse_metric(name, names);
}

void refuse_metric(std::string_view name, std::span<const std::string_view> names) {
  // Metrics that were there in versions before 1.0, and what is the same.
  constexpr std::pair<std::string_view, std::string_view> gone[] = {{"pcf_error", "error"},
                                                                    {"pcf_error_soft", "error_soft"}};
  for (const auto& [old, same] : gone)
    if (name == old)
      throw Error(ErrorKind::usage,
                  fmt::format("there is no metric '{}' any more: it was '{}' at every point; write that", old, same));
  const std::string near = nearest_name(name, names);
  throw Error(ErrorKind::usage, fmt::format("there is no metric '{}'{} (noonmark settings lists the metrics)", name,
                                            near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
}

}  // namespace noonmark
