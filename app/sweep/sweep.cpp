#include "app/sweep/sweep.h"

#include <fmt/format.h>

#include "app/definition/definition.h"
#include "app/sweep/identity.h"
#include "app/sweep/stop_on_signal.h"
#include "app/sweep/sweep_run.h"
#include "base/build_facts.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/text.h"
#include "compare/judge/soundness.h"

namespace noonmark {

std::string SweepOutcome::counts() const {
  return kept == 0 ? fmt::format("{} measured", counted(static_cast<size_t>(measured), "point"))
                   : fmt::format("{} measured, {} kept", counted(static_cast<size_t>(measured), "point"), kept);
}

void compare_with_baseline(const SweepOptions& options, SweepOutcome& outcome, ResultStore& store) {
  outcome.results.stopped = outcome.interrupted;
  if (!options.baseline || outcome.interrupted || !find_unsound(outcome.results.points).empty()) return;
  outcome.results.baseline = options.baseline(outcome);
  if (outcome.results.baseline) store.set_baseline(*outcome.results.baseline);
}

std::string stopped_text(const SweepOutcome& outcome) {
  const Results& results = outcome.results;
  const std::string points = counted(static_cast<size_t>(results.planned_points), "point");
  if (static_cast<int64_t>(results.points.size()) == results.planned_points)
    return fmt::format("stopped after all {}; the same command continues with what is left (times, phase diagrams)",
                       points);
  return fmt::format("stopped after {} of {}; the same command continues from there", results.points.size(), points);
}

namespace {

// Empty if no file can say the experiment with its options. A share needs it, because merge judges without the file.
std::string definition_of(const Experiment& experiment, bool needed) {
  try {
    return definition_text(experiment);
  } catch (const Error&) {
    if (needed) throw;
    return "";
  }
}

}  // namespace

RunInfo run_info(const Experiment& experiment, const std::string& folder, const SweepOptions& options,
                 const gl::DeviceInfo& device, const raytrace::TracerInfo& tracer) {
  RunInfo info;
  info.experiment = experiment.path;
  info.file = seen_from(folder, experiment.path);
  info.title = experiment.title;
  info.command = options.command;
  info.commit = build_facts().commit;
  info.version = build_facts().version;
  info.started = utc_now();
  info.host_cpu = host_cpu();
  info.gl_vendor = device.vendor;
  info.gl_renderer = device.renderer;
  info.gl_version = device.version;
  info.gl_timer = gl::text_of(device.times);
  info.embree_version = tracer.version;
  info.embree_isa = tracer.isa;
  for (const LibraryVersion& library : build_facts().libraries)
    info.libraries[std::string(library.name)] = library.version;
  info.swept = swept_names(experiment);
  info.over = condition_names(experiment);
  info.cost = experiment.cost;
  info.accuracy = experiment.accuracy;
  info.plot = experiment.plot;
  info.share = options.shard ? options.shard->text() : "";
  info.definition = definition_of(experiment, options.shard.has_value());
  return info;
}

SweepOutcome run_sweep(const Experiment& experiment, const ResultsFolder& folder, const SweepOptions& options) {
  if (!experiment.frames.empty()) return run_frames(experiment, folder, options);
  if (options.shard && experiment.lights)
    throw Error(ErrorKind::usage,
                fmt::format("{}: the lights of one frame cannot be measured in shares; run it without --shard",
                            experiment.path));
  if (options.shard)
    definition_text(experiment);  // an experiment that no file can say is refused before it is measured
  SweepRun run(experiment, folder, options);
  run.open();
  run.prepare();
  {
    const StopOnSignal guard;
    run.measure();
    run.lights();
    run.time();
  }
  run.tell();
  run.picture();
  run.picture_lights();
  run.judge();
  run.compare();  // after the last change of the run's facts
  run.show_recommended();
  run.show_failures();
  run.write();
  return run.take();
}

}  // namespace noonmark
