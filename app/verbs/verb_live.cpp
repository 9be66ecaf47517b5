#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "app/live/live_page.h"
#include "app/sweep/output_folder.h"
#include "app/verbs/one_point.h"
#include "app/verbs/verbs.h"
#include "base/build_facts.h"
#include "base/file.h"
#include "base/text.h"
#include "scenes/library.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

std::string page_of(const std::string& what) { return "live-" + fs::path(what).stem().string() + ".html"; }

int write_page(const PointOptions& options) {
  const std::string file = options.arguments.out.empty() ? page_of(options.what) : options.arguments.out;
  require_new_file(file, "", options.arguments.overwrite);
  const Settings settings = live_settings(chosen_point(options, "live").settings);
  const Scene scene = make_scene(settings.scene);
  require_live(scene, settings);
  const std::string page = live_page(scene, settings, build_facts().version);
  make_folder_above(file);
  write_file_atomically(file, page);
  fmt::print("{} is written: {} triangles, {:.0f} kB; open it in a browser, it needs no network\n", printable(file),
             scene.triangles.size(), std::ceil(static_cast<double>(page.size()) / 1000));
  print_notes(scene, settings);
  return 0;
}

RunVerb add_live(CLI::App& verb) {
  const auto options = std::make_shared<PointOptions>();
  add_point_options(verb, *options, false);
  add_out_file(verb, options->arguments, "The page that is written", "FILE.html",
               fmt::format("{} for cube-room", page_of("cube-room")));
  return [options](const std::string&) { return write_page(*options); };
}

}  // namespace

Verb verb_live() {
  return {"live", "Write a page with sliders: a scene's map and shadows, and why each pixel is wrong",
          "noonmark live model.glb", add_live};
}

}  // namespace noonmark
