#include "app/sweep/baseline_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "compare/judge/deliveries.h"

namespace noonmark {
namespace {

// Far larger than the baseline of the largest sweep that a repository would hold. A device can be endless.
constexpr uint64_t max_baseline_bytes = uint64_t{1} << 28;

Baseline read_baseline(const std::string& path) {
  std::string text;
  try {
    text = read_file(path, max_baseline_bytes);
  } catch (const Error& error) {
    throw Error(ErrorKind::usage, fmt::format("{}; --update-baseline writes a baseline", error.what()));
  }
  return parse_baseline(text, path);
}

// What --update-baseline may replace: also a baseline that cannot be read, as one of another version, or with the marks of a merge.
void require_baseline_or_nothing(const std::string& path) {
  std::error_code none;
  if (!std::filesystem::exists(std::filesystem::symlink_status(path, none))) return;
  const std::string text = read_file(path, max_baseline_bytes);
  const auto has = [&](const char* key) { return text.find(key) != text.npos; };
  if (!text.empty() && !(has("\"format\":") && has("\"points\":")))
    throw Error(ErrorKind::usage,
                fmt::format("{}: is not a baseline, so --update-baseline does not replace it; give another file, or "
                            "remove it",
                            path));
}

Baseline baseline_of(const Experiment& experiment, const SweepOutcome& outcome, bool times) {
  Baseline baseline;
  baseline.opengl = outcome.results.info.gl_renderer;
  for (const PointRecord& point : outcome.results.points) {
    std::vector<Bound> bounds;
    for (const Bound& pattern : part_of_point(experiment, point.id).bounds)
      for (Bound& bound : expanded(pattern, {&point, 1})) bounds.push_back(std::move(bound));
    baseline.points.push_back(
        baseline_point(point, bounds, experiment.plot, times, outcome.scenes.at(static_cast<size_t>(point.id))));
  }
  return baseline;
}

}  // namespace

BaselineFile::BaselineFile(const BaselineOptions& options, const Experiment& experiment) : options_(options) {
  if (options_.file.empty()) return;
  const auto has_bounds = [](const Experiment& e) { return !e.bounds.empty(); };
  if (experiment.plot.empty() && !has_bounds(experiment) &&
      std::none_of(experiment.parts.begin(), experiment.parts.end(), has_bounds))
    throw Error(
        ErrorKind::usage,
        fmt::format("{} has no [[bound]] and no [plot], so a baseline would keep no value; add one", experiment.path));
  if (options_.update && !experiment.chosen.empty())
    throw Error(ErrorKind::usage,
                "--update-baseline with --part would remove the other parts from the baseline; leave --part out");
  if (options_.update)
    require_baseline_or_nothing(options_.file);
  else
    before_ = read_baseline(options_.file);
}

std::optional<BaselineComparison> BaselineFile::compare_or_update(const Experiment& experiment,
                                                                  const SweepOutcome& outcome,
                                                                  std::string& said) const {
  if (options_.file.empty()) return {};
  const Baseline now = baseline_of(experiment, outcome, options_.times.has_value());
  if (!options_.update) return compare_with_baseline(before_, now, options_.file, options_.times, experiment.chosen);
  // Its values would be written as "not measured", and a later one could not be worse.
  if (const size_t refused = refused_frames(outcome.results.points).size()) {
    said += fmt::format("the baseline {} is not written: {} of {} refused\n", printable(options_.file), refused,
                        counted(outcome.results.points.size(), "frame"));
    return {};
  }
  write_file_atomically(options_.file, baseline_text(now));
  said +=
      fmt::format("the baseline {} is written: {}\n", printable(options_.file), counted(now.points.size(), "point"));
  return {};
}

}  // namespace noonmark
