#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "app/pictures/pictures.h"
#include "app/sweep/output_folder.h"
#include "app/verbs/experiment_arguments.h"
#include "app/verbs/model_report.h"
#include "app/verbs/verbs.h"
#include "base/progress.h"
#include "base/text.h"
#include "base/threads.h"
#include "measure/workbench.h"

namespace noonmark {
namespace {

// Says what a glTF model holds and writes a picture of it.
int inspect_file(const std::string& model, ExperimentArguments arguments) {
  const VerbOutputs outputs = outputs_of("inspect", model, arguments.out);
  OutputFolder folder(outputs);
  // A picture that is quick to make. A finer map changes nothing in it, because its shadow is the truth.
  arguments.sets.insert(arguments.sets.begin(), {"view.width_px=960", "view.height_px=540"});
  take_scene(arguments, model);
  const Settings settings = points(experiment_from("", arguments)).at(0);
  const ModelReport report = inspect_model(settings);
  const std::string& out = outputs.folder;
  if (!arguments.json) {
    fmt::print("{}", report_text(report));
    std::fflush(stdout);  // what follows can end the program: it takes OpenGL and the library of pictures
  }
  require_room_to_start(true);
  Workbench bench(gl::DebugMode::log);
  require_memory(bench.memory(settings, false, false), bench.memory_of_program(true), "this picture");
  Progress progress(arguments.quiet);
  const Progress::Work picture_drawn = progress.add(1);
  progress.say(fmt::format("the picture of {}", model));
  const Measurement m = bench.measure(settings, std::nullopt);
  folder.make();
  const std::string picture = out + "/" + outputs.files.front();
  write_png(picture, lit_picture(m));
  progress.finished(picture_drawn, "the picture is drawn");
  progress.end_line();
  if (arguments.json) {
    fmt::print("{}", report_json(report, picture));
    return 0;
  }
  fmt::print(
      "\n{} shows it with its true shadow: dark grey is in shadow, blue faces away from the light, pale "
      "yellow is ambiguous.\n"
      "Next: noonmark init {}\n",
      printable(picture), shell_quoted(model));
  return 0;
}

struct InspectOptions {
  std::string model;
  ExperimentArguments arguments;
};

RunVerb add_inspect(CLI::App& verb) {
  const auto options = std::make_shared<InspectOptions>();
  add_model(verb, options->model);
  add_json(verb, options->arguments, "Print the same as JSON");
  add_sets(verb, options->arguments);
  add_out(verb, options->arguments, "Folder for the picture",
          folders_of({"helmet.glb", "checks/helmet.glb"},
                     [](const std::string& model) { return outputs_of("inspect", model, "").folder; }));
  return [options](const std::string&) {
    const ThreadLimit limit(options->arguments.threads);
    return inspect_file(options->model, options->arguments);
  };
}

}  // namespace

Verb verb_inspect() {
  return {"inspect", "Say what a model holds and what is not modelled, and draw it with its shadow",
          "noonmark inspect model.glb", add_inspect};
}

}  // namespace noonmark
