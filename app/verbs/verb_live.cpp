#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "app/live/live_page.h"
#include "app/sweep/output_folder.h"
#include "app/verbs/experiment_arguments.h"
#include "app/verbs/one_point.h"
#include "app/verbs/option_values.h"
#include "app/verbs/verbs.h"
#include "base/build_facts.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "scenes/library.h"
#include "technique/light_frame.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

struct LiveOptions {
  std::string what;  // an experiment's *.toml, a built-in scene, or a model's file
  long point = -1;   // of the experiment's sweep; -1: the sweep must have one point only
  ExperimentArguments arguments;
};

std::string page_of(const std::string& what) { return "live-" + fs::path(what).stem().string() + ".html"; }

int write_page(const LiveOptions& options) {
  const std::string file = options.arguments.out.empty() ? page_of(options.what) : options.arguments.out;
  require_new_file(file, "", options.arguments.overwrite);
  const Settings settings =
      live_settings(the_point(scene_or_experiment(options.what, options.arguments), options.point, "live"));
  const Scene scene = make_scene(settings.scene);
  require_live(scene, settings);
  const std::string page = live_page(scene, settings, build_facts().version);
  make_folder_above(file);
  write_file_atomically(file, page);
  fmt::print("{} is written: {} triangles, {:.0f} kB; open it in a browser, it needs no network\n", printable(file),
             scene.triangles.size(), std::ceil(static_cast<double>(page.size()) / 1000));
  if (const std::string note = notes_line(scene); !note.empty()) fmt::print("  note: {}\n", printable(note));
  for (const std::string& note : light_notes(scene, settings)) fmt::print("  note: {}\n", printable(note));
  return 0;
}

RunVerb add_live(CLI::App& verb) {
  const auto options = std::make_shared<LiveOptions>();
  add_scene_or_experiment(verb, options->what, "A built-in scene, a model, or an experiment's TOML file")->required();
  add_point(verb, options->point);
  add_sets(verb, options->arguments);
  verb.add_option("--out", options->arguments.out, "The page that is written")
      ->check(not_empty())
      ->type_name("FILE.html")
      ->default_str(fmt::format("{} for cube-room", page_of("cube-room")));
  verb.add_flag("--overwrite", options->arguments.overwrite, "Replace the file if it is there already");
  return [options](const std::string&) { return write_page(*options); };
}

}  // namespace

Verb verb_live() {
  return {"live",
          "Write one HTML page that draws a scene's map and shadows with sliders, and names why each pixel is wrong",
          add_live};
}

}  // namespace noonmark
