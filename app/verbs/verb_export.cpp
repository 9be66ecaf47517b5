#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <span>

#include "app/sweep/output_folder.h"
#include "app/verbs/experiment_arguments.h"
#include "app/verbs/option_values.h"
#include "app/verbs/verbs.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "scenes/camera_fit.h"
#include "scenes/gltf/write_glb.h"
#include "scenes/library.h"
#include "technique/chosen_light.h"
#include "technique/light_frame.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  std::string scene;
  ExperimentArguments arguments;
};

std::string glb_file_of(const std::string& scene) { return fs::path(scene).stem().string() + ".glb"; }

int write_scene(const ExportOptions& options) {
  const std::string file = options.arguments.out.empty() ? glb_file_of(options.scene) : options.arguments.out;
  require_new_file(file, ".glb", options.arguments.overwrite);
  ExperimentArguments arguments = options.arguments;
  take_scene(arguments, options.scene);
  const Settings settings = points(experiment_from("", arguments)).at(0);
  const Scene scene = make_scene(settings.scene);
  if (scene.triangles.empty()) throw Error(ErrorKind::file, options.scene + " has no triangle to write");
  const Light light = effective_light(scene, settings);
  // Where nothing chooses one light, the file has all, as an experiment with lights = "all" measures them. The first of them is
  // `light`, with what the settings change of it.
  std::span<const Named<Light>> more;
  if (!first_of_several_note(scene, settings).empty()) more = std::span(scene.lights).subspan(1);
  const std::string bytes = glb_of(scene, effective_camera(scene, settings.view), light, more);
  make_folder_above(file);
  write_file_atomically(file, bytes);
  const auto usable =
      std::count_if(more.begin(), more.end(), [](const Named<Light>& one) { return one.value.has_value(); });
  fmt::print("{} is written: {} triangles, camera and {}\n", printable(file), scene.triangles.size(),
             usable == 0 ? "light" : fmt::format("{} lights", 1 + usable));
  for (const Named<Light>& one : more)
    if (!one.value) fmt::print("  note: a light is left out: {}\n", printable(one.why_not));
  if (more.empty() && scene.lights.size() > 1)
    fmt::print(
        "  note: {} has {} lights, and the file has the one chosen; without light.name, light.index and light.kind it "
        "has "
        "all\n",
        printable(scene.name), scene.lights.size());
  if (scene.map)
    fmt::print("  note: glTF has no shadow map; {} has extent {:g} m, near {:g} m, far {:g} m of its own\n",
               printable(scene.name), scene.map->extent_m, scene.map->near_m, scene.map->far_m);
  if (light.angular_diameter_deg > 0 || light.radius_m > 0)
    fmt::print("  note: glTF's lights have no size, so the light in the file is a point\n");
  if (const std::string note = notes_line(scene); !note.empty()) fmt::print("  note: {}\n", printable(note));
  return 0;
}

RunVerb add_export(CLI::App& verb) {
  const auto options = std::make_shared<ExportOptions>();
  verb.add_option("scene", options->scene, "A built-in scene, or a model")
      ->required()
      ->check(not_empty())
      ->type_name(value_kind::scene);
  add_sets(verb, options->arguments);
  add_out_file(verb, options->arguments, "The file that is written", "FILE.glb",
               fmt::format("{} for cube-room", glb_file_of("cube-room")));
  return [options](const std::string&) { return write_scene(*options); };
}

}  // namespace

Verb verb_export() {
  return {"export", "Write a scene, its camera and its lights as a .glb that other renderers can show",
          "noonmark export cube-room --out cube-room.glb", add_export};
}

}  // namespace noonmark
