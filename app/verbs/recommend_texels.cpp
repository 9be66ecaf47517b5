#include "app/verbs/recommend_texels.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/advise/recommend_text.h"
#include "app/advise/texel_budget.h"
#include "app/sweep/output_folder.h"
#include "base/error.h"
#include "base/file.h"
#include "base/progress.h"
#include "base/text.h"

namespace noonmark {
namespace {

// The lights of a frame, each with its settings, in a picture that is quick to measure.
std::vector<std::pair<std::string, Settings>> lights_of(const Experiment& experiment) {
  constexpr int most_width_px = 480;
  const std::vector<Settings> all = points(experiment);
  if (all.size() != experiment.parts.size())
    throw Error(ErrorKind::usage,
                "--texels divides the texels of one frame, and the experiment sweeps; fix its settings");
  std::vector<std::pair<std::string, Settings>> lights;
  for (size_t i = 0; i < all.size(); ++i) {
    Settings light = all[i];
    if (light.view.width_px > most_width_px) {
      light.view.height_px = std::max(1, light.view.height_px * most_width_px / light.view.width_px);
      light.view.width_px = most_width_px;
    }
    lights.emplace_back(experiment.parts[i].part, std::move(light));
  }
  return lights;
}

// Without --out the folder is named after the file or the scene alone. An answer for another scene of that name stays.
void require_own_division(const std::string& folder, const std::string& subject) {
  constexpr uint64_t most_bytes = 1 << 24;
  const std::string file = folder + "/texels.json";
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none) || subject_in(read_file(file, most_bytes)) == subject) return;
  throw Error(ErrorKind::usage,
              fmt::format("{}: holds a division of texels for another scene; give --out, or remove it", file));
}

}  // namespace

int recommend_texels(Experiment whole, int64_t texels, const ExperimentArguments& arguments, const std::string& out) {
  if (whole.parts.empty()) {
    whole.all_lights = true;
    take_all_lights(whole);
  } else if (!whole.lights) {
    throw Error(
        ErrorKind::usage,
        fmt::format("--texels: the parts of {} are not the lights of one frame; write lights = \"parts\"", whole.path));
  }
  const std::vector<std::pair<std::string, Settings>> lights = lights_of(whole);
  if (arguments.out.empty()) require_own_division(out, subject_of(lights.front().second));
  OutputFolder folder(outputs_of("texels", "", out));
  Workbench bench(gl::DebugMode::log);
  Progress progress(arguments.quiet);
  const TexelBudget found =
      divide_texels(bench, lights, texels, [&](const std::string& step) { progress.say(printable(step)); });
  progress.end_line();
  folder.make();
  write_file_atomically(out + "/texels.toml", budget_experiment(found, out));
  write_file_atomically(out + "/texels.json", budget_json(found));
  if (arguments.json) {
    fmt::print("{}", budget_json(found));
    return 0;
  }
  for (const std::string& line : budget_text(found)) fmt::print("{}\n", printable(line));
  fmt::print("\n{0}/texels.toml (measure it: noonmark run {0}/texels.toml) and {0}/texels.json are written\n",
             printable(out));
  return 0;
}

}  // namespace noonmark
