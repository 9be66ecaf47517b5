#include "app/sweep/run_info.h"

#include "app/definition/definition.h"
#include "app/sweep/identity.h"
#include "base/build_facts.h"
#include "base/clock.h"
#include "base/error.h"

namespace noonmark {
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

}  // namespace noonmark
