#include <fmt/format.h>

#include <filesystem>

#include "app/definition/default_folder.h"
#include "app/definition/experiment.h"
#include "app/definition/experiment_file.h"
#include "app/definition/first_experiment.h"
#include "app/verbs/verbs.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "scenes/library.h"
#include "technique/light_frame.h"

namespace noonmark {

namespace fs = std::filesystem;

int verb_init(const std::string& model, const ExperimentArguments& arguments) {
  if (!names_file(model))
    throw Error(ErrorKind::usage, fmt::format("{} is not a model: give the path of a .gltf or .glb file", model));
  const std::string file = arguments.out.empty() ? fs::path(model).stem().string() + ".toml" : arguments.out;
  std::error_code none;
  if (fs::is_directory(file, none))
    throw Error(ErrorKind::usage, fmt::format("{} is a folder; give the path of a file with --out", file));
  if (!arguments.overwrite && fs::exists(fs::symlink_status(file, none)))
    throw Error(ErrorKind::usage, fmt::format("{} is there already; choose another --out, or pass --overwrite", file));
  const Model loaded = load_model(model);
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  const std::string named =
      fs::path(model).is_absolute() ? model : fs::absolute(model).lexically_relative(folder).string();
  const std::string text = first_experiment(loaded, named);
  if (const std::string above = fs::path(file).parent_path().string(); !above.empty()) make_folder(above);
  write_file_atomically(file, text);
  // What is written must run: its settings are read back, and the light's map is laid as for the first point.
  const Settings first = points(load_experiment(file)).at(0);
  make_light_frame(make_scene(first.scene), first);
  const std::string word = shell_quoted(file);
  fmt::print("{} is written; each line says what to change\n", printable(file));
  if (const std::string note = notes_line(loaded.scene); !note.empty()) fmt::print("note: {}\n", printable(note));
  fmt::print(
      "\nNext:\n  noonmark run {}\n  open {}/report.html\n"
      "or, for the cheapest settings that hold the bounds:\n  noonmark recommend {}\n  noonmark check {}\n",
      word, shell_quoted(default_folder(file)), word,
      shell_quoted(default_folder(file, "recommend-") + "/recommended.toml"));
  return 0;
}

}  // namespace noonmark
