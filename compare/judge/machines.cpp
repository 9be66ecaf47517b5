#include "compare/judge/machines.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "base/text.h"
#include "compare/judge/conditions.h"
#include "compare/results/metrics.h"

namespace noonmark {
namespace {

using Machine = Machine;
using Numerics = std::tuple<std::string, std::string, std::string>;

// Two machines of the same kind give the same numbers, but for times.
Numerics numerics_of(const Machine& machine) { return {machine.cpu, machine.driver, machine.ray_tracer}; }

bool names_a_time(const std::string& text) {
  const std::span<const Metric> table = metrics_table();
  return std::any_of(table.begin(), table.end(),
                     [&](const Metric& row) { return row.unit == "ms" && text.find(row.name) != std::string::npos; });
}

// Whether numbers of several machines are joined.
class Machines {
 public:
  void add(const Machine& machine, bool times) {
    if (times) hosts_.insert(machine.host);
    kinds_.insert(numerics_of(machine));
  }
  bool several() const { return hosts_.size() > 1 || kinds_.size() > 1; }

 private:
  std::set<std::string> hosts_;
  std::set<Numerics> kinds_;
};

std::string named_list(const std::vector<std::string>& names) {
  constexpr size_t most = 5;
  if (names.size() <= most) return fmt::format("{}", fmt::join(names, ", "));
  return fmt::format("{} and {} more", fmt::join(names.begin(), names.begin() + most, ", "), names.size() - most);
}

}  // namespace

MachineNotes machine_notes(const Results& results) {
  std::map<std::tuple<std::string, Numerics>, size_t> counts;
  for (const PointRecord& point : results.points) ++counts[{point.machine.host, numerics_of(point.machine)}];
  MachineNotes notes;
  if (counts.size() < 2) return notes;
  for (const auto& [machine, count] : counts) {
    const auto& [host, kind] = machine;
    const auto& [cpu, driver, ray_tracer] = kind;
    notes.machines.push_back(fmt::format("{} measured on host {} ({}; {}; Embree {})", counted(count, "point"), host,
                                         cpu, driver, ray_tracer));
  }

  std::vector<std::string> hanging;
  for (const BoundResult& bound : results.bounds) {
    Machines machines;
    const bool times = names_a_time(bound.metric);
    for (const PointRecord& point : results.points)
      if (point.part == bound.part && matches(point, bound.where)) machines.add(point.machine, times);
    if (machines.several()) hanging.push_back(fmt::format("the bound on {}", bound.metric));
  }
  for (const LawResult& law : results.laws) {
    Machines machines;
    const bool times = names_a_time(law.measured + " " + law.predicted);
    for (const PointRecord& point : results.points)
      if (point.part == law.part) machines.add(point.machine, times);
    if (machines.several()) hanging.push_back(fmt::format("law '{}'", law.name));
  }
  if (!hanging.empty())
    notes.warnings.push_back(fmt::format(
        "the points of {} were measured on machines that may round differently or are not equally fast, so the "
        "verdict can differ from that of one machine",
        named_list(hanging)));
  Machines timed;
  for (const PointRecord& point : results.points) timed.add(point.machine, true);
  if (names_a_time(results.info.cost) && timed.several())
    notes.warnings.push_back(fmt::format(
        "the answer ranks by {}, a time, and the points were timed on several machines", results.info.cost));
  return notes;
}

}  // namespace noonmark
