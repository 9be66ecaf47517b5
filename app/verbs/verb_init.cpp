#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/definition/default_folder.h"
#include "app/definition/experiment.h"
#include "app/definition/experiment_file.h"
#include "app/definition/first_experiment.h"
#include "app/sweep/output_folder.h"
#include "app/verbs/experiment_arguments.h"
#include "app/verbs/option_values.h"
#include "app/verbs/verbs.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "scenes/library.h"
#include "technique/light_frame.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

struct InitOptions {
  std::string model;
  std::string out;         // the experiment's file; empty: default_file()
  bool overwrite = false;  // a file that is there may be replaced
};

// In the working folder.
std::string default_file(const std::string& model) { return fs::path(model).stem().string() + ".toml"; }

int write_first_experiment(const InitOptions& options) {
  const std::string& model = options.model;
  if (!names_file(model))
    throw Error(ErrorKind::usage, fmt::format("{} is not a model: give the path of a .gltf, .glb or .vrm file", model));
  const std::string file = options.out.empty() ? default_file(model) : options.out;
  require_new_file(file, "", options.overwrite);
  const Model loaded = load_model(model);
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  const std::string named =
      fs::path(model).is_absolute() ? model : fs::absolute(model).lexically_relative(folder).string();
  const std::string text = first_experiment(loaded, named);
  make_folder_above(file);
  write_file_atomically(file, text);
  // What is written must run: its settings are read back, and the light's map is laid as for the first point.
  const Settings first = points(load_experiment(file)).at(0);
  make_light_frame(make_scene(first.scene), first);
  const std::string word = shell_quoted(file);
  fmt::print("{} is written; each line says what to change\n", printable(file));
  if (const std::string note = notes_line(loaded.scene); !note.empty()) fmt::print("note: {}\n", printable(note));
  if (loaded.scene.lights.size() > 1)
    fmt::print("note: the file has {} lights, and this experiment measures one; lights = \"all\" in it measures all\n",
               loaded.scene.lights.size());
  fmt::print(
      "\nNext:\n  noonmark run {}\n  open {}/report.html\n"
      "or, for the cheapest settings that hold the bounds:\n  noonmark recommend {}\n  noonmark check {}\n",
      word, shell_quoted(default_folder(file)), word,
      shell_quoted(default_folder(file, "recommend-") + "/recommended.toml"));
  return 0;
}

RunVerb add_init(CLI::App& verb) {
  const auto options = std::make_shared<InitOptions>();
  add_model(verb, options->model);
  verb.add_option("--out", options->out, "The experiment's file")
      ->check(not_empty())
      ->type_name(value_kind::experiment)
      ->default_str(fmt::format("{} for models/tree.glb", default_file("models/tree.glb")));
  verb.add_flag("--overwrite", options->overwrite, "Replace the file if it is there already");
  return [options](const std::string&) { return write_first_experiment(*options); };
}

}  // namespace

Verb verb_init() {
  return {"init", "Write a first experiment for a model of your own, ready to run", "noonmark init model.glb",
          add_init};
}

}  // namespace noonmark
